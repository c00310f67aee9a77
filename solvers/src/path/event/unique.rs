//! Uniqueness of the mechanism at the end of a path.
//!
//! At a field r every mechanism moves only points without slack, by flows of their active facets. With associated flow
//! this holds for every mechanism at the collapse load and any field (complementary slackness). Let N be the motions
//! with ġ of each point in the span of those flows, with any sign, and N₊ those with ġ in the span of the flows with γ
//! > 0. Mechanisms lie in N, and a small change along N₊ gives another mechanism:
//!
//! - dim N = 1: it is unique;
//! - dim N₊ > 1: it is not unique;
//! - otherwise the signs decide: the mechanisms with a power of 1, q̇ = N y with ġ = −Σ γ d and γ ≥ 0, are not unique
//!   if some linear form of y has two values. A random form is used; two linear programs give its least and its
//!   greatest value.

use super::piece::point::Point;
use crate::contact::facet::{dilatancy, dot, multipliers};
use crate::contact::mode::ContactMode;
use crate::optimise::dense_simplex::Feasibility;
use crate::path::system::{Load, System};
use crate::rate::mechanism::mechanisms;
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, Vector3};
use voussoir_core::random::Random;

/// Greatest number of degrees of freedom for which uniqueness is examined.
const MOST: usize = 150;

/// Greatest number of pivots of a linear program.
const PIVOTS: u64 = 5000;

/// Returns true if the mechanism with these gap rates is the only one under a load; `None` if that is not decided.
pub fn unique(system: &System, points: &[Point], load: &Load, x: &[f64], gaps: &[[f64; 2]]) -> Option<bool> {
    let freedoms = 3 * system.bodies;
    if freedoms > MOST {
        return None;
    }
    let size = gaps.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
    let space = |flows: &dyn Fn(usize) -> Option<Vec<[f64; 2]>>| {
        // A gap depends on the motion of two bodies about each other, which has three parts: rows in the span of earlier rows
        // of the same bodies constrain nothing.
        let mut spans: Vec<([usize; 2], Vec<Vector3<f64>>)> = Vec::new();
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for c in 0..points.len() {
            let columns = system.kinematics.row(2 * c);
            let [Some(first), Some(last)] = [columns.first(), columns.last()] else { continue };
            let bodies = [first.0 / 3, last.0 / 3];
            let at = spans.iter().position(|(known, _)| *known == bodies).unwrap_or_else(|| {
                spans.push((bodies, Vec::new()));
                spans.len() - 1
            });
            let span = &mut spans[at].1;
            for row in (span.len() < 3).then(|| constraints(system, c, flows(c))).into_iter().flatten() {
                let own = Vector3::from_column_slice(&row[3 * bodies[0]..][..3]);
                let left = span.iter().fold(own, |left, known| left - known * known.dot(&left));
                if left.norm() > SETTINGS.admissible * own.norm() {
                    span.push(left.normalize());
                    rows.push(row);
                }
            }
        }
        null_space(&DMatrix::from_fn(rows.len().max(freedoms), freedoms, |i, j| rows.get(i).map_or(0.0, |row| row[j])))
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
        let flows = match point.mode {
            ContactMode::Stick => Vec::new(),
            ContactMode::Open if gap[0] - dilatancy(facets) * gap[1].abs() > SETTINGS.same_rate() * size => {
                return None;
            }
            ContactMode::Open => Vec::new(),
            ContactMode::Facet(f) => {
                let f = f as usize;
                let flow = facets[f].flow;
                vec![(f, -dot(gap, flow) / dot(flow, flow))]
            }
            ContactMode::Corner(i, j) => {
                let (i, j) = (i as usize, j as usize);
                let [a, b] = multipliers(facets[i].flow, facets[j].flow, gap);
                vec![(i, a), (j, b)]
            }
        };
        let at_work = |(f, rate): &(usize, f64)| {
            *rate > SETTINGS.same_rate() * size || (point.open() && point.opening_facet == Some(*f))
        };
        Some(flows.into_iter().filter(at_work).map(|(f, _)| facets[f].flow).collect())
    };
    let all = space(&possible);
    if all.ncols() == 1 {
        return Some(true);
    }
    if space(&working).ncols() > 1 {
        return Some(false);
    }
    let power: Vec<f64> = load.wrench.iter().flatten().copied().collect();
    let own: f64 = power.iter().zip(&x[2 * system.contacts..]).map(|(p, q)| p * q).sum();
    by_signs(system, points, &all, &power.iter().map(|p| p * own.signum()).collect::<Vec<_>>())
}

/// Returns vectors that span the x with A x = 0, as columns, by a decomposition with pivots. A has no more columns than rows.
fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, qr) = (matrix.ncols(), matrix.clone().col_piv_qr());
    let r = qr.r();
    let rank = (0..n).take_while(|i| r[(*i, *i)].abs() > SETTINGS.admissible * r[(0, 0)].abs()).count();
    let mut null = DMatrix::zeros(n, n - rank);
    null.view_mut((rank, 0), (n - rank, n - rank)).fill_with_identity();
    let mut dependent = -r.view((0, rank), (rank, n - rank)).clone_owned();
    let _ = r.view((0, 0), (rank, rank)).solve_upper_triangular_mut(&mut dependent);
    null.view_mut((0, 0), (rank, n - rank)).copy_from(&dependent);
    qr.p().inv_permute_rows(&mut null);
    null
}

/// Returns true if only one mechanism N y has a power of 1.
fn by_signs(system: &System, points: &[Point], all: &DMatrix<f64>, power: &[f64]) -> Option<bool> {
    let k = all.ncols();
    // (contact point, flow) of every variable γ.
    let mut flows: Vec<(usize, [f64; 2])> = Vec::new();
    for (c, point) in points.iter().enumerate() {
        let Some(facets) = system.facets[c].as_ref().filter(|_| !(point.open() && point.apex)) else { continue };
        let opening = point.opening_facet.filter(|_| point.open());
        flows.extend(point.active.iter().copied().chain(opening).map(|f| (c, facets[f].flow)));
        flows.extend(opening.map(|f| (c, facets[f].flow.map(|d| -d))));
    }
    let moves = |row: &[(usize, f64)]| -> Vec<f64> {
        (0..k).map(|j| row.iter().map(|&(i, v)| v * all[(i, j)]).sum()).collect()
    };
    let mut at: Vec<usize> = flows.iter().map(|f| f.0).collect();
    at.dedup();
    let rows: Vec<_> = at.iter().map(|&c| (c, [0, 1].map(|i| moves(system.kinematics.row(2 * c + i))))).collect();
    let whole: Vec<(usize, f64)> = power.iter().copied().enumerate().collect();
    let mut program = mechanisms(&rows, &flows, &moves(&whole))?;
    if program.feasible() != Feasibility::Point {
        return None;
    }
    let mut random = Random::from_state(3);
    for _ in 0..2 {
        let form: Vec<f64> = (0..k).map(|_| random.signed()).collect();
        let weights = |sign: f64| -> Vec<(usize, f64)> {
            (0..k).flat_map(|j| [(j, sign * form[j]), (k + j, -sign * form[j])]).collect()
        };
        let (Some(least), Some(most)) =
            (program.minimise(&weights(1.0), PIVOTS), program.minimise(&weights(-1.0), PIVOTS))
        else {
            return Some(false);
        };
        if (least.0 + most.0).abs() > SETTINGS.distinct() * least.0.abs().max(most.0.abs()) {
            return Some(false);
        }
        if !(least.1 && most.1) {
            return None;
        }
    }
    Some(true)
}

/// Returns rows over the motions that keep the gap rate of a point in the span of some flows; `None`: a free point.
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
    let apart =
        |d: &[f64; 2]| (first[0] * d[1] - first[1] * d[0]).abs() > SETTINGS.admissible * length(*first) * length(*d);
    if flows.iter().any(apart) {
        return Vec::new();
    }
    vec![row([-first[1] / length(*first), first[0] / length(*first)])]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors of the null space have no image, and their number completes the rank.
    #[test]
    fn null_spaces_complete_the_rank() {
        let mut random = Random::from_state(5);
        let mut matrix = |rows, columns| DMatrix::from_fn(rows, columns, |_, _| random.signed());
        for (rows, columns, rank) in [(6, 4, 2), (4, 4, 4), (5, 3, 0), (9, 7, 6)] {
            let product = matrix(rows, rank) * matrix(rank, columns);
            let null = null_space(&product);
            assert_eq!(null.ncols(), columns - rank);
            assert!((product * null).iter().all(|x| x.abs() < 1e-13));
        }
    }
}
