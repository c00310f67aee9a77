//! Factorisation L U of unsymmetric matrices with a given order of elimination: the frontal method.
//!
//! Unknowns of one rank are eliminated together. A row joins the front when the first of its unknowns is eliminated;
//! the remaining rows are passed to the next rank. When an unknown is eliminated, all rows that contain it are in the
//! front, so that partial pivoting chooses among all of them. Along a chain of bodies the front is as wide as a few
//! joints, whatever the length of the chain; all work is on dense columns.
//!
//! Sources: Irons 1970, Int. J. Numer. Meth. Engng 2, 5-32; Hood 1976, Int. J. Numer. Meth. Engng 10, 379-399.

use super::entries::Entries;
use super::vectors::{Simd, add_four};
use crate::with_vectors;

/// The elimination of the unknowns of one rank.
struct Front {
    /// Rows that join, after the rows left by the previous front.
    joining: Vec<usize>,
    /// Unknowns that are eliminated.
    columns: Vec<usize>,
    /// Row exchanges of the pivots, in order.
    exchanged: Vec<usize>,
    /// Number of rows.
    height: usize,
    /// Columns of the eliminated unknowns: L below the diagonal, U on and above it.
    eliminated: Vec<f64>,
    /// Other unknowns in the pivot rows, and their columns in these rows.
    upper: (Vec<usize>, Vec<f64>),
}

/// L U factors, front by front.
pub struct FrontalLu {
    fronts: Vec<Front>,
    size: usize,
}

/// Least number of unknowns that a front eliminates; ranks with fewer unknowns are combined.
const LEAST: usize = 6;

/// The rows that remain after a front: their columns, and the values column by column.
#[derive(Default)]
struct Left {
    rows: usize,
    columns: Vec<usize>,
    values: Vec<f64>,
}

/// Subtracts L times the first `pivots` entries of columns from their other entries, in place; entries before `first`
/// are zero. L is stored column by column, with the height of the columns, and is read once for all of them.
#[inline(always)]
fn substitute<S: Simd, const N: usize>(
    simd: S,
    mut columns: [&mut [f64]; N],
    lower: &[f64],
    (first, pivots): (usize, usize),
) {
    let height = columns.first().map_or(0, |column| column.len());
    let mut k = first;
    while k + 4 <= pivots {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| &lower[(k + i) * height..(k + i + 1) * height]);
        let below = [&a[k + 4..], &b[k + 4..], &c[k + 4..], &d[k + 4..]];
        for column in &mut columns {
            let (u, rest) = column[k..].split_at_mut(4);
            u[1] -= a[k + 1] * u[0];
            u[2] -= a[k + 2] * u[0] + b[k + 2] * u[1];
            u[3] -= a[k + 3] * u[0] + b[k + 3] * u[1] + c[k + 3] * u[2];
            add_four(simd, rest, below, [-u[0], -u[1], -u[2], -u[3]]);
        }
        k += 4;
    }
    for k in k..pivots {
        let lower = &lower[k * height + k + 1..(k + 1) * height];
        for column in &mut columns {
            let u = column[k];
            column[k + 1..].iter_mut().zip(lower).for_each(|(rest, l)| *rest -= l * u);
        }
    }
}

/// Returns the first pivot row in which a column is not zero.
fn first_row(column: &[f64], pivots: usize) -> usize {
    column[..pivots].iter().position(|v| *v != 0.0).unwrap_or(pivots)
}

/// Computes out −= A x with A stored column by column, four columns at a time.
#[inline(always)]
fn subtract_product<S: Simd>(simd: S, out: &mut [f64], a: &[f64], x: &[f64]) {
    let height = out.len();
    if height == 0 {
        return;
    }
    for (a, x) in a.chunks(4 * height).zip(x.chunks(4)) {
        if let [w, x, y, z] = *x {
            let (a, b) = a.split_at(2 * height);
            let ((a, b), (c, d)) = (a.split_at(height), b.split_at(height));
            add_four(simd, out, [a, b, c, d], [-w, -x, -y, -z]);
        } else {
            for (a, x) in a.chunks_exact(height).zip(x) {
                out.iter_mut().zip(a).for_each(|(out, a)| *out -= a * x);
            }
        }
    }
}

/// Applies the row exchanges to a column.
fn exchange(column: &mut [f64], exchanged: &[usize]) {
    for (k, other) in exchanged.iter().enumerate() {
        column.swap(k, *other);
    }
}

/// Eliminates the first columns of a front with partial pivoting and returns the row exchanges. A pivot of zero gives
/// numbers that are not finite; the solution reports it.
#[inline(always)]
fn eliminate<S: Simd>(simd: S, values: &mut [f64], height: usize, pivots: usize) -> Vec<usize> {
    let mut exchanged = Vec::with_capacity(pivots);
    for j in 0..pivots {
        let (before, rest) = values.split_at_mut(j * height);
        let column = &mut rest[..height];
        exchange(column, &exchanged);
        let first = first_row(column, j);
        substitute(simd, [&mut *column], before, (first, j));
        let greatest = (j..height).fold(j, |best, i| if column[i].abs() > column[best].abs() { i } else { best });
        let pivot = column[greatest];
        column.swap(j, greatest);
        column[j + 1..].iter_mut().for_each(|v| *v /= pivot);
        before.chunks_exact_mut(height).for_each(|column| column.swap(j, greatest));
        exchanged.push(greatest);
    }
    let (lower, rest) = values.split_at_mut(pivots * height);
    for columns in rest.chunks_mut(2 * height.max(1)) {
        columns.chunks_exact_mut(height).for_each(|column| exchange(column, &exchanged));
        let (one, two) = columns.split_at_mut(height);
        let first = first_row(one, pivots);
        match (!two.is_empty()).then(|| first_row(two, pivots)) {
            Some(other) if other == first => substitute(simd, [one, two], lower, (first, pivots)),
            other => {
                substitute(simd, [one], lower, (first, pivots));
                other.into_iter().for_each(|other| substitute(simd, [&mut *two], lower, (other, pivots)));
            }
        }
    }
    exchanged
}

/// Returns the unknowns of each front in the order of their ranks, and the front of every unknown.
fn grouped(rank: &[usize]) -> (Vec<Vec<usize>>, Vec<usize>) {
    let ranks = rank.iter().max().map_or(0, |most| most + 1);
    let mut count = vec![0; ranks];
    rank.iter().for_each(|rank| count[*rank] += 1);
    let (mut front_of, mut last, mut size) = (vec![0; ranks], 0, 0);
    for (front, count) in front_of.iter_mut().zip(count) {
        if size >= LEAST && count > 0 {
            (last, size) = (last + 1, 0);
        }
        (*front, size) = (last, size + count);
    }
    let front: Vec<usize> = rank.iter().map(|rank| front_of[*rank]).collect();
    let mut unknowns: Vec<Vec<usize>> = vec![Vec::new(); last + 1];
    front.iter().enumerate().for_each(|(j, front)| unknowns[*front].push(j));
    (unknowns, front)
}

/// Access to the rows of a square matrix for the assembly of fronts.
pub trait FrontRows {
    /// Calls `each` with unknowns of a row, among them all unknowns of least rank.
    fn candidates(&self, row: usize, each: &mut dyn FnMut(usize));

    /// Calls `each` with every unknown of some rows, at least once.
    fn unknowns(&self, rows: &[usize], each: &mut dyn FnMut(usize));

    /// Adds rows to the columns of a front: the value of the k-th row for unknown j goes to index `place[j] * height +
    /// first + k`.
    fn add(&self, rows: &[usize], place: &[usize], values: &mut [f64], height: usize, first: usize);
}

/// Entries row by row.
struct ByRows<'a> {
    entries: &'a Entries,
    starts: Vec<usize>,
}

impl<'a> ByRows<'a> {
    fn new(size: usize, entries: &'a Entries) -> Self {
        let mut starts = vec![0; size + 1];
        entries.iter().for_each(|entry| starts[entry.0 + 1] += 1);
        (0..size).for_each(|i| starts[i + 1] += starts[i]);
        ByRows { entries, starts }
    }

    fn row(&self, i: usize) -> &[(usize, usize, f64)] {
        &self.entries[self.starts[i]..self.starts[i + 1]]
    }
}

impl FrontRows for ByRows<'_> {
    fn candidates(&self, row: usize, each: &mut dyn FnMut(usize)) {
        self.row(row).iter().for_each(|entry| each(entry.1));
    }

    fn unknowns(&self, rows: &[usize], each: &mut dyn FnMut(usize)) {
        rows.iter().for_each(|i| self.candidates(*i, each));
    }

    fn add(&self, rows: &[usize], place: &[usize], values: &mut [f64], height: usize, first: usize) {
        for (k, row) in rows.iter().enumerate() {
            self.row(*row).iter().for_each(|&(_, j, value)| values[place[j] * height + first + k] += value);
        }
    }
}

impl FrontalLu {
    /// Factorises a matrix whose entries are sorted by row. `rank` gives the place of every unknown in the order of
    /// elimination. `None` if the pattern is singular.
    pub fn new(size: usize, entries: &Entries, rank: &[usize]) -> Option<Self> {
        FrontalLu::of(size, &ByRows::new(size, entries), rank)
    }

    /// Factorises a matrix whose rows are assembled by [`FrontRows`].
    pub fn of(size: usize, rows: &impl FrontRows, rank: &[usize]) -> Option<Self> {
        let (unknowns, rank) = grouped(rank);
        let mut joining: Vec<Vec<usize>> = vec![Vec::new(); unknowns.len()];
        for i in 0..size {
            let mut first = usize::MAX;
            rows.candidates(i, &mut |j| first = first.min(rank[j]));
            joining.get_mut(first)?.push(i);
        }
        let mut place = vec![usize::MAX; size];
        let mut fronts = Vec::with_capacity(joining.len());
        let mut left = Left::default();
        for (unknowns, joining) in unknowns.into_iter().zip(joining) {
            let (front, rest) = Front::new(unknowns, joining, rows, &left, &mut place)?;
            fronts.push(front);
            left = rest;
        }
        (left.rows == 0).then_some(FrontalLu { fronts, size })
    }

    /// Solves for several right-hand sides. `None` if the matrix is singular within rounding.
    pub fn solve(&self, right: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let (fronts, size) = (self.fronts.as_slice(), self.size);
        let all =
            with_vectors!('a, solve_all(fronts: &'a [Front], size: usize, right: &'a [Vec<f64>]) -> Vec<Vec<f64>>);
        all.iter().flatten().all(|v| v.is_finite()).then_some(all)
    }
}

/// Passes all right-hand sides through one front after the other.
#[inline(always)]
fn solve_all<S: Simd>(simd: S, fronts: &[Front], size: usize, right: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut pivotal: Vec<Vec<f64>> = right.iter().map(|_| Vec::with_capacity(size)).collect();
    let mut left: Vec<Vec<f64>> = vec![Vec::new(); right.len()];
    for front in fronts {
        let pivots = front.exchanged.len();
        for ((left, pivotal), right) in left.iter_mut().zip(&mut pivotal).zip(right) {
            left.extend(front.joining.iter().map(|i| right[*i]));
            exchange(left, &front.exchanged);
            let first = first_row(left, pivots);
            substitute(simd, [left], &front.eliminated, (first, pivots));
            pivotal.extend(left.drain(..pivots));
        }
    }
    let mut all = vec![vec![0.0; size]; right.len()];
    let mut known: Vec<f64> = Vec::new();
    for front in fronts.iter().rev() {
        let pivots = front.exchanged.len();
        for (x, pivotal) in all.iter_mut().zip(&mut pivotal) {
            let before = pivotal.len() - pivots;
            let own = &mut pivotal[before..];
            known.clear();
            known.extend(front.upper.0.iter().map(|j| x[*j]));
            subtract_product(simd, own, &front.upper.1, &known);
            for k in (0..pivots).rev() {
                let column = &front.eliminated[k * front.height..k * front.height + k + 1];
                let value = own[k] / column[k];
                own[..k].iter_mut().zip(column).for_each(|(own, u)| *own -= u * value);
                x[front.columns[k]] = value;
            }
            pivotal.truncate(before);
        }
    }
    all
}

impl Front {
    /// Assembles the remaining and the joining rows and eliminates the `unknowns`. `place` is a work array.
    fn new(
        unknowns: Vec<usize>,
        joining: Vec<usize>,
        rows: &impl FrontRows,
        left: &Left,
        place: &mut [usize],
    ) -> Option<(Front, Left)> {
        let (pivots, height) = (unknowns.len(), left.rows + joining.len());
        if height < pivots {
            return None;
        }
        let mut columns = unknowns;
        columns.iter().enumerate().for_each(|(k, j)| place[*j] = k);
        let mut meet = |j: usize| {
            if place[j] == usize::MAX {
                place[j] = columns.len();
                columns.push(j);
            }
        };
        left.columns.iter().for_each(|j| meet(*j));
        rows.unknowns(&joining, &mut meet);
        let mut values = vec![0.0; height * columns.len()];
        for (j, own) in left.columns.iter().zip(left.values.chunks_exact(left.rows.max(1))) {
            values[place[*j] * height..][..left.rows].copy_from_slice(own);
        }
        rows.add(&joining, place, &mut values, height, left.rows);
        columns.iter().for_each(|j| place[*j] = usize::MAX);
        let exchanged = {
            let values = values.as_mut_slice();
            with_vectors!('a, eliminate(values: &'a mut [f64], height: usize, pivots: usize) -> Vec<usize>)
        };
        let rest = height - pivots;
        let others = columns.split_off(pivots);
        let mut upper = (Vec::with_capacity(others.len()), Vec::with_capacity(pivots * others.len()));
        let mut below = Vec::with_capacity(rest * others.len());
        for (j, column) in others.iter().zip(values[pivots * height..].chunks_exact(height.max(1))) {
            // Unknowns two joints away occur only in rows that are not pivots yet.
            if column[..pivots].iter().any(|v| *v != 0.0) {
                upper.0.push(*j);
                upper.1.extend_from_slice(&column[..pivots]);
            }
            below.extend_from_slice(&column[pivots..]);
        }
        values.truncate(pivots * height);
        let left = Left { rows: rest, columns: others, values: below };
        Some((Front { joining, columns, exchanged, height, eliminated: values, upper }, left))
    }
}

#[cfg(test)]
mod tests {
    use super::super::lu::SparseLu;
    use super::*;

    /// A chain of blocks with a border in the last row and column, and some zero pivots, has the same solution as by
    /// partial pivoting on the whole matrix.
    #[test]
    fn a_chain_with_a_border_is_solved_as_by_the_whole_matrix() {
        let (blocks, width): (usize, usize) = (7, 6);
        let size = blocks * width + 1;
        let value = |i: usize, j: usize| ((17 * i + 31 * j * j + 3) as f64).sin();
        let mut entries: Entries = Vec::new();
        for i in 0..size {
            for j in 0..size {
                let near = (i / width).abs_diff(j / width) < 2 && (i == j || (i + 2 * j) % 3 != 0);
                let zero = i % width == 2 && j / width == i / width && j % width <= 2;
                let border = j + 1 == size || (i + 1 == size && j == 2 * width + 1);
                if (i + 1 < size && near && !zero && j + 1 < size) || border {
                    entries.push((i, j, if i + j + 2 == 2 * size { 0.0 } else { value(i, j) }));
                }
            }
        }
        let rank: Vec<usize> = (0..size).map(|j| (j / width).min(blocks - 1)).collect();
        let right: Vec<Vec<f64>> = (0..2).map(|k| (0..size).map(|i| value(i + k, 5)).collect()).collect();
        let frontal = FrontalLu::new(size, &entries, &rank).unwrap();
        assert_eq!(frontal.fronts.len(), blocks);
        let x = frontal.solve(&right).unwrap();
        let whole = SparseLu::new(size, &entries).unwrap().solve(&right, 2).unwrap();
        let size = whole.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs()));
        assert!(x.iter().flatten().zip(whole.iter().flatten()).all(|(x, y)| (x - y).abs() < 1e-11 * size));
        let mut singular = entries.clone();
        singular.iter_mut().filter(|entry| entry.1 == 12).for_each(|entry| entry.2 = 0.0);
        assert!(FrontalLu::new(rank.len(), &singular, &rank).unwrap().solve(&right).is_none());
    }
}
