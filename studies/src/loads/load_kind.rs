//! What a load kind is.

use super::site::LoadSite;
use std::fmt::Debug;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{LoadSpread, PointForce};
use voussoir_core::plugin::Diagnostic;

/// What a load does to the blocks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Placed {
    /// Forces on blocks.
    pub forces: Vec<PointForce>,
    /// Accelerations of all blocks \[m/s²\].
    pub accelerations: Vec<Vec2>,
    /// How what stands on a road has spread.
    pub spreads: Vec<LoadSpread>,
    /// What a user should know of where the load went.
    pub notes: Vec<String>,
}

impl From<Vec<PointForce>> for Placed {
    fn from(forces: Vec<PointForce>) -> Self {
        Placed { forces, ..Placed::default() }
    }
}

/// A kind of load, chosen by `kind = …` in an entry of `loads`.
#[typetag::serde(tag = "kind")]
pub trait LoadKind: Debug + Send + Sync {
    /// The forces and accelerations of the load, or what is wrong with its keys on these blocks.
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>>;
}
