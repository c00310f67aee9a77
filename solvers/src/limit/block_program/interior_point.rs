//! A primal–dual interior point method with Mehrotra's predictor and corrector on the bodies' stiffness matrix.
//!
//! Can the fixed load be carried? The steps hold θ at zero until one of full length makes equilibrium exact: that
//! point, inside all bounds, is the answer, and the search for the greatest θ goes on from it.

use super::cone::ROWS;
use super::directions::{Directions, Wanted};
use super::polish::{polish, unpolished};
use super::program::Program;
use super::residuals::Residuals;
use super::solution::Solution;
use super::state::{State, Step};
use voussoir_core::limit::JointForce;

/// Iterations at the most.
const MOST: u64 = 250;
/// Iterations until a fixed load should be carried.
const MOST_HELD: u64 = 25;
/// Gap from which a polish is tried where every row is far nearer to its bound than to no multiplier, or the reverse.
const CLOSE: f64 = 1e-5;
/// Ratio of a multiplier to its slack, or the reverse, that is clear.
const CLEAR: f64 = 1e2;
/// Residuals above which there is nothing to polish.
const OFF: f64 = 1e-4;
/// Error of an answer that is rounding, and the greatest that counts where nothing less is reached.
const SETTLED: [f64; 2] = [2e-13, 1e-11];
/// Share of the way to the nearest bound.
const SHORT: f64 = 0.995;
/// Correctors of one direction at the most, the step that needs none, and the least gain of one.
const CORRECTORS: usize = 4;
const LONG: f64 = 0.9;
const GAIN: f64 = 0.005;
/// What a corrector aims at: so many times the present step, and so much more.
const BEYOND: [f64; 2] = [1.5, 0.1];
/// Share of the gap of a polish at which the next is tried.
const SOONEST: f64 = 1e-2;
/// Gap below which nothing is to be gained.
const ROUNDING: f64 = 5e-14;
/// Iterations in which neither the gap nor what equilibrium misses was halved, after which nothing is hoped for.
const IDLE: u32 = 12;
/// Factor in its unit below which it is as good as zero.
const LEAST: f64 = 1e-6;
/// Factor in its unit beyond which there may be no bound.
const FAR: f64 = 1e7;

/// What a program came to, with the work done.
pub struct Solved {
    /// Forces inside all bounds in equilibrium with the fixed load, where they were asked for and found.
    pub stands: Option<Vec<JointForce>>,
    /// The optimum, where it was found.
    pub solution: Option<Solution>,
    /// Iterations.
    pub iterations: u64,
    /// Factorisations.
    pub factorisations: u64,
    /// Corrections of polishes.
    pub corrections: u64,
}

/// Forces in equilibrium with the fixed load, inside all bounds, if the method finds them.
pub fn stands(program: &Program) -> Solved {
    run(program, true, false)
}

/// The greatest θ. With `held`, only if the fixed load is carried.
pub fn solve(program: &Program, held: bool) -> Solved {
    run(program, held, true)
}

fn run(program: &Program, held: bool, greatest: bool) -> Solved {
    let mut solved = Solved { stands: None, solution: None, iterations: 0, factorisations: 0, corrections: 0 };
    let Some(directions) = Directions::new(program) else { return solved };
    let state = State::start(program, 1.0);
    let mut method = Method { program, directions, state, iterations: 0, corrections: 0 };
    let carried = !held || method.carry_fixed().is_some();
    if held && carried {
        solved.stands = Some(program.joint_forces(&method.state.x));
    }
    if carried && greatest {
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
    iterations: u64,
    corrections: u64,
}

impl Method<'_> {
    /// Steps at θ = 0 until equilibrium is exact.
    fn carry_fixed(&mut self) -> Option<()> {
        let mean = self.state.gap() / self.products();
        for _ in 0..MOST_HELD {
            let residuals = Residuals::new(self.program, &self.state);
            if residuals.greatest()[0] < 1e-12 && self.inside() {
                return Some(());
            }
            self.directions.factorise(&self.state)?;
            let wanted = Wanted::new(&self.state, None, mean);
            let mut step = self.directions.towards(&self.state, &residuals, &wanted, false);
            self.directions.refined(&self.state, &residuals, &wanted, false, &mut step);
            let longest = self.state.longest(self.program, &step);
            let lengths = longest.map(|l| if l < 1.0 { SHORT * l } else { 1.0 });
            self.state.go(&step, lengths);
            self.iterations += 1;
        }
        None
    }

    fn products(&self) -> f64 {
        (self.program.rows + usize::from(self.program.cap.is_some())) as f64
    }

    /// Whether the forces themselves lie inside all bounds.
    fn inside(&self) -> bool {
        (0..self.state.x.len()).all(|index| self.state.true_slacks(self.program, index).iter().all(|s| *s > 0.0))
    }

    fn greatest(&mut self) -> Option<Solution> {
        let mut best: Option<(f64, Solution)> = None;
        let mut nearest: Option<(f64, State)> = None;
        let (mut least, mut idle, mut polished) = ([f64::INFINITY; 2], 0, f64::INFINITY);
        for _ in 0..MOST {
            let residuals = Residuals::new(self.program, &self.state);
            let [statics, kinematics] = residuals.greatest();
            let gap = self.state.gap() / (1.0 + self.state.theta.abs());
            if !(gap.is_finite() && statics.is_finite() && kinematics.is_finite()) || self.state.theta.abs() > FAR {
                break;
            }
            let missing = [gap, statics];
            let halved: [bool; 2] = std::array::from_fn(|i| missing[i] < 0.5 * least[i]);
            (0..2).filter(|i| halved[*i]).for_each(|i| least[i] = missing[i]);
            idle = if halved.contains(&true) { 0 } else { idle + 1 };
            let error = self.error(statics, &residuals);
            // Below the gap that is asked for, rounding of the motion is all that is left.
            let last = nearest.as_ref().map_or(f64::INFINITY, |nearest| nearest.0);
            let done = error < SETTLED[0] || (gap < ROUNDING && error < SETTLED[1] && error > 0.5 * last);
            if error < SETTLED[1].min(last) {
                nearest = Some((error, self.state.clone()));
            }
            if statics.max(kinematics) < OFF && gap < CLOSE.min(SOONEST * polished) && self.clear() {
                polished = gap;
                self.polished(&mut best);
            }
            let settled = best.as_ref().is_some_and(|best| best.0 < SETTLED[0]);
            if settled || done || idle > IDLE || self.improve(&residuals).is_none() {
                break;
            }
        }
        if let Some((error, state)) = nearest
            && best.as_ref().is_none_or(|best| best.0 > SETTLED[0] && error < best.0)
        {
            best = Some((error, unpolished(self.program, &state, &mut self.directions.stiffness)?));
        }
        best.filter(|best| best.0 < SETTLED[1]).map(|best| best.1)
    }

    /// Polishes the present state, for what is better than the best so far.
    fn polished(&mut self, best: &mut Option<(f64, Solution)>) {
        let stiffness = &mut self.directions.stiffness;
        if let Some((error, solution)) = polish(self.program, &self.state, stiffness, &mut self.corrections)
            && best.as_ref().is_none_or(|best| error < best.0)
        {
            *best = Some((error, solution));
        }
    }

    /// How far the state itself is from an optimum: the gap in units of θ, what equilibrium misses and what joints resist.
    fn error(&self, statics: f64, residuals: &Residuals) -> f64 {
        let moved = residuals.flow.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
        let largest = self.state.multipliers.iter().flatten().fold(f64::MIN_POSITIVE, |m, z| m.max(*z));
        let gap = self.state.gap() / self.state.theta.abs().max(LEAST);
        // Without a motion on which the load does work nothing is proved.
        if residuals.power.abs() > OFF {
            return f64::INFINITY;
        }
        // NaN counts as greatest.
        [statics, moved / largest].into_iter().fold(gap, |m, v| if v <= m { m } else { v })
    }

    /// Whether it is clear of every row if it carries.
    fn clear(&self) -> bool {
        let rows = self.state.slacks.iter().flatten().zip(self.state.multipliers.iter().flatten());
        rows.filter(|(_, z)| **z > 0.0).all(|(s, z)| *z > CLEAR * s || *s > CLEAR * z)
    }

    /// One predictor, with correctors.
    fn improve(&mut self, residuals: &Residuals) -> Option<()> {
        let (program, state, directions) = (self.program, &self.state, &mut self.directions);
        directions.factorise(state)?;
        let predictor = directions.towards(state, residuals, &Wanted::new(state, None, 0.0), true);
        let longest = state.longest(program, &predictor);
        let gap = state.gap();
        let share = (gap_along(state, &predictor, longest) / gap).powi(3).clamp(1e-8, 1.0);
        let products = program.rows + usize::from(program.cap.is_some());
        let mean = share * gap / products as f64;
        let mut wanted = Wanted::new(state, Some(&predictor), mean);
        let mut step = directions.towards(state, residuals, &wanted, true);
        let mut lengths = state.longest(program, &step);
        for _ in 0..CORRECTORS {
            if lengths[0].min(lengths[1]) > LONG {
                break;
            }
            let aim = lengths.map(|length| (BEYOND[0] * length + BEYOND[1]).min(1.0));
            let other = wanted.centred(program, state, &step, aim, mean);
            let corrected = directions.towards(state, residuals, &other, true);
            let longer = state.longest(program, &corrected);
            if longer[0] + longer[1] < lengths[0] + lengths[1] + GAIN {
                break;
            }
            (wanted, step, lengths) = (other, corrected, longer);
        }
        directions.refined(state, residuals, &wanted, true, &mut step);
        let lengths = state.longest(program, &step).map(|l| if l < 1.0 { SHORT * l } else { 1.0 });
        self.state.go(&step, lengths);
        self.iterations += 1;
        Some(())
    }
}

/// Σ s z after a step.
fn gap_along(state: &State, step: &Step, [primal, dual]: [f64; 2]) -> f64 {
    let ahead = |s: f64, ds: f64, z: f64, dz: f64| (s + primal * ds) * (z + dual * dz);
    let mut sum = ahead(state.cap[0], step.cap[0], state.cap[1], step.cap[1]);
    for index in 0..state.x.len() {
        for row in 0..ROWS {
            let (s, z) = (state.slacks[index][row], state.multipliers[index][row]);
            sum += ahead(s, step.slacks[index][row], z, step.multipliers[index][row]);
        }
    }
    sum
}
