//! Where a stage's search for collapse starts.

use voussoir_core::model::Stage;

/// The factor nearest to 0 among those searched.
pub fn search_start(stage: &Stage) -> f64 {
    0.0f64.clamp(stage.factor_min, stage.factor_max)
}
