//! The linear program of a one-sided derivative, and the check that the derivative exists.

use super::row::FaceRow;
use crate::limit::settings::SETTINGS;
use crate::optimise::dense_simplex::{Dictionary, Equations, Feasibility};
use nalgebra::{DMatrix, DVector};

/// The parts that do not depend on the parameter. s is the difference between a field of the face and r̂; δr is a step.
#[derive(Debug, Default)]
pub(super) struct Program {
    /// s = `spread` t: it preserves equilibrium and the work of the mechanism.
    pub spread: DMatrix<f64>,
    /// Null space of E.
    pub steps: DMatrix<f64>,
    /// −E⁺ p: the step that carries a unit load.
    pub response: DVector<f64>,
    /// E⁺.
    pub inverse: DMatrix<f64>,
    /// Tight rows of r̂.
    pub tight: Vec<usize>,
}

/// Derivatives of the data.
#[derive(Debug)]
pub(super) struct Direction {
    /// E′.
    pub matrix: DMatrix<f64>,
    /// E′ r̂ + w′ + λ p′.
    pub residual: DVector<f64>,
    /// A′ r̂ − b′ and A′ of the tight rows.
    pub rows: Vec<(f64, DVector<f64>)>,
}

/// A program with free variables, then variables ≥ 0; the last of these are the slacks of its rows.
struct Rows {
    free: usize,
    own: usize,
    rows: Vec<(Vec<f64>, f64)>,
}

impl Rows {
    /// Writes Σ a x ≤ b as an equation with a slack.
    fn dictionary(self) -> Option<Dictionary> {
        let (width, count) = (self.free + self.own, self.rows.len());
        let (rows, right) = self
            .rows
            .into_iter()
            .enumerate()
            .map(|(index, (mut row, right))| {
                row.resize(width + count, 0.0);
                row[width + index] = 1.0;
                (row, right)
            })
            .unzip();
        Equations { free: self.free, variables: self.own + count, rows, right }.dictionary()
    }
}

fn pivots(dictionary: &Rows) -> u64 {
    200 + 50 * (dictionary.rows.len() + dictionary.free) as u64
}

impl Program {
    /// Returns an error if the theorem does not hold. It needs a field strictly inside the strengths at a slightly
    /// lower load (so that mechanisms are bounded), and a bounded set of fields on the face.
    pub fn stable(&self, rows: &[FaceRow]) -> Result<(), String> {
        let steps = self.steps.ncols();
        let inside = self.tight.iter().map(|&row| {
            let along = rows[row].coefficients.transpose() * &self.steps;
            let load = rows[row].coefficients.dot(&self.response);
            (along.iter().copied().chain([load, -load]).collect(), -1.0)
        });
        let inside = Rows { free: steps, own: 2, rows: inside.collect() };
        let found = inside.dictionary().map(|mut own| own.feasible());
        if found != Some(Feasibility::Point) {
            return Err("no field lies strictly within the strengths at a smaller load".into());
        }
        let spread = self.spread.ncols();
        if spread == 0 {
            return Ok(());
        }
        // Variables: slack gained by each row, at most 1.
        let mut grows = Rows { free: spread, own: rows.len(), rows: Vec::new() };
        for (index, row) in rows.iter().enumerate() {
            let along: Vec<f64> = (row.coefficients.transpose() * &self.spread).iter().copied().collect();
            let own = |sense: f64| (0..rows.len()).map(move |k| if k == index { sense } else { 0.0 });
            grows.rows.push((along.iter().copied().chain(own(1.0)).collect(), 0.0));
            grows.rows.push((vec![0.0; spread].into_iter().chain(own(1.0)).collect(), 1.0));
        }
        let most = pivots(&grows);
        let matrix = DMatrix::from_fn(rows.len(), spread, |i, j| rows[i].coefficients.dot(&self.spread.column(j)));
        let weights: Vec<(usize, f64)> = (0..rows.len()).map(|index| (index, -1.0)).collect();
        let least = grows
            .dictionary()
            .and_then(|mut own| (own.feasible() == Feasibility::Point).then(|| own.minimise(&weights, most)).flatten());
        let bounded = matches!(least, Some((value, true)) if value > -SETTINGS.apart);
        if matrix.rank(SETTINGS.active) < spread || !bounded {
            return Err("fields that carry the limit load are not bounded".into());
        }
        Ok(())
    }

    /// Returns the greatest δλ, in units of force over load.
    pub fn greatest(&self, rows: &[FaceRow], direction: &Direction) -> Result<f64, String> {
        let (spread, steps) = (self.spread.ncols(), self.steps.ncols());
        let along_face = &direction.matrix * &self.spread;
        let size = direction.rows.iter().map(|(rate, a)| rate.abs().max(a.amax())).fold(0.0, f64::max);
        let size = size.max(direction.residual.amax()).max(direction.matrix.amax());
        if size <= SETTINGS.rounding {
            return Ok(0.0);
        }
        // δr = −E⁺(E′ r̂ + …) − E⁺ E′ s − E⁺ p δλ + steps u
        let (fixed, by_face) = (&self.inverse * &direction.residual, &self.inverse * along_face);
        let mut program = Rows { free: spread + steps, own: 2, rows: Vec::new() };
        if spread > 0 {
            for row in rows {
                let along = row.coefficients.transpose() * &self.spread;
                let mut line: Vec<f64> = along.iter().copied().collect();
                line.resize(spread + steps + 2, 0.0);
                program.rows.push((line, row.slack));
            }
        }
        for (&index, (rate, changed)) in self.tight.iter().zip(&direction.rows) {
            let own = &rows[index].coefficients;
            let face = (changed.transpose() * &self.spread - own.transpose() * &by_face) / size;
            let along = own.transpose() * &self.steps;
            let load = own.dot(&self.response);
            let line = face.iter().chain(along.iter()).copied().chain([load, -load]);
            program.rows.push((line.collect(), (own.dot(&fixed) - rate) / size));
        }
        let most = pivots(&program);
        let mut own = program.dictionary().ok_or("its equations contradict each other")?;
        match own.feasible() {
            Feasibility::Point => {}
            Feasibility::Reason(_) => return Err("the limit load falls without a rate".into()),
            Feasibility::Undecided => return Err("rounding left it undecided".into()),
        }
        match own.minimise(&[(0, -1.0), (1, 1.0)], most) {
            Some((value, true)) if value.is_finite() => Ok(-value * size),
            Some(_) => Err("rounding left it undecided".into()),
            None => Err("the limit load rises without a rate".into()),
        }
    }
}
