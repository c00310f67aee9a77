//! The entries that study kinds add to results.json: `worsts` and `curve` of an envelope, `optima` of an optimisation, `seismic` of a
//! kinematic analysis.

use super::seismic_entry::SeismicEntry;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use voussoir_core::limit::Status;

/// The entries of a study beside its cases and their comparison.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct KindEntries {
    /// The most onerous position for each case of the study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worsts: Option<Vec<WorstEntry>>,
    /// All positions that were tried, in order of vehicle, direction and position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Vec<PlaceEntry>>,
    /// The best value for each case of the study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optima: Option<Vec<OptimumEntry>>,
    /// The kinematic analysis of each case of the study and each direction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seismic: Option<Vec<SeismicEntry>>,
    /// Entries of other kinds, by name.
    #[serde(flatten)]
    pub other: Map<String, Json>,
}

/// A position of the load, with its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlaceEntry {
    /// Name of the variant, if the study has variants.
    pub variant: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Name of the vehicle, if the load is a vehicle.
    pub vehicle: Option<String>,
    /// Direction of the vehicle.
    pub direction: Option<String>,
    /// The position.
    pub value: f64,
    /// The load factor.
    pub result: Option<f64>,
    /// For a path: the factor of its first limit point.
    pub first_limit_point: Option<f64>,
    /// Its status.
    pub status: Status,
    /// Id of its case.
    pub case: usize,
}

impl PlaceEntry {
    /// Names of the variant, the vehicle and the direction.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        [&self.variant, &self.vehicle, &self.direction].into_iter().filter_map(Option::as_deref)
    }
}

/// The most onerous position for a case of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstEntry {
    /// The position.
    #[serde(flatten)]
    pub place: PlaceEntry,
    /// The key that moves the load.
    pub parameter: String,
    /// The intervals of one status, for this vehicle and direction.
    pub intervals: Vec<IntervalEntry>,
}

/// The best value for a case of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OptimumEntry {
    /// Name of the variant, if the study has variants.
    pub variant: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// The key that is changed.
    pub parameter: Option<String>,
    /// The best value; `null` if some value has no bound.
    pub value: Option<f64>,
    /// The result at this value.
    pub result: Option<f64>,
    /// Its status.
    pub status: Option<Status>,
    /// Id of its case.
    pub case: Option<usize>,
    /// The best value with a finite result.
    pub best_finite: Option<FiniteEntry>,
    /// `maximise` or `minimise`.
    #[serde(default)]
    pub goal: String,
    /// The name of the result: `load_factor` or `first_limit_point`.
    #[serde(default)]
    pub optimised: String,
    /// The best value of each key, if there are several independent keys.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub values: Map<String, Json>,
    /// The neighbours of the best finite value that were tried; `null` for several independent keys.
    #[serde(default)]
    pub bracket: Option<[f64; 2]>,
    /// The greatest gain between these neighbours, if the result is concave there (convex if it is minimised).
    #[serde(default)]
    pub possible_gain: Option<f64>,
    /// The number of values that were tried.
    #[serde(default)]
    pub tried: usize,
    /// The intervals of one status; empty for several independent keys.
    pub intervals: Vec<IntervalEntry>,
    /// Distance between the values that are tried first; `null` for several independent keys.
    pub scan_spacing: Option<f64>,
}

impl OptimumEntry {
    /// Returns the keys that vary independently.
    pub fn keys(&self) -> Vec<&str> {
        match self.values.is_empty() {
            true => self.parameter.as_deref().into_iter().collect(),
            false => self.values.keys().map(String::as_str).collect(),
        }
    }

    /// Returns the best finite values in the order of the keys; `None` without one.
    pub fn point(&self) -> Option<Vec<f64>> {
        let best = self.best_finite.as_ref()?;
        match self.values.is_empty() {
            true => Some(vec![best.value]),
            false => self.values.values().map(Json::as_f64).collect(),
        }
    }

    /// Returns `greatest` or `least`.
    pub fn extreme(&self) -> &'static str {
        if self.goal == "minimise" { "least" } else { "greatest" }
    }

    /// Returns the name of the result in words.
    pub fn quantity(&self) -> String {
        if self.optimised.is_empty() { "load factor".into() } else { self.optimised.replace('_', " ") }
    }
}

/// Returns the best of the optima of a study; one without a bound is better than all others.
pub fn best_of(optima: &[OptimumEntry]) -> Option<&OptimumEntry> {
    let merit = |own: &OptimumEntry| match (own.result, own.value.is_none() && own.best_finite.is_some()) {
        (Some(result), _) => {
            if own.goal == "minimise" {
                -result
            } else {
                result
            }
        }
        (None, true) => f64::INFINITY,
        (None, false) => f64::NEG_INFINITY,
    };
    optima.iter().reduce(|best, other| if merit(other) > merit(best) { other } else { best })
}

/// A value with a finite result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FiniteEntry {
    /// The value.
    pub value: f64,
    /// Its result.
    pub result: f64,
    /// Id of its case.
    pub case: usize,
}

/// An interval of values with one status, from its first value that was tried to its last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct IntervalEntry {
    /// The first value.
    pub from: f64,
    /// The last value.
    pub to: f64,
    /// Their status; `impossible` if they give no valid scene.
    pub status: String,
}
