//! Energy along a path: work of loads and supports, energy stored in blocks and joints.
//!
//! Within a mode of the path everything is linear, so that the trapezoidal rule is exact.
//! Elastic energy of a block in equilibrium: ½ Σ f·u over its contact and load points (Clapeyron);
//! the work of gravity on the elastic displacements vanishes, since their mean does.

use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{Contact, Loading, PathProblem, PathState};

/// Displacements of all points that loads act on, and the energy stored, at one state.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Σ F·u of each load step's loading per unit of its factor.
    pub conjugate: Vec<f64>,
    /// Σ of contact forces on settled supports times the settlement, per unit of the factor.
    pub reaction: Vec<f64>,
    /// Elastic energy.
    pub stored: f64,
}

/// Displacement of a point by the rigid motion of its body.
pub fn rigid(problem: &PathProblem, motion: &[[f64; 3]], body: usize, point: Vec2) -> Vec2 {
    let [x, y, theta] = motion[body];
    Vec2::new(x, y) + turned(point - problem.bodies[body].pole) * theta
}

/// Energies at a state.
pub fn snapshot(problem: &PathProblem, state: &PathState) -> Snapshot {
    let (force, motion) = (&state.force, &state.motion);
    let forces = problem.forces_on_points(state, false);
    let of_joint = |(contact, f): (&Contact, &[f64; 2])| {
        0.5 * (contact.compliance[0] * f[0] * f[0] + contact.compliance[1] * f[1] * f[1])
    };
    let mut stored: f64 = problem.contacts.iter().zip(force).map(of_joint).sum();
    let mut elastic: Vec<Vec<Vec2>> = Vec::with_capacity(problem.bodies.len());
    for (body, f) in problem.bodies.iter().zip(&forces) {
        let Some(flexibility) = &body.flexibility else {
            elastic.push(Vec::new());
            continue;
        };
        let flat = nalgebra::DVector::from_iterator(2 * f.len(), f.iter().flat_map(|f| [f.x, f.y]));
        let u = &**flexibility * &flat;
        stored += 0.5 * flat.dot(&u);
        elastic.push((0..f.len()).map(|i| Vec2::new(u[2 * i], u[2 * i + 1])).collect());
    }
    let conjugate = |loading: &Loading| {
        let pushed: f64 = loading
            .forces
            .iter()
            .map(|(body, slot, point, f)| {
                let own = slot.map_or(Vec2::zeros(), |slot| elastic[*body][slot]);
                f.dot(&(rigid(problem, motion, *body, *point) + own))
            })
            .sum();
        let carried: f64 = problem
            .bodies
            .iter()
            .zip(motion)
            .map(|(body, m)| body.mass * loading.acceleration.dot(&Vec2::new(m[0], m[1])))
            .sum();
        pushed + carried
    };
    let reaction = |loading: &Loading| {
        let mut sum = 0.0;
        for (body, [x, y, theta]) in &loading.settlements {
            for (contact, f) in problem.contacts.iter().zip(force) {
                let on_plus = contact.normal * f[0] + contact.tangent * f[1];
                let u = Vec2::new(*x, *y) + turned(contact.position - problem.bodies[*body].pole) * *theta;
                let sign = f64::from(contact.plus.body == *body) - f64::from(contact.minus.body == *body);
                sum += sign * on_plus.dot(&u);
            }
        }
        sum
    };
    Snapshot {
        conjugate: problem.load_steps.iter().map(|d| conjugate(&d.loading)).collect(),
        reaction: problem.load_steps.iter().map(|d| reaction(&d.loading)).collect(),
        stored,
    }
}

/// Work between two states, by the trapezoidal rule.
pub fn work(from: &Snapshot, to: &Snapshot, applied: [&[f64]; 2]) -> f64 {
    (0..from.conjugate.len())
        .map(|k| {
            let (a, b) = (applied[0][k], applied[1][k]);
            0.5 * (a + b) * (to.conjugate[k] - from.conjugate[k]) - 0.5 * (from.reaction[k] + to.reaction[k]) * (b - a)
        })
        .sum()
}

/// Work-conjugate displacement of a loading by the rigid motions of its blocks: Σ F·u / Σ |F|.
pub fn load_displacement(problem: &PathProblem, loading: &Loading, motion: &[[f64; 3]]) -> f64 {
    let (mut sum, mut size) = (0.0, 0.0);
    for (body, _, point, f) in &loading.forces {
        sum += f.dot(&rigid(problem, motion, *body, *point));
        size += f.norm();
    }
    if size == 0.0 {
        for (body, m) in problem.bodies.iter().zip(motion).filter(|(b, _)| !b.held) {
            sum += body.mass * loading.acceleration.dot(&Vec2::new(m[0], m[1]));
            size += body.mass * loading.acceleration.norm();
        }
    }
    if size > 0.0 { sum / size } else { 0.0 }
}
