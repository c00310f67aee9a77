//! Path solvers: elastic blocks under growing loads until they collapse, and behind.

mod cells;
pub mod continuation;
pub mod event;
pub mod newton;
