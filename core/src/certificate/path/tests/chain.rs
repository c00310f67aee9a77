//! The chain of a block that slides on two points of the ground, its collapse, and forged states.

use super::scenes::{FRICTION, sliding_block, stuck};
use crate::certificate::path::chain::PathChain;
use crate::path::{FarkasVector, ModeTree, PathProblem, PathState, RateClaim, Witness};
use std::sync::Arc;

/// The greatest factor.
const LIMIT: f64 = 10.0 * FRICTION;

/// The block under its weight alone.
fn weight() -> PathState {
    PathState {
        load_step: 0,
        factor: 1.0,
        force: vec![[5.0, 0.0]; 2],
        gap: vec![[0.0; 2]; 2],
        motion: vec![[0.0; 3], [0.0, -5e-6, 0.0]],
        ..PathState::default()
    }
}

/// The block after a slip along +x; with dilatancy it rises by `dilatancy` times the slip.
fn slipped(slip: f64, dilatancy: f64) -> PathState {
    let mut state = stuck(LIMIT);
    state.gap = vec![[dilatancy * slip, -slip]; 2];
    state.motion[1][0] += slip;
    state.motion[1][1] += dilatancy * slip;
    state
}

fn chain(problem: &PathProblem, states: &[PathState]) -> PathChain {
    let mut chain = PathChain::new(Arc::new(problem.clone()), false);
    states.iter().for_each(|state| chain.add(with_displacement(problem, state)));
    chain
}

/// A state with the displacement of its load.
fn with_displacement(problem: &PathProblem, state: &PathState) -> PathState {
    let growing = (&problem.load_steps[state.load_step].loading, state.factor);
    let moved = |body, point| problem.rigid_displacement(&state.motion, body, point, false);
    PathState { displacement: problem.load_displacement(growing, &state.motion, moved), ..state.clone() }
}

/// A state whose displacement of the load does not follow from its motions breaks the chain.
#[test]
fn the_displacement_of_the_load_follows_from_the_motions() {
    let problem = sliding_block(0.0);
    let state = with_displacement(&problem, &weight());
    let mut chain = PathChain::new(Arc::new(problem), false);
    chain.add(PathState { displacement: 2.0 * state.displacement, ..state });
    assert!(chain.broken().is_some_and(|why| why.contains("displacement of the load")), "{:?}", chain.broken());
}

/// The mechanism with p·q̇ = 1 as a proof: its slip opens the joint along the normal of the facet.
fn proof(state: &PathState) -> Witness {
    let tree = ModeTree::Leaf(FarkasVector {
        equilibrium: vec![[0.0; 3], [-1.0, -FRICTION, 0.0]],
        gap: vec![[0.0; 2]; 2],
        work: 0.0,
    });
    Witness { state: state.clone(), claim: RateClaim::NoneRises(tree) }
}

#[test]
fn the_collapse_of_a_sliding_block_is_proved() {
    for dilatancy in [0.0, FRICTION] {
        let problem = sliding_block(dilatancy);
        let end = stuck(LIMIT);
        let motion = [[0.0; 3], [1.0, dilatancy, 0.0]];
        let states = [weight(), stuck(3.0), end.clone(), slipped(1e-3, dilatancy)];
        let chain = chain(&problem, &states);
        assert_eq!(chain.broken(), None);
        // With associated flow it slips without dissipation. Rounding errors of gaps are no slip.
        assert_eq!([1, 2, 3].map(|at| chain.slips_after(at)), [false, false, true]);
        let mut rounded = stuck(3.0);
        rounded.gap[0][1] = -1e-19;
        assert!(!self::chain(&problem, &[weight(), rounded]).slips_after(1));
        assert_eq!(chain.check_none_rises(&end, &[&proof(&end)]), Ok(()));
        assert_eq!(chain.check_collapse(&end, &motion, &[&proof(&end)]), Ok(()));
        assert_eq!(chain.check_collapse(&states[3], &motion, &[&proof(&states[3])]), Ok(()));
        // With associated flow the mechanism itself proves that no rate rises.
        assert_eq!(chain.check_collapse(&end, &motion, &[]).is_ok(), dilatancy > 0.0);
        // Mechanisms that lift, slip back, have half of the power or rotate are refused.
        for forged in
            [[1.0, dilatancy + 0.1, 0.0], [-1.0, dilatancy, 0.0], [0.5, 0.5 * dilatancy, 0.0], [1.0, dilatancy, 0.1]]
        {
            assert!(chain.check_collapse(&end, &[[0.0; 3], forged], &[&proof(&end)]).is_err(), "{forged:?}");
        }
        // Before the limit the proof is refused.
        assert!(chain.check_none_rises(&states[1], &[&proof(&states[1])]).is_err());
        assert!(
            chain
                .check_none_rises(&stuck(2.0), &[&proof(&stuck(2.0))])
                .is_err_and(|why| why.contains("not on the path"))
        );
    }
}

#[test]
fn states_that_do_not_follow_each_other_break_a_chain() {
    let problem = sliding_block(0.0);
    let end = stuck(LIMIT);
    let breaks = |states: &[PathState], why: &str| {
        let chain = chain(&problem, states);
        assert!(chain.broken().is_some_and(|said| said.contains(why)), "{why}: {:?}", chain.broken());
        assert!(chain.states().count() <= states.len());
    };
    // Refused: a stuck point that slips, a point that slips back, a load without its weight.
    let mut crept = stuck(3.0);
    crept.gap[0][1] = -1e-6;
    breaks(&[weight(), crept], "does not flow");
    let slip = slipped(1e-3, 0.0);
    breaks(&[weight(), end.clone(), slip.clone(), slipped(0.5e-3, 0.0)], "does not flow");
    breaks(&[stuck(3.0)], "another load step");
    let mut lifted = slip.clone();
    lifted.gap[1][0] = 1e-4;
    breaks(&[weight(), end, lifted], "does not flow");
    let mut settled = stuck(3.0);
    settled.motion[0][1] = -1e-5;
    breaks(&[weight(), settled], "support");
    let mut earlier = weight();
    earlier.factor = 0.5;
    breaks(&[weight(), stuck(1.0), earlier], "load step");
}

/// A block above a surface that slip with dilatancy has raised is open and carries no force there.
#[test]
fn an_open_point_carries_nothing() {
    let problem = sliding_block(FRICTION);
    let end = stuck(LIMIT);
    let mut open = slipped(1e-3, FRICTION);
    open.gap[0][0] += 1e-4;
    let chain = chain(&problem, &[weight(), end, open]);
    assert!(chain.broken().is_some());
}
