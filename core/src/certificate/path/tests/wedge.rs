//! A point wedged by an inclined spring: rates, and the proof with two leaves that none rises.

use super::scenes::{FRICTION, stiffness, wedged};
use crate::certificate::path::none_rises::RateProblem;
use crate::certificate::path::point_modes::{ModeCone, point_modes};
use crate::certificate::path::rate_equations::RateEquations;
use crate::model::geometry::Vec2;
use crate::path::{FarkasVector, ModeTree, PathProblem, PathRate, PathState, PointMode};

/// The point slips along +x: r_t = μ r_n on facet 1.
fn slipping() -> PathState {
    PathState {
        load_step: 1,
        factor: 1.0,
        force: vec![[10.0, FRICTION * 10.0], [1.0, 1.0]],
        gap: vec![[0.0; 2]; 2],
        motion: vec![[0.0; 3]; 2],
        ..PathState::default()
    }
}

fn modes(problem: &PathProblem, state: &PathState, active: bool) -> Vec<Vec<ModeCone>> {
    let slack = if active { 1e-7 } else { -1.0 };
    let points = problem.contacts.iter().zip(&state.force);
    points.map(|(contact, force)| point_modes(contact, *force, false, slack)).collect()
}

/// Multipliers with y of the point along the normal of its facet, without force in its spring.
fn multipliers() -> FarkasVector {
    let [kxx, kxy] = stiffness();
    let kyy = 1e6 * 0.75 + 1e4 * 0.25;
    let y = [-1.0, -FRICTION];
    // K y, balanced by β of the contact point: g_n = u_y, g_t = −u_x.
    let [fx, fy] = [kxx * y[0] + kxy * y[1], kxy * y[0] + kyy * y[1]];
    let (n, t) = ([0.5, -(0.75f64.sqrt())], [0.75f64.sqrt(), 0.5]);
    let along = |e: [f64; 2]| e[0] * y[0] + e[1] * y[1];
    FarkasVector {
        equilibrium: vec![[0.0; 3], [y[0], y[1], 0.0]],
        gap: vec![[fy, -fx], [-1e6 * along(n), -1e4 * along(t)]],
        work: 0.0,
    }
}

fn proof() -> ModeTree {
    let leaf = || ModeTree::Leaf(multipliers());
    ModeTree::Split { contact: 0, branches: vec![(PointMode::Stick, leaf()), (PointMode::Facet(1), leaf())] }
}

/// Returns the verdict of a proof at the slipping state under a force λ `live`.
fn verdict(live: Vec2, tree: &ModeTree, active: bool) -> Result<usize, String> {
    let (problem, state) = (wedged(live), slipping());
    let equations = RateEquations::new(&problem, &state, false);
    let modes = modes(&problem, &state, active);
    RateProblem { equations: &equations, modes: &modes }.check_none_rises(tree)
}

#[test]
fn a_wedged_point_has_no_rate_that_rises() {
    let right = Vec2::new(1.0, 0.0);
    assert_eq!(verdict(right, &proof(), true), Ok(2));
    // In the opposite direction there is a rate.
    assert!(verdict(-right, &proof(), true).is_err());
    // A point with slack in its facets sticks, and the load rises.
    assert!(verdict(right, &proof(), false).is_err());
    assert!(verdict(right, &ModeTree::Leaf(multipliers()), false).is_err());
}

#[test]
fn each_forged_part_of_a_proof_is_refused() {
    let right = Vec2::new(1.0, 0.0);
    let missing =
        |kept: PointMode| ModeTree::Split { contact: 0, branches: vec![(kept, ModeTree::Leaf(multipliers()))] };
    assert!(verdict(right, &missing(PointMode::Stick), true).is_err_and(|why| why.contains("not complete")));
    assert!(verdict(right, &missing(PointMode::Facet(1)), true).is_err());
    // Refused: the wrong facet, the same mode twice, a point decided twice, a point that does not exist.
    let leaf = || ModeTree::Leaf(multipliers());
    let split =
        |contact, modes: [PointMode; 2]| ModeTree::Split { contact, branches: modes.map(|mode| (mode, leaf())).into() };
    assert!(verdict(right, &split(0, [PointMode::Stick, PointMode::Facet(2)]), true).is_err());
    assert!(verdict(right, &split(0, [PointMode::Stick; 2]), true).is_err());
    assert!(verdict(right, &split(7, [PointMode::Stick, PointMode::Facet(1)]), true).is_err());
    let ModeTree::Split { contact, mut branches } = proof() else { unreachable!() };
    branches[0].1 = proof();
    assert!(verdict(right, &ModeTree::Split { contact, branches }, true).is_err_and(|why| why.contains("twice")));
    // Every entry of the multipliers matters.
    let size = 1e-6;
    for place in 0..2 {
        for entry in [0, 1] {
            for gap in [false, true] {
                let mut forged = multipliers();
                let row = if gap { &mut forged.gap[place][entry] } else { &mut forged.equilibrium[place][entry] };
                if !gap && place == 0 {
                    // The entries of the ground are not read.
                    continue;
                }
                *row += size * if gap { 1e6 } else { 1.0 };
                let tree = ModeTree::Split {
                    contact: 0,
                    branches: vec![(PointMode::Stick, leaf()), (PointMode::Facet(1), ModeTree::Leaf(forged))],
                };
                assert!(verdict(right, &tree, true).is_err(), "{place} {entry} {gap}");
            }
        }
    }
    // The wrong sign proves nothing.
    let mut turned = multipliers();
    turned.equilibrium[1].iter_mut().chain(turned.gap.as_flattened_mut()).for_each(|v| *v = -*v);
    assert!(verdict(right, &ModeTree::Leaf(turned), true).is_err());
    assert!(verdict(right, &ModeTree::Leaf(FarkasVector::default()), true).is_err_and(|why| why.contains("malformed")));
    let nothing = FarkasVector { equilibrium: vec![[0.0; 3]; 2], gap: vec![[0.0; 2]; 2], work: 0.0 };
    assert!(verdict(right, &ModeTree::Leaf(nothing), true).is_err());
}

/// A tree with too many leaves is refused before it is read.
#[test]
fn a_tree_with_too_many_leaves_is_refused() {
    let mut tree = ModeTree::Leaf(FarkasVector::default());
    for _ in 0..14 {
        let branches = vec![(PointMode::Stick, tree.clone()), (PointMode::Facet(1), tree)];
        tree = ModeTree::Split { contact: 0, branches };
    }
    assert!(verdict(Vec2::new(1.0, 0.0), &tree, true).is_err_and(|why| why.contains("leaves")));
}

/// A rate is checked with its mode and its sign: with the opposite force the point slips back, K u̇ − λ̇ p on its
/// facet.
#[test]
fn a_rate_is_checked_with_its_mode_and_its_sign() {
    let (problem, state) = (wedged(Vec2::new(-1.0, 0.0)), slipping());
    let equations = RateEquations::new(&problem, &state, false);
    let modes = modes(&problem, &state, true);
    let rates = RateProblem { equations: &equations, modes: &modes };
    let [kxx, kxy] = stiffness();
    // γ (K_xx + μ K_xy) = −λ̇ with u̇_x = γ.
    let slip = -1.0 / (kxx + FRICTION * kxy);
    let (n, t) = ([0.5, -(0.75f64.sqrt())], [0.75f64.sqrt(), 0.5]);
    let rate = PathRate {
        factor: 1.0,
        force: vec![[kxy * slip, -kxx * slip - 1.0], [-1e6 * n[0] * slip, -1e4 * t[0] * slip]],
        gap: vec![[0.0, -slip], [0.0; 2]],
        motion: vec![[0.0; 3], [slip, 0.0, 0.0]],
    };
    let found = rates.check_rate(&rate);
    assert!(found.clone().is_ok_and(|worst| worst < 1e-12), "{found:?}");
    let back = |v: &[f64; 2]| v.map(|x| -x);
    let turned = PathRate {
        factor: -1.0,
        force: rate.force.iter().map(back).collect(),
        gap: rate.gap.iter().map(back).collect(),
        motion: rate.motion.iter().map(|v| v.map(|x| -x)).collect(),
    };
    // The reversed rate is a slip against friction.
    assert!(rates.check_rate(&turned).is_err_and(|why| why.contains("no mode")));
    let wrong = PathRate { factor: 1.001, ..rate.clone() };
    assert!(rates.check_rate(&wrong).is_err());
    let mut lifted = rate;
    lifted.motion[0][1] = 1e-9;
    assert!(rates.check_rate(&lifted).is_err_and(|why| why.contains("support")));
}
