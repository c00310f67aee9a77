//! Derivatives of a load factor with respect to the numbers of a study.

use serde::{Deserialize, Serialize};

/// The derivative of the load factor with respect to one number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SensitivityEntry {
    /// Its dotted key.
    pub key: String,
    /// The value, in SI units or in the unit of its key.
    pub value: f64,
    /// Left-sided derivative (the number decreases), per unit of the key; `null` if there is none.
    pub left: Option<f64>,
    /// Right-sided derivative (the number increases).
    pub right: Option<f64>,
    /// True if the two differ: the field or the mechanism is not unique, and this changes the derivative.
    pub kink: bool,
    /// The reason if a derivative is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl SensitivityEntry {
    /// Returns the change of the factor in per cent if the number decreases and if it increases by one per cent.
    pub fn relative(&self, factor: f64) -> [Option<f64>; 2] {
        [self.left, self.right]
            .map(|slope| slope.map(|slope| slope * self.value / factor).filter(|x| x.is_finite() && self.value != 0.0))
    }
}
