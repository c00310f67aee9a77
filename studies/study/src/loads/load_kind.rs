//! The trait of a kind of load.

use super::site::LoadSite;
use super::space_site::{SpacePlaced, SpaceSite};
use std::fmt::Debug;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{LoadSpread, PointForce};
use voussoir_core::plugin::{Diagnostic, PluginKind, Registered};

/// The action of a load on the blocks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Placed {
    /// Forces on blocks.
    pub forces: Vec<PointForce>,
    /// Accelerations of all blocks \[m/s²\].
    pub accelerations: Vec<Vec2>,
    /// The spread of loads on the road.
    pub spreads: Vec<LoadSpread>,
    /// Notes for the user about the places where the load acts.
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
    /// Returns the forces and accelerations of the load. The error lists the mistakes in its keys for these blocks.
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>>;

    /// Returns the forces and accelerations of the load on blocks in space. `None` if the load exists in plane scenes only.
    fn place_space(&self, _: &SpaceSite) -> Option<Result<SpacePlaced, Vec<Diagnostic>>> {
        None
    }
}

voussoir_core::inventory::submit! { Registered::of::<dyn LoadKind>(PluginKind::LoadKind) }
