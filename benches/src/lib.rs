//! Benches; they are in `benches/benches`.
