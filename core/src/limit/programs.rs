//! Limit analysis by any solver of linear programs: every question becomes programs of one form.
//!
//! ```text
//! maximise θ   with   E r + θ p + μ f + w = 0,   S r ≤ b,   θ ≤ cap
//! ```
//!
//! The duals of the rows of equilibrium are the motion. Three choices of the loads answer every question: all loads as p
//! with cap 1 (are they carried, or which motion refutes them?), the load f with a free factor (is any factor possible?),
//! and b = 0 (which ray balances p alone?).

use super::engine::{Engine, Equilibrium, GreatestFactor};
use super::force_variables::SparseRow;
use super::matrices::LimitMatrices;
use super::problem::LimitProblem;
use super::question::answer_by;
use super::scale::{force_scale, force_unit, with_unit_power};
use super::solver::{LimitAnswer, LimitQuestion};
use super::status::Counters;
use crate::model::Wrenches;

/// Distance of a share of the loads from 1 below which all loads are carried.
const WHOLE: f64 = 1e-10;

/// Relative distance from the cap within which a factor has reached it.
const REACHED: f64 = 1e-12;

/// A linear program in numbers of about size one: maximise the last column subject to bounds of rows and columns. A bound
/// may be infinite.
#[derive(Debug, Clone)]
pub struct LinearProgram {
    /// The rows; the first [`LinearProgram::equations`] of them are equations.
    pub rows: Vec<SparseRow>,
    /// Lower and upper bound of each row.
    pub row_bounds: Vec<[f64; 2]>,
    /// Lower and upper bound of each column; the number of columns.
    pub column_bounds: Vec<[f64; 2]>,
    /// Number of equations of equilibrium, whose duals are needed.
    pub equations: usize,
}

/// The optimum of a linear program.
#[derive(Debug, Clone)]
pub struct LinearSolution {
    /// The value of each column.
    pub columns: Vec<f64>,
    /// The dual of each row, or of the equations only, in either sign convention.
    pub duals: Vec<f64>,
}

/// A function that solves a linear program, or gives the reason why it has no optimum.
type Solve<'s> = dyn FnMut(&LinearProgram) -> Result<LinearSolution, String> + 's;

/// Answers a question with a solver of linear programs. It stalls if the joints have strengths that are not linear.
pub fn answer_by_programs(
    problem: &LimitProblem,
    question: LimitQuestion,
    solve: &mut dyn FnMut(&LinearProgram) -> Result<LinearSolution, String>,
) -> LimitAnswer {
    let matrices = problem.matrices();
    match matrices.left_out {
        Some(why) => LimitAnswer::stalled(why),
        None => answer_by(problem, question, &mut Programs { problem, matrices, solve, solved: 0 }),
    }
}

/// The loads of a program.
struct Loads<'a> {
    fixed: Option<&'a Wrenches>,
    varying: &'a Wrenches,
    /// A load with a free factor.
    free: Option<&'a Wrenches>,
    /// Greatest factor of the varying load.
    cap: f64,
    /// True with strengths, false for the recession cone.
    strengths: bool,
}

/// The optimum of a program in the scene's units.
struct Optimum {
    factor: f64,
    forces: Vec<f64>,
    duals: Vec<f64>,
}

struct Programs<'a, 's> {
    problem: &'a LimitProblem,
    matrices: LimitMatrices,
    solve: &'s mut Solve<'s>,
    solved: u64,
}

impl Programs<'_, '_> {
    /// Returns a program in the unit of force, and the factor of the varying load for θ = 1.
    fn program(&self, loads: &Loads) -> (LinearProgram, f64, f64) {
        let matrices = &self.matrices;
        let force = force_scale(self.problem, loads.fixed.unwrap_or(loads.varying), loads.varying);
        let unit = force / force_unit(self.problem, loads.varying);
        let mut rows = matrices.equilibrium.clone();
        let forces = matrices.columns.len();
        let mut column_bounds = vec![[f64::NEG_INFINITY, f64::INFINITY]; forces];
        let mut add = |wrenches: &Wrenches, scale: f64, bounds: [f64; 2]| {
            let column = column_bounds.len();
            for (row, load) in rows.iter_mut().zip(matrices.loads(wrenches)).filter(|(_, load)| *load != 0.0) {
                row.push((column, load * scale));
            }
            column_bounds.push(bounds);
        };
        if let Some(free) = loads.free {
            add(free, 1.0 / force_unit(self.problem, free), [f64::NEG_INFINITY, f64::INFINITY]);
        }
        add(loads.varying, unit / force, [f64::NEG_INFINITY, loads.cap / unit]);
        let right = match loads.fixed {
            Some(fixed) => matrices.loads(fixed).iter().map(|load| -load / force).collect(),
            None => vec![0.0; rows.len()],
        };
        let mut row_bounds: Vec<[f64; 2]> = right.iter().map(|load| [*load; 2]).collect();
        let equations = rows.len();
        for (row, bound) in matrices.strength.iter().zip(&matrices.bounds) {
            let bound = if loads.strengths { bound / force } else { 0.0 };
            // Bounds may be much greater than the loads: their rows are scaled to size one.
            let scale = 1.0 / bound.max(1.0);
            rows.push(row.iter().map(|(k, entry)| (*k, entry * scale)).collect());
            row_bounds.push([f64::NEG_INFINITY, bound * scale]);
        }
        (LinearProgram { rows, row_bounds, column_bounds, equations }, force, unit)
    }

    fn optimum(&mut self, loads: &Loads) -> Result<Optimum, String> {
        let (program, force, unit) = self.program(loads);
        self.solved += 1;
        let LinearSolution { columns, duals } = (self.solve)(&program)?;
        let (wanted, found) = ([program.column_bounds.len(), program.equations], [columns.len(), duals.len()]);
        if found[0] != wanted[0] || found[1] < wanted[1] {
            let [columns, equations] = wanted;
            return Err(format!(
                "the solution of a program has {found:?} columns and duals, not {columns} and at least {equations}"
            ));
        }
        if !columns.iter().chain(&duals).all(|value| value.is_finite()) {
            return Err("the solution of a program is not finite".into());
        }
        Ok(Optimum {
            factor: columns[columns.len() - 1] * unit,
            forces: columns[..self.matrices.columns.len()].iter().map(|x| x * force).collect(),
            duals: duals[..program.equations].to_vec(),
        })
    }

    /// Finds the greatest share θ ≤ 1 of `loads` that can be carried: 1, or a refutation.
    fn share(&mut self, loads: &Wrenches, free: Option<&Wrenches>, strengths: bool) -> Equilibrium {
        match self.optimum(&Loads { fixed: None, varying: loads, free, cap: 1.0, strengths }) {
            Ok(optimum) if optimum.factor >= 1.0 - WHOLE => {
                Equilibrium::Field(self.matrices.joint_forces(&optimum.forces))
            }
            Ok(optimum) => Equilibrium::Motion(with_unit_power(loads, self.matrices.motion(&optimum.duals))),
            Err(why) => Equilibrium::Failed(why),
        }
    }
}

impl Engine for Programs<'_, '_> {
    fn admissible(&mut self, loads: &Wrenches) -> Equilibrium {
        self.share(loads, None, true)
    }

    fn possible(&mut self, fixed: &Wrenches, varying: &Wrenches) -> Equilibrium {
        self.share(fixed, Some(varying), true)
    }

    fn greatest(&mut self, fixed: &Wrenches, varying: &Wrenches, cap: f64) -> GreatestFactor {
        match self.optimum(&Loads { fixed: Some(fixed), varying, free: None, cap, strengths: true }) {
            Ok(optimum) if optimum.factor >= cap - REACHED * cap.abs() => {
                GreatestFactor::Capped(self.matrices.joint_forces(&optimum.forces))
            }
            Ok(Optimum { factor, forces, duals }) => GreatestFactor::Collapse {
                factor,
                field: self.matrices.joint_forces(&forces),
                motion: with_unit_power(varying, self.matrices.motion(&duals)),
                unique: None,
            },
            // No optimum: a ray shows that the factor has no bound.
            Err(why) => match self.share(varying, None, false) {
                Equilibrium::Field(ray) => GreatestFactor::Unbounded(ray),
                _ => GreatestFactor::Failed(why),
            },
        }
    }

    fn counters(&self) -> Counters {
        Counters::from([("programs".into(), self.solved)])
    }
}
