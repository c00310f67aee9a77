//! Ends of a path: a point that a spring wedges so that no rate continues, and a block that slides off its face.

use super::scenes::{FRICTION, dry, point, sliding_block, structure, stuck};
use crate::certificate::path::chain::PathChain;
use crate::model::geometry::Vec2;
use crate::path::{
    FarkasVector, ModeTree, NoneContinues, PathProblem, PathState, PointLaw, PointMode, RateClaim, Sliding, Witness,
};
use std::sync::Arc;

/// Cosine and sine of the direction of the spring.
const SPRING: [f64; 2] = [0.5, -0.866_025_403_784_438_6];
/// Stiffness along the spring \[N/m\].
const STIFF: f64 = 1e6;

/// Stiffness across the spring, for which slip changes normal and shear force without changing the distance to
/// friction.
fn across() -> f64 {
    let [c, s] = SPRING;
    STIFF * (FRICTION * (c * s).abs() - c * c) / (s * s + FRICTION * (c * s).abs())
}

/// A point on the ground that an inclined spring wedges, under a force λ that lifts it.
fn lifted() -> PathProblem {
    let spring = Vec2::new(SPRING[0], SPRING[1]);
    let contacts = vec![
        point(Vec2::zeros(), Vec2::new(0.0, 1.0), dry(0.0), [0.0; 2]),
        point(Vec2::zeros(), spring, PointLaw::Bonded, [1.0 / STIFF, 1.0 / across()]),
    ];
    structure(Vec2::zeros(), contacts, Vec2::new(0.0, 1.0))
}

/// The state at λ with the given shear force at the ground.
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
        chain.add(PathState { displacement, ..state.clone() });
    }
    assert_eq!(chain.broken(), None);
    chain
}

/// Multipliers with y along the normal of the facet, without force in the spring.
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

/// A wedged point has no continuation: it reaches friction as it is lifted, it cannot carry more, its slip does no
/// work, and the way back is not a continuation.
#[test]
fn a_wedged_point_has_no_continuation() {
    let limit = FRICTION * 10.0;
    let rising = [state(0, 1.0, 2.0), state(1, 0.5, 5.0), state(1, 1.0, limit)];
    assert_eq!(verdict(&rising, proof()), Ok(()));
    // Before friction is reached the load can rise.
    let early = [state(0, 1.0, 2.0), state(1, 0.5, 5.0), state(1, 1.0, 0.9 * limit)];
    assert!(verdict(&early, proof()).is_err());
    // On a falling path the modes of the piece before are the continuation.
    let falling = [state(0, 1.0, 2.0), state(1, 1.5, limit), state(1, 1.0, limit)];
    assert!(verdict(&falling, proof()).is_err_and(|why| why.contains("may go on")));
    // A point that has slipped before may continue to slip.
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
    // Refused: no force that carries κ p, half of it, and a force with a shear component.
    for gap in [[0.0, 0.0], [-0.5, 0.0], [-1.0, 0.1]] {
        let forged = FarkasVector { gap: vec![gap, [0.0; 2]], ..carried(1.0) };
        refused(NoneContinues { stands: ModeTree::Leaf(forged), ..proof() });
    }
    let chain = chain(&lifted(), false, &rising);
    assert!(chain.check_none_continues(&[]).is_err_and(|why| why.contains("no witness")));
}

/// The state of the sliding block with finite displacements after a slip along +x.
fn slipped(slip: f64) -> PathState {
    let mut state = stuck(10.0 * FRICTION);
    state.gap = vec![[0.0, -slip]; 2];
    state.motion[1][0] += slip;
    state
}

/// A block loses its joint if its points leave the face of the ground, and only on the way out.
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
    // Not lost: at the bound without slip, and with small displacements, which have no faces.
    assert!(!lost(&problem, true, &[0.5, 0.5]));
    assert!(!lost(&problem, false, &[0.2, 0.5]));
    // The rule of a point away from all corners ends at a small slip, but its blocks do not separate.
    let with = |corners| Sliding { slip: [-1e-4, 1e-4], corners, ..Sliding::fixed(0.5) };
    problem.contacts.iter_mut().for_each(|contact| contact.sliding = with([0.5; 2]));
    assert!(!lost(&problem, true, &[1e-5, 1e-4]));
    problem.contacts.iter_mut().for_each(|contact| contact.sliding = with([0.0, 1.0]));
    assert!(lost(&problem, true, &[1e-5, 1e-4]));
}
