//! Rows of contact points, with dense blocks for contact forces between groups of points, and sparse entries for all
//! other unknowns.
//!
//! The points of one joint are a group and are numbered consecutively. Groups on the same elastic body are coupled by a
//! block, stored column by column, so that products and the assembly of factors run along columns. A group that touches no
//! elastic body has only a diagonal.

use super::csr::CsrMatrix;
use nalgebra::{DMatrix, Matrix2};
use std::ops::Range;
use std::sync::Arc;
use voussoir_core::linear::vectors;

/// The pattern of coupled groups.
#[derive(Debug, Default)]
pub struct Pattern {
    /// First contact point of every group, and the number of points.
    start: Vec<usize>,
    /// Group of every contact point.
    group: Vec<usize>,
    /// For each group of rows: the group of the columns and the start of the block, in order.
    beside: Vec<Vec<(usize, usize)>>,
    /// Number of entries in all blocks.
    entries: usize,
}

impl Pattern {
    /// Creates a pattern from the group of each contact point. `pairs` lists coupled groups, in both directions.
    pub fn new(group: Vec<usize>, pairs: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let groups = group.last().map_or(0, |last| last + 1);
        let mut start = vec![0; groups + 1];
        group.iter().for_each(|g| start[g + 1] += 1);
        (0..groups).for_each(|g| start[g + 1] += start[g]);
        let mut beside: Vec<Vec<(usize, usize)>> = vec![Vec::new(); groups];
        for (a, b) in pairs {
            for (row, column) in [(a, b), (b, a)] {
                if !beside[row].iter().any(|e| e.0 == column) {
                    beside[row].push((column, 0));
                }
            }
        }
        let mut entries = 0;
        for (row, own) in beside.iter_mut().enumerate() {
            own.sort_unstable();
            for (column, at) in own {
                *at = entries;
                entries += 4 * (start[row + 1] - start[row]) * (start[*column + 1] - start[*column]);
            }
        }
        Pattern { start, group, beside, entries }
    }

    /// Returns the number of groups.
    pub fn groups(&self) -> usize {
        self.beside.len()
    }

    /// Returns true if any groups are coupled.
    pub fn couples(&self) -> bool {
        self.entries > 0
    }

    /// Returns the group of a contact point.
    pub fn group(&self, contact: usize) -> usize {
        self.group[contact]
    }

    /// Returns the contact points of a group.
    pub fn contacts(&self, group: usize) -> Range<usize> {
        self.start[group]..self.start[group + 1]
    }

    /// Returns the groups that have a block in the rows of a group.
    pub fn beside(&self, group: usize) -> impl Iterator<Item = usize> {
        self.beside[group].iter().map(|e| e.0)
    }

    fn rows(&self, group: usize) -> Range<usize> {
        2 * self.start[group]..2 * self.start[group + 1]
    }

    fn block(&self, row: usize, column: usize) -> Option<usize> {
        self.beside[row].iter().find(|e| e.0 == column).map(|e| e.1)
    }
}

/// A square matrix over contact forces.
#[derive(Debug, Clone)]
pub struct BlockMatrix {
    pattern: Arc<Pattern>,
    /// All blocks, each stored column by column.
    values: Vec<f64>,
    /// Diagonal of groups without a block.
    diagonal: Vec<f64>,
}

impl BlockMatrix {
    /// Creates a matrix of zeros.
    pub fn zeros(pattern: Arc<Pattern>) -> Self {
        let (values, diagonal) = (vec![0.0; pattern.entries], vec![0.0; 2 * pattern.group.len()]);
        BlockMatrix { pattern, values, diagonal }
    }

    /// Returns the pattern.
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Multiplies all entries by a factor.
    pub fn scale(&mut self, by: f64) {
        self.values.iter_mut().chain(&mut self.diagonal).for_each(|v| *v *= by);
    }

    /// Adds the 2 × 2 entries between two points, row by row. Without a block only diagonal entries are allowed.
    pub fn add(&mut self, row: usize, column: usize, entries: [[f64; 2]; 2]) {
        let pattern = &*self.pattern;
        let (a, b) = (pattern.group[row], pattern.group[column]);
        let Some(at) = pattern.block(a, b) else {
            debug_assert_eq!(row, column);
            (0..2).for_each(|k| self.diagonal[2 * row + k] += entries[k][k]);
            return;
        };
        let height = 2 * (pattern.start[a + 1] - pattern.start[a]);
        let first = at + 2 * (column - pattern.start[b]) * height + 2 * (row - pattern.start[a]);
        for (i, entries) in entries.into_iter().enumerate() {
            self.values[first + i] += entries[0];
            self.values[first + height + i] += entries[1];
        }
    }

    /// Adds to the block of two groups all 2 × 2 entries Mᵀ C N between their points. C is a matrix over the slots of
    /// the points; points are given in order as (point, slot, frame).
    pub fn add_turned(
        &mut self,
        rows: &[(usize, usize, Matrix2<f64>)],
        columns: &[(usize, usize, Matrix2<f64>)],
        c: &DMatrix<f64>,
    ) {
        let (Some(first), Some(other)) = (rows.first(), columns.first()) else { return };
        let pattern = &*self.pattern;
        let (a, b) = (pattern.group[first.0], pattern.group[other.0]);
        let Some(at) = pattern.block(a, b) else { return };
        let (own, height) = (pattern.rows(a), pattern.rows(a).len());
        let block = &mut self.values[at..at + height * pattern.rows(b).len()];
        let slots = c.nrows();
        for (point, slot, n) in columns {
            let (x, y) = c.as_slice()[2 * slot * slots..][..2 * slots].split_at(slots);
            let target = &mut block[2 * (point - pattern.start[b]) * height..][..2 * height];
            let (normal, tangent) = target.split_at_mut(height);
            // Written out for speed: the compiler does not inline closures over pairs here.
            let [n00, n10, n01, n11] = [n[(0, 0)], n[(1, 0)], n[(0, 1)], n[(1, 1)]];
            for (point, slot, m) in rows {
                let (k, s) = (2 * point - own.start, 2 * slot);
                let (x0, x1, y0, y1) = (x[s], x[s + 1], y[s], y[s + 1]);
                let (p0, p1) = (x0 * n00 + y0 * n10, x1 * n00 + y1 * n10);
                let (q0, q1) = (x0 * n01 + y0 * n11, x1 * n01 + y1 * n11);
                let [m00, m10, m01, m11] = [m[(0, 0)], m[(1, 0)], m[(0, 1)], m[(1, 1)]];
                normal[k] += m00 * p0 + m10 * p1;
                normal[k + 1] += m01 * p0 + m11 * p1;
                tangent[k] += m00 * q0 + m10 * q1;
                tangent[k + 1] += m01 * q0 + m11 * q1;
            }
        }
    }

    /// Adds one entry; without a block only to the diagonal.
    pub fn add_entry(&mut self, i: usize, j: usize, value: f64) {
        let mut entries = [[0.0; 2]; 2];
        entries[i % 2][j % 2] = value;
        self.add(i / 2, j / 2, entries);
    }

    /// Returns the non-zero entries of a row by columns.
    fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let pattern = &*self.pattern;
        let group = pattern.group[i / 2];
        let (rows, diagonal) = (pattern.rows(group), self.diagonal[i]);
        let (height, own) = (rows.len(), i - rows.start);
        let blocks = pattern.beside[group].iter().flat_map(move |&(column, at)| {
            pattern.rows(column).enumerate().map(move |(k, j)| (j, self.values[at + k * height + own]))
        });
        blocks.chain([(i, diagonal)]).filter(|e| e.1 != 0.0)
    }

    /// Returns the columns of the blocks of a group of rows: index among the forces, and values.
    pub fn columns(&self, group: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let height = self.pattern.rows(group).len();
        self.blocks(group).flat_map(move |(columns, block)| columns.zip(block.chunks_exact(height)))
    }

    /// Returns the diagonal entry of a row whose group has no block.
    pub fn diagonal(&self, i: usize) -> f64 {
        self.diagonal[i]
    }

    /// Returns the blocks of a group of rows: range of the forces, and values column by column.
    fn blocks(&self, group: usize) -> impl Iterator<Item = (Range<usize>, &[f64])> {
        let pattern = &*self.pattern;
        let height = pattern.rows(group).len();
        pattern.beside[group].iter().map(move |&(column, at)| {
            let rows = pattern.rows(column);
            let size = height * rows.len();
            (rows, &self.values[at..at + size])
        })
    }

    /// Computes out += A x.
    pub fn add_product(&self, x: &[f64], out: &mut [f64]) {
        for group in 0..self.pattern.groups() {
            let out = &mut out[self.pattern.rows(group)];
            for (columns, block) in self.blocks(group) {
                let rows = out.len();
                vectors::add_product(out, rows, block, &x[columns]);
            }
        }
        out.iter_mut().zip(self.diagonal.iter().zip(x)).for_each(|(out, (d, x))| *out += d * x);
    }

    /// Computes out += A x, and adds the absolute values of the terms to `sizes`.
    fn add_product_and_sizes(&self, x: &[f64], out: &mut [f64], sizes: &mut [f64]) {
        for group in 0..self.pattern.groups() {
            let rows = self.pattern.rows(group);
            for (columns, block) in self.blocks(group) {
                let (out, sizes) = (&mut out[rows.clone()], &mut sizes[rows.clone()]);
                super::dense::add_block_and_sizes((out, sizes), block, &x[columns]);
            }
        }
        let all = out.iter_mut().zip(sizes.iter_mut()).zip(self.diagonal.iter().zip(x));
        for ((out, size), (d, x)) in all {
            *out += d * x;
            *size += (d * x).abs();
        }
    }
}

/// Rows of contact points over all unknowns: two rows per point.
#[derive(Debug)]
pub struct GapRows {
    /// Entries for contact forces.
    pub forces: BlockMatrix,
    /// Entries for all other unknowns, by their index among all unknowns.
    pub others: CsrMatrix,
}

impl GapRows {
    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.others.len()
    }

    /// Returns the entries of a row, forces first.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        self.forces.row(i).chain(self.others.row(i).iter().copied())
    }

    /// Returns the product of one row with all unknowns.
    pub fn row_dot(&self, i: usize, x: &[f64]) -> f64 {
        self.row(i).map(|(j, v)| v * x[j]).sum()
    }

    /// Returns the products of all rows with all unknowns.
    pub fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = (0..self.len()).map(|i| self.others.row_dot(i, x)).collect();
        self.forces.add_product(&x[..self.len()], &mut out);
        out
    }

    /// Returns the products of all rows, and the sums of the absolute values of their terms.
    pub fn product_and_sizes(&self, x: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (mut out, mut sizes) = (vec![0.0; self.len()], vec![0.0; self.len()]);
        for (i, (out, size)) in out.iter_mut().zip(&mut sizes).enumerate() {
            for (j, v) in self.others.row(i) {
                *out += v * x[*j];
                *size += (v * x[*j]).abs();
            }
        }
        self.forces.add_product_and_sizes(&x[..self.len()], &mut out, &mut sizes);
        (out, sizes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Products, rows and 2 × 2 blocks agree with the matrix given by entries.
    #[test]
    fn blocks_are_the_matrix_entry_by_entry() {
        let pattern = Pattern::new(vec![0, 0, 1, 1, 1, 2, 3], [(0, 0), (1, 1), (0, 1), (1, 2), (2, 2)]);
        let (points, size) = (7, 17);
        let mut forces = BlockMatrix::zeros(Arc::new(pattern));
        let value = |i: usize, j: usize| ((13 * i + 7 * j * j + 2) as f64).sin();
        let coupled = |a: usize, b: usize| {
            let group = [0, 0, 1, 1, 1, 2, 3];
            [(0, 0), (1, 1), (0, 1), (1, 0), (1, 2), (2, 1), (2, 2)].contains(&(group[a], group[b]))
        };
        let mut dense = vec![vec![0.0; size]; 2 * points];
        for a in 0..points {
            for b in (0..points).filter(|b| coupled(a, *b) || (a == 6 && *b == 6)) {
                let all =
                    [0, 1].map(|i| [0, 1].map(|j| if a == 6 && i != j { 0.0 } else { value(2 * a + i, 2 * b + j) }));
                forces.add(a, b, all);
                (0..2).for_each(|i| (0..2).for_each(|j| dense[2 * a + i][2 * b + j] = all[i][j]));
            }
        }
        let others: Vec<Vec<(usize, f64)>> = (0..2 * points).map(|i| vec![(14 + i % 3, value(i, 3))]).collect();
        others.iter().enumerate().for_each(|(i, row)| row.iter().for_each(|&(j, v)| dense[i][j] = v));
        let rows = GapRows { forces, others: CsrMatrix::from_rows(&others) };
        let x: Vec<f64> = (0..size).map(|i| if i % 5 == 1 { 0.0 } else { value(i, 8) }).collect();
        let close = |a: f64, b: f64| (a - b).abs() < 1e-13;
        let (product, sizes) = rows.product_and_sizes(&x);
        for i in 0..2 * points {
            let exact: f64 = dense[i].iter().zip(&x).map(|(a, x)| a * x).sum();
            let size: f64 = dense[i].iter().zip(&x).map(|(a, x)| (a * x).abs()).sum();
            assert!(close(rows.product(&x)[i], exact) && close(product[i], exact) && close(rows.row_dot(i, &x), exact));
            assert!(close(sizes[i], size));
            let row: Vec<(usize, f64)> = rows.row(i).collect();
            let own: Vec<(usize, f64)> = dense[i].iter().copied().enumerate().filter(|e| e.1 != 0.0).collect();
            assert_eq!(row, own);
        }
    }
}
