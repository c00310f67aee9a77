//! The entry of a seismic check in results.json: one for each case of the study and each direction of the push.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};

/// The kinematic analysis of one mechanism.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeismicEntry {
    /// Name of the variant, if the study has variants.
    pub variant: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Direction in which the masses are pushed.
    pub direction: PushDirection,
    /// Id of the case that gives the multiplier and the mechanism.
    pub case: usize,
    /// Id of the case that follows the path; `None` if no block and no joint deforms.
    pub path_case: Option<usize>,
    /// α₀: the ratio of the horizontal forces to the weights at which the mechanism starts \[-\].
    pub activation_multiplier: Option<f64>,
    /// Conversion of the mechanism to one degree of freedom.
    pub oscillator: Option<Oscillator>,
    /// Displacements of the capacity curve; `None` without a certified path.
    pub capacity: Option<DisplacementCapacity>,
    /// Comparisons of capacity and demand.
    pub checks: Vec<SeismicCheck>,
    /// The capacity curve: \[d* \[m\], a* \[m/s²\]\].
    pub curve: Vec<[f64; 2]>,
}

/// The direction in which the masses are pushed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PushDirection {
    /// Towards positive x.
    Right,
    /// Towards negative x.
    Left,
}

impl PushDirection {
    /// Returns the word in texts.
    pub fn word(self) -> &'static str {
        match self {
            PushDirection::Right => "right",
            PushDirection::Left => "left",
        }
    }
}

/// A mechanism as an oscillator with one degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Oscillator {
    /// M*: participating mass \[kg\].
    pub mass: f64,
    /// e*: participating mass over the mass of the blocks that move \[-\].
    pub mass_fraction: f64,
    /// a₀*: spectral acceleration at which the mechanism starts \[m/s²\].
    pub activation_acceleration: f64,
    /// True if limit analysis has proved that there is no other mechanism; `None` if it is not known.
    pub unique_mechanism: Option<bool>,
}

/// Displacements of the oscillator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DisplacementCapacity {
    /// d₀*: displacement at which the acceleration has fallen to zero \[m\]; the last displacement if `reaches_zero` is false.
    pub zero_displacement: f64,
    /// True if the certified path reaches zero acceleration.
    pub reaches_zero: bool,
    /// d_u*: ultimate displacement \[m\].
    pub ultimate_displacement: f64,
    /// d_s* = 0.4 d_u* \[m\].
    pub secant_displacement: f64,
    /// a_s*: acceleration of the curve at d_s* \[m/s²\].
    pub secant_acceleration: f64,
    /// T_s: period of the secant stiffness at d_s* \[s\].
    pub secant_period: f64,
}

/// The quantity that a seismic check compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CheckedQuantity {
    /// Accelerations.
    #[serde(rename = "m/s2")]
    Acceleration,
    /// Displacements.
    #[serde(rename = "m")]
    Displacement,
}

/// A comparison of capacity and demand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeismicCheck {
    /// The inequality.
    pub rule: String,
    /// The clauses of the inequality and of the demand.
    pub source: String,
    /// Unit of capacity and demand.
    pub unit: CheckedQuantity,
    /// The capacity.
    pub capacity: f64,
    /// The demand.
    pub demand: f64,
    /// Capacity over demand.
    pub ratio: f64,
    /// True if the ratio is at least 1.
    pub met: bool,
}

impl SeismicEntry {
    /// Returns the least ratio of the checks of one quantity.
    pub fn least(&self, unit: CheckedQuantity) -> Option<&SeismicCheck> {
        let own = self.checks.iter().filter(|check| check.unit == unit);
        own.min_by(|a, b| a.ratio.total_cmp(&b.ratio))
    }

    /// Returns the check that decides: the least ratio of displacements; without a capacity curve, of accelerations.
    pub fn deciding(&self) -> Option<&SeismicCheck> {
        self.least(CheckedQuantity::Displacement).or_else(|| self.least(CheckedQuantity::Acceleration))
    }
}

/// Returns the acceleration \[m/s²\] of a capacity curve \[d*, a*\] at a displacement \[m\], linear between its points. The curve starts at
/// the origin. `None` beyond its end.
pub fn acceleration_at(curve: &[[f64; 2]], d: f64) -> Option<f64> {
    let mut before = [0.0, 0.0];
    for point in curve {
        if point[0] >= d {
            let span = point[0] - before[0];
            let share = if span > 0.0 { (d - before[0]) / span } else { 1.0 };
            return Some(before[1] + share * (point[1] - before[1]));
        }
        before = *point;
    }
    None
}

/// Ratios with a smaller relative difference are equal: a symmetric mechanism has equal ratios in both directions.
const EQUAL: f64 = 1e-6;

/// Returns the entry that governs: the first one without a check, otherwise the first one with the least deciding ratio.
pub fn governing(entries: &[SeismicEntry]) -> Option<&SeismicEntry> {
    let ratio = |entry: &SeismicEntry| entry.deciding().map_or(f64::NEG_INFINITY, |check| check.ratio);
    let least = entries.iter().map(ratio).fold(f64::INFINITY, f64::min);
    entries.iter().find(|entry| ratio(entry) <= least * (1.0 + EQUAL))
}
