//! The choice among twins: continuations with the same energy or dissipation.
//!
//! The choice must not depend on the numbers of blocks or on rounding. The rule prefers the twin on which the loads of
//! the present and of later stages do more work, or on which the blocks lean to the right.

use crate::settings::SETTINGS;
use voussoir_core::path::{Branching, PathProblem};

/// Returns the record of a state from which `others` other continuations lead on as well as the one that is followed,
/// and its note.
pub(super) fn record(load_step: usize, factor: f64, others: usize) -> (Branching, String) {
    let branches = if others == 1 { "another branch satisfies" } else { "other branches satisfy" };
    let note = format!(
        "at factor {factor} the path divides: {branches} all laws equally well and can carry another load; one branch \
         is followed"
    );
    (Branching { load_step, factor, snaps: false, released: 0.0, twins: true }, note)
}

/// Returns the index of the motion that is followed. `load_step`: the present one.
pub(super) fn favoured(problem: &PathProblem, load_step: usize, motions: &[&[[f64; 3]]]) -> usize {
    let mut left: Vec<usize> = (0..motions.len()).collect();
    let loads = problem.load_steps[load_step..].iter().map(|later| problem.wrenches(&later.loading));
    let to_the_right = problem.bodies.iter().map(|body| [body.mass, 0.0, 0.0]).collect();
    for load in loads.chain(std::iter::once(to_the_right)) {
        // Twins may be nearly equal, so only differences of their motions count.
        let differences = |k: usize| motions[k].iter().flatten().zip(motions[0].iter().flatten()).map(|(q, p)| q - p);
        let terms = |k: usize| load.iter().flatten().zip(differences(k)).map(|(w, q)| w * q);
        let works: Vec<f64> = left.iter().map(|k| terms(*k).sum()).collect();
        let size = left.iter().map(|k| terms(*k).map(f64::abs).sum()).fold(0.0, f64::max);
        let most = works.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut works = works.into_iter();
        left.retain(|_| works.next().is_some_and(|work| most - work <= SETTINGS.distinct() * size));
        if left.len() == 1 {
            break;
        }
    }
    left[0]
}
