//! Solvers. Limit analysis so far: a general sparse conic one and one in the redundants of a chain.
//!
//! A solver knows no law: it reads strengths over a joint ([`voussoir_core::law::JointStrength`]).
#![forbid(unsafe_code)]

pub mod limit;
pub mod path;
pub mod point;
