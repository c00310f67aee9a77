//! What solving and verifying share of a path's state: motions of blocks and of the path's bodies, the
//! mechanism of a motion, and the bounds of residuals.

use super::inelastic_state::with_crushing;
use voussoir_core::certificate::{CentroidVelocity, Mechanism, mechanism, mechanism_above, tolerance};
use voussoir_core::law::FlowRule;
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{PathProblem, PathState};

/// Whether a residual is within its bound for results; NaN is not, where there is one.
pub fn small(name: &str, value: f64) -> bool {
    let bound = tolerance(name).result;
    value <= bound || bound.is_infinite()
}

/// Jumps below this share of the greatest are the blocks' deformation: where a path ends in rates on which
/// forces change (peaks of finite displacements, blocks that yield) every joint moves a little.
const DEFORMATION: f64 = 0.1;

/// The mechanism of a motion at a state.
pub fn mechanism_of(
    (assembly, problem): (&Assembly, &PathProblem),
    state: &PathState,
    motion: &[CentroidVelocity],
    unique: Option<bool>,
    finite: bool,
) -> Option<Mechanism> {
    let deforming = finite || !state.yielded.iter().all(Option::is_none);
    let found = if deforming {
        mechanism_above(DEFORMATION, assembly, motion, unique, FlowRule::NonAssociated)
    } else {
        mechanism(assembly, motion, unique, FlowRule::NonAssociated)
    };
    found.map(|found| with_crushing(found, assembly, problem, &state.yielded))
}

/// Displacement of a point that moves rigidly with a body: \[u_x, u_y, θ\] at `from`, u + R(θ) a − a
/// with a = to − from; linear in θ where displacements are small.
pub fn carried([x, y, theta]: [f64; 3], from: Vec2, to: Vec2, finite: bool) -> Vec2 {
    let arm = to - from;
    let swing = if finite { arm * (theta.cos() - 1.0) + turned(arm) * theta.sin() } else { turned(arm) * theta };
    Vec2::new(x, y) + swing
}

/// Rigid motion of a block's body about its pole, from the displacement of the block's centroid.
pub fn motion_of_body(
    assembly: &Assembly,
    problem: &PathProblem,
    block: usize,
    displacement: [f64; 3],
    finite: bool,
) -> [f64; 3] {
    let pole = problem.bodies[problem.body_of[block]].pole;
    let u = carried(displacement, assembly.inertia(block).centroid, pole, finite);
    [u.x, u.y, displacement[2]]
}
