//! The canonical order of the points of a rate problem, so that no answer depends on their numbering.

use super::arrival::Arrival;
use super::problem::{Rate, RateProblem};
use nalgebra::{DMatrix, DVector};

/// A problem and its arrival in canonical order.
pub struct Ordered<'a> {
    /// The problem.
    pub problem: RateProblem<'a>,
    /// The arrival.
    pub arrival: Arrival,
    /// Original index of each point.
    pub original: Vec<usize>,
}

impl<'a> Ordered<'a> {
    /// Sorts the points by values that do not depend on their numbers.
    pub fn new(problem: &RateProblem<'a>, arrival: &Arrival) -> Ordered<'a> {
        let n = problem.points.len();
        let keys: Vec<Vec<f64>> = (0..n).map(|k| key(problem, arrival, k)).collect();
        let mut original: Vec<usize> = (0..n).collect();
        let compare = |a: &usize, b: &usize| {
            let values = keys[*a].iter().zip(&keys[*b]).map(|(a, b)| a.total_cmp(b));
            values.fold(keys[*a].len().cmp(&keys[*b].len()), |all, own| all.then(own))
        };
        original.sort_by(compare);
        let at = |i: usize| 2 * original[i / 2] + i % 2;
        // λ̇ stays last.
        let of = |i: usize| if i < 2 * n { at(i) } else { i };
        let ordered = RateProblem {
            points: original.iter().map(|k| problem.points[*k].clone()).collect(),
            s: DMatrix::from_fn(2 * n, 2 * n, |i, j| problem.s[(at(i), at(j))]),
            load_rate: DVector::from_fn(2 * n, |i, _| problem.load_rate[at(i)]),
            metric: problem
                .metric
                .as_ref()
                .map(|metric| DMatrix::from_fn(2 * n + 1, 2 * n + 1, |i, j| metric[(of(i), of(j))])),
            ..*problem
        };
        let points = original.iter().map(|k| arrival.points[*k]).collect();
        Ordered { problem: ordered, arrival: Arrival { factor: arrival.factor, points }, original }
    }

    /// A rate in the original order.
    pub fn restored(&self, rate: Rate) -> Rate {
        let mut all = rate.clone();
        for (k, at) in self.original.iter().enumerate() {
            (all.modes[*at], all.gaps[*at]) = (rate.modes[k], rate.gaps[k]);
        }
        all
    }
}

/// Values of a point: its place in the event, load, own stiffness, force, facets.
fn key(problem: &RateProblem, arrival: &Arrival, k: usize) -> Vec<f64> {
    let (point, own) = (&problem.points[k], &arrival.points[k]);
    let mut row: Vec<f64> = (0..problem.s.ncols()).map(|j| problem.s[(2 * k, j)].abs()).collect();
    row.sort_by(f64::total_cmp);
    let mut key = vec![f64::from(u8::from(!own.hit)), point.active.len() as f64];
    key.extend([0, 1].map(|i| problem.load_rate[2 * k + i]));
    key.extend([(0, 0), (1, 1), (0, 1)].map(|(i, j)| problem.s[(2 * k + i, 2 * k + j)]));
    key.extend(own.force);
    key.extend(row);
    key.extend(point.active.iter().flat_map(|f| point.facets[*f].normal));
    key
}
