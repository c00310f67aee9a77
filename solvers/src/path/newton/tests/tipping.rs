//! A block of weight W = 1 N that tips with finite displacements, beyond its limit point; φ is its rotation to the right.

use crate::path::newton::NewtonPath;
use crate::path::two_blocks::{
    Kept, STIFFNESS, assert_close, block, finite, finite_states, followed, force, pushed_at, stage, v,
};
use voussoir_core::limit::Status;
use voussoir_core::path::{ContactEvent, LoadStepEnd, PathSettings, PathSolver, PathState};

const HEIGHT: f64 = 0.8;
const FRICTION: f64 = 0.9;

/// Load on the closed joint: two springs resist with ½ k sin φ, the weight at half height helps.
fn closed(turned: f64) -> f64 {
    0.5 * (STIFFNESS - 1.0) * turned.sin() / (HEIGHT * turned.cos() + 0.5 * turned.sin())
}

/// Load on the open joint: the block turns about its right corner, whose spring only moves it.
fn open(turned: f64) -> f64 {
    0.5 * (turned.cos() - turned.sin()) / (HEIGHT * turned.cos() + turned.sin())
}

fn tipped() -> Vec<PathState> {
    let all = finite_states(&block(FRICTION, pushed_at(HEIGHT)));
    all.into_iter().filter(|state| state.load_step == 1).collect()
}

/// States with a closed joint: λ = ½ (k − W) sin φ/(h cos φ + ½ sin φ).
#[test]
fn a_closed_joint_turns_on_two_springs() {
    // Points do not slip yet.
    let slips = FRICTION / (1.0 + 2.0 * FRICTION * HEIGHT);
    let closed_at = |state: &PathState| state.gap[0][0] < 1e-12 && state.factor < 0.99 * slips;
    let states: Vec<PathState> = tipped().into_iter().filter(closed_at).collect();
    assert!(!states.is_empty());
    states.iter().for_each(|state| assert_close(state.factor, closed(-state.motion[1][2]), 1e-10));
}

/// States with an open left corner: λ = ½ W (cos φ − sin φ)/(h cos φ + sin φ), down to half of the limit point.
#[test]
fn an_open_joint_turns_about_its_corner() {
    let states: Vec<PathState> = tipped().into_iter().filter(|state| state.gap[0][0] > 1e-9).collect();
    assert!(states.len() > 5 && states[states.len() - 1].factor < 0.35, "{} states", states.len());
    states.iter().for_each(|state| assert_close(state.factor, open(-state.motion[1][2]), 1e-9));
}

/// While the joint is open the right corner carries W upwards and λ to the left.
#[test]
fn the_corner_carries_weight_and_load() {
    for state in tipped().iter().filter(|state| state.gap[0][0] > 1e-9) {
        assert_close(state.force[1][0], 1.0, 1e-9);
        assert_close(state.force[1][1], state.factor, 1e-9);
    }
}

/// The left corner opens once, and never closes again.
#[test]
fn the_left_corner_opens_once() {
    let answer = followed(&block(FRICTION, pushed_at(HEIGHT)), None);
    let opens: Vec<usize> =
        answer.events.iter().filter(|event| event.what == ContactEvent::Opens).map(|event| event.contact).collect();
    assert_eq!(opens, [0], "{:?}", answer.events);
    assert!(answer.events.iter().all(|event| event.what != ContactEvent::Closes), "{:?}", answer.events);
}

/// The compressed corner moves by s = W/(k b), which lowers the limit point to (½ − ½ s)/(h + s), to first order in s.
#[test]
fn a_stiffer_joint_tips_closer_to_half_its_width() {
    let limit = |compliance: f64| {
        let mut problem = block(FRICTION, pushed_at(HEIGHT));
        problem.contacts.iter_mut().for_each(|contact| contact.compliance = [compliance; 2]);
        0.5 / HEIGHT - followed(&problem, None).factor.expect("a factor")
    };
    let [soft, stiff] = [1e-3, 1e-4].map(limit);
    assert!(stiff > 0.0 && soft > 0.0);
    assert_close(soft, 1e-3 * 0.5 * (1.0 / HEIGHT + 1.0 / (HEIGHT * HEIGHT)), 5e-6);
    assert_close(soft / stiff, 10.0, 0.05);
}

/// Work = stored + dissipated along the whole path, to 1e-3 of the work of the load, λ u at most.
#[test]
fn work_is_stored_or_dissipated_beyond_the_limit_point() {
    for state in tipped() {
        let work = 0.5 / HEIGHT * state.displacement + state.stored;
        assert_close(state.work, state.stored + state.dissipated, 1e-3 * work);
    }
}

/// Unloaded before the limit point, the block comes back to the forces W/2 at both corners.
#[test]
fn a_block_that_is_unloaded_comes_back() {
    let mut problem = block(FRICTION, pushed_at(HEIGHT));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.3);
    problem.load_steps.push(stage(2, force(v(0.0, HEIGHT), v(-1.0, 0.0)), LoadStepEnd::Factor(0.3)));
    let answer = followed(&problem, None);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    // The direction of the load and its arm are unchanged: no force remains.
    answer.state.force.iter().for_each(|r| assert_close(r[0], 0.5, 1e-9));
    assert_close(answer.state.motion[1][2], 0.0, 1e-12);
}

/// A path with a requested displacement of the load ends at that distance beyond its limit point.
#[test]
fn a_stop_displacement_ends_the_path_behind_its_limit_point() {
    let how = PathSettings { stop_displacement: Some(0.05), ..finite(None) };
    let mut states = Kept(Vec::new());
    let answer = NewtonPath {}.trace(&block(FRICTION, pushed_at(HEIGHT)), &how, &mut states);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    let (peak, end) = (answer.state.displacement, answer.last.expect("a last state").displacement);
    assert!(end - peak >= 0.05 && end - peak < 0.06, "{peak} {end}");
}
