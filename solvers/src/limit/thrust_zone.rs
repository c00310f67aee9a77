//! The zone of thrust: for each joint the interval of eccentricities M/N over all admissible fields under given loads.
//!
//! An end is the greatest ratio of two linear forms, s M / N with N > 0. It is found by Dinkelbach's method (1967): t is
//! the end if the greatest s M − t N is zero. Otherwise the ratio at that optimum is the next t. The loads are fixed, so the
//! flow of the joints does not matter.

use super::chain::{self, ChainEngine};
use super::conic;
use crate::limit::settings::SETTINGS;
use voussoir_core::limit::{Engine, Extreme, JointForce, LimitJoint, LimitProblem};
use voussoir_core::model::Wrenches;

/// Returns true if the zone of a problem costs little: few joints close its bodies to rings.
pub fn zone_costs_little(problem: &LimitProblem) -> bool {
    chain::trees(problem).is_some()
}

/// For each joint the least and the greatest eccentricity \[m\] from its middle, positive towards its second end. `None` for
/// the fill, if the normal force may vanish before the eccentricity has an end, and if an end is not found.
pub fn thrust_zone(problem: &LimitProblem, loads: &Wrenches) -> Vec<Option<[f64; 2]>> {
    let mut engines: Vec<Box<dyn Engine + '_>> = Vec::new();
    if let Some(chain) = ChainEngine::new(problem) {
        engines.push(Box::new(chain));
    }
    engines.push(conic::engine(problem));
    zone_by(problem, loads, engines)
}

/// Computes the zone with several engines; each engine gets the ends that the previous ones did not find.
pub(super) fn zone_by<'a>(
    problem: &'a LimitProblem,
    loads: &Wrenches,
    mut engines: Vec<Box<dyn Engine + 'a>>,
) -> Vec<Option<[f64; 2]>> {
    let end = |engines: &mut [Box<dyn Engine + 'a>], joint: usize, sense: f64| {
        engines.iter_mut().find_map(|engine| greatest_ratio(engine.as_mut(), loads, joint, sense))
    };
    let zone = |(index, joint): (usize, &LimitJoint)| {
        if joint.fill.is_some() {
            return None;
        }
        let least = end(&mut engines, index, -1.0)?;
        let greatest = end(&mut engines, index, 1.0)?;
        let height = (joint.ends[1] - joint.ends[0]).norm();
        // If only one field exists, both ends are the same but for rounding.
        let ends = [-least * height, greatest * height];
        Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
    };
    problem.joints.iter().enumerate().map(zone).collect()
}

/// The greatest s M / (N h) of a joint over all admissible fields.
fn greatest_ratio(engine: &mut dyn Engine, loads: &Wrenches, joint: usize, sense: f64) -> Option<f64> {
    // N_0 or N_1; its greatest value is positive if the joint can be in compression.
    let (mut ratio, mut reached) = (-0.5, false);
    // Five iterations are usual.
    for _ in 0..50 {
        let form = [-sense / 2.0 - ratio, sense / 2.0 - ratio, 0.0];
        let force = match engine.extreme(loads, joint, form) {
            Extreme::Finite(force) | Extreme::Ray(force) => force,
            Extreme::Failed => return None,
        };
        let next = ratio_of(force, sense)?;
        // A ray reaches its ratio only in the limit: all fields may have lower ratios.
        if reached && next <= ratio + SETTINGS.balanced {
            return Some(next.max(ratio));
        }
        (ratio, reached) = (next, true);
    }
    None
}

/// Returns s M / (N h) of a force; `None` without compression.
fn ratio_of(force: JointForce, sense: f64) -> Option<f64> {
    let [n_0, n_1] = force.normal;
    let normal = n_0 + n_1;
    let size = n_0.abs().max(n_1.abs());
    (normal > SETTINGS.active * size).then(|| sense * (n_1 - n_0) / (2.0 * normal))
}
