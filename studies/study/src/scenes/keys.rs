//! Keys that scenes share.

use super::mesh::Mesh;
use voussoir_core::law::Plane;
use voussoir_core::plugin::Keys;

/// `plane`: stress state of deformable bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum PlaneState {
    /// ε_z = 0.
    Strain,
    /// σ_z = 0.
    Stress,
}

impl From<PlaneState> for Plane {
    fn from(state: PlaneState) -> Plane {
        match state {
            PlaneState::Strain => Plane::Strain,
            PlaneState::Stress => Plane::Stress,
        }
    }
}

/// Keys that scenes share.
#[derive(Debug, Keys)]
pub(crate) struct SceneKeys {
    /// width out of plane
    #[key(unit = "m", range = "> 0")]
    width: f64,
    /// stress state of deformable blocks: no strain, or no stress, out of plane
    #[key(default = "strain")]
    plane: PlaneState,
    /// material of the blocks
    #[key(reference = "materials")]
    material: String,
    /// interface law of the joints
    #[key(reference = "joints")]
    joint: String,
    /// mesh of deformable blocks
    #[key(optional = "the defaults of its keys")]
    mesh: Option<Mesh>,
}
