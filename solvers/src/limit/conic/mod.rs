//! `limit_conic`: limit analysis of any scene by sparse conic programming, polished to rounding.

mod engine;
mod envelope;
mod interior_point;
mod polish;
mod solver;
mod system;
mod tangents;

pub use self::solver::{LimitConic, engine};
