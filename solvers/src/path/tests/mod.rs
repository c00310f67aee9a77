//! Tests of the shared parts of both path solvers: energies, events, stability, and checked claims.

mod claims;
mod energies;
mod outcomes;
mod second_order;
mod transitions;
