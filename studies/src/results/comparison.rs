//! The cases of a study beside each other: what `kind = "compare"` and `"map"` add to its results.

use serde::{Deserialize, Serialize};
use voussoir_core::certificate::MechanismKind;
use voussoir_core::limit::Status;

/// The cases of a study beside each other: a row for each scene and swept value, a column for each
/// variant (a law with a solver).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The variant that the others are divided by.
    pub reference: String,
    /// Names of the columns.
    #[serde(rename = "voices")]
    pub variants: Vec<String>,
    /// Scenes outermost, then the axes of the sweep.
    pub rows: Vec<ComparisonRow>,
    /// Of a map: the swept keys along x and y; rows run through x slowest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map: Option<MapAxes>,
}

/// What all variants say of one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonRow {
    /// Name of the scene, where there are several.
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: serde_json::Map<String, serde_json::Value>,
    /// One per variant.
    pub cells: Vec<ComparisonCell>,
}

/// What one variant says of one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonCell {
    /// Id of the case.
    pub case: usize,
    /// How it ends; `null` where it was not answered.
    pub status: Option<Status>,
    /// The collapse factor.
    pub load_factor: Option<f64>,
    /// Of a path: the factor of its first limit point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_limit_point: Option<f64>,
    /// \[proved lower, found upper\].
    pub bounds: Option<[Option<f64>; 2]>,
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
    /// The variant whose ratio to the reference is drawn as contours.
    pub contours: String,
    /// The variant whose mechanisms are drawn as regions.
    pub regions: String,
}
