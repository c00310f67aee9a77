//! The horizontal push of a case, and the cases that are made from it.

use serde_json::{Value as Json, json};
use voussoir_study::study::{Case, Study};

/// Number of cases that are made from one case of the study: the opposite push, and the paths of both pushes.
pub const MADE: usize = 3;

/// The horizontal push of a case.
pub struct Push {
    /// Acceleration at the factor 1 \[m/s²\]; positive to the right.
    pub acceleration: f64,
    /// Size of gravity \[m/s²\].
    pub gravity: f64,
    /// Key of the horizontal acceleration.
    key: String,
}

impl Push {
    /// Returns the push of the last stage: one load of kind `body` without a vertical part, which grows until collapse.
    pub fn of(case: &Case) -> Option<Push> {
        let (stage, index) = (case.stages.last()?, case.stages.len() - 1);
        let gravity = case.stages.iter().filter_map(|stage| stage.gravity).next_back()?;
        let [acceleration] = stage.accelerations.as_slice() else { return None };
        let alone = stage.forces.is_empty() && stage.settlements.is_empty();
        let loads = case.resolved.at(&format!("stages.{index}.loads"))?.as_array()?.len();
        let horizontal = acceleration.y == 0.0 && acceleration.x != 0.0 && gravity.x == 0.0 && gravity.y < 0.0;
        let until = case.resolved.at(&format!("stages.{index}.until")).and_then(Json::as_str);
        let searches = until == Some("collapse");
        (alone && loads == 1 && horizontal && searches).then(|| Push {
            acceleration: acceleration.x,
            gravity: -gravity.y,
            key: format!("stages.{index}.loads.0.acceleration.0"),
        })
    }

    /// Returns the keys that differ from the case of the study in a case that is made from it.
    pub fn values(&self, made: usize) -> Vec<(String, Json)> {
        let against = made != 1;
        let mut values = Vec::new();
        if against {
            values.push((self.key.clone(), json!(-self.acceleration)));
        }
        if made > 0 {
            values.push(("solver.solver".into(), json!("newton_path")));
            values.push(("solver.kinematics".into(), json!("finite")));
            values.push(("solver.stop.factor".into(), json!(0.0)));
        }
        values
    }
}

/// Returns the id of a case that is made from a case of the study.
pub fn made_id(study: &Study, base: usize, made: usize) -> usize {
    study.count() + MADE * base + made
}
