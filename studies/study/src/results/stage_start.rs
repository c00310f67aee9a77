//! The load factor at which the search for collapse in a stage starts.

use voussoir_core::model::Stage;

/// Returns the factor nearest to 0 in the searched range.
pub fn search_start(stage: &Stage) -> f64 {
    0.0f64.clamp(stage.factor_min, stage.factor_max)
}
