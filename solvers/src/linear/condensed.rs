//! Linear equations of contact points and bodies without the contact forces that are condensed out.
//!
//! Unknowns are (r_n, r_t) of every contact point, then all others. If the two rows of a point contain no other contact
//! force (rigid bodies with compliant joints: C is diagonal; open points, r = 0), they are condensed out exactly,
//!
//! ```text
//! A_c r_c + E_c y = f_c      r_c = A_c⁻¹ (f_c − E_c y)
//! D y + Σ F_c r_c = g        (D − Σ F_c A_c⁻¹ E_c) y = g − Σ F_c A_c⁻¹ f_c
//! ```
//!
//! so that the factorised matrix has three unknowns per body and none for the contact points of its joints. Closed
//! points of elastic bodies are kept, because their gaps depend on other forces. Condensed forces are differences of
//! motions and are rounded by the size of the motions. Residuals are therefore computed from all equations, and one or
//! two steps of iterative refinement restore the accuracy.

use super::csr::CsrMatrix;
use super::factorised::{Factorised, row_error};
use super::largest;
use crate::settings::SETTINGS;
use std::sync::Arc;
use voussoir_core::linear::{Analysis, Entries, FrontalLu, SparseLu};

/// The factorisation method of condensed equations.
#[derive(Default)]
pub struct Elimination {
    /// Ranks of the unknowns along a chain, if they form one.
    chain: Option<Arc<[usize]>>,
    /// The analysis kept from the previous factorisation, if they do not.
    analysis: Analysis,
}

impl Elimination {
    /// Creates the method with a chain, if the unknowns form one; an additional unknown is the last one.
    pub fn along(chain: Option<Arc<[usize]>>) -> Self {
        Elimination { chain, analysis: Analysis::default() }
    }

    /// Factorises equations of the `kept` unknowns, given row by row.
    fn factorise(&mut self, kept: &[usize], entries: &Entries) -> Option<Reduced> {
        let Some(chain) = &self.chain else {
            return SparseLu::analysed(kept.len(), entries, &mut self.analysis)
                .map(|factors| Reduced::Sparse(Box::new(factors)));
        };
        let last = chain.iter().copied().max().unwrap_or(0);
        let rank: Vec<usize> = kept.iter().map(|i| chain.get(*i).copied().unwrap_or(last)).collect();
        FrontalLu::new(kept.len(), entries, &rank).map(Reduced::Frontal)
    }
}

/// Factors of condensed equations.
enum Reduced {
    Sparse(Box<SparseLu>),
    Frontal(FrontalLu),
}

impl Reduced {
    fn solve(&self, rights: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        match self {
            Reduced::Sparse(factors) => factors.solve(rights, 0),
            Reduced::Frontal(factors) => factors.solve(rights),
        }
    }
}

/// A contact point whose forces are condensed out.
struct Point {
    /// Index of r_n.
    first: usize,
    /// A⁻¹.
    inverse: [[f64; 2]; 2],
    /// Range of its E in the list of all points.
    across: [usize; 2],
    /// True if all of its E are added terms.
    added: bool,
}

impl Point {
    /// Returns A⁻¹ v.
    fn own(&self, v: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.inverse;
        [a[0] * v[0] + a[1] * v[1], b[0] * v[0] + b[1] * v[1]]
    }
}

/// Factorised equations, with the equations themselves for residuals.
pub struct Condensed {
    rows: CsrMatrix,
    points: Vec<Point>,
    /// E: kept column, and values in both rows of a point.
    across: Vec<(usize, [f64; 2])>,
    /// F by kept rows: start of each row, and (position in `points`, values in both columns).
    down: (Vec<usize>, Vec<(usize, [f64; 2])>),
    /// Position in `points` of every contact point.
    of: Vec<Option<usize>>,
    /// Indices of kept unknowns.
    kept: Vec<usize>,
    /// Position of every index among the kept ones; `usize::MAX` if it is condensed out.
    place: Vec<usize>,
    reduced: Reduced,
}

/// Returns a value in one of two places and zero in the other.
pub fn pair(k: usize, value: f64) -> [f64; 2] {
    if k == 0 { [value, 0.0] } else { [0.0, value] }
}

/// Returns A⁻¹ of the two rows of a point, if its equations are well conditioned.
fn own_inverse(rows: [impl Iterator<Item = (usize, f64)>; 2], forces: usize) -> Option<[[f64; 2]; 2]> {
    let (mut own, mut other) = ([[0.0f64; 2]; 2], [0.0; 2]);
    for (k, row) in rows.into_iter().enumerate() {
        for (j, value) in row {
            match j < forces {
                true => own[k][j % 2] += value,
                false => other[k] = f64::max(other[k], value.abs()),
            }
        }
    }
    let strong = (0..2).all(|k| own[k][0].abs().max(own[k][1].abs()) >= SETTINGS.small * other[k]);
    if strong { inverse(own) } else { None }
}

/// Returns the inverse of the two rows of a point, if they are well conditioned.
pub fn inverse([a, b]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let size = [a, b].map(|row| row[0].abs().max(row[1].abs()));
    let determinant = a[0] * b[1] - a[1] * b[0];
    let strong = determinant != 0.0 && determinant.abs() >= SETTINGS.small * size[0] * size[1];
    strong.then(|| [[b[1], -a[1]], [-b[0], a[0]]].map(|row| row.map(|v| v / determinant)))
}

/// Returns the contact points whose forces are condensed out, and the position of every point among them.
fn condensable(rows: &CsrMatrix, shifts: &CsrMatrix, contacts: usize) -> (Vec<Point>, Vec<Option<usize>>) {
    let forces = 2 * contacts;
    let both = |i: usize| rows.row(i).iter().chain(shifts.row(i)).copied();
    let (mut points, mut of) = (Vec::new(), vec![None; contacts]);
    for (c, of) in of.iter_mut().enumerate() {
        let own = 2 * c..2 * c + 2;
        let alone = own.clone().all(|i| both(i).all(|(j, _)| j >= forces || j / 2 == c));
        let inverse = if alone { own_inverse([0, 1].map(|k| both(2 * c + k)), forces) } else { None };
        let Some(inverse) = inverse else { continue };
        let added = own.clone().all(|i| rows.row(i).iter().all(|e| e.0 < forces));
        *of = Some(points.len());
        points.push(Point { first: 2 * c, inverse, across: [0; 2], added });
    }
    (points, of)
}

impl Condensed {
    /// Condenses and factorises equations of `size` unknowns; the first ones belong to `contacts` points. `shifts` are
    /// added terms that refinement removes. `None` if the pattern is singular.
    pub fn new(
        size: usize,
        contacts: usize,
        (entries, shift): (&Entries, &Entries),
        elimination: &mut Elimination,
    ) -> Option<Self> {
        let (rows, shifts) = (CsrMatrix::new(size, entries), CsrMatrix::new(size, shift));
        Condensed::of(rows, &shifts, contacts, elimination)
    }

    /// Condenses and factorises equations given as rows.
    pub fn of(rows: CsrMatrix, shifts: &CsrMatrix, contacts: usize, elimination: &mut Elimination) -> Option<Self> {
        let size = rows.len();
        let forces = 2 * contacts;
        let both = |i: usize| rows.row(i).iter().chain(shifts.row(i)).copied();
        let (mut points, of) = condensable(&rows, shifts, contacts);
        let kept: Vec<usize> = (0..size).filter(|i| *i >= forces || of[i / 2].is_none()).collect();
        let mut place = vec![usize::MAX; size];
        kept.iter().enumerate().for_each(|(k, i)| place[*i] = k);
        let mut across: Vec<(usize, [f64; 2])> = Vec::new();
        for point in &mut points {
            let begin = across.len();
            for k in 0..2 {
                for (j, value) in both(point.first + k).filter(|e| e.0 >= forces) {
                    match across[begin..].iter_mut().find(|e| e.0 == place[j]) {
                        Some(entry) => entry.1[k] += value,
                        None => across.push((place[j], pair(k, value))),
                    }
                }
            }
            point.across = [begin, across.len()];
        }
        let mut reduced: Entries = Vec::with_capacity(rows.entries() + shifts.entries());
        let mut row = vec![0.0; kept.len()];
        let mut met = vec![usize::MAX; kept.len()];
        let mut down: (Vec<usize>, Vec<(usize, [f64; 2])>) = (vec![0], Vec::new());
        let mut columns: Vec<usize> = Vec::new();
        for (k, &i) in kept.iter().enumerate() {
            columns.clear();
            // Gaps contain few repeated entries, which factorisations add.
            let mut sum = |j: usize, value: f64| {
                if i < forces {
                    reduced.push((k, j, value));
                    return;
                }
                if met[j] != k {
                    (met[j], row[j]) = (k, 0.0);
                    columns.push(j);
                }
                row[j] += value;
            };
            let begin = down.1.len();
            for (j, value) in both(i) {
                match of.get(j / 2).filter(|_| j < forces) {
                    Some(Some(point)) => match down.1[begin..].last_mut() {
                        Some(last) if last.0 == *point => last.1[j % 2] += value,
                        _ => down.1.push((*point, pair(j % 2, value))),
                    },
                    _ => sum(place[j], value),
                }
            }
            for &(point, f) in &down.1[begin..] {
                let point: &Point = &points[point];
                // Added terms need not act on the gaps of other points: refinement removes them, and the unknowns of
                // a chain stay neighbours.
                if point.added && i < forces {
                    continue;
                }
                let [a, b] = point.inverse;
                let by = [f[0] * a[0] + f[1] * b[0], f[0] * a[1] + f[1] * b[1]];
                for &(j, e) in &across[point.across[0]..point.across[1]] {
                    sum(j, -(by[0] * e[0] + by[1] * e[1]));
                }
            }
            down.0.push(down.1.len());
            reduced.extend(columns.iter().map(|&j| (k, j, row[j])));
        }
        let reduced = elimination.factorise(&kept, &reduced)?;
        Some(Condensed { rows, points, across, down, of, kept, place, reduced })
    }

    /// Returns y for several right-hand sides of all equations.
    pub fn condense(&self, rights: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let reduced = |right: &Vec<f64>| {
            let own = |p: &Point| p.own([right[p.first], right[p.first + 1]]);
            let own: Vec<[f64; 2]> = self.points.iter().map(own).collect();
            let by_forces = |k: usize| -> f64 {
                let f = &self.down.1[self.down.0[k]..self.down.0[k + 1]];
                f.iter().map(|(p, f)| f[0] * own[*p][0] + f[1] * own[*p][1]).sum()
            };
            self.kept.iter().enumerate().map(|(k, i)| right[*i] - by_forces(k)).collect()
        };
        let rights: Vec<Vec<f64>> = rights.iter().map(reduced).collect();
        self.reduced.solve(&rights)
    }

    /// Returns y for unit right-hand sides of the two rows of a contact point.
    pub fn units(&self, contact: usize) -> Option<[Vec<f64>; 2]> {
        let mut rights = vec![vec![0.0; self.kept.len()]; 2];
        for (k, right) in rights.iter_mut().enumerate() {
            match self.of[contact] {
                None => right[self.place[2 * contact + k]] = 1.0,
                Some(point) => {
                    let own = self.points[point].own(pair(k, 1.0));
                    for (row, right) in right.iter_mut().enumerate() {
                        let all = &self.down.1[self.down.0[row]..self.down.0[row + 1]];
                        for (_, f) in all.iter().filter(|(p, _)| *p == point) {
                            *right -= f[0] * own[0] + f[1] * own[1];
                        }
                    }
                }
            }
        }
        let mut columns = self.reduced.solve(&rights)?.into_iter();
        Some([columns.next()?, columns.next()?])
    }

    /// Number of contact points.
    pub fn contacts(&self) -> usize {
        self.of.len()
    }

    /// Returns r = A⁻¹ (f − E y).
    fn recovered(&self, point: &Point, right: [f64; 2], y: &[f64]) -> [f64; 2] {
        let mut f = right;
        for (j, e) in &self.across[point.across[0]..point.across[1]] {
            f[0] -= e[0] * y[*j];
            f[1] -= e[1] * y[*j];
        }
        point.own(f)
    }

    /// Returns all unknowns from y and the right-hand side.
    pub fn expand(&self, right: &[f64], y: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.rows.len()];
        self.kept.iter().zip(y).for_each(|(i, y)| x[*i] = *y);
        for point in &self.points {
            let r = self.recovered(point, [right[point.first], right[point.first + 1]], y);
            x[point.first..point.first + 2].copy_from_slice(&r);
        }
        x
    }

    /// Returns the force of one contact point from y and the right-hand sides of its rows.
    pub fn force(&self, contact: usize, right: [f64; 2], y: &[f64]) -> [f64; 2] {
        match self.of[contact] {
            Some(point) => self.recovered(&self.points[point], right, y),
            None => [y[self.place[2 * contact]], y[self.place[2 * contact + 1]]],
        }
    }

    /// Returns y of all unknowns.
    pub fn kept_of(&self, x: &[f64]) -> Vec<f64> {
        self.kept.iter().map(|i| x[*i]).collect()
    }

    /// Returns an unknown that belongs to no contact point, from y.
    pub fn other(&self, index: usize, y: &[f64]) -> f64 {
        y[self.place[index]]
    }

    /// Returns a zero right-hand side and a zero y.
    pub fn nothing(&self) -> (Vec<f64>, Vec<f64>) {
        (vec![0.0; self.rows.len()], vec![0.0; self.kept.len()])
    }

    /// Solves with refinement while it halves the residual, at most `refinements` times.
    pub fn solve(&self, right: &[f64], refinements: usize) -> Option<Vec<f64>> {
        let mut x = self.apply(right)?;
        let mut left = if refinements > 0 { self.left(right, &x) } else { Vec::new() };
        for _ in 0..refinements {
            let step = self.apply(&left)?;
            let better: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x + s).collect();
            let now = self.left(right, &better);
            // No decrease: only rounding is left, or the residual is zero.
            if largest(&now) >= largest(&left) {
                break;
            }
            (x, left) = (better, now);
        }
        x.iter().all(|v| v.is_finite()).then_some(x)
    }

    /// Returns the residual of the equations, without the added terms, for a right-hand side.
    pub fn left(&self, right: &[f64], x: &[f64]) -> Vec<f64> {
        right.iter().enumerate().map(|(i, right)| right - self.rows.row_dot(i, x)).collect()
    }
}

impl Factorised for Condensed {
    fn apply(&self, right: &[f64]) -> Option<Vec<f64>> {
        let y = self.condense(&[right.to_vec()])?.swap_remove(0);
        Some(self.expand(right, &y))
    }

    fn errors(&self, right: &[f64], x: &[f64]) -> (Vec<f64>, f64) {
        let mut worst = 0.0f64;
        let by_row = |(i, right): (usize, &f64)| {
            let (left, size) = self.rows.left_of_row(i, *right, x);
            worst = worst.max(row_error(left, size));
            left
        };
        (right.iter().enumerate().map(by_row).collect(), worst)
    }

    fn last_row_dot(&self, x: &[f64]) -> f64 {
        self.rows.row_dot(self.rows.len() - 1, x)
    }
}
