//! A block of weight W = 1 N and width b = 1 m that tips about a corner.

use crate::path::two_blocks::{
    STIFFNESS, assert_close, block, block_on, coulomb, forces, live, pushed_at, stage, traced, v,
};
use voussoir_core::limit::Status;
use voussoir_core::path::{ContactEvent, LoadStepEnd};

/// Pushed at height h, a block tips at λ = W b/(2 h).
#[test]
fn a_block_tips_at_half_its_width() {
    for height in [0.6, 0.8, 1.0] {
        let answer = traced(&block(0.9, pushed_at(height)));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), 0.5 / height, 1e-12);
    }
}

/// A block slides or tips, whichever comes first: λ = W min(μ, b/(2 h)).
#[test]
fn the_lower_of_two_mechanisms_decides() {
    for (friction, height) in [(0.2, 0.3), (0.2, 1.0), (0.6, 0.5), (0.6, 1.0), (0.9, 0.9), (1.5, 0.3)] {
        let answer = traced(&block(friction, pushed_at(height)));
        assert_eq!(answer.status, Status::Collapse, "{friction} {height}: {:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), f64::min(friction, 0.5 / height), 1e-12);
    }
}

/// The mechanism turns about the right corner: θ̇ = −1/h, and the centre moves by (b/(2 h), b/(2 h)).
#[test]
fn the_mechanism_of_tipping_turns_about_a_corner() {
    let height = 0.8;
    let motion = traced(&block(0.9, pushed_at(height))).motion.expect("a mechanism");
    let right = [0.5 / height, 0.5 / height, -1.0 / height];
    right.iter().zip(motion[1]).for_each(|(right, found)| assert_close(found, *right, 1e-9));
}

/// On three points with N = W/3 ∓ M/b the left one opens at M = W b/3, and the block tips later, at M = W b/2.
#[test]
fn points_open_one_after_the_other() {
    let height = 0.8;
    let answer = traced(&block_on(&[0.0, 0.5, 1.0], &coulomb(2.0, 0.0, 0.0), live(pushed_at(height))));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.5 / height, 1e-12);
    let opened = |contact: usize| {
        let opens = answer.events.iter().filter(|e| e.contact == contact && e.what == ContactEvent::Opens);
        opens.map(|e| e.factor).next()
    };
    assert_close(opened(0).expect("the left point opens"), 1.0 / (3.0 * height), 1e-12);
    assert_eq!(opened(2), None);
}

/// With the left of three points open, the block turns by θ = −2 (4 M − W b)/(k b²).
#[test]
fn the_rotation_with_an_open_point() {
    let (height, factor) = (0.8, 0.55);
    let pushed = stage(1, pushed_at(height), LoadStepEnd::Factor(factor));
    let answer = traced(&block_on(&[0.0, 0.5, 1.0], &coulomb(2.0, 0.0, 0.0), pushed));
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    let right = -2.0 * (4.0 * factor * height - 1.0) / STIFFNESS;
    assert_close(answer.state.motion[1][2], right, 1e-12 * right.abs());
    assert!(answer.state.gap[0][0] > 0.0, "{:?}", answer.state.gap);
    assert_close(answer.state.force[0][0], 0.0, 1e-15);
}

/// A point that a couple opened closes again on the way back: after loading and unloading all gaps are zero.
#[test]
fn an_opening_is_reversible() {
    let couple = |sense: f64| forces(&[(1, v(0.5, 1.0), v(sense, 0.0)), (1, v(0.5, 0.0), v(-sense, 0.0))]);
    let mut problem = block_on(&[0.0, 0.5, 1.0], &coulomb(2.0, 0.0, 0.0), live(couple(1.0)));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.45);
    problem.load_steps.push(stage(2, couple(-1.0), LoadStepEnd::Factor(0.45)));
    let answer = traced(&problem);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    assert!(answer.events.iter().any(|e| e.contact == 0 && e.what == ContactEvent::Closes), "{:?}", answer.events);
    for r in &answer.state.force {
        assert_close(r[0], 1.0 / 3.0, 1e-11);
        assert_close(r[1], 0.0, 1e-11);
    }
    assert_close(answer.state.motion[1][2], 0.0, 1e-15);
}

/// A force couple F, −F at a distance a tips at λ = W b/(2 a), wherever it acts.
#[test]
fn a_couple_tips_wherever_it_acts() {
    for place in [0.1, 0.5, 0.9] {
        let couple = forces(&[(1, v(place, 0.75), v(1.0, 0.0)), (1, v(place, 0.25), v(-1.0, 0.0))]);
        let answer = traced(&block(0.2, couple));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), 1.0, 1e-12);
    }
}
