//! Path solvers: elastic blocks under growing loads until they collapse, and beyond: `event_path` and `newton_path`, and what they share.

mod cells;
mod complementarity;
mod condensed;
pub mod continuation;
mod energy;
pub mod event;
mod events;
pub mod newton;
mod outcome;
mod rows;
mod self_check;
mod shuffle;
mod walk;
