//! The engine of `limit_chain`. `limit_conic` also uses it if its own programs do not converge.

use super::layout::{Aim, Forms, Redundants, Trees, trees};
use super::optimum::centre;
use super::simplex::{Outcome, Program, Solved};
use crate::limit::settings::SETTINGS;
use voussoir_core::limit::{
    Counters, Engine, Equilibrium, Extreme, GreatestFactor, JointForce, LimitProblem, force_scale, force_unit,
    with_unit_power,
};
use voussoir_core::model::Wrenches;

/// The three optimisations in terms of redundants.
pub struct ChainEngine<'a> {
    problem: &'a LimitProblem,
    trees: Trees,
    redundants: Redundants,
    pivots: u64,
    newton_iterations: u64,
    programs: u64,
}

impl<'a> ChainEngine<'a> {
    /// Creates the engine if few joints close the bodies to rings.
    pub fn new(problem: &'a LimitProblem) -> Option<Self> {
        let trees = trees(problem)?;
        let redundants = Redundants::new(problem, &trees);
        Some(ChainEngine { problem, trees, redundants, pivots: 0, newton_iterations: 0, programs: 0 })
    }

    /// Returns the greatest margin s by which every row can be satisfied, with λ free if `varying` is given. With
    /// `any`, every field is accepted.
    fn margin(&mut self, fixed: &Wrenches, varying: Option<&Wrenches>, any: bool) -> Equilibrium {
        let force = force_unit(self.problem, fixed);
        let columns: Vec<_> = varying.iter().map(|v| (*v, force / force_unit(self.problem, v))).collect();
        let forms = self.forms((fixed, &columns), force);
        let program = Program::new(self.problem, &forms, force);
        let program = if any { program.with_any_margin() } else { program.with_margin() };
        match self.run(&program) {
            Outcome::Optimal(solved) if solved.value >= -SETTINGS.balanced => {
                Equilibrium::Field(program.forces(&solved.point))
            }
            Outcome::Optimal(solved) => {
                let (columns, _) = centre(&program, &solved.point, solved.columns);
                Equilibrium::Motion(program.motion(self.problem, &self.trees, &columns))
            }
            // Rows that set T to zero have no margin: they alone may refute equilibrium.
            Outcome::Infeasible(columns) => Equilibrium::Motion(program.motion(self.problem, &self.trees, &columns)),
            Outcome::Unbounded(_) => Equilibrium::Failed("the margin program has no optimum".into()),
            Outcome::Failed(why) => Equilibrium::Failed(why),
        }
    }

    /// Returns the joint forces as functions of the redundants and of the loads; the first load is constant.
    fn forms(&self, loads: (&Wrenches, &[(&Wrenches, f64)]), force: f64) -> Forms {
        Forms::new(self.problem, &self.trees, &self.redundants, loads, force)
    }

    fn run(&mut self, program: &Program) -> Outcome {
        self.programs += 1;
        let (outcome, work) = program.solve();
        self.pivots += work.pivots;
        self.newton_iterations += work.newton_iterations;
        outcome
    }
}

impl Engine for ChainEngine<'_> {
    fn admissible(&mut self, loads: &Wrenches) -> Equilibrium {
        self.margin(loads, None, false)
    }

    fn carried(&mut self, loads: &Wrenches) -> Equilibrium {
        self.margin(loads, None, true)
    }

    fn possible(&mut self, fixed: &Wrenches, varying: &Wrenches) -> Equilibrium {
        self.margin(fixed, Some(varying), false)
    }

    fn greatest(&mut self, fixed: &Wrenches, varying: &Wrenches, cap: f64) -> GreatestFactor {
        let force = force_scale(self.problem, fixed, varying);
        let factor_unit = force / force_unit(self.problem, varying);
        let forms = self.forms((fixed, &[(varying, factor_unit)]), force);
        let program = Program::new(self.problem, &forms, force).with_cap(cap / factor_unit);
        match self.run(&program) {
            Outcome::Optimal(Solved { columns, capped: false, .. }) if columns.is_empty() => {
                GreatestFactor::Failed("the optimum of the simplex has no mechanism".into())
            }
            Outcome::Optimal(Solved { value, point, columns, capped: false }) => {
                let (columns, unique) = centre(&program, &point, columns);
                let motion = program.motion(self.problem, &self.trees, &columns);
                GreatestFactor::Collapse {
                    factor: value * factor_unit,
                    field: program.forces(&point),
                    motion: with_unit_power(varying, motion),
                    unique: Some(unique),
                }
            }
            Outcome::Optimal(Solved { point, .. }) => GreatestFactor::Capped(program.forces(&point)),
            Outcome::Unbounded(direction) => {
                let forces = program.directions(&direction);
                GreatestFactor::Unbounded(
                    forces
                        .into_iter()
                        .map(|f| JointForce { normal: f.normal.map(|n| n / factor_unit), shear: f.shear / factor_unit })
                        .collect(),
                )
            }
            Outcome::Infeasible(_) => {
                GreatestFactor::Failed("no admissible field: the start is on the verge of collapse".into())
            }
            Outcome::Failed(why) => GreatestFactor::Failed(why),
        }
    }

    fn extreme(&mut self, loads: &Wrenches, joint: usize, form: [f64; 3]) -> Extreme {
        let force = force_unit(self.problem, loads);
        let mut forms = self.forms((loads, &[]), force);
        match forms.aim_at(joint, form) {
            Aim::Determined(forces) => {
                let [n_0, n_1, shear] = forces.map(|component| component * force);
                return Extreme::Finite(JointForce { normal: [n_0, n_1], shear });
            }
            Aim::Constant => return Extreme::Failed,
            Aim::Last => {}
        }
        let program = Program::new(self.problem, &forms, force);
        match self.run(&program) {
            Outcome::Optimal(solved) => Extreme::Finite(program.forces(&solved.point)[joint]),
            Outcome::Unbounded(direction) => Extreme::Ray(program.directions(&direction)[joint]),
            Outcome::Infeasible(_) | Outcome::Failed(_) => Extreme::Failed,
        }
    }

    fn counters(&self) -> Counters {
        [
            ("programs", self.programs),
            ("pivots", self.pivots),
            ("newton_iterations", self.newton_iterations),
            ("factorisations", 0),
        ]
        .map(|(name, count)| (name.to_string(), count))
        .into()
    }
}
