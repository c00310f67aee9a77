//! Scenes: each converts its geometry into an assembly of blocks. One file each; file = tag.

pub mod abutments;
pub mod arch;
pub mod blocks;
pub mod bridge;
mod curve;
pub mod dispersion;
pub(crate) mod keys;
pub(crate) mod lookup;
pub mod mesh;
mod overlap;
pub mod profile;
mod surveyed;
#[cfg(test)]
pub(crate) mod test_catalogue;
pub mod thickness;
pub mod wall;

pub use keys::PlaneState;
pub(crate) use lookup::unknown;
