//! Path solvers: elastic blocks under growing loads until they collapse, and behind.

mod cells;
mod complementarity;
pub mod continuation;
pub mod event;
pub mod newton;
mod shuffle;
mod walk;
