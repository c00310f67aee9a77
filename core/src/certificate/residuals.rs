//! Named residuals of a proof, and its verdict.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Named residuals, all relative, and the verdict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// True if every residual is within its tolerance.
    pub passed: bool,
    /// Values of the residuals by name.
    pub residuals: BTreeMap<String, f64>,
    /// Descriptions of the failures; empty if passed.
    pub failures: Vec<String>,
}

impl Certificate {
    /// Creates a certificate without residuals and failures.
    pub(super) fn blank() -> Self {
        Certificate { passed: true, residuals: BTreeMap::new(), failures: Vec::new() }
    }

    /// Records a failure.
    pub(super) fn fail(&mut self, why: impl Into<String>) {
        self.passed = false;
        self.failures.push(why.into());
    }

    /// Records a residual; NaN fails.
    pub(super) fn residual(&mut self, name: &str, value: f64, tolerance: f64) -> bool {
        self.residuals.insert(name.into(), value);
        let fine = value <= tolerance;
        if !fine {
            self.fail(format!("{name}: {value:.3e} exceeds {tolerance:.1e}"));
        }
        fine
    }
}
