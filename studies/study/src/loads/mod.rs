//! Loads of a stage: from the keys of a study to forces on blocks. One file each; file = tag.

pub mod axles;
pub mod body;
mod extrados;
pub mod face;
mod keys;
pub mod lane;
mod load_kind;
pub mod point;
pub mod pressure;
mod site;
mod space_site;
pub mod strip;
#[cfg(test)]
mod tests;
mod track;
mod vectors;
pub mod vehicle;
mod vehicle_axles;

pub use extrados::fill_layers;
pub use keys::load_shape;
pub use load_kind::{LoadKind, Placed};
pub use site::{BlockName, LoadSite, LoadTables};
pub use space_site::{SpacePlaced, SpaceSite};
pub use track::{Track, footprints};
pub use vectors::{Acceleration, Components, Force, Place};
pub use vehicle_axles::{Axle, VehicleAxles};
