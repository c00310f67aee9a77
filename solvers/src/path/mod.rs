//! Path solvers: elastic blocks under growing loads until they collapse, and behind.

mod cells;
mod complementarity;
mod condensed;
pub mod continuation;
pub mod event;
mod events;
pub mod newton;
mod rows;
mod shuffle;
mod walk;
