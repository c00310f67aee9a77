//! How a load factor changes with the numbers of a study.

use serde::{Deserialize, Serialize};

/// The derivative of the load factor with respect to one number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SensitivityEntry {
    /// Its dotted key.
    pub key: String,
    /// The number, in SI units or those of its key.
    pub value: f64,
    /// Derivative where the number falls, per unit of the key; `null` where there is none.
    pub left: Option<f64>,
    /// Derivative where it grows.
    pub right: Option<f64>,
    /// Whether the two differ: the field or the mechanism is not unique in a way that matters to this number.
    pub kink: bool,
    /// Why one of them is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl SensitivityEntry {
    /// Per cent that the factor changes by where the number changes by one per cent, falling and growing.
    pub fn relative(&self, factor: f64) -> [Option<f64>; 2] {
        [self.left, self.right]
            .map(|slope| slope.map(|slope| slope * self.value / factor).filter(|x| x.is_finite() && self.value != 0.0))
    }
}
