//! Solvers. Limit analysis so far: a general sparse conic one and one in the redundants of a chain.
//!
//! A solver knows no law: it reads strengths over a joint ([`voussoir_core::strength`]).
#![forbid(unsafe_code)]

mod contact;
pub mod limit;
mod linear;
pub use voussoir_core::lu;
mod optimise;
pub mod path;
pub mod point;
mod rate;
