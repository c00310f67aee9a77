//! Pseudo-random numbers that are the same in every run.

/// A linear congruential generator (Knuth 1997, The Art of Computer Programming 2, 3.3.4, MMIX).
#[derive(Debug, Clone)]
pub struct Lcg(u64);

impl Lcg {
    /// Creates the sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Lcg(seed)
    }

    /// Returns the next number in [−1, 1).
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
