//! One factorisation for many events: every contact point has a piece of its law in the factorised
//! matrix, and points that have changed since enter as right-hand sides of their own two rows.
//!
//! ```text
//! stick   C ṙ + G q̇ = ε − λ̇ g_p          free    ṙ = ε
//! facet   −a·ṙ = ε_1,  d⊥·(C ṙ + G q̇ + λ̇ g_p) = ε_2
//! bodies  Gᵀ ṙ = −λ̇ p
//! ```

use super::rate::Piece;
use super::system::{Load, System};
use crate::lu::{Entries, SparseLu};
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// Added to the flexibility of stuck points, relative to its mean, and taken out again by
/// refinement: forces that equilibrium and flexibility leave open are shared evenly.
const SHARING: f64 = 1e-11;

/// A factorised system.
pub struct Base {
    /// Piece of each contact point in the matrix.
    pub pieces: Vec<Piece>,
    lu: SparseLu,
    columns: BTreeMap<usize, [Vec<f64>; 2]>,
    drive: Option<(usize, Vec<f64>)>,
}

/// d⊥, unit.
fn across(flow: [f64; 2]) -> [f64; 2] {
    let l = flow[0].hypot(flow[1]);
    [-flow[1] / l, flow[0] / l]
}

impl Base {
    /// Assembles and factorises. `None` where the system is singular.
    pub fn new(system: &System, pieces: Vec<Piece>) -> Option<Self> {
        let nc = system.contacts;
        let (mut entries, mut sharing): (Entries, Entries) = (Vec::new(), Vec::new());
        let gap_row = |c: usize, i: usize, row: usize, factor: f64, entries: &mut Entries| {
            entries.extend(system.flexibility[2 * c + i].iter().map(|&(j, v)| (row, j, factor * v)));
            entries.extend(system.kinematics[2 * c + i].iter().map(|&(j, v)| (row, 2 * nc + j, factor * v)));
        };
        for (c, piece) in pieces.iter().enumerate() {
            match piece {
                Piece::Stick => {
                    for i in 0..2 {
                        gap_row(c, i, 2 * c + i, 1.0, &mut entries);
                        sharing.push((2 * c + i, 2 * c + i, SHARING));
                    }
                }
                Piece::Free | Piece::Corner(..) => entries.extend((0..2).map(|i| (2 * c + i, 2 * c + i, 1.0))),
                Piece::Facet(f) => {
                    let facet = &system.facets[c].as_ref()?[*f];
                    entries.extend((0..2).map(|i| (2 * c, 2 * c + i, -facet.normal[i])));
                    let n = across(facet.flow);
                    for (i, n) in n.into_iter().enumerate() {
                        gap_row(c, i, 2 * c + 1, n, &mut entries);
                    }
                }
            }
        }
        for (row, kinematics) in system.kinematics.iter().enumerate() {
            entries.extend(kinematics.iter().map(|&(j, v)| (2 * nc + j, row, v)));
        }
        let lu = SparseLu::shifted(system.size(), &entries, &sharing)?;
        Some(Base { pieces, lu, columns: BTreeMap::new(), drive: None })
    }

    /// x for λ̇ = 1 with every piece as factorised.
    pub fn drive(&mut self, system: &System, index: usize, load: &Load) -> Option<&Vec<f64>> {
        if self.drive.as_ref().is_none_or(|(i, _)| *i != index) {
            let right = self.right(system, load);
            self.drive = Some((index, self.lu.solve(&[right], 2)?.swap_remove(0)));
        }
        self.drive.as_ref().map(|(_, x)| x)
    }

    /// Another load comes.
    pub fn forget_drive(&mut self) {
        self.drive = None;
    }

    fn right(&self, system: &System, load: &Load) -> Vec<f64> {
        let mut right = vec![0.0; system.size()];
        for (c, piece) in self.pieces.iter().enumerate() {
            match piece {
                Piece::Stick => (0..2).for_each(|i| right[2 * c + i] = -load.gap[c][i]),
                Piece::Facet(f) => {
                    if let Some(facets) = &system.facets[c] {
                        let n = across(facets[*f].flow);
                        right[2 * c + 1] = -(n[0] * load.gap[c][0] + n[1] * load.gap[c][1]);
                    }
                }
                _ => {}
            }
        }
        for (b, wrench) in load.wrench.iter().enumerate() {
            (0..3).for_each(|i| right[2 * system.contacts + 3 * b + i] = -wrench[i]);
        }
        right
    }

    /// Makes sure that the responses to the rows of these points are known. `solves` counts.
    pub fn respond(&mut self, system: &System, points: &[usize], solves: &mut u64) -> Option<()> {
        let new: Vec<usize> = points.iter().copied().filter(|c| !self.columns.contains_key(c)).collect();
        if new.is_empty() {
            return Some(());
        }
        let unit = |row: usize| {
            let mut right = vec![0.0; system.size()];
            right[row] = 1.0;
            right
        };
        let right: Vec<Vec<f64>> = new.iter().flat_map(|c| [unit(2 * c), unit(2 * c + 1)]).collect();
        *solves += right.len() as u64;
        let mut x = self.lu.solve(&right, 2)?.into_iter();
        for c in new {
            self.columns.insert(c, [x.next()?, x.next()?]);
        }
        Some(())
    }

    /// Number of points whose responses are known.
    pub fn responses(&self) -> usize {
        self.columns.len()
    }

    /// (ṙ, ġ) at `points`, 4 rows each, per ε of `points` (2 columns each) and, last, per λ̇.
    /// Responses and drive must be known.
    pub fn local(&self, system: &System, points: &[usize], load: &Load) -> DMatrix<f64> {
        let n = points.len();
        let mut out = DMatrix::zeros(4 * n, 2 * n + 1);
        let nc = system.contacts;
        let mut fill = |column: usize, x: &[f64], load: Option<&Load>| {
            for (k, &c) in points.iter().enumerate() {
                for i in 0..2 {
                    let row = 2 * c + i;
                    let gap = system.flexibility[row].iter().map(|&(j, v)| v * x[j]).sum::<f64>()
                        + system.kinematics[row].iter().map(|&(j, v)| v * x[2 * nc + j]).sum::<f64>();
                    out[(4 * k + i, column)] = x[row];
                    out[(4 * k + 2 + i, column)] = gap + load.map_or(0.0, |l| l.gap[c][i]);
                }
            }
        };
        for (k, c) in points.iter().enumerate() {
            if let Some([first, second]) = self.columns.get(c) {
                fill(2 * k, first, None);
                fill(2 * k + 1, second, None);
            }
        }
        if let Some((_, x)) = &self.drive {
            fill(2 * n, x, Some(load));
        }
        out
    }

    /// x for ε at `points` and λ̇.
    pub fn combine(&self, points: &[usize], epsilon: &[f64], factor: f64) -> Vec<f64> {
        let size = self.drive.as_ref().map_or(0, |(_, x)| x.len());
        let mut sum = vec![0.0; size];
        let mut add = |x: &[f64], f: f64| sum.iter_mut().zip(x).for_each(|(s, x)| *s += f * x);
        if let Some((_, x)) = &self.drive {
            add(x, factor);
        }
        for (k, c) in points.iter().enumerate() {
            if let Some(columns) = self.columns.get(c) {
                add(&columns[0], epsilon[2 * k]);
                add(&columns[1], epsilon[2 * k + 1]);
            }
        }
        sum
    }
}
