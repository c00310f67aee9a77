//! Dispersion of live loads between their position and the extrados of an arch. One file each; file = tag.

mod boussinesq;
mod law;
mod none;
mod uniform;

pub use law::{Dispersion, Patch, Through};
