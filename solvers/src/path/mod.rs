//! Path solvers: elastic blocks under growing loads up to collapse and post-peak, and their shared parts.

pub mod continuation;
mod dual_vector;
mod energy;
pub mod event;
mod events;
pub mod newton;
mod outcome;
mod self_check;
mod stability;
mod system;
mod twins;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod two_blocks;
