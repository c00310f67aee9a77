//! The Schur complement of a factorisation on some contact points: ṙ = S ġ + s λ̇ over the points with open modes,
//! while all others keep theirs, for any modes in the factorised matrix.

use super::factorisation::FactorisedModes;
use super::point::{Point, active_points};
use crate::contact::mode::ContactMode;
use crate::linear::{inner, largest};
use crate::path::system::{Load, System};
use crate::rate::problem::{Rate, RateProblem};
use nalgebra::{DMatrix, DVector};

/// A rate problem over points, with the data to recover all unknowns.
pub struct SchurComplement<'a> {
    /// The rate problem over the points with open modes.
    pub rate: RateProblem<'a>,
    /// The problem in its units.
    pub system: &'a System,
    /// These points, then others whose mode is not the factorised one.
    points: Vec<usize>,
    /// Number of points with open modes.
    open: usize,
    /// (ṙ, ġ) of all `points` per ε and, last, λ̇.
    response: DMatrix<f64>,
    /// ε of all `points` per ġ of the open points and, last, λ̇.
    epsilon: DMatrix<f64>,
}

/// Returns the rows that fix ε of points times (ṙ, ġ) there.
fn picked(picks: &[[[f64; 4]; 2]], seen: &DMatrix<f64>, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(2 * picks.len(), columns, |i, j| {
        let (k, pick) = (i / 2, &picks[i / 2][i % 2]);
        (0..4).filter(|t| pick[*t] != 0.0).map(|t| pick[t] * seen[(4 * k + t, j)]).sum()
    })
}

impl<'a> SchurComplement<'a> {
    /// Reduces to the `open` points; all others keep their `modes`. `None` if linear algebra fails.
    pub fn new(
        (system, all): (&'a System, &[Point]),
        base: &mut FactorisedModes,
        (load_step, load): (usize, &Load),
        open: &[usize],
        modes: &[ContactMode],
        solves: &mut u64,
    ) -> Option<Self> {
        let mut points = open.to_vec();
        let changed = (0..modes.len()).filter(|c| modes[*c] != base.modes[*c]);
        points.extend(changed.filter(|c| !open.contains(c)));
        let (n, m) = (points.len(), open.len());
        base.respond(&points, solves)?;
        base.load_rate(system, load_step, load)?;
        let response = base.local(system, &points, load);
        // Rows that fix ε: ġ of the open points, the modes of the others.
        let mode = |(k, c): (usize, &usize)| system.rows(*c, if k < m { ContactMode::Stick } else { modes[*c] });
        let picks: Vec<[[f64; 4]; 2]> = points.iter().enumerate().map(mode).collect::<Option<_>>()?;
        let fixed = picked(&picks, &response, 2 * n + 1);
        let mut right = DMatrix::zeros(2 * n, 2 * m + 1);
        (0..2 * m).for_each(|i| right[(i, i)] = 1.0);
        right.set_column(2 * m, &-fixed.column(2 * n));
        let epsilon = if n == 0 { right } else { fixed.columns(0, 2 * n).into_owned().lu().solve(&right)? };
        if epsilon.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let responses = response.view((0, 0), (4 * m, 2 * n)) * &epsilon;
        let row = |i: usize| 4 * (i / 2) + i % 2;
        let rate = RateProblem {
            points: active_points(system, all, open),
            s: DMatrix::from_fn(2 * m, 2 * m, |i, j| responses[(row(i), j)]),
            load_rate: DVector::from_fn(2 * m, |i, _| responses[(row(i), 2 * m)] + response[(row(i), 2 * n)]),
            load_force: largest(&base.load_rate(system, load_step, load)?[..2 * system.contacts]),
            load_flexibility: 0.0,
            metric: None,
            settles: load.settles,
        };
        Some(SchurComplement { rate, system, points, open: m, response, epsilon })
    }

    /// Returns all unknowns of a solution. `None` if the response to the load is not known.
    pub fn combine(
        &self,
        base: &mut FactorisedModes,
        (load_step, load): (usize, &Load),
        rate: &Rate,
    ) -> Option<Vec<f64>> {
        let mut gaps = rate.gaps.as_flattened().to_vec();
        gaps.push(rate.factor);
        let epsilon = &self.epsilon * DVector::from_vec(gaps);
        let mut x = if self.points.is_empty() {
            vec![0.0; self.system.size()]
        } else {
            base.combine(&self.points, epsilon.as_slice(), base.nothing())
        };
        let load_rate = base.load_rate(self.system, load_step, load)?;
        x.iter_mut().zip(load_rate).for_each(|(x, d)| *x += rate.factor * d);
        Some(x)
    }

    /// Adds the products of motions and the displacement of the load, which the rule uses to compare rates. `factor`:
    /// the unit of the load factor. `None` if linear algebra fails.
    pub fn measure(&mut self, base: &mut FactorisedModes, at: (usize, &Load), factor: f64) -> Option<()> {
        let (n, forces) = (2 * self.open, 2 * self.system.contacts);
        let unit = |i: usize| {
            let gap = |k: usize| [0, 1].map(|t| f64::from(u8::from(i == 2 * k + t)));
            let gaps = (0..self.open).map(gap).collect();
            Rate { factor: f64::from(u8::from(i == n)), modes: Vec::new(), gaps }
        };
        let responses: Option<Vec<Vec<f64>>> = (0..=n).map(|i| self.combine(base, at, &unit(i))).collect();
        let responses = responses?;
        let own = |i: usize, j: usize| if i == n && j == n { factor.powi(-2) } else { 0.0 };
        let product = |i: usize, j: usize| inner(&responses[i][forces..], &responses[j][forces..]) + own(i, j);
        let (by_load, load) = (responses[n].split_at(forces), at.1);
        self.rate.metric = Some(DMatrix::from_fn(n + 1, n + 1, product));
        self.rate.load_flexibility =
            inner(load.wrench.as_flattened(), by_load.1) + inner(load.gap.as_flattened(), by_load.0);
        Some(())
    }

    /// Returns the correction for the residual of a direction: one step of refinement with the points' `modes`. If they
    /// are `still` (a mechanism, whose modes hold nothing), the gaps of the open points are held. `None` if linear
    /// algebra fails.
    pub fn refinement(
        &self,
        base: &FactorisedModes,
        modes: &[ContactMode],
        still: bool,
        left: &[f64],
    ) -> Option<Vec<f64>> {
        let n = self.points.len();
        let mut right = left.to_vec();
        self.points.iter().for_each(|c| right[2 * c..2 * c + 2].fill(0.0));
        // If the residual concerns only these points, the remaining equations need no solution.
        let y = if right.iter().any(|v| *v != 0.0) { base.kept(&right)? } else { base.nothing().1 };
        let held = |k: usize| still && k < self.open;
        let mode = |(k, c): (usize, &usize)| self.system.rows(*c, if held(k) { ContactMode::Stick } else { modes[*c] });
        let picks: Vec<[[f64; 4]; 2]> = self.points.iter().enumerate().map(mode).collect::<Option<_>>()?;
        let seen = base.seen(self.system, &self.points, |c| [right[2 * c], right[2 * c + 1]], &y);
        let wanted = DVector::from_fn(2 * n, |i, _| {
            let (k, c) = (i / 2, self.points[i / 2]);
            let now: f64 = (0..4).map(|t| picks[k][i % 2][t] * seen[k][t]).sum();
            if held(k) { -now } else { left[2 * c + i % 2] - now }
        });
        let epsilon = if n == 0 { wanted } else { picked(&picks, &self.response, 2 * n).lu().solve(&wanted)? };
        let step = base.combine(&self.points, epsilon.as_slice(), (right, y));
        step.iter().all(|v| v.is_finite()).then_some(step)
    }
}
