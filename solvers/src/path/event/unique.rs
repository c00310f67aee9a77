//! Whether the mechanism at the end of a path is the only one.
//!
//! At a field r every mechanism leaves points with slack alone and moves others by flows of their
//! active facets; where flow is associated that is so of every mechanism at the collapse load,
//! whichever field is taken (complementary slackness). Let N be the motions with ġ of each point in
//! the span of those flows, whatever their sign, and N₊ those with ġ in the span of the flows that are
//! at work with γ > 0. Mechanisms lie in N, and one can be moved a little along N₊ and stays one:
//!
//! - dim N = 1: the only one;
//! - dim N₊ > 1: not the only one;
//! - else the signs decide, which is not examined.

use super::point::Point;
use super::rate::{Piece, corner, dilatancy};
use super::system::{System, dot};
use nalgebra::DMatrix;

/// Freedoms of motion above which it is not examined.
const MOST: usize = 150;
/// Singular values below this share of the greatest are zero.
const ZERO: f64 = 1e-9;
/// Flows below this share of the greatest gap rate are not at work.
const WORKING: f64 = 1e-7;

/// Whether the mechanism with these gap rates is the only one; `None` where that is not decided.
pub fn unique(system: &System, points: &[Point], gaps: &[[f64; 2]]) -> Option<bool> {
    let freedoms = 3 * system.bodies;
    if freedoms > MOST {
        return None;
    }
    let size = gaps.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
    let dimension = |flows: &dyn Fn(usize) -> Option<Vec<[f64; 2]>>| {
        let rows: Vec<Vec<f64>> = (0..points.len()).flat_map(|c| constraints(system, c, flows(c))).collect();
        if rows.is_empty() {
            return Some(freedoms);
        }
        let matrix = DMatrix::from_fn(rows.len(), freedoms, |i, j| rows[i][j]);
        let values = matrix.try_svd(false, false, f64::EPSILON, 10_000)?.singular_values;
        Some(freedoms - values.iter().filter(|v| **v > ZERO * values.max()).count())
    };
    let possible = |c: usize| {
        let Some(facets) = &system.facets[c] else { return Some(Vec::new()) };
        let point = &points[c];
        let opening = point.opening_facet.filter(|_| point.open());
        let free = point.open() && point.apex;
        (!free).then(|| point.active.iter().copied().chain(opening).map(|f| facets[f].flow).collect())
    };
    let working = |c: usize| {
        let (point, gap) = (&points[c], gaps[c]);
        let Some(facets) = &system.facets[c] else { return Some(Vec::new()) };
        if point.open() && point.apex {
            return None;
        }
        let flows = match point.piece {
            Piece::Stick => Vec::new(),
            Piece::Free if gap[0] - dilatancy(facets) * gap[1].abs() > WORKING * size => return None,
            Piece::Free => Vec::new(),
            Piece::Facet(f) => {
                let flow = facets[f].flow;
                vec![(f, -dot(gap, flow) / dot(flow, flow))]
            }
            Piece::Corner(i, j) => {
                let [a, b] = corner(facets[i].flow, facets[j].flow, gap);
                vec![(i, a), (j, b)]
            }
        };
        let at_work =
            |(f, rate): &(usize, f64)| *rate > WORKING * size || (point.open() && point.opening_facet == Some(*f));
        Some(flows.into_iter().filter(at_work).map(|(f, _)| facets[f].flow).collect())
    };
    match (dimension(&possible)?, dimension(&working)?) {
        (1, _) => Some(true),
        (_, n) if n > 1 => Some(false),
        _ => None,
    }
}

/// Rows over the motions that keep the gap rate of a point in the span of some flows; `None` of them:
/// the point is free.
fn constraints(system: &System, c: usize, flows: Option<Vec<[f64; 2]>>) -> Vec<Vec<f64>> {
    let Some(flows) = flows else { return Vec::new() };
    let row = |n: [f64; 2]| {
        let mut row = vec![0.0; 3 * system.bodies];
        for (i, n) in n.into_iter().enumerate() {
            system.kinematics.row(2 * c + i).iter().for_each(|&(j, v)| row[j] += n * v);
        }
        row
    };
    let Some(first) = flows.first() else { return vec![row([1.0, 0.0]), row([0.0, 1.0])] };
    let length = |d: [f64; 2]| d[0].hypot(d[1]);
    let apart = |d: &[f64; 2]| (first[0] * d[1] - first[1] * d[0]).abs() > ZERO * length(*first) * length(*d);
    if flows.iter().any(apart) {
        return Vec::new();
    }
    vec![row([-first[1] / length(*first), first[0] / length(*first)])]
}
