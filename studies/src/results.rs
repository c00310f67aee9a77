//! The result of a case, as it stands in `results.json`.

use serde::{Deserialize, Serialize};
use voussoir_core::certificate::{Certificate, Mechanism, MechanismKind};
use voussoir_core::limit::{Counters, LowerProof, Status};
use voussoir_core::path::ContactEvent;

/// All results of a study.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StudyResults {
    /// Name of the study.
    pub study: String,
    /// Version of the program.
    pub version: String,
    /// One entry per case, by `id`.
    pub cases: Vec<CaseResult>,
    /// Of `kind = "compare"` and `"map"`: the cases beside each other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub comparison: Option<Comparison>,
}

/// The cases of a study beside each other: a row for each scene and swept value, a column for each
/// variant (a *voice*: a law with a solver).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The voice that the others are divided by.
    pub reference: String,
    /// Names of the columns.
    pub voices: Vec<String>,
    /// Scenes outermost, then the axes of the sweep.
    pub rows: Vec<ComparisonRow>,
    /// Of a map: the swept keys along x and y; rows run through x slowest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map: Option<MapAxes>,
}

/// What all voices say of one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonRow {
    /// Name of the scene, where there are several.
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: serde_json::Map<String, serde_json::Value>,
    /// One per voice.
    pub cells: Vec<ComparisonCell>,
}

/// What one voice says of one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonCell {
    /// Id of the case.
    pub case: usize,
    /// How it ends; `null` where it was not answered.
    pub status: Option<Status>,
    /// The collapse factor.
    pub load_factor: Option<f64>,
    /// \[proved lower, found upper\].
    pub bounds: Option<[f64; 2]>,
    /// The factor over that of the reference; `null` where one of them is missing or the reference is 0.
    pub ratio: Option<f64>,
    /// Kind of the mechanism.
    pub mechanism: Option<MechanismKind>,
    /// `"associated"` where a non-associated law was read so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow_read_as: Option<String>,
}

/// The axes of a map and what is drawn over them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapAxes {
    /// Swept key along x.
    pub x: String,
    /// Its values.
    pub x_values: Vec<f64>,
    /// Swept key along y.
    pub y: String,
    /// Its values.
    pub y_values: Vec<f64>,
    /// How the x axis is called.
    pub x_label: String,
    /// How the y axis is called.
    pub y_label: String,
    /// The voice whose ratio to the reference is drawn as contours.
    pub contours: String,
    /// The voice whose mechanisms are drawn as regions.
    pub regions: String,
}

/// A contact force at a point of a joint \[N\].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FieldEntry {
    /// Index of the joint.
    pub joint: usize,
    /// Where it acts \[m\].
    pub point: [f64; 2],
    /// \[r_n, r_t\] on the plus body.
    pub force: [f64; 2],
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

/// A block whose material has yielded, at the state of the field: what `verify` needs to recompute its
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

/// An event of a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EventEntry {
    /// Name of the stage; gravity of a stage comes before its loads.
    pub stage: String,
    /// The factor of that stage's loads (of its gravity, where `gravity` is set).
    pub factor: f64,
    /// Whether it happened while gravity was applied.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub gravity: bool,
    /// Index of the joint.
    pub joint: usize,
    /// Where \[m\].
    pub point: [f64; 2],
    /// What happened there.
    pub what: ContactEvent,
}

/// What one stage came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageResult {
    /// Its name.
    pub name: String,
    /// How it ended.
    pub status: Status,
    /// The factor it reached; `null` where it reached none, or any.
    pub factor: Option<f64>,
    /// Hinges of the mechanism that ended it, else empty.
    pub hinges: Vec<usize>,
}

/// The answer to one case with what proves it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CaseResult {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Name of the variant, if the study has variants.
    pub variant: Option<String>,
    /// Name of the scene, where the study compares several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: serde_json::Map<String, serde_json::Value>,
    /// How it ends.
    pub status: Status,
    /// The collapse factor.
    pub load_factor: Option<f64>,
    /// \[lower, upper\], from the field and from the mechanism.
    pub bounds: Option<[f64; 2]>,
    /// The factor with associated flow, where the solver answers another question.
    pub associated_load_factor: Option<f64>,
    /// Velocities of the mechanism that proves `associated_load_factor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub associated_motion: Option<Vec<MotionEntry>>,
    /// What the lower bound rests on where joints flow as their laws say, with what `verify` needs to check it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_proof: Option<LowerProof>,
    /// All factors with an admissible field, where dead load alone has none; `null` ends are infinite.
    pub feasible_interval: Option<[Option<f64>; 2]>,
    /// `"associated"` where a non-associated law was read so.
    pub flow_read_as: Option<String>,
    /// The solver that answered.
    pub solver: String,
    /// What a user should know.
    pub notes: Vec<String>,
    /// The collapse mechanism, or the one that refutes equilibrium.
    pub mechanism: Option<Mechanism>,
    /// The factor at which `field` is in equilibrium.
    pub field_factor: Option<f64>,
    /// Contact forces.
    pub field: Option<Vec<FieldEntry>>,
    /// Velocities of the mechanism.
    pub motion: Option<Vec<MotionEntry>>,
    /// Contact forces that balance the live load alone, for `unbounded`.
    pub ray: Option<Vec<FieldEntry>>,
    /// On arches, where the resultant crosses each joint \[m\]; `null` where a joint carries nothing.
    pub thrust_line: Option<Vec<Option<[f64; 2]>>>,
    /// Named residuals.
    pub certificate: Certificate,
    /// Work done.
    pub counters: Counters,
    /// Wall time \[s\].
    pub seconds: f64,
    /// Each stage in turn.
    pub stages: Vec<StageResult>,
    /// Of a path: what happened at the contact points, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventEntry>,
    /// Of a path, on request: \[displacement of the load point \[m\], factor\] of the last stage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Vec<[f64; 2]>>,
    /// Of a path: displacement of every body as a rigid motion at the state of `field`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacements: Option<Vec<DisplacementEntry>>,
    /// Of a path with laws of tractions from gaps: their states (such as damage) at the start of the step
    /// that ended at `field`, contact point after contact point, from which the laws give its forces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_states: Option<Vec<f64>>,
    /// Of a path: blocks whose material has yielded at the state of `field`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub yielded: Vec<YieldedEntry>,
}
