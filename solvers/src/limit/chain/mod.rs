//! `limit_chain`: limit analysis in the redundants of chains of bodies, and of scenes in which few joints close rings.
//!
//! A chain of bodies between two supports has three redundants (the force transmitted at its middle), a chain with a
//! free end has no redundant, a viaduct has three for each span. Every joint force is affine in the redundants and λ,
//! so an arch is a problem in four variables with a few rows per joint. It is solved by the simplex method on the dual:
//! columns are elementary mechanisms, and the basis has as many columns as there are variables. The most violated joint
//! of the present field enters. Crushing joints give infinitely many columns (the tangents of their stress block); the
//! last digits come from Newton's method on the active stress blocks.

mod engine;
mod layout;
mod optimum;
mod simplex;
mod small_lu;
mod solver;

pub use self::engine::ChainEngine;
pub use self::layout::trees;
pub use self::solver::LimitChain;
