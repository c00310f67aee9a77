//! Sizes of loads, their displacements, work and its balance.

use crate::path::energy::{EnergyBalance, StageBalance, WorkState};
use crate::path::event::EventPath;
use crate::path::two_blocks::{assert_close, block, force, forces, pushed_at, settings, settlement, stack, v};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{Loading, PathProblem, PathSolver, PathState, Unobserved};

fn problem() -> PathProblem {
    block(0.3, pushed_at(0.1))
}

/// A state of the block with energies.
fn state(load_step: usize, work: f64, stored: f64, dissipated: f64) -> PathState {
    PathState { load_step, factor: 1.0, motion: vec![[0.0; 3]; 2], work, stored, dissipated, ..PathState::default() }
}

/// A work state of one loading with one force.
fn pushed(factor: f64, at: Vec2) -> WorkState {
    WorkState {
        factors: vec![factor],
        displacements: vec![vec![at]],
        motion: vec![[0.0; 3], [at.x, at.y, 0.0]],
        unbalanced: vec![[0.0; 3]; 2],
    }
}

/// Σ|F| of forces of 3–4–5 and 1 N, and of weights m |a| of free bodies alone.
#[test]
fn the_size_of_a_load_sums_its_forces() {
    let problem = problem();
    let both = forces(&[(1, v(0.0, 0.0), v(3.0, 4.0)), (1, v(1.0, 0.0), v(-1.0, 0.0))]);
    assert_close(problem.load_size(&both), 6.0, 1e-15);
    // The ground has a mass of 2 kg, too, but is held.
    let weight = Loading { acceleration: v(0.0, -10.0), ..Loading::default() };
    assert_close(problem.load_size(&weight), 20.0, 1e-14);
}

/// A support that turns by θ about the origin moves its farthest point, at 1 m, by θ.
#[test]
fn the_size_of_a_settlement_is_that_of_its_fastest_point() {
    let problem = problem();
    assert_close(problem.settlement_size(&settlement(0, [0.0, 0.0, 0.02])), 0.02, 1e-16);
    assert_close(problem.settlement_size(&settlement(0, [0.0, 3e-3, 0.02])), 0.023, 1e-16);
    assert_eq!(problem.settlement_size(&pushed_at(0.1)), 0.0);
}

/// u = Σ F·u/Σ|F|: forces of 3 N and 1 N whose points move along them by 1 and 5 have the displacement 2.
#[test]
fn the_displacement_of_a_load_is_a_weighted_mean() {
    let problem = problem();
    let both = forces(&[(1, v(0.0, 0.0), v(3.0, 0.0)), (1, v(1.0, 0.0), v(0.0, -1.0))]);
    let moves = |_: usize, point: Vec2| if point.x == 0.0 { v(1.0, 9.0) } else { v(7.0, -5.0) };
    assert_close(problem.load_displacement((&both, 1.0), &[[0.0; 3]; 2], moves), 2.0, 1e-15);
}

/// The displacement of a settlement is its factor times its size.
#[test]
fn the_displacement_of_a_settlement_is_its_movement() {
    let loading = settlement(0, [0.0, 3e-3, 0.0]);
    let found = problem().load_displacement((&loading, 2.5), &[[0.0; 3]; 2], |_, _| Vec2::zeros());
    assert_close(found, 7.5e-3, 1e-17);
}

/// If a load grows in proportion to u from λ₁ to λ₂, its work is (λ₁ + λ₂)/2 F·Δu.
#[test]
fn work_is_the_mean_force_times_the_way() {
    let (problem, loading) = (problem(), force(v(0.0, 0.0), v(2.0, 1.0)));
    let mut balance = EnergyBalance::default();
    balance.add_work(&problem, &[&loading], &pushed(1.0, v(0.0, 0.0)), &pushed(3.0, v(0.5, -0.2)));
    assert_close(balance.work, 2.0 * (2.0 * 0.5 - 0.2), 1e-15);
}

/// A load that moves forth and back does no work.
#[test]
fn work_there_and_back_is_nothing() {
    let (problem, loading) = (problem(), force(v(0.0, 0.0), v(2.0, 1.0)));
    let [here, there] = [pushed(1.0, v(0.1, 0.0)), pushed(3.0, v(0.5, -0.2))];
    let mut balance = EnergyBalance::default();
    balance.add_work(&problem, &[&loading], &here, &there);
    balance.add_work(&problem, &[&loading], &there, &here);
    assert_close(balance.work, 0.0, 1e-15);
}

/// A support with the reaction R that moves by u does the work R·u; R balances the unbalanced force.
#[test]
fn a_moving_support_does_the_work_of_its_reaction() {
    let problem = problem();
    let at = |moved: f64, unbalanced: f64| WorkState {
        factors: Vec::new(),
        displacements: Vec::new(),
        motion: vec![[0.0, moved, 0.0], [0.0; 3]],
        unbalanced: vec![[0.0, unbalanced, 0.0], [0.0; 3]],
    };
    let mut balance = EnergyBalance::default();
    balance.add_work(&problem, &[], &at(0.0, -1.0), &at(-0.3, -2.0));
    assert_close(balance.work, 1.5 * -0.3, 1e-15);
}

/// The error of a step is Δwork − Δstored − Δdissipated, and a stage adds the errors of its steps.
#[test]
fn a_balance_adds_up_what_steps_leave() {
    let problem = problem();
    let states = [state(1, 0.0, 0.0, 0.0), state(1, 5.0, 3.0, 1.5), state(1, 7.0, 4.0, 2.0)];
    let (first, left) = StageBalance::default().after(&problem, false, &states[0], &states[1]);
    assert_close(left, 0.5, 1e-15);
    let (second, left) = first.after(&problem, false, &states[1], &states[2]);
    assert_close(left, 0.5, 1e-15);
    assert_close(second.left(), 1.0, 1e-15);
    // Σ|work| 7, stored 4, dissipated 2.
    assert_close(second.scale(4.0), 13.0, 1e-14);
}

#[test]
fn a_new_stage_begins_a_new_balance() {
    let problem = problem();
    let (first, _) = StageBalance::default().after(&problem, false, &state(0, 0.0, 0.0, 0.0), &state(0, 5.0, 3.0, 1.5));
    let (second, _) = first.after(&problem, false, &state(0, 5.0, 3.0, 1.5), &state(1, 6.0, 4.0, 1.5));
    assert_close(second.left(), 0.0, 1e-15);
}

/// Stored energy of a stack is Σ ½ c r² over its points.
#[test]
fn stored_energy_is_that_of_all_springs() {
    let problem = stack([0.5, 0.5], forces(&[(2, v(0.0, 1.2), v(1.0, 0.0))]));
    let mut until = problem.clone();
    until.load_steps[1].end = voussoir_core::path::LoadStepEnd::Factor(0.1);
    let state = EventPath {}.trace(&until, &settings(None), &mut Unobserved).state;
    let of_point = |(c, r): (&voussoir_core::path::Contact, &[f64; 2])| {
        0.5 * (c.compliance[0] * r[0] * r[0] + c.compliance[1] * r[1] * r[1])
    };
    let right: f64 = problem.contacts.iter().zip(&state.force).map(of_point).sum();
    assert_close(state.stored, right, 1e-12 * right);
}
