//! Ends of a path: a point that a spring wedges so that no rate leads on, and a block that slides off its face.

use super::scenes::{FRICTION, dry, point, sliding_block, structure, stuck};
use crate::certificate::path::chain::PathChain;
use crate::model::geometry::Vec2;
use crate::path::{
    FarkasVector, ModeTree, NoneContinues, PathProblem, PathState, PointLaw, PointMode, RateClaim, Sliding, Witness,
};
use std::sync::Arc;

/// Cosine and sine of the spring.
const SPRING: [f64; 2] = [0.5, -0.866_025_403_784_438_6];
/// Its stiffness along itself \[N/m\].
const STIFF: f64 = 1e6;

/// Its stiffness across itself, for which slip changes normal and shear force so that the distance to friction stays.
fn across() -> f64 {
    let [c, s] = SPRING;
    STIFF * (FRICTION * (c * s).abs() - c * c) / (s * s + FRICTION * (c * s).abs())
}

/// A point on the ground that an inclined spring wedges, under a force that lifts it by λ.
fn lifted() -> PathProblem {
    let spring = Vec2::new(SPRING[0], SPRING[1]);
    let contacts = vec![
        point(Vec2::zeros(), Vec2::new(0.0, 1.0), dry(0.0), [0.0; 2]),
        point(Vec2::zeros(), spring, PointLaw::Bonded, [1.0 / STIFF, 1.0 / across()]),
    ];
    structure(Vec2::zeros(), contacts, Vec2::new(0.0, 1.0))
}

/// The state at λ with the shear force at the ground.
fn state(load_step: usize, factor: f64, shear: f64) -> PathState {
    let force = vec![[10.0, shear], [1.0, 1.0]];
    let motion = vec![[0.0; 3]; 2];
    PathState { load_step, factor, force, gap: vec![[0.0; 2]; 2], motion, ..PathState::default() }
}

fn chain(problem: &PathProblem, finite: bool, states: &[PathState]) -> PathChain {
    let mut chain = PathChain::new(Arc::new(problem.clone()), finite);
    for state in states {
        let growing = (&problem.load_steps[state.load_step].loading, state.factor);
        let moved = |body, point| problem.rigid_displacement(&state.motion, body, point, finite);
        let displacement = problem.load_displacement(growing, &state.motion, moved);
        chain.add(&PathState { displacement, ..state.clone() });
    }
    assert_eq!(chain.broken(), None);
    chain
}

/// y along the normal of the facet, while the spring rests.
fn along_normal(sign: f64) -> FarkasVector {
    let [c, s] = SPRING;
    let (stiff, soft) = (STIFF, across());
    let y = [-sign, -sign * FRICTION];
    let stiffness = [
        [stiff * c * c + soft * s * s, (stiff - soft) * c * s],
        [(stiff - soft) * c * s, stiff * s * s + soft * c * c],
    ];
    let [fx, fy] = stiffness.map(|row| row[0] * y[0] + row[1] * y[1]);
    let (n, t) = ([c, s], [-s, c]);
    let along = |e: [f64; 2]| e[0] * y[0] + e[1] * y[1];
    FarkasVector {
        equilibrium: vec![[0.0; 3], [y[0], y[1], 0.0]],
        gap: vec![[fy, -fx], [-stiff * along(n), -soft * along(t)]],
        work: 0.0,
    }
}

/// The ground alone carries κ p.
fn carried(work: f64) -> FarkasVector {
    FarkasVector { equilibrium: vec![[0.0; 3]; 2], gap: vec![[-work, 0.0], [0.0; 2]], work }
}

fn proof() -> NoneContinues {
    let leaf = |vector| ModeTree::Leaf(vector);
    let split = |stick, slips| ModeTree::Split {
        contact: 0,
        branches: vec![(PointMode::Stick, stick), (PointMode::Facet(1), slips)],
    };
    NoneContinues {
        rises: split(leaf(along_normal(1.0)), leaf(along_normal(1.0))),
        stands: leaf(carried(1.0)),
        falls: split(ModeTree::Before, leaf(along_normal(-1.0))),
    }
}

fn verdict(states: &[PathState], proof: NoneContinues) -> Result<(), String> {
    let chain = chain(&lifted(), false, states);
    let state = chain.states().last().expect("a state").clone();
    chain.check_none_continues(&[Witness { state, claim: RateClaim::NoneContinues(proof) }])
}

/// The point reaches friction as it is lifted. It cannot carry more, its slip does no work, and to go back is no continuation.
#[test]
fn a_wedged_point_has_no_continuation() {
    let limit = FRICTION * 10.0;
    let rising = [state(0, 1.0, 2.0), state(1, 0.5, 5.0), state(1, 1.0, limit)];
    assert_eq!(verdict(&rising, proof()), Ok(()));
    // Before friction is reached the load rises.
    let early = [state(0, 1.0, 2.0), state(1, 0.5, 5.0), state(1, 1.0, 0.9 * limit)];
    assert!(verdict(&early, proof()).is_err());
    // On a path that falls the modes that it had are the way on.
    let falling = [state(0, 1.0, 2.0), state(1, 1.5, limit), state(1, 1.0, limit)];
    assert!(verdict(&falling, proof()).is_err_and(|why| why.contains("may go on")));
    // A point that has slipped before may slip on.
    let slipping = [state(0, 1.0, 2.0), state(1, 0.5, limit), state(1, 1.0, limit)];
    let slips = NoneContinues { falls: ModeTree::Before, ..proof() };
    assert_eq!(verdict(&slipping, slips.clone()), Ok(()));
    assert!(verdict(&rising, slips).is_err_and(|why| why.contains("did not have before")));
}

#[test]
fn each_forged_part_of_the_proof_is_refused() {
    let rising = [state(0, 1.0, 2.0), state(1, 0.5, 5.0), state(1, 1.0, FRICTION * 10.0)];
    let refused = |forged: NoneContinues| assert!(verdict(&rising, forged.clone()).is_err(), "{forged:?}");
    refused(NoneContinues { rises: ModeTree::Before, ..proof() });
    refused(NoneContinues { rises: proof().falls, ..proof() });
    refused(NoneContinues { falls: proof().rises, ..proof() });
    refused(NoneContinues { stands: ModeTree::Before, ..proof() });
    for work in [0.0, -1.0, f64::NAN] {
        refused(NoneContinues { stands: ModeTree::Leaf(carried(work)), ..proof() });
    }
    // κ p that nothing carries, and a part of it.
    for gap in [[0.0, 0.0], [-0.5, 0.0], [-1.0, 0.1]] {
        let forged = FarkasVector { gap: vec![gap, [0.0; 2]], ..carried(1.0) };
        refused(NoneContinues { stands: ModeTree::Leaf(forged), ..proof() });
    }
    let chain = chain(&lifted(), false, &rising);
    assert!(chain.check_none_continues(&[]).is_err_and(|why| why.contains("no witness")));
}

/// The sliding block of finite displacements, after a slip along +x.
fn slipped(slip: f64) -> PathState {
    let mut state = stuck(10.0 * FRICTION);
    state.gap = vec![[0.0, -slip]; 2];
    state.motion[1][0] += slip;
    state
}

/// A block loses its joint where its points leave the face of the ground, on the way out and nowhere else.
#[test]
fn a_joint_is_lost_at_the_end_of_its_face() {
    let mut problem = sliding_block(0.0);
    let own = Sliding { slip: [-0.5, 0.5], ..Sliding::fixed(0.0) };
    problem.contacts.iter_mut().for_each(|contact| contact.sliding = own);
    let mut weight = stuck(0.0);
    (weight.load_step, weight.factor) = (0, 1.0);
    let path = |slips: &[f64]| -> Vec<PathState> {
        let slid = slips.iter().map(|slip| slipped(*slip));
        [weight.clone(), stuck(3.0), stuck(10.0 * FRICTION)].into_iter().chain(slid).collect()
    };
    let lost = |problem: &PathProblem, finite: bool, slips: &[f64]| {
        chain(problem, finite, &path(slips)).check_joint_lost().is_ok()
    };
    assert!(lost(&problem, true, &[0.2, 0.5]));
    assert!(!lost(&problem, true, &[0.2, 0.4]));
    // At the bound without slip, and with small displacements, which have no faces.
    assert!(!lost(&problem, true, &[0.5, 0.5]));
    assert!(!lost(&problem, false, &[0.2, 0.5]));
    // A point away from all corners is paired for less, and its blocks do not come apart.
    let with = |corners| Sliding { slip: [-1e-4, 1e-4], corners, ..Sliding::fixed(0.5) };
    problem.contacts.iter_mut().for_each(|contact| contact.sliding = with([0.5; 2]));
    assert!(!lost(&problem, true, &[1e-5, 1e-4]));
    problem.contacts.iter_mut().for_each(|contact| contact.sliding = with([0.0, 1.0]));
    assert!(lost(&problem, true, &[1e-5, 1e-4]));
}
