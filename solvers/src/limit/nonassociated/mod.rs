//! `limit_least`: the least load with non-associated flow, with a proved lower bound.
#![doc = include_str!("limit_least.md")]

mod bracket;
mod conflict_search;
mod curve;
mod descent;
mod exchange;
mod products;
mod solver;
mod splitting;

pub use self::solver::LimitNonassociated;
