//! Claims at the end of a path: mechanisms and rays.

use crate::path::{Loading, PathProblem, PointLaw};

/// Returns `path_power`: |p·q̇ − 1| with the loading p and the velocities q̇ of all bodies about their poles.
pub fn power_residual(problem: &PathProblem, loading: &Loading, motion: &[[f64; 3]]) -> f64 {
    let load = problem.wrenches(loading);
    let power: f64 = load.iter().flatten().zip(motion.iter().flatten()).map(|(p, v)| p * v).sum();
    (power - 1.0).abs()
}

/// Returns `path_ray`: the residual of rates of contact forces that carry any amount of a loading. It is the greatest
/// unbalanced resultant on a free body (moments divided by the length of the scene) or the greatest excess over a facet
/// of the recession cone, relative to the sum of all rates; NaN if all rates are zero under a load.
pub fn ray_residual(problem: &PathProblem, loading: &Loading, ray: &[[f64; 2]]) -> f64 {
    let mut sum = problem.wrenches(loading);
    let size: f64 = ray.iter().map(|r| r[0].hypot(r[1])).sum();
    let mut worst: f64 = 0.0;
    for (contact, r) in problem.contacts.iter().zip(ray) {
        for plus in [false, true] {
            let rows = problem.kinematics(contact, plus);
            let body = if plus { contact.plus.body } else { contact.minus.body };
            (0..3).for_each(|i| sum[body][i] += rows[0][i] * r[0] + rows[1][i] * r[1]);
        }
        for facet in contact.law.facets().unwrap_or_default() {
            worst = worst.max(facet.normal[0] * r[0] + facet.normal[1] * r[1]);
        }
    }
    for (w, _) in sum.iter().zip(&problem.bodies).filter(|(_, body)| !body.held) {
        worst = worst.max(w[0].hypot(w[1])).max(w[2].abs() / problem.length);
    }
    match size.is_finite() {
        // A moving support needs no forces.
        true if worst == 0.0 => 0.0,
        true => worst / size,
        false => f64::NAN,
    }
}

/// Returns `path_flow`: the distance of the jumps of a mechanism from the flow of the yielding facets, relative to the
/// greatest jump. A contact point with slack in all facets must not move. Responses have no flow: see
/// [`leaves_forces`](super::leaves_forces).
pub fn flow_residual(problem: &PathProblem, force: &[[f64; 2]], motion: &[[f64; 3]]) -> f64 {
    let largest = force.iter().flatten().fold(0.0, |a: f64, f| a.max(f.abs()));
    let jumps: Vec<[f64; 2]> = problem
        .contacts
        .iter()
        .map(|contact| {
            let mut jump = [0.0; 2];
            for plus in [false, true] {
                let rows = problem.kinematics(contact, plus);
                let body = if plus { contact.plus.body } else { contact.minus.body };
                (0..2).for_each(|i| jump[i] += (0..3).map(|k| rows[i][k] * motion[body][k]).sum::<f64>());
            }
            jump
        })
        .collect();
    let size = jumps.iter().map(|j| j[0].hypot(j[1])).fold(1e-300, f64::max);
    let mut worst: f64 = 0.0;
    for ((contact, force), jump) in problem.contacts.iter().zip(force).zip(&jumps) {
        let facets = match &contact.law {
            PointLaw::Bonded => {
                worst = worst.max(jump[0].hypot(jump[1]) / size);
                continue;
            }
            PointLaw::Response(_) => continue,
            PointLaw::Facets(facets) => facets,
        };
        let yielding = facets
            .iter()
            .filter(|f| {
                let slack = f.bound * contact.area - f.normal[0] * force[0] - f.normal[1] * force[1];
                slack <= YIELDING * largest
            })
            .map(|f| f.flow.map(|d| -d));
        worst = worst.max(outside(*jump, yielding) / size);
    }
    worst
}

/// Greatest slack, relative to the greatest contact force, of a facet that yields.
const YIELDING: f64 = 1e-9;

/// Returns the length of a vector. Only vectors whose square is too small or too large need the scaling of `hypot`.
pub(super) fn length(v: [f64; 2]) -> f64 {
    let square = v[0] * v[0] + v[1] * v[1];
    if square.is_normal() { square.sqrt() } else { v[0].hypot(v[1]) }
}

/// Returns the distance of v from the cone of some directions in the plane.
pub(super) fn outside(v: [f64; 2], mut cone: impl Iterator<Item = [f64; 2]> + Clone) -> f64 {
    let mut least = length(v);
    while let Some(a) = cone.next() {
        let along = ((v[0] * a[0] + v[1] * a[1]) / (a[0] * a[0] + a[1] * a[1])).max(0.0);
        least = least.min(length([v[0] - along * a[0], v[1] - along * a[1]]));
        for b in cone.clone() {
            let determinant = a[0] * b[1] - a[1] * b[0];
            if determinant != 0.0 {
                let shares = [(v[0] * b[1] - v[1] * b[0]) / determinant, (a[0] * v[1] - a[1] * v[0]) / determinant];
                if shares.iter().all(|s| *s >= 0.0) {
                    return 0.0;
                }
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion outside the cone of its flow is seen at any size, also if its square is no number of the machine.
    #[test]
    fn motions_outside_are_seen_at_any_size() {
        for size in [1e-200, 1e-160, 1e-9, 1.0, 1e160, 1e200] {
            let off = outside([-3.0 * size, 4.0 * size], [[1.0, 0.0], [1.0, -1.0]].into_iter());
            assert!((off / size - 5.0).abs() < 1e-12, "{size}: {off}");
            assert!((length([3.0 * size, 4.0 * size]) / size - 5.0).abs() < 1e-12, "{size}");
        }
        assert!(length([f64::NAN, 1.0]).is_nan() && length([0.0; 2]) == 0.0);
    }
}
