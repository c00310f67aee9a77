//! Dispersion of live loads between their position and the extrados of an arch. One file each; file = tag.

pub mod boussinesq;
mod law;
pub mod none;
pub mod uniform;

pub use law::{Dispersion, Patch, Through};
