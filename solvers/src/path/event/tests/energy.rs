//! Energies of exact paths: work is stored or dissipated, to rounding.

use crate::path::two_blocks::{
    STIFFNESS, assert_close, block, block_on, coulomb, force, forces, live, pushed_at, stack, stage, states, turning, v,
};
use voussoir_core::path::{LoadStepEnd, PathProblem};

/// A stage that ends at a factor.
fn until(mut problem: PathProblem, factor: f64) -> PathProblem {
    problem.load_steps[1].end = LoadStepEnd::Factor(factor);
    problem
}

/// Work = stored + dissipated at every state of every path.
#[test]
fn work_is_stored_or_dissipated() {
    let cohesive = block_on(&[0.0, 0.5, 1.0], &coulomb(0.3, 0.05, 0.1), live(pushed_at(0.4)));
    let problems = [block(0.3, pushed_at(0.4)), block(0.9, pushed_at(0.8)), cohesive, turning()];
    let stacked = stack([0.3, 0.5], forces(&[(2, v(0.0, 1.2), v(1.0, 0.0))]));
    for problem in problems.into_iter().chain([stacked]) {
        let all = states(&problem);
        assert!(all.len() > 2);
        for state in &all {
            let scale = state.stored + state.dissipated;
            assert_close(state.work, state.stored + state.dissipated, 1e-11 * scale);
        }
    }
}

/// Under its weight a block on two points stores W²/(4 k), half of W times the settlement W/(2 k).
#[test]
fn weight_is_stored_in_two_springs() {
    let all = states(&until(block(0.3, pushed_at(0.4)), 0.1));
    let state = all.iter().rfind(|state| state.load_step == 0).expect("a state under weight");
    assert_close(state.stored, 0.25 / STIFFNESS, 1e-12 / STIFFNESS);
}

/// A corner that slips from λ₁ to λ dissipates ∫ μ (W/2 − λ h) ds with ds = (1 + 2 μ h) dλ/k.
#[test]
fn a_slipping_corner_dissipates_friction_times_slip() {
    let (friction, height, factor) = (0.3, 0.4, 0.28);
    let end = states(&until(block(friction, pushed_at(height)), factor)).pop().expect("a state");
    let begins = friction / (1.0 + 2.0 * friction * height);
    let integral = 0.5 * (factor - begins) - 0.5 * height * (factor * factor - begins * begins);
    let right = friction * (1.0 + 2.0 * friction * height) * integral / STIFFNESS;
    assert_close(end.dissipated, right, 1e-11 * right);
}

/// Associated friction without cohesion dissipates nothing: r lies on a cone through the origin and ġ is normal to it.
#[test]
fn associated_friction_dissipates_nothing() {
    let problem = block_on(&[0.0, 1.0], &coulomb(0.3, 0.0, 0.3), live(pushed_at(0.4)));
    let end = states(&until(problem, 0.29)).pop().expect("a state");
    assert!(end.gap[0][1].abs() > 0.0);
    assert_close(end.dissipated, 0.0, 1e-12 * end.stored);
}

/// Associated slip with cohesion c dissipates c A per unit of slip: D = c A |γ|.
#[test]
fn associated_cohesion_dissipates_cohesion_times_slip() {
    let (friction, cohesion) = (0.3, 0.05);
    let problem = block_on(&[0.0, 1.0], &coulomb(friction, cohesion, friction), live(pushed_at(0.4)));
    let end = states(&until(problem, 0.38)).pop().expect("a state");
    // The gap of a point includes C r: it is the slip.
    let slip: f64 = end.gap.iter().map(|g| g[1].abs()).sum();
    assert!(slip > 0.0);
    assert_close(end.dissipated, cohesion * slip, 1e-11 * end.dissipated);
}

/// A cycle of loads dissipates all work that is put in, except what stays stored.
#[test]
fn a_cycle_leaves_the_dissipated_energy() {
    let mut problem = until(block(0.3, pushed_at(0.4)), 0.28);
    for (number, sense) in [(2, -1.0), (3, 1.0), (4, -1.0)] {
        problem.load_steps.push(stage(number, force(v(0.0, 0.4), v(sense, 0.0)), LoadStepEnd::Factor(0.28)));
    }
    let all = states(&problem);
    let before = all.iter().rfind(|state| state.load_step == 0).expect("a state under weight");
    let end = all.last().expect("a state");
    let (work, stored) = (end.work - before.work, end.stored - before.stored);
    assert!(work > 0.0 && end.dissipated > 0.0);
    assert_close(work, stored + end.dissipated, 1e-11 * work);
}

/// Dissipation never falls along a path.
#[test]
fn dissipation_never_falls() {
    for problem in [block(0.3, pushed_at(0.4)), turning(), stack([0.3, 0.5], forces(&[(2, v(0.0, 1.2), v(1.0, 0.0))]))]
    {
        for pair in states(&problem).windows(2) {
            assert!(pair[1].dissipated >= pair[0].dissipated - 1e-15, "{pair:?}");
        }
    }
}
