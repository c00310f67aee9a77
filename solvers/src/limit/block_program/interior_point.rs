//! A primal–dual interior point method with Mehrotra's predictor and corrector on the bodies' stiffness matrix.
//!
//! Can the fixed load be carried? The steps hold θ at zero until one of full length makes equilibrium exact: that
//! point, inside all bounds, is the answer, and the search for the greatest θ goes on from it.

use super::cone::{ROWS, dot};
use super::polish::polish;
use super::program::Program;
use super::residuals::Residuals;
use super::solution::Solution;
use super::state::{State, Step};
use super::stiffness::{Root, Stiffness};
use crate::linear::inner;
use voussoir_core::limit::JointForce;

/// Iterations at the most, of either search.
const MOST: u64 = 60;
/// Iterations until a fixed load should be carried.
const MOST_HELD: u64 = 25;
/// Gap from which a polish is tried where every row is far nearer to its bound than to no multiplier, or the reverse;
/// and from which it is tried in any case.
const CLOSE: [f64; 2] = [1e-5, 1e-9];
/// Ratio of a multiplier to its slack, or the reverse, that is clear.
const CLEAR: f64 = 1e2;
/// Residuals above which there is nothing to polish.
const OFF: f64 = 1e-4;
/// Error of a polish that is rounding, and the greatest that counts where nothing less is reached.
const SETTLED: [f64; 2] = [2e-13, 1e-11];
/// Share of the way to the nearest bound.
const SHORT: f64 = 0.995;
/// Added to each pivot, relative to it: far less than what the directions need.
const RELATIVE: f64 = 1e-14;
/// Least weight of a row, so that stiff joints are not beyond what soft ones can be told from.
const SOFTEST: f64 = 1e-10;
/// Refinements of a direction at the most, and the share of the gap that its equilibrium may miss.
const REFINEMENTS: usize = 2;
const REFINED: f64 = 1e-4;
/// Polishes tried.
const POLISHES: usize = 3;
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
    let Some(stiffness) = Stiffness::new(program) else { return solved };
    let state = State::start(program, 1.0);
    let roots = vec![[[0.0; 3]; 3]; program.members.len()];
    let mut method = Method { program, stiffness, state, roots, iterations: 0, corrections: 0 };
    let carried = !held || method.carry_fixed().is_some();
    if held && carried {
        solved.stands = Some(program.joint_forces(&method.state.x));
    }
    if carried && greatest {
        solved.solution = method.greatest();
    }
    solved.iterations = method.iterations;
    solved.factorisations = method.stiffness.factorisations;
    solved.corrections = method.corrections;
    solved
}

struct Method<'a> {
    program: &'a Program,
    stiffness: Stiffness,
    state: State,
    roots: Vec<Root>,
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
            self.factorise()?;
            let wanted = self.complementarity(None, mean);
            let step = self.direction(&residuals, &wanted, None, true);
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
        let mut least = f64::INFINITY;
        let (mut without_gain, mut polishes) = (0, 0);
        for _ in 0..MOST {
            let residuals = Residuals::new(self.program, &self.state);
            let [statics, kinematics] = residuals.greatest();
            let gap = self.state.gap() / (1.0 + self.state.theta.abs());
            if !(gap.is_finite() && statics.is_finite() && kinematics.is_finite()) || self.state.theta.abs() > FAR {
                break;
            }
            if gap < 0.5 * least {
                (least, without_gain) = (gap, 0);
            } else {
                without_gain += 1;
            }
            if statics.max(kinematics) < OFF && (gap < CLOSE[1] || (gap < CLOSE[0] && self.clear())) {
                polishes += 1;
                if let Some((error, solution)) =
                    polish(self.program, &self.state, &mut self.stiffness, &mut self.corrections)
                    && best.as_ref().is_none_or(|best| error < best.0)
                {
                    best = Some((error, solution));
                }
                if polishes == POLISHES || best.as_ref().is_some_and(|best| best.0 < SETTLED[0]) {
                    break;
                }
            }
            if without_gain > 8 || self.improve(&residuals).is_none() {
                break;
            }
        }
        best.filter(|best| best.0 < SETTLED[1]).map(|best| best.1)
    }

    /// Whether it is clear of every row if it carries.
    fn clear(&self) -> bool {
        let rows = self.state.slacks.iter().flatten().zip(self.state.multipliers.iter().flatten());
        rows.filter(|(_, z)| **z > 0.0).all(|(s, z)| *z > CLEAR * s || *s > CLEAR * z)
    }

    /// One predictor and corrector.
    fn improve(&mut self, residuals: &Residuals) -> Option<()> {
        self.factorise()?;
        let wanted = self.complementarity(None, 0.0);
        let mut v = Vec::new();
        let predictor = self.direction(residuals, &wanted, Some(&mut v), false);
        let longest = self.state.longest(self.program, &predictor);
        let gap = self.state.gap();
        let ahead = self.gap_along(&predictor, longest);
        let share = (ahead / gap).powi(3).clamp(1e-8, 1.0);
        let wanted = self.complementarity(Some(&predictor), share * gap / self.products());
        let step = self.direction(residuals, &wanted, Some(&mut v), true);
        let lengths = self.state.longest(self.program, &step).map(|l| if l < 1.0 { SHORT * l } else { 1.0 });
        self.state.go(&step, lengths);
        self.iterations += 1;
        Some(())
    }

    /// Σ s z after a step.
    fn gap_along(&self, step: &Step, [primal, dual]: [f64; 2]) -> f64 {
        let state = &self.state;
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

    /// The flexibilities of the present state, factorised.
    fn factorise(&mut self) -> Option<()> {
        for (index, member) in self.program.members.iter().enumerate() {
            let (s, z) = (&self.state.slacks[index], &self.state.multipliers[index]);
            let weights = std::array::from_fn(|row| (z[row] / s[row]).max(SOFTEST));
            self.roots[index] = self.program.cones[member.cone].root(&weights);
        }
        self.stiffness.factorise(self.program, &self.roots, 0.0, RELATIVE).then_some(())
    }

    /// s z − `mean` of all rows and the cap, with the products of a predictor.
    fn complementarity(&self, predictor: Option<&Step>, mean: f64) -> (Vec<[f64; ROWS]>, f64) {
        let state = &self.state;
        let of = |(index, s): (usize, &[f64; ROWS])| {
            std::array::from_fn(|row| {
                let second = predictor.map_or(0.0, |step| step.slacks[index][row] * step.multipliers[index][row]);
                s[row] * state.multipliers[index][row] - mean + second
            })
        };
        let second = predictor.map_or(0.0, |step| step.cap[0] * step.cap[1]);
        (state.slacks.iter().enumerate().map(of).collect(), state.cap[0] * state.cap[1] - mean + second)
    }

    /// The direction in which all residuals and `wanted` vanish. θ moves where `v`, the motion that the varying load
    /// causes, is given; it is computed where it is empty.
    fn direction(
        &mut self,
        residuals: &Residuals,
        wanted: &(Vec<[f64; ROWS]>, f64),
        mut v: Option<&mut Vec<f64>>,
        refine: bool,
    ) -> Step {
        let (program, state) = (self.program, &self.state);
        let count = state.x.len();
        let mut pull = vec![[0.0; 3]; count];
        let mut dq = residuals.equilibrium.clone();
        for (index, member) in program.members.iter().enumerate() {
            let mut g: [f64; 3] = std::array::from_fn(|k| -residuals.flow[index][k]);
            for (row, normal) in program.cones[member.cone].normals.iter().enumerate() {
                let (s, z) = (state.slacks[index][row], state.multipliers[index][row]);
                let by = (wanted.0[index][row] - z * residuals.slacks[index][row]) / s;
                (0..3).for_each(|k| g[k] += by * normal[k]);
            }
            program.press(member, &flexed(&self.roots[index], &g), &mut dq);
            pull[index] = g;
        }
        let mut theta = 0.0;
        let capped = program.cap.is_some();
        if let Some(v) = v.as_mut() {
            if v.is_empty() {
                let mut both = dq;
                both.extend_from_slice(&program.varying);
                self.stiffness.solve(&mut both);
                **v = both.split_off(program.varying.len());
                dq = both;
            } else {
                self.stiffness.solve(&mut dq);
            }
            let stiff = if capped { state.cap[1] / state.cap[0] } else { 0.0 };
            let right = -residuals.power + if capped { wanted.1 / state.cap[0] - stiff * residuals.cap } else { 0.0 };
            theta = (right - inner(&program.varying, &dq)) / (inner(&program.varying, v) + stiff);
            dq.iter_mut().zip(v.iter()).for_each(|(dq, v)| *dq += theta * v);
        } else {
            self.stiffness.solve(&mut dq);
        }
        let mut changes = vec![[0.0; 3]; count];
        let aim = REFINED * self.state.gap();
        let mut last = f64::INFINITY;
        for round in 0..=REFINEMENTS {
            let mut left: Vec<f64> =
                residuals.equilibrium.iter().zip(&program.varying).map(|(r, p)| r + theta * p).collect();
            for (index, member) in program.members.iter().enumerate() {
                let jump = program.jump(member, &dq);
                changes[index] = flexed(&self.roots[index], &std::array::from_fn(|k| pull[index][k] - jump[k]));
                program.press(member, &changes[index], &mut left);
            }
            let error = left.iter().fold(0.0f64, |m, r| m.max(r.abs()));
            if round == REFINEMENTS || error < aim || error > 0.5 * last || !refine {
                break;
            }
            last = error;
            self.stiffness.solve(&mut left);
            if let Some(v) = v.as_ref() {
                let stiff = if capped { self.state.cap[1] / self.state.cap[0] } else { 0.0 };
                let change = -inner(&program.varying, &left) / (inner(&program.varying, v) + stiff);
                theta += change;
                left.iter_mut().zip(v.iter()).for_each(|(c, v)| *c += change * v);
            }
            dq.iter_mut().zip(&left).for_each(|(q, c)| *q += c);
        }
        self.completed(residuals, wanted, Step { x: changes, theta, q: dq, ..State::none(count) })
    }

    /// A step in forces, θ and velocities with those of slacks and multipliers that go with it.
    fn completed(&self, residuals: &Residuals, wanted: &(Vec<[f64; ROWS]>, f64), mut step: Step) -> Step {
        let (program, state) = (self.program, &self.state);
        for (index, member) in program.members.iter().enumerate() {
            for (row, normal) in program.cones[member.cone].normals.iter().enumerate() {
                let ds = -residuals.slacks[index][row] - dot(normal, &step.x[index]);
                let (s, z) = (state.slacks[index][row], state.multipliers[index][row]);
                step.slacks[index][row] = ds;
                step.multipliers[index][row] = -(wanted.0[index][row] + z * ds) / s;
            }
        }
        if program.cap.is_some() {
            step.cap[0] = -residuals.cap - step.theta;
            step.cap[1] = -(wanted.1 + state.cap[1] * step.cap[0]) / state.cap[0];
        }
        step
    }
}

/// R Rᵀ g.
pub fn flexed(root: &Root, g: &[f64; 3]) -> [f64; 3] {
    let along: [f64; 3] = std::array::from_fn(|c| root[0][c] * g[0] + root[1][c] * g[1] + root[2][c] * g[2]);
    std::array::from_fn(|k| dot(&root[k], &along))
}
