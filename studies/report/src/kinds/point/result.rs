//! The result of a driven point, and the names of its numbers.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use std::collections::BTreeMap;
use voussoir_solvers::point::PointLaw;

/// The end of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PathStatus {
    /// The path was followed to its end.
    Reached,
    /// The path ended early; the notes give the reason.
    Stalled,
}

/// The numbers of a stored point.
#[derive(Debug, Clone, Deserialize)]
pub struct PointRows {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl PointRows {
    /// Returns the last number of a column, which is named without its unit.
    pub fn last(&self, name: &str) -> Option<f64> {
        let place = column(&self.columns, name)?;
        self.rows.last()?.get(place).copied()
    }
}

/// Returns the index of a column by its name without the unit.
pub fn column(columns: &[String], name: &str) -> Option<usize> {
    columns.iter().position(|column| column.split(' ').next() == Some(name))
}

/// A driven point: a row of numbers and a region per step.
#[derive(Debug, Clone, Serialize)]
pub struct PointResult {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Name of its variant.
    pub variant: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Tag of the law.
    pub law: String,
    /// End of the path.
    pub status: PathStatus,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// Names of the numbers in a row, with units.
    pub columns: Vec<String>,
    /// One row per step; the first row is the state before the first step.
    pub rows: Vec<Vec<f64>>,
    /// Region or regime of each row.
    pub regions: Vec<&'static str>,
    /// Segment of each row.
    pub segments: Vec<usize>,
    /// Greatest error of a controlled stress \[Pa\].
    pub largest_control_error: f64,
    /// Counters of the work.
    pub counters: BTreeMap<&'static str, u64>,
}

/// Returns the names of the numbers in a row.
pub fn columns(law: &PointLaw) -> Vec<String> {
    let names = law.names();
    let (strain, stress, energy) = match law {
        PointLaw::Joint(_) => (("gap", "m"), "traction", "J/m2"),
        _ => (("strain", "-"), "stress", "J/m3"),
    };
    let mut out: Vec<String> = names.iter().map(|name| format!("{}_{name} [{}]", strain.0, strain.1)).collect();
    out.extend(names.iter().map(|name| format!("{stress}_{name} [Pa]")));
    match law {
        PointLaw::Space(..) => out.extend(["p [Pa]".into(), "q [Pa]".into()]),
        PointLaw::Plane(..) => {
            out.extend(["strain_zz [-]".into(), "stress_zz [Pa]".into(), "p [Pa]".into(), "q [Pa]".into()]);
        }
        PointLaw::Joint(_) => {}
    }
    out.push(format!("dissipated [{energy}]"));
    out.extend(law.state_names().iter().map(|name| name.to_string()));
    out
}
