//! Solvers of limit analysis (`limit`: chains, conic programs, sequences of them, non-associated flow), of paths
//! (`path`: from event to event, and steps by Newton's method) and of one point of a law (`point`).
//!
//! They stand on four folders that know no assembly: `optimise` (dense simplex, complementarity problems, line
//! search), `linear` (sparse rows, factorisations that follow changes of few rows), `contact` (modes, yield polygon and
//! return map of one contact point) and `rate` (the rate problem over the active set, for both path solvers). A solver
//! knows no law: limit analysis reads strengths over a joint ([`voussoir_core::law::JointStrength`]), paths read facets
//! or tractions from gaps.
#![forbid(unsafe_code)]

mod contact;
pub mod limit;
mod linear;
mod optimise;
pub mod path;
pub mod point;
mod rate;
