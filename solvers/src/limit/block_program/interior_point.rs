//! A primal–dual interior point method with Mehrotra's predictor and corrector on the stiffness matrix of the bodies.
//!
//! To find if the fixed load can be carried, θ stays zero until a full step makes equilibrium exact. That point is
//! inside all bounds; it is the answer, and the search for the greatest θ continues from it.

use super::directions::Directions;
use super::polish::{polish, unpolished};
use super::program::Program;
use super::residuals::{Residuals, greatest};
use super::solution::Solution;
use super::state::{State, Step};
use super::wanted::Wanted;
use crate::limit::settings::SETTINGS;
use voussoir_core::limit::JointForce;

/// Greatest number of iterations.
const MAX_ITERATIONS: u64 = 250;
/// Greatest number of iterations until the fixed load is carried.
const MAX_ITERATIONS_OF_FIXED_LOAD: u64 = 25;
/// Step length relative to the distance to the nearest bound.
const SHARE_OF_DISTANCE_TO_BOUNDS: f64 = 0.995;
/// Greatest number of correctors of one direction, the step length that needs no corrector, and the least gain of one.
const MAX_CORRECTORS: usize = 4;
const LENGTH_WITHOUT_CORRECTOR: f64 = 0.9;
const LEAST_GAIN_OF_CORRECTOR: f64 = 0.005;
/// Target of a corrector: factor on the present step length, and addition to it.
const CORRECTOR_TARGET: [f64; 2] = [1.5, 0.1];
/// Ratio of the gap to the gap of the last polish, below which the next polish is tried.
const GAP_RATIO_OF_POLISHES: f64 = 1e-2;
/// Number of iterations after which the method stops if neither the gap nor the error of equilibrium was halved.
const MAX_IDLE_ITERATIONS: u32 = 12;

/// The result of a program, with the work done.
pub struct Solved {
    /// Forces inside all bounds in equilibrium with the fixed load, if requested and found.
    pub stands: Option<Vec<JointForce>>,
    /// The optimum, if found.
    pub solution: Option<Solution>,
    /// Iterations.
    pub iterations: u64,
    /// Factorisations.
    pub factorisations: u64,
    /// Corrections of polishes.
    pub corrections: u64,
}

/// Finds the greatest θ. With `held`, only if the fixed load is carried.
pub fn solve(program: &Program, held: bool) -> Solved {
    let mut solved = Solved { stands: None, solution: None, iterations: 0, factorisations: 0, corrections: 0 };
    let Some(directions) = Directions::new(program) else { return solved };
    let mut method = Method {
        program,
        directions,
        state: State::start(program, 1.0),
        residuals: Residuals::none(program),
        steps: [0, 1].map(|_| Step::none(program)),
        wanted: [0, 1].map(|_| Wanted::none(program.members.len())),
        iterations: 0,
        corrections: 0,
    };
    let carried = !held || method.carry_fixed().is_some();
    if held && carried {
        solved.stands = Some(program.joint_forces(&method.state.x));
    }
    if carried {
        solved.solution = method.greatest();
    }
    solved.iterations = method.iterations;
    solved.factorisations = method.directions.stiffness.factorisations;
    solved.corrections = method.corrections;
    solved
}

struct Method<'a> {
    program: &'a Program,
    directions: Directions<'a>,
    state: State,
    residuals: Residuals,
    /// The best step so far, a trial step, and their targets.
    steps: [Step; 2],
    wanted: [Wanted; 2],
    iterations: u64,
    corrections: u64,
}

impl Method<'_> {
    /// Iterates at θ = 0 until equilibrium is exact.
    fn carry_fixed(&mut self) -> Option<()> {
        let mean = self.state.gap() / self.products();
        for _ in 0..MAX_ITERATIONS_OF_FIXED_LOAD {
            self.residuals.update(self.program, &self.state);
            if self.residuals.greatest()[0] < SETTINGS.balanced && self.inside() {
                return Some(());
            }
            let Method { directions, state, residuals, steps: [step, _], wanted: [wanted, _], .. } = self;
            directions.factorise(state)?;
            wanted.all(state);
            wanted.but(state, mean);
            directions.towards(state, residuals, wanted, false, step);
            directions.refined(state, residuals, wanted, false, step);
            self.go();
        }
        None
    }

    fn products(&self) -> f64 {
        (self.program.rows + usize::from(self.program.cap.is_some())) as f64
    }

    /// Returns true if the forces themselves are inside all bounds.
    fn inside(&self) -> bool {
        (0..self.state.x.len()).all(|index| self.state.true_slacks(self.program, index).iter().all(|s| *s > 0.0))
    }

    fn greatest(&mut self) -> Option<Solution> {
        let mut best: Option<(f64, Solution)> = None;
        let mut nearest: Option<(f64, State)> = None;
        let (mut least, mut idle, mut polished) = ([f64::INFINITY; 2], 0, f64::INFINITY);
        for _ in 0..MAX_ITERATIONS {
            self.residuals.update(self.program, &self.state);
            let [statics, kinematics] = self.residuals.greatest();
            let gap = self.state.gap() / (1.0 + self.state.theta.abs());
            if !(gap.is_finite() && statics.is_finite() && kinematics.is_finite())
                || self.state.theta.abs() > SETTINGS.greatest_factor
            {
                break;
            }
            let missing = [gap, statics];
            let halved: [bool; 2] = std::array::from_fn(|i| missing[i] < 0.5 * least[i]);
            (0..2).filter(|i| halved[*i]).for_each(|i| least[i] = missing[i]);
            idle = if halved.contains(&true) { 0 } else { idle + 1 };
            let error = self.error(statics);
            // Below the required gap, only rounding errors of the motion remain.
            let last = nearest.as_ref().map_or(f64::INFINITY, |nearest| nearest.0);
            let done = error < SETTINGS.settled
                || (gap < SETTINGS.exhausted_gap && error < SETTINGS.admissible && error > 0.5 * last);
            if error < SETTINGS.admissible.min(last) {
                nearest = Some((error, self.state.clone()));
            }
            if statics.max(kinematics) < SETTINGS.unpolished
                && gap < SETTINGS.close_gap.min(GAP_RATIO_OF_POLISHES * polished)
                && self.clear()
            {
                polished = gap;
                self.polished(&mut best);
            }
            let settled = best.as_ref().is_some_and(|best| best.0 < SETTINGS.settled);
            if settled || done || idle > MAX_IDLE_ITERATIONS || self.improve().is_none() {
                break;
            }
        }
        if let Some((error, state)) = nearest
            && best.as_ref().is_none_or(|best| best.0 > SETTINGS.settled && error < best.0)
        {
            best = Some((error, unpolished(self.program, &state, &mut self.directions.stiffness)?));
        }
        best.filter(|best| best.0 < SETTINGS.admissible).map(|best| best.1)
    }

    /// Polishes the present state and keeps the result if it is better than the best so far.
    fn polished(&mut self, best: &mut Option<(f64, Solution)>) {
        let stiffness = &mut self.directions.stiffness;
        if let Some((error, solution)) = polish(self.program, &self.state, stiffness, &mut self.corrections)
            && best.as_ref().is_none_or(|best| error < best.0)
        {
            *best = Some((error, solution));
        }
    }

    /// Returns the error of the state itself: the gap in units of θ, the equilibrium error and the resistance.
    fn error(&self, statics: f64) -> f64 {
        let moved = greatest(self.residuals.flow.as_flattened());
        let largest = greatest(self.state.multipliers.as_flattened()).max(f64::MIN_POSITIVE);
        let gap = self.state.gap() / self.state.theta.abs().max(SETTINGS.least_factor);
        // A motion without work of the load proves nothing.
        if self.residuals.power.abs() > SETTINGS.unpolished {
            return f64::INFINITY;
        }
        // NaN counts as greatest.
        [statics, moved / largest].into_iter().fold(gap, |m, v| if v <= m { m } else { v })
    }

    /// Returns true if every row is clearly active or clearly inactive.
    fn clear(&self) -> bool {
        let rows = self.state.slacks.iter().flatten().zip(self.state.multipliers.iter().flatten());
        rows.filter(|(_, z)| **z > 0.0).all(|(s, z)| *z > SETTINGS.clear * s || *s > SETTINGS.clear * z)
    }

    /// Computes one predictor with its correctors.
    fn improve(&mut self) -> Option<()> {
        let products = self.products();
        let Method { directions, state, residuals, steps: [step, other], wanted: [wanted, centred], .. } = self;
        directions.factorise(state)?;
        wanted.all(state);
        directions.towards(state, residuals, wanted, true, step);
        let gap = state.gap();
        let share = (state.gap_after(step) / gap).powi(3).clamp(SETTINGS.moves, 1.0);
        let mean = share * gap / products;
        wanted.but(state, mean);
        wanted.and_second_order(step);
        directions.towards(state, residuals, wanted, true, step);
        for _ in 0..MAX_CORRECTORS {
            let lengths = step.longest;
            if lengths[0].min(lengths[1]) > LENGTH_WITHOUT_CORRECTOR {
                break;
            }
            let aim = lengths.map(|length| (CORRECTOR_TARGET[0] * length + CORRECTOR_TARGET[1]).min(1.0));
            centred.centre(wanted, state, step, aim, mean);
            directions.towards(state, residuals, centred, true, other);
            if other.longest[0] + other.longest[1] < lengths[0] + lengths[1] + LEAST_GAIN_OF_CORRECTOR {
                break;
            }
            std::mem::swap(wanted, centred);
            std::mem::swap(step, other);
        }
        directions.refined(state, residuals, wanted, true, step);
        self.go();
        Some(())
    }

    /// Moves along the step, up to a fixed share of the distance to the nearest bounds.
    fn go(&mut self) {
        let [step, _] = &self.steps;
        self.state.go(step, step.longest.map(|l| if l < 1.0 { SHARE_OF_DISTANCE_TO_BOUNDS * l } else { 1.0 }));
        self.iterations += 1;
    }
}
