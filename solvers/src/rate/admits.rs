//! The check of a rate by the definition of its laws, without its modes.
//!
//! ġ lies in the cone of the flows of those active facets on which ṙ stays, and ṙ leaves no active facet outwards. If an
//! opening facet is open, ṙ stays on it and its multiplier has any sign.

use super::problem::{Rate, RateProblem};
use crate::contact::active_point::ActivePoint;
use crate::contact::facet::dot;
use crate::settings::SETTINGS;
use nalgebra::DVector;

impl RateProblem<'_> {
    /// True if a rate satisfies the law of each point.
    pub fn admits(&self, rate: &Rate) -> bool {
        let gaps = DVector::from_iterator(2 * rate.gaps.len(), rate.gaps.iter().flatten().copied());
        let forces = &self.s * &gaps + &self.load_rate * rate.factor;
        let gap_size = gaps.amax().max(1e-300);
        let force_size = forces.amax().max(self.s.amax() * gaps.amax()).max(1e-300);
        let admits = |(k, point): (usize, &ActivePoint)| {
            let force = [0, 1].map(|i| forces[2 * k + i] / force_size);
            in_law(point, force, rate.gaps[k].map(|g| g / gap_size))
        };
        gaps.iter().all(|g| g.is_finite()) && self.points.iter().enumerate().all(admits)
    }
}

/// True if scaled rates satisfy the law of a point.
fn in_law(point: &ActivePoint, force: [f64; 2], gap: [f64; 2]) -> bool {
    let slack = |i: usize| -dot(point.facets[i].normal, force);
    if point.active.iter().any(|i| slack(*i) < -SETTINGS.active)
        || point.open.is_some_and(|i| slack(i).abs() > SETTINGS.active)
    {
        return false;
    }
    let stays: Vec<usize> = point.active.iter().copied().filter(|i| slack(*i).abs() <= SETTINGS.active).collect();
    let mut flows: Vec<[f64; 2]> = stays.iter().map(|i| point.facets[*i].flow.map(|d| -d)).collect();
    flows.extend(point.open.map(|i| point.facets[i].flow));
    let small = |v: [f64; 2]| v[0].abs().max(v[1].abs()) <= SETTINGS.same_rate();
    let along = |d: &[f64; 2]| {
        let share = dot(gap, *d) / dot(*d, *d);
        share >= 0.0 && small([gap[0] - share * d[0], gap[1] - share * d[1]])
    };
    let between = |a: &[f64; 2], b: &[f64; 2]| {
        let determinant = a[0] * b[1] - a[1] * b[0];
        let shares = [(gap[0] * b[1] - gap[1] * b[0]) / determinant, (a[0] * gap[1] - a[1] * gap[0]) / determinant];
        determinant != 0.0 && shares.iter().all(|share| *share >= -SETTINGS.same_rate())
    };
    let pairs = |(i, a): (usize, &[f64; 2])| flows[i + 1..].iter().any(|b| between(a, b));
    small(gap) || flows.iter().any(along) || flows.iter().enumerate().any(pairs)
}
