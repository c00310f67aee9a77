//! Functions on the state of a path that solving and verifying share: motions of blocks and bodies, the mechanism of a
//! motion, and the bounds of residuals.

use super::inelastic_state::with_crushing;
use voussoir_core::certificate::{
    CentroidVelocity, Deforming, Hinge, Mechanism, Side, mechanism, mechanism_of_deforming, tolerance,
};
use voussoir_core::law::FlowRule;
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{PathProblem, PathState};

/// Returns true if a residual is within its bound for results, or has no bound. NaN is not within a bound.
pub fn small(name: &str, value: f64) -> bool {
    let bound = tolerance(name).result;
    value <= bound || bound.is_infinite()
}

/// Jumps below this share of the greatest jump are attributed to the deformation of blocks. If a path ends in rates
/// that change forces (peaks of finite displacements, yielding blocks), every joint moves a little.
const DEFORMATION: f64 = 0.1;

/// Returns the mechanism of a motion at a state.
pub fn mechanism_of(
    (assembly, problem): (&Assembly, &PathProblem),
    state: &PathState,
    motion: &[CentroidVelocity],
    unique: Option<bool>,
    finite: bool,
) -> Option<Mechanism> {
    let deforming = finite || !state.yielded.iter().all(Option::is_none);
    let found = if deforming {
        let pressed = pressed_joints(assembly, problem, state);
        let deforming = Deforming { share: DEFORMATION, pressed: &pressed };
        mechanism_of_deforming(deforming, assembly, motion, unique, FlowRule::NonAssociated)
    } else {
        mechanism(assembly, motion, unique, FlowRule::NonAssociated)
    };
    found.map(|found| with_crushing(found, assembly, problem, &state.yielded))
}

/// Returns for each joint the end nearer to which the resultant presses its blocks together.
fn pressed_joints(assembly: &Assembly, problem: &PathProblem, state: &PathState) -> Vec<Option<usize>> {
    let largest = state.force.iter().fold(0.0, |a: f64, r| a.max(r[0].abs()));
    // Normal force of every joint, and its moment about the middle divided by the height.
    let mut resultants = vec![[0.0; 2]; assembly.joints.len()];
    for (contact, force) in problem.contacts.iter().zip(&state.force) {
        // Contact points of the fill come after those of all joints.
        let Some(joint) = assembly.joints.get(contact.joint) else { break };
        let along = joint.ends[1] - joint.ends[0];
        let place = (contact.position - joint.middle()).dot(&along) / along.norm_squared();
        resultants[contact.joint][0] += force[0];
        resultants[contact.joint][1] += force[0] * place;
    }
    let end = |[force, moment]: &[f64; 2]| (*force > 1e-9 * largest).then(|| usize::from(*moment > 0.0));
    resultants.iter().map(end).collect()
}

/// Displacement of the point `to` that moves rigidly with a body whose displacement at `from` is \[u_x, u_y, θ\]: u +
/// R(θ) a − a with a = to − from; linear in θ if displacements are small.
pub fn carried([x, y, theta]: [f64; 3], from: Vec2, to: Vec2, finite: bool) -> Vec2 {
    let arm = to - from;
    let swing = if finite { arm * (theta.cos() - 1.0) + turned(arm) * theta.sin() } else { turned(arm) * theta };
    Vec2::new(x, y) + swing
}

/// Converts the displacement of a block's centroid to the rigid motion of its body about its pole.
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

/// At a hinge, the resultant acts within this share of the joint's height from the end at which the blocks touch.
const TOE: f64 = 0.25;

/// Returns the hinges of a state: joints whose resultant acts within a quarter of their height from one end, and that
/// are open at the other. Rotations are those of the plus body relative to the minus body \[rad\].
pub fn open_hinges(assembly: &Assembly, problem: &PathProblem, state: &PathState) -> Vec<Hinge> {
    let largest = state.force.iter().fold(0.0, |a: f64, r| a.max(r[0].abs()));
    let mut hinges = Vec::new();
    for points in problem.contacts.chunk_by(|a, b| a.joint == b.joint) {
        let index = points[0].joint;
        // Contact points of the fill come after those of all joints.
        let Some(joint) = assembly.joints.get(index) else { break };
        let from = problem.contacts.partition_point(|c| c.joint < index);
        if points[0].law.is_bonded() {
            continue;
        }
        let along = joint.ends[1] - joint.ends[0];
        let place = |k: usize| (points[k].position - joint.ends[0]).dot(&along) / along.norm_squared();
        let pressed: Vec<f64> =
            (0..points.len()).filter(|k| state.force[from + k][0] > 1e-9 * largest).map(place).collect();
        let open = |end: usize| {
            let at = (0..points.len()).find(|k| (place(*k) - end as f64).abs() < 1e-9);
            at.is_some_and(|k| state.gap[from + k][0] > 0.0 && state.force[from + k][0] <= 1e-9 * largest)
        };
        let touching = match pressed.iter().copied().fold((1.0f64, 0.0f64), |(a, b), s| (a.min(s), b.max(s))) {
            _ if pressed.is_empty() => continue,
            (_, greatest) if greatest <= TOE && open(1) => 0,
            (least, _) if least >= 1.0 - TOE && open(0) => 1,
            _ => continue,
        };
        let arch = assembly.arch.as_ref().filter(|arch| arch.crosses_ring(index));
        let turn = |block: usize| state.motion[problem.body_of[block]][2];
        hinges.push(Hinge {
            joint: index,
            between: [joint.minus, joint.plus].map(|body| assembly.bodies[body].name.clone()),
            side: arch.map(|_| [Side::Intrados, Side::Extrados][touching]),
            point: joint.ends[touching].into(),
            rotation: turn(joint.plus) - turn(joint.minus),
        });
    }
    hinges
}
