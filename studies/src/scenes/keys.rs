//! Keys that scenes share.

use serde::{Deserialize, Serialize};
use voussoir_core::law::Plane;
use voussoir_core::plugin::{Need, Parameter, Quantity, Range, Shape};

/// `plane`: stress state of deformable bodies.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlaneState {
    /// ε_z = 0.
    #[default]
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

pub(super) const WIDTH: Parameter = Parameter::number("width", Quantity::Length, Range::POSITIVE, "width out of plane");

pub(super) const PLANE: Parameter = Parameter {
    name: "plane",
    doc: "stress state of deformable blocks: no strain, or no stress, out of plane",
    shape: Shape::Choice(&["strain", "stress"]),
    need: Need::Default("\"strain\""),
};

pub(super) const MATERIAL: Parameter = Parameter {
    name: "material",
    doc: "material of the blocks",
    shape: Shape::Reference("materials"),
    need: Need::Required,
};

pub(super) const JOINT: Parameter = Parameter {
    name: "joint",
    doc: "interface law of the joints",
    shape: Shape::Reference("joints"),
    need: Need::Required,
};

/// A point \[x, y\] in m.
pub(crate) const POINT: Shape = Shape::Tuple(&[("x", LENGTH), ("y", LENGTH)]);
pub(super) const LENGTH: Shape = Shape::Number(Quantity::Length, Range::ANY);
