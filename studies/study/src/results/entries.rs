//! Entries of a result: forces, velocities, displacements, yielded blocks and events.

use serde::{Deserialize, Serialize};
use voussoir_core::path::ContactEvent;

/// A contact force at a point of a joint \[N\].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FieldEntry {
    /// Index of the joint.
    pub joint: usize,
    /// Point of application \[m\].
    pub point: [f64; 2],
    /// \[r_n, r_t\] on the plus body.
    pub force: [f64; 2],
}

/// Origin of a load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadOrigin {
    /// Self-weight of the block.
    Weight,
    /// The weight of the fill on the block.
    Fill,
    /// Loads of the stage, at factor 1.
    Load,
}

/// A load on a block.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LoadEntry {
    /// Name of the stage.
    pub stage: String,
    /// Origin of the load.
    pub what: LoadOrigin,
    /// Name of the block.
    pub block: String,
    /// \[x, y\] \[N\].
    pub resultant: [f64; 2],
    /// A point on the line of action \[m\].
    pub point: [f64; 2],
}

/// The pressure of the fill on the side of a block.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FillEntry {
    /// Name of the block.
    pub block: String,
    /// Point of application \[m\].
    pub point: [f64; 2],
    /// Unit vector towards the ring.
    pub direction: [f64; 2],
    /// H \[N\].
    pub force: f64,
    /// Least and greatest H \[N\].
    pub bounds: [f64; 2],
}

/// Velocity of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotionEntry {
    /// Name of the body.
    pub body: String,
    /// \[v_x, v_y, ω\] at its centroid.
    pub velocity: [f64; 3],
}

/// Displacement of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DisplacementEntry {
    /// Name of the body.
    pub body: String,
    /// \[u_x, u_y, θ\] at its centroid.
    pub displacement: [f64; 3],
}

/// A block whose material has yielded, at the state of the field, with the data that `verify` needs to recompute its
/// stresses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct YieldedEntry {
    /// Name of the body.
    pub body: String,
    /// Displacements (x, y) of the nodes of its mesh relative to the mean rigid motion, in the frame of
    /// its first edge, in units of √area.
    pub displacement: Vec<f64>,
    /// Gauss points that have yielded: index, cumulated equivalent plastic strain, the part of it under
    /// compression, state of the law.
    pub points: Vec<(usize, f64, f64, Vec<f64>)>,
    /// Mean equivalent plastic strain of each element.
    pub elements: Vec<f64>,
}

/// A state of a path, for drawings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StateEntry {
    /// Name of the stage.
    pub stage: String,
    /// Factor of the loads of the stage. If `gravity` is true, factor of its gravity.
    pub factor: f64,
    /// True if gravity was being applied.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub gravity: bool,
    /// Displacement of the loads in their own direction by the rigid motion of their blocks \[m\].
    pub displacement: f64,
    /// \[u_x, u_y, θ\] of every body at its centroid, in the order of the scene.
    pub bodies: Vec<[f64; 3]>,
    /// Pressure at every contact point, in the order of `field` \[Pa\].
    pub pressures: Vec<f64>,
}

/// An event of a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EventEntry {
    /// Name of the stage; gravity of a stage comes before its loads.
    pub stage: String,
    /// Factor of the loads of the stage. If `gravity` is true, factor of its gravity.
    pub factor: f64,
    /// True if it happened while gravity was applied.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub gravity: bool,
    /// Index of the joint.
    pub joint: usize,
    /// The contact point \[m\].
    pub point: [f64; 2],
    /// The kind of event.
    pub what: ContactEvent,
}
