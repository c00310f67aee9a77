//! The normal fan of a law's yield polygon: its cells, their boundaries and the neighbour across each boundary.
//!
//! In a cell the law of a step is two linear equations: Δg = 0 (inside), a·r = b A and Δg ∥ d (on a
//! facet), r = corner A (a pair of facets). Its boundaries are linear in (r, Δg): slack b A − a·r of other
//! facets, multipliers γ of its own. The cells cover the plane of z = r − ρ Δg once (Robinson 1992, Math.
//! Operations Research 17: the normal manifold).

use super::facet::dot;
use voussoir_core::law::Facet;

/// A cell: the facets that are active in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// No facet.
    Inside,
    /// On one facet.
    Facet(usize),
    /// On two facets at a corner.
    Pair(usize, [usize; 2]),
}

/// A boundary of a cell: slack = bound × area − force·r − gap·Δg ≥ 0 inside.
#[derive(Debug, Clone, Copy)]
pub struct Boundary {
    bound: f64,
    force: [f64; 2],
    gap: [f64; 2],
    /// The cell across it, and which of that cell's boundaries this is from there.
    pub neighbour: (usize, usize),
}

impl Boundary {
    fn slack_of(facet: &Facet) -> Boundary {
        Boundary { bound: facet.bound, force: facet.normal, gap: [0.0; 2], neighbour: (0, 0) }
    }

    fn multiplier(gap: [f64; 2]) -> Boundary {
        Boundary { bound: 0.0, force: [0.0; 2], gap, neighbour: (0, 0) }
    }

    /// How far a state is from the boundary.
    pub fn slack(&self, force: [f64; 2], gap: [f64; 2], area: f64) -> f64 {
        self.bound * area + self.slack_rate(force, gap)
    }

    /// Rate of the slack.
    pub fn slack_rate(&self, force: [f64; 2], gap: [f64; 2]) -> f64 {
        -dot(self.force, force) - dot(self.gap, gap)
    }
}

/// All cells of a law: inside, one per facet, one per pair of facets at a corner.
#[derive(Debug, Clone, Default)]
pub struct NormalFan {
    /// Cells with their boundaries.
    pub cells: Vec<(Cell, Vec<Boundary>)>,
    /// (corner, facets) of the cells of pairs.
    pairs: Vec<(usize, [usize; 2])>,
    facets: usize,
}

impl NormalFan {
    /// Of facets and corners, with the pairs of facets that may be active there.
    pub fn new(facets: &[Facet], corners: &[([f64; 2], Vec<[usize; 2]>)]) -> Self {
        let n = facets.len();
        let pairs: Vec<(usize, [usize; 2])> =
            corners.iter().enumerate().flat_map(|(k, (_, all))| all.iter().map(move |p| (k, *p))).collect();
        // The boundaries of a facet: its multiplier, then the other facets of the pairs it is part of.
        let on = |i: usize| -> Vec<(usize, usize)> {
            let other = |pair: &[usize; 2]| match *pair {
                [a, b] if a == i => Some(b),
                [a, b] if b == i => Some(a),
                _ => None,
            };
            pairs.iter().enumerate().filter_map(|(p, (_, pair))| other(pair).map(|j| (p, j))).collect()
        };
        let mut cells = Vec::with_capacity(1 + n + pairs.len());
        let inside =
            facets.iter().enumerate().map(|(i, f)| Boundary { neighbour: (1 + i, 0), ..Boundary::slack_of(f) });
        cells.push((Cell::Inside, inside.collect::<Vec<_>>()));
        for (i, f) in facets.iter().enumerate() {
            let square = f.flow[0] * f.flow[0] + f.flow[1] * f.flow[1];
            let own = Boundary { neighbour: (0, i), ..Boundary::multiplier(f.flow.map(|d| d / square)) };
            let mut boundaries = vec![own];
            for (p, j) in on(i) {
                let place = usize::from(pairs[p].1[1] == j);
                boundaries.push(Boundary { neighbour: (1 + n + p, place), ..Boundary::slack_of(&facets[j]) });
            }
            cells.push((Cell::Facet(i), boundaries));
        }
        for (p, &(k, pair)) in pairs.iter().enumerate() {
            let (d, e) = (facets[pair[0]].flow, facets[pair[1]].flow);
            let determinant = d[0] * e[1] - d[1] * e[0];
            let rows = [[e[1] / determinant, -e[0] / determinant], [-d[1] / determinant, d[0] / determinant]];
            let boundaries = (0..2).map(|side| {
                // The multiplier of pair[side] ends: the other facet is left, or another pair with it.
                let (ends, stays) = (pair[side], pair[1 - side]);
                let another = pairs
                    .iter()
                    .enumerate()
                    .find(|(q, (l, other))| *q != p && *l == k && other.contains(&stays) && !other.contains(&ends));
                let neighbour = match another {
                    Some((q, (_, other))) => (1 + n + q, usize::from(other[0] == stays)),
                    None => {
                        let boundaries = on(stays);
                        (1 + stays, 1 + boundaries.iter().position(|(q, _)| *q == p).unwrap_or(0))
                    }
                };
                Boundary { neighbour, ..Boundary::multiplier(rows[side]) }
            });
            cells.push((Cell::Pair(k, pair), boundaries.collect()));
        }
        NormalFan { cells, pairs, facets: n }
    }

    /// Takes the boundaries away at which a facet stops flowing: its multiplier may have any sign.
    pub fn free_multiplier(&mut self, facet: usize) {
        for (cell, boundaries) in &mut self.cells {
            match *cell {
                Cell::Facet(i) if i == facet => boundaries[0].bound = f64::INFINITY,
                Cell::Pair(_, pair) => {
                    (0..2).filter(|k| pair[*k] == facet).for_each(|k| boundaries[k].bound = f64::INFINITY);
                }
                _ => {}
            }
        }
    }

    /// The cell of a pair of facets at a corner.
    pub fn at(&self, corner: usize, pair: [usize; 2]) -> usize {
        1 + self.facets + self.pairs.iter().position(|p| *p == (corner, pair)).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::yield_polygon::YieldPolygon;

    /// Crossing a boundary and back ends where it began; but the opening facet of dry friction has no
    /// width, and is left for the apex only.
    #[test]
    fn neighbours_share_their_boundary() {
        let laws = [
            vec![Facet::opening(0.0)],
            [vec![Facet::opening(0.0)], Facet::friction(0.6, 0.0, 0.2).to_vec()].concat(),
            [vec![Facet::opening(0.4)], Facet::friction(0.5, 1.0, 0.0).to_vec(), vec![Facet::crushing(10.0)]].concat(),
        ];
        let (mut both, mut one) = (0, 0);
        for facets in laws {
            let cells = YieldPolygon::new(&facets).fan.cells;
            for (index, (_, boundaries)) in cells.iter().enumerate() {
                for (k, boundary) in boundaries.iter().enumerate() {
                    let (to, back) = boundary.neighbour;
                    if cells[to].1[back].neighbour == (index, k) {
                        both += 1;
                    } else {
                        one += 1;
                    }
                }
            }
        }
        assert_eq!((both, one), (38, 2));
    }
}
