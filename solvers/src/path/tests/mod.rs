//! Tests of what both path solvers share: energies, events, stability, and claims that are checked again.

mod claims;
mod energies;
mod outcomes;
mod second_order;
mod transitions;
