//! Path solvers: elastic blocks under growing loads until they collapse, and post-peak.

pub mod continuation;
pub mod event;
pub mod newton;
