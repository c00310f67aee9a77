//! The engine of `limit_conic`.

use super::interior_point::{Pair, Word, solve};
use super::polish::{balanced, polish};
use super::system::{Loads, System};
use super::tangents::by_tangents;
use crate::limit::block_program::{self, Program, Solution, Solved};
use crate::limit::equilibrium::{field_error, field_violation};
use crate::limit::settings::SETTINGS;
use voussoir_core::limit::{
    Counters, Engine, Equilibrium, Extreme, GreatestFactor, JointForce, LimitJoint, LimitProblem, combined,
    force_scale, force_unit, with_unit_power,
};
use voussoir_core::model::Wrenches;

/// Solves single optimisations of a problem without envelopes.
pub struct ConicEngine<'a> {
    problem: &'a LimitProblem,
    work: Counters,
    /// Loads that a previous program has shown to be carried, with a field.
    carried: Option<(Wrenches, Vec<JointForce>)>,
    /// Fixed and varying loads whose greatest factor the block program has not found.
    unsolved: Option<(Wrenches, Wrenches)>,
}

enum Optimum {
    Found {
        pair: Pair,
        unique: bool,
        /// Error of the polished optimality system.
        error: f64,
    },
    /// An interior point in equilibrium whose polish did not converge.
    Unsettled(Pair),
    Unbounded,
    Failed(String),
}

/// The results of the program of a greatest factor with the units of force tried so far.
#[derive(Default)]
struct Tried {
    /// The polished answer with the least error.
    best: Option<(f64, GreatestFactor)>,
    /// The first answer without a converged polish.
    unsettled: Option<GreatestFactor>,
    /// The reason if there is no answer.
    failed: String,
}

/// Returns the least strength of a joint \[N\]; infinite if no joint has a finite strength.
fn weakest(problem: &LimitProblem) -> f64 {
    let of = |joint: &LimitJoint| {
        let rows = joint.strength.rows.iter().map(|row| row.bound).filter(|bound| *bound > 0.0);
        rows.chain(joint.strength.block.map(|block| block.total)).fold(f64::INFINITY, f64::min)
    };
    problem.joints.iter().filter(|joint| joint.fill.is_none()).map(of).fold(f64::INFINITY, f64::min)
}

impl<'a> ConicEngine<'a> {
    /// Creates the engine of a problem without envelopes.
    pub fn new(problem: &'a LimitProblem) -> Self {
        ConicEngine { problem, work: Counters::new(), carried: None, unsolved: None }
    }

    fn count(&mut self, name: &str, by: u64) {
        *self.work.entry(name.into()).or_default() += by;
    }

    fn optimum(&mut self, system: &System) -> Optimum {
        self.count("programs", 1);
        match solve(system) {
            Word::Pair(pair, iterations) => {
                self.count("interior_point_iterations", iterations);
                self.count("factorisations", iterations);
                let Some(polished) = polish(system, &pair) else {
                    return Optimum::Failed("the polish met a singular system".into());
                };
                self.count("factorisations", polished.factorisations);
                self.count("newton_iterations", polished.iterations);
                if polished.error > SETTINGS.active {
                    return match balanced(system, &pair) {
                        Some(pair) => Optimum::Unsettled(pair),
                        None => Optimum::Failed("equilibrium could not be restored".into()),
                    };
                }
                Optimum::Found { pair: polished.pair, unique: polished.unique, error: polished.error }
            }
            Word::Unbounded(iterations) => {
                self.count("interior_point_iterations", iterations);
                Optimum::Unbounded
            }
            Word::Other(why, iterations) => {
                self.count("interior_point_iterations", iterations);
                Optimum::Failed(why)
            }
        }
    }

    /// Solves a program by its blocks and counts the work. `None` if it is not linear.
    fn by_blocks(&mut self, loads: block_program::Loads, solve: impl Fn(&Program) -> Solved) -> Option<Solved> {
        let program = Program::new(self.problem, loads)?;
        let solved = solve(&program);
        self.counted(&solved);
        Some(solved)
    }

    fn counted(&mut self, solved: &Solved) {
        self.count("programs", 1);
        self.count("interior_point_iterations", solved.iterations);
        self.count("factorisations", solved.factorisations);
        self.count("newton_iterations", solved.corrections);
    }

    /// Returns true if the field of a block program is admissible in the scene's own units.
    fn holds(&self, fixed: &Wrenches, varying: &Wrenches, solution: &Solution) -> bool {
        let loads = combined(fixed, varying, solution.factor);
        field_error(self.problem, &loads, &solution.forces) <= SETTINGS.admissible
    }

    /// Returns true if a field carries the loads within rounding.
    fn carries(&self, loads: &Wrenches, field: &[JointForce]) -> bool {
        field_error(self.problem, loads, field) <= SETTINGS.carried
    }

    /// Returns the greatest share θ ≤ 1 of `loads` by the block program; `None` if its field does not carry them.
    fn share_by_blocks(&mut self, loads: &Wrenches, strengths: bool) -> Option<Equilibrium> {
        let share = block_program::Loads { fixed: None, varying: loads, cap: 1.0, strengths };
        let solution = self.by_blocks(share, |program| block_program::solve(program, false))?.solution?;
        if solution.factor >= 1.0 - 1e-10 {
            let forces = Some(solution.forces).filter(|field| self.carries(loads, field));
            return forces.map(Equilibrium::Field);
        }
        let excess = 1.0 - solution.factor;
        let mut motion = with_unit_power(loads, solution.motion);
        motion.iter_mut().flatten().for_each(|v| *v /= excess);
        Some(Equilibrium::Motion(motion))
    }

    /// Returns the program of the greatest factor with a force scale \[N\], and the load factor for θ = 1.
    fn program(&self, fixed: &Wrenches, varying: &Wrenches, cap: f64, force: f64) -> (System, f64) {
        let unit = force / force_unit(self.problem, varying);
        let loads = Loads {
            constant: Some(fixed),
            varying: (varying, unit),
            free: None,
            cap: cap.is_finite().then_some(cap / unit),
            strengths: true,
            force,
        };
        (System::new(self.problem, &loads), unit)
    }

    /// Solves the program in a unit of force \[N\].
    fn attempt(&mut self, (fixed, varying, cap): (&Wrenches, &Wrenches, f64), force: f64, tried: &mut Tried) {
        let (system, unit) = self.program(fixed, varying, cap, force);
        match self.optimum(&system) {
            Optimum::Found { pair, unique, error } => {
                if tried.best.as_ref().is_none_or(|best| error < best.0) {
                    tried.best = Some((error, self.finite(&system, &pair, unique, varying, unit)));
                }
            }
            Optimum::Unsettled(pair) => {
                tried.unsettled.get_or_insert_with(|| self.finite(&system, &pair, false, varying, unit));
            }
            Optimum::Unbounded if tried.failed.is_empty() => {
                tried.failed = "no ray confirms that the factor has no bound".into();
            }
            Optimum::Failed(why) if tried.failed.is_empty() => tried.failed = why,
            Optimum::Unbounded | Optimum::Failed(_) => {}
        }
    }

    /// Returns a finite optimum: capped or a collapse.
    fn finite(&self, system: &System, pair: &Pair, unique: bool, varying: &Wrenches, unit: f64) -> GreatestFactor {
        if system.cap.is_some_and(|row| pair.rows[row] > 1e-9) {
            return GreatestFactor::Capped(system.forces(&pair.x));
        }
        let motion = with_unit_power(varying, system.motion(&pair.equations));
        let factor = pair.x[system.theta] * unit;
        GreatestFactor::Collapse { factor, field: system.forces(&pair.x), motion, unique: Some(unique) }
    }

    /// Finds the greatest factor with tangents of the stress blocks, starting from the earlier result without them.
    fn by_tangents(&mut self, question: (&Wrenches, &Wrenches, f64), tried: &Tried) -> Option<GreatestFactor> {
        let start = tried.best.as_ref().map(|best| &best.1).or(tried.unsettled.as_ref());
        let (GreatestFactor::Collapse { field, .. } | GreatestFactor::Capped(field)) = start? else { return None };
        let solved = by_tangents(self.problem, question, field);
        solved.iter().for_each(|solved| self.counted(solved));
        Some(greatest_of(solved.into_iter().last()?.solution?, question.1))
    }

    /// Finds the greatest share θ ≤ 1 of `loads` that can be carried: 1, or a refutation.
    fn share(&mut self, loads: &Wrenches, free: Option<&Wrenches>, strengths: bool) -> Equilibrium {
        if free.is_none()
            && let Some(answer) = self.share_by_blocks(loads, strengths)
        {
            return answer;
        }
        let force = force_unit(self.problem, loads);
        let system = System::new(
            self.problem,
            &Loads {
                constant: None,
                varying: (loads, 1.0),
                free: free.map(|f| (f, force / force_unit(self.problem, f))),
                cap: Some(1.0),
                strengths,
                force,
            },
        );
        match self.optimum(&system) {
            Optimum::Found { pair, .. } | Optimum::Unsettled(pair) if pair.x[system.theta] >= 1.0 - 1e-10 => {
                Equilibrium::Field(system.forces(&pair.x))
            }
            Optimum::Found { pair, .. } | Optimum::Unsettled(pair) => {
                // loads·q̇ = 1 − y_cap = 1 and D = θ, so the excess is 1 − θ.
                let excess = force * (1.0 - pair.x[system.theta]);
                let mut motion = system.motion(&pair.equations);
                motion.iter_mut().flatten().for_each(|v| *v /= excess);
                Equilibrium::Motion(motion)
            }
            Optimum::Unbounded => Equilibrium::Failed("a bounded program was called unbounded".into()),
            Optimum::Failed(why) => Equilibrium::Failed(why),
        }
    }

    /// Returns the field at which a linear form of the forces of a joint is greatest.
    pub fn extreme_field(&mut self, loads: &Wrenches, joint: usize, form: [f64; 3]) -> Extreme<Vec<JointForce>> {
        let none: Wrenches = vec![[0.0; 3]; self.problem.groups];
        let force = force_unit(self.problem, loads);
        let held =
            Loads { constant: Some(loads), varying: (&none, 1.0), free: None, cap: None, strengths: true, force };
        let mut system = System::new(self.problem, &held);
        system.aim_at(joint, form);
        match self.optimum(&system) {
            Optimum::Found { pair, .. } | Optimum::Unsettled(pair) => {
                let field = system.forces(&pair.x);
                if self.carries(loads, &field) { Extreme::Finite(field) } else { Extreme::Failed }
            }
            Optimum::Unbounded => {
                let mut system = System::new(self.problem, &Loads { constant: None, strengths: false, ..held });
                system.aim_at(joint, form);
                system.press(joint);
                let (Optimum::Found { pair, .. } | Optimum::Unsettled(pair)) = self.optimum(&system) else {
                    return Extreme::Failed;
                };
                let ray = system.forces(&pair.x);
                let size = |force: &JointForce| force.normal[0].abs().max(force.normal[1].abs());
                let greatest = ray.iter().map(size).fold(0.0, f64::max);
                let holds = field_violation(self.problem, &none, &ray) <= SETTINGS.carried * greatest;
                if holds { Extreme::Ray(ray) } else { Extreme::Failed }
            }
            Optimum::Failed(_) => Extreme::Failed,
        }
    }
}

impl Engine for ConicEngine<'_> {
    fn admissible(&mut self, loads: &Wrenches) -> Equilibrium {
        if let Some((_, field)) = self.carried.take_if(|(carried, _)| carried == loads) {
            return Equilibrium::Field(field);
        }
        self.share(loads, None, true)
    }

    fn possible(&mut self, fixed: &Wrenches, varying: &Wrenches) -> Equilibrium {
        self.share(fixed, Some(varying), true)
    }

    fn greatest(&mut self, fixed: &Wrenches, varying: &Wrenches, cap: f64) -> GreatestFactor {
        let loads = block_program::Loads { fixed: Some(fixed), varying, cap, strengths: true };
        let again = self.unsolved.take_if(|(known, _)| known == fixed).is_some_and(|(_, known)| known == *varying);
        let solved = if again { None } else { self.by_blocks(loads, |program| block_program::solve(program, false)) };
        let linear = again || solved.is_some();
        let solution = solved.and_then(|solved| solved.solution);
        if let Some(solution) = solution.filter(|solution| self.holds(fixed, varying, solution)) {
            return greatest_of(solution, varying);
        }
        let mut tried = Tried::default();
        let force = force_scale(self.problem, fixed, varying);
        let question = (fixed, varying, cap);
        self.attempt(question, force, &mut tried);
        // If only strengths limit the load, as in flat arches of strong stone, the load is of their size. In the
        // unit of the fixed loads its number would be too great for the interior point method.
        let weakest = weakest(self.problem);
        if tried.best.is_none() && weakest.is_finite() && weakest > force * SETTINGS.strong {
            self.attempt(question, weakest, &mut tried);
        }
        if !linear
            && tried.best.is_none()
            && let Some(greatest) = self.by_tangents(question, &tried)
        {
            return greatest;
        }
        if let Some((_, greatest)) = tried.best {
            return greatest;
        }
        // Unbounded or not solved: a ray decides. A pair without polish is the last resort.
        match self.share(varying, None, false) {
            Equilibrium::Field(ray) => GreatestFactor::Unbounded(ray),
            _ => tried.unsettled.unwrap_or(GreatestFactor::Failed(tried.failed)),
        }
    }

    fn greatest_if_carried(
        &mut self,
        fixed: &Wrenches,
        varying: &Wrenches,
        cap: f64,
    ) -> Option<(Vec<JointForce>, GreatestFactor)> {
        let loads = block_program::Loads { fixed: Some(fixed), varying, cap, strengths: true };
        let solved = self.by_blocks(loads, |program| block_program::solve(program, true))?;
        let stands = solved.stands.filter(|field| self.carries(fixed, field))?;
        let solution = solved.solution.filter(|solution| self.holds(fixed, varying, solution));
        match solution {
            Some(solution) => Some((stands, greatest_of(solution, varying))),
            None => {
                self.carried = Some((fixed.clone(), stands));
                self.unsolved = Some((fixed.clone(), varying.clone()));
                None
            }
        }
    }

    fn extreme(&mut self, loads: &Wrenches, joint: usize, form: [f64; 3]) -> Extreme {
        self.extreme_field(loads, joint, form).at(joint)
    }

    fn counters(&self) -> Counters {
        self.work.clone()
    }
}

/// Returns the greatest factor of a program that was solved by its blocks.
fn greatest_of(solution: Solution, varying: &Wrenches) -> GreatestFactor {
    let Solution { factor, capped, forces, motion, unique } = solution;
    if capped {
        return GreatestFactor::Capped(forces);
    }
    GreatestFactor::Collapse { factor, field: forces, motion: with_unit_power(varying, motion), unique: Some(unique) }
}
