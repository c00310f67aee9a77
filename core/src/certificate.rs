//! Certificates: what proves an answer, recomputed from the assembly alone.

use serde::{Deserialize, Serialize};

/// Named residuals, all relative, and the verdict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Whether every residual is within its tolerance.
    pub passed: bool,
    /// Name → value.
    pub residuals: std::collections::BTreeMap<String, f64>,
    /// What failed, in words; empty when passed.
    pub failures: Vec<String>,
}
