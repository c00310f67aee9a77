//! Responses recomputed from recorded states: their forces, and motions that do not change these forces.

use crate::certificate::MechanismPlace;
use crate::law::TractionPoint;
use crate::path::{LawStep, PathProblem, PathState, Responses};

/// Results of contact points, and the states of all responses after them.
type Updated = (Vec<(usize, TractionPoint)>, Vec<f64>);

/// Updates every contact point with a response once in a step of laws, from the state `before`. Returns contact points with results, and
/// the states after them. `None` if `before` has the wrong length or an update fails.
fn updated(problem: &PathProblem, gaps: &[[f64; 2]], before: &[f64], step: &LawStep) -> Option<Updated> {
    if before.len() != problem.memory_size() || step.previous_gap.len() != gaps.len() {
        return None;
    }
    let responses = Responses::new(problem);
    let (points, after) = responses.update(gaps, before, step).ok()?;
    Some((responses.points().map(|contact| (contact, points[contact])).collect(), after))
}

/// Returns the difference between forces and the forces of responses, relative to the greatest contact force, with the
/// results of the contact points and the states of the responses afterwards. `None` if there is no response. The
/// rounding of a gap times the stiffness of the law is allowed; a gap is a difference of displacements, or of positions if displacements are `finite`. `least` is
/// the least force \[N\] used as scale. A `before` of the wrong length is replaced by the initial state.
pub fn law_residual(
    problem: &PathProblem,
    state: &PathState,
    (before, step): (&[f64], &LawStep),
    deformation: f64,
    finite: bool,
    least: f64,
) -> Option<(f64, Updated)> {
    let size = problem.memory_size();
    if !(0..problem.contacts.len()).any(|c| problem.response(c).is_some()) {
        return None;
    }
    let untouched = problem.untouched();
    let before = if before.len() == size { before } else { &untouched };
    let Some((points, after)) = updated(problem, &state.gap, before, step) else {
        return Some((f64::INFINITY, (Vec::new(), untouched)));
    };
    let largest = state.force.iter().flatten().fold(0.0, |a: f64, f| a.max(f.abs()));
    let rounding = f64::EPSILON * if finite { 512.0 * problem.length } else { 64.0 * deformation };
    let mut scale = largest.max(least);
    let mut worst: f64 = 0.0;
    for (contact, point) in &points {
        let (contact, area) = (*contact, problem.contacts[*contact].area);
        for k in 0..2 {
            let stiffness = point.tangent[k][0].abs() + point.tangent[k][1].abs();
            let off = (state.force[contact][k] - area * point.traction[k]).abs() - rounding * area * stiffness;
            scale = scale.max(area * point.traction[k].abs());
            worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
        }
    }
    Some((if worst <= 0.0 { 0.0 } else { worst / scale.max(1e-300) }, (points, after)))
}

/// Returns true if forces are constant along the mechanism of a path, so that its flow can be checked at one state.
/// They are not constant with finite displacements, in blocks that yield, and after the limit point of laws with a
/// history.
pub fn forces_rest(problem: &PathProblem, finite: bool, place: Option<MechanismPlace>) -> bool {
    let softens = problem.memory_size() > 0 && place == Some(MechanismPlace::Peak);
    !finite && !problem.yields() && !softens
}

/// Returns the change of the forces of responses along a motion of up to the length of the scene, relative to the
/// greatest contact force: 0 for a mechanism.
pub fn leaves_forces(problem: &PathProblem, state: &PathState, motion: &[[f64; 3]]) -> f64 {
    let jump = |contact: usize| {
        let mut jump = [0.0; 2];
        let point = &problem.contacts[contact];
        for plus in [false, true] {
            let rows = problem.kinematics(point, plus);
            let body = if plus { point.plus.body } else { point.minus.body };
            (0..2).for_each(|i| jump[i] += (0..3).map(|k| rows[i][k] * motion[body][k]).sum::<f64>());
        }
        jump
    };
    let mut jumps: Vec<[f64; 2]> = (0..problem.contacts.len()).map(jump).collect();
    let size = jumps.iter().map(|j| j[0].hypot(j[1])).fold(0.0, f64::max);
    // Motions within rounding count as zero.
    jumps.iter_mut().flatten().filter(|j| j.abs() <= 1e-7 * size).for_each(|j| *j = 0.0);
    let largest = state.force.iter().flatten().fold(0.0, |a: f64, f| a.max(f.abs()));
    let Some((_, after)) = updated(problem, &state.gap, &state.memory, &LawStep::to(problem, state)) else {
        return 0.0;
    };
    let step = LawStep::from(problem, state);
    let mut worst: f64 = 0.0;
    for distance in [1e-9, 1e-6, 1e-3, 1.0] {
        let share = distance * problem.length / size.max(1e-300);
        let far = |(g, j): (&[f64; 2], &[f64; 2])| [g[0] + share * j[0], g[1] + share * j[1]];
        let gaps: Vec<[f64; 2]> = state.gap.iter().zip(&jumps).map(far).collect();
        let Some((points, _)) = updated(problem, &gaps, &after, &step) else { return f64::INFINITY };
        for (contact, point) in points {
            for k in 0..2 {
                let off = state.force[contact][k] - problem.contacts[contact].area * point.traction[k];
                worst = worst.max(off.abs() / largest.max(1e-300));
            }
        }
    }
    worst
}
