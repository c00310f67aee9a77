//! The table of a comparison: `kind = "compare"` and `"map"` add it to the results of a study.

use serde::{Deserialize, Serialize};
use voussoir_core::certificate::MechanismKind;
use voussoir_core::limit::Status;

/// The comparison of the cases of a study: a row for each scene and swept value, a column for each variant (a law with
/// a solver).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The reference variant of all ratios.
    pub reference: String,
    /// Names of the columns.
    #[serde(rename = "voices")]
    pub variants: Vec<String>,
    /// Scenes outermost, then the axes of the sweep.
    pub rows: Vec<ComparisonRow>,
    /// For a map: the swept keys along x and y. The rows are ordered by x, then by y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map: Option<MapAxes>,
}

/// The results of all variants for one scene and one set of swept values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonRow {
    /// Name of the scene, if there are several.
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: serde_json::Map<String, serde_json::Value>,
    /// One per variant.
    pub cells: Vec<ComparisonCell>,
}

/// The result of one variant for one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonCell {
    /// Id of the case.
    pub case: usize,
    /// Its status; `null` if it was not solved.
    pub status: Option<Status>,
    /// The collapse factor.
    pub load_factor: Option<f64>,
    /// For a path: the factor of its first limit point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_limit_point: Option<f64>,
    /// \[proved lower, found upper\].
    pub bounds: Option<[Option<f64>; 2]>,
    /// The factor divided by the factor of the reference; `null` if one of them is missing or the reference is 0.
    pub ratio: Option<f64>,
    /// Kind of the mechanism.
    pub mechanism: Option<MechanismKind>,
    /// `"associated"` if a non-associated law was solved with associated flow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow_read_as: Option<String>,
}

/// The axes of a map, and the variants that are drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapAxes {
    /// Swept key along x.
    pub x: String,
    /// Values along x.
    pub x_values: Vec<f64>,
    /// Swept key along y.
    pub y: String,
    /// Values along y.
    pub y_values: Vec<f64>,
    /// Label of the x axis.
    pub x_label: String,
    /// Label of the y axis.
    pub y_label: String,
    /// The variant whose ratio to the reference is drawn as contours.
    pub contours: String,
    /// The variant whose mechanisms are drawn as regions.
    pub regions: String,
}
