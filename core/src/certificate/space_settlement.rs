//! The proof of a motion of rigid blocks in space that follow moving supports.
//!
//! A motion of the free bodies and the given motion of the supports cause a jump v at each point of a contact. With an
//! admissible field f in equilibrium with the loads w, virtual power gives for each motion q whose jumps are a flow
//!
//! ```text
//! −w·q + D(v) = D(v) + Σ f·v − Σ f·g ≥ −Σ f·g,   v = B q + g
//! ```
//!
//! where g are the jumps that the supports alone cause. A motion with D + Σ f·v = 0 therefore has the least potential energy of
//! all. Forces that are in balance without loads, do no positive work on any flow and negative work on g prove that
//! no motion is compatible with the supports. Flow is associated.

use super::space::jump;
use crate::limit::{SpaceContact, SpaceField, SpaceProblem, SpaceVelocity};
use crate::model::space::{SpaceAssembly, SpaceStage, Vec3, velocity_at};
use crate::model::{Stage, Target};

/// Returns the motion of every held body about the pole of the problem at the end of stage `index` \[m, rad\]; `None` for free
/// bodies.
pub fn space_support_motions(
    assembly: &SpaceAssembly,
    stages: &[(&Stage, &SpaceStage)],
    index: usize,
    pole: &Vec3,
) -> Vec<Option<SpaceVelocity>> {
    let mut motions: Vec<_> = assembly.bodies.iter().map(|body| body.fixed.then_some([0.0; 6])).collect();
    for (stage, loads) in &stages[..=index] {
        let factor = match stage.target {
            Target::Factor(factor) => factor,
            Target::Collapse => 1.0,
        };
        for settlement in &loads.settlements {
            let moved = settlement.displacement + settlement.rotation.cross(&(pole - settlement.about));
            let all = moved.iter().chain(settlement.rotation.iter());
            for (sum, own) in motions[settlement.body].iter_mut().flatten().zip(all) {
                *sum += factor * own;
            }
        }
    }
    motions
}

/// Returns the gap (n, s, t) \[m\] that the motion of the supports alone causes at each inner point of each contact.
pub fn space_openings(
    assembly: &SpaceAssembly,
    problem: &SpaceProblem,
    supports: &[Option<SpaceVelocity>],
) -> SpaceField {
    let at = |body: usize, point: &Vec3| supports[body].map_or(Vec3::zeros(), |own| velocity_at(&own, point));
    let of = |contact: &SpaceContact| {
        let own = &assembly.contacts[contact.contact];
        let gap = |point: &Vec3| {
            let apart = at(own.plus, point) - at(own.minus, point);
            contact.frame.map(|axis| axis.dot(&apart))
        };
        contact.inner.points.iter().map(gap).collect()
    };
    problem.contacts.iter().map(of).collect()
}

/// Returns the residuals of a motion by name. `settlement_flow` is the greatest jump that is not a flow, relative to the greatest
/// jump or opening. `settlement_gap` is the work of the field on all jumps that is not dissipated, relative to the sum of
/// |force| × greatest jump or opening. The shapes must match.
pub fn space_settlement_residuals(
    problem: &SpaceProblem,
    openings: &SpaceField,
    field: &SpaceField,
    motion: &[SpaceVelocity],
) -> [(&'static str, f64); 2] {
    let (mut largest, mut impossible, mut gap, mut forces) = (0.0f64, 0.0f64, 0.0, 0.0);
    for ((contact, opened), pressed) in problem.contacts.iter().zip(openings).zip(field) {
        let mut idle = 0.0;
        let points = contact.inner.points.iter().zip(&contact.inner.areas);
        for (((point, area), open), force) in points.zip(opened).zip(pressed) {
            let moved = jump(contact, point, motion);
            let rate: [f64; 3] = std::array::from_fn(|i| moved[i] + open[i]);
            largest = largest.max(Vec3::from(rate).norm());
            impossible = impossible.max(contact.law.violation_of_flow(&rate));
            let work: f64 = force.iter().zip(&rate).map(|(f, v)| f * v).sum();
            idle += work + area * contact.law.dissipation(&rate);
            forces += Vec3::from(*force).norm();
        }
        gap += idle.abs();
    }
    let driven = openings.iter().flatten().map(|open| Vec3::from(*open).norm());
    let largest = driven.fold(largest, f64::max).max(f64::MIN_POSITIVE);
    let scale = (forces * largest).max(f64::MIN_POSITIVE);
    [("settlement_flow", impossible / largest), ("settlement_gap", gap / scale)]
}

/// Returns the residual `settlement_ray` of forces that prove that no motion is compatible with the supports: their imbalance
/// and the greatest force outside the cones, times the greatest opening, divided by their negative work on the openings; infinite
/// without such work, or without one force for each point of each contact.
pub fn space_settlement_ray(problem: &SpaceProblem, openings: &SpaceField, ray: &SpaceField) -> f64 {
    let fits = |(contact, forces): (&SpaceContact, &Vec<[f64; 3]>)| contact.inner.points.len() == forces.len();
    if ray.len() != problem.contacts.len() || !problem.contacts.iter().zip(ray).all(fits) {
        return f64::INFINITY;
    }
    let still = SpaceProblem {
        fixed: vec![[0.0; 6]; problem.bodies],
        varying: vec![[0.0; 6]; problem.bodies],
        ..problem.clone()
    };
    let [unbalanced, outside] = super::space::defects(&still, ray);
    let (mut work, mut greatest) = (0.0, 0.0f64);
    for (open, force) in openings.iter().flatten().zip(ray.iter().flatten()) {
        work += open.iter().zip(force).map(|(g, f)| g * f).sum::<f64>();
        greatest = greatest.max(Vec3::from(*open).norm());
    }
    if work < 0.0 { (unbalanced + outside) * greatest / -work } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::FrictionCone;

    /// A cube of side and weight 1 on a support with μ = 0.5.
    fn cube() -> SpaceProblem {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let frame = [Vec3::z(), Vec3::x(), Vec3::y()];
        let contact = SpaceContact::new(0, [None, Some(0)], &vertices, frame, (FrictionCone::dry(0.5, 0.5), 1));
        SpaceProblem {
            free: vec![None, Some(0)],
            bodies: 1,
            contacts: vec![contact],
            fixed: vec![SpaceContact::wrench(&Vec3::new(0.5, 0.5, 0.5), &-Vec3::z())],
            varying: vec![[0.0; 6]],
            pole: Vec3::zeros(),
            length: 2.0,
        }
    }

    /// The cube follows a support that sinks; standing still above it, or sinking too far, is refused.
    #[test]
    fn a_cube_follows_its_support() {
        let problem = cube();
        let openings = vec![vec![[0.1, 0.0, 0.0]; 4]];
        let field = vec![vec![[0.25, 0.0, 0.0]; 4]];
        let residuals = |sinks: f64| {
            let found = space_settlement_residuals(&problem, &openings, &field, &[[0.0, 0.0, -sinks, 0.0, 0.0, 0.0]]);
            found.map(|(_, value)| value)
        };
        assert_eq!(residuals(0.1), [0.0, 0.0]);
        assert!(residuals(0.0)[0] == 0.0 && residuals(0.0)[1] > 0.5);
        assert!(residuals(0.2)[0] > 0.5);
    }

    /// Forces that press against a closing support prove that nothing can follow it, if they are balanced and in the cones.
    #[test]
    fn a_ray_needs_balance_cones_and_work() {
        let problem = cube();
        let of = |force: [f64; 3], open: f64| {
            space_settlement_ray(&problem, &vec![vec![[open, 0.0, 0.0]; 4]], &vec![vec![force; 4]])
        };
        // These forces are not in balance.
        assert!(of([1.0, 0.0, 0.0], -0.1) > 0.1);
        assert_eq!(of([1.0, 0.0, 0.0], 0.1), f64::INFINITY);
        assert!(of([-1.0, 0.0, 0.0], 0.1) > 0.1);
    }
}
