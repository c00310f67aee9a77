//! Path solvers: elastic blocks under growing loads until they collapse, and behind.

pub mod continuation;
pub mod event;
pub mod newton;
