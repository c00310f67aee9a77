//! Directions of the interior point method at a state: one factorisation, several right-hand sides.

use super::cone::{ROWS, dot};
use super::program::Program;
use super::residuals::Residuals;
use super::state::{State, Step};
use super::stiffness::{Root, Stiffness};
use crate::linear::inner;

/// Added to each pivot, relative to it: far less than what the directions need.
const RELATIVE: f64 = 1e-14;
/// Least weight of a row. Where it is more than the row's own, forces change by more than the factors know, and the flow
/// misses that share of their change.
const SOFTEST: f64 = 1e-16;
/// Products s z after a step, in units of their mean, beyond which a corrector moves them; and how much it moves one
/// at the most.
const CENTRED: [f64; 2] = [0.1, 10.0];

/// What a direction takes off the products s z.
#[derive(Debug, Clone)]
pub struct Wanted {
    rows: Vec<[f64; ROWS]>,
    cap: f64,
}

impl Wanted {
    /// s z − `mean` of all rows and the cap, with the products of a predictor.
    pub fn new(state: &State, predictor: Option<&Step>, mean: f64) -> Self {
        let of = |(index, s): (usize, &[f64; ROWS])| {
            std::array::from_fn(|row| {
                let second = predictor.map_or(0.0, |step| step.slacks[index][row] * step.multipliers[index][row]);
                s[row] * state.multipliers[index][row] - mean + second
            })
        };
        let second = predictor.map_or(0.0, |step| step.cap[0] * step.cap[1]);
        let rows = state.slacks.iter().enumerate().map(of).collect();
        Wanted { rows, cap: state.cap[0] * state.cap[1] - mean + second }
    }

    /// The same where products that would be far from `mean` after steps of these lengths are moved towards it.
    pub fn centred(&self, program: &Program, state: &State, step: &Step, lengths: [f64; 2], mean: f64) -> Self {
        let off = |s: f64, ds: f64, z: f64, dz: f64| {
            let product = (s + lengths[0] * ds) * (z + lengths[1] * dz);
            (product.clamp(CENTRED[0] * mean, CENTRED[1] * mean) - product).max(-CENTRED[1] * mean)
        };
        let mut wanted = self.clone();
        for (index, member) in program.members.iter().enumerate() {
            for row in 0..member.rows {
                let (s, z) = (state.slacks[index][row], state.multipliers[index][row]);
                wanted.rows[index][row] -= off(s, step.slacks[index][row], z, step.multipliers[index][row]);
            }
        }
        if program.cap.is_some() {
            wanted.cap -= off(state.cap[0], step.cap[0], state.cap[1], step.cap[1]);
        }
        wanted
    }
}

/// The stiffness matrix at a state, factorised.
pub struct Directions<'a> {
    pub(super) program: &'a Program,
    /// The matrices of the program.
    pub stiffness: Stiffness,
    /// R of each joint's flexibility R Rᵀ, and A R.
    pub(super) roots: Vec<Root>,
    rows: Vec<[[f64; 3]; ROWS]>,
    /// The motion that the varying load causes; empty until it is asked for.
    pub(super) v: Vec<f64>,
}

impl<'a> Directions<'a> {
    /// Of a program. `None` where memory is short.
    pub fn new(program: &'a Program) -> Option<Self> {
        let (stiffness, count) = (Stiffness::new(program)?, program.members.len());
        let (roots, rows) = (vec![[[0.0; 3]; 3]; count], vec![[[0.0; 3]; ROWS]; count]);
        Some(Directions { program, stiffness, roots, rows, v: Vec::new() })
    }

    /// The flexibilities of a state, factorised.
    pub fn factorise(&mut self, state: &State) -> Option<()> {
        self.v.clear();
        for (index, member) in self.program.members.iter().enumerate() {
            let (s, z) = (&state.slacks[index], &state.multipliers[index]);
            let weights = std::array::from_fn(|row| (z[row] / s[row]).max(SOFTEST));
            (self.roots[index], self.rows[index]) = self.program.cones[member.cone].root(&weights);
        }
        self.stiffness.factorise(self.program, &self.roots, 0.0, RELATIVE).then_some(())
    }

    /// The direction in which all residuals and `wanted` vanish, with θ where it moves.
    pub fn towards(&mut self, state: &State, residuals: &Residuals, wanted: &Wanted, moves: bool) -> Step {
        let program = self.program;
        let mut step = Step::none(state.x.len());
        step.q = residuals.equilibrium.clone();
        for (index, member) in program.members.iter().enumerate() {
            let mut g: [f64; 3] = std::array::from_fn(|k| -residuals.flow[index][k]);
            for (row, normal) in program.cones[member.cone].normals.iter().enumerate() {
                let (s, z) = (state.slacks[index][row], state.multipliers[index][row]);
                let by = (wanted.rows[index][row] - z * residuals.slacks[index][row]) / s;
                (0..3).for_each(|k| g[k] += by * normal[k]);
            }
            let root = &self.roots[index];
            step.along[index] = along(root, &g);
            program.press(member, &flexed(root, &step.along[index]), &mut step.q);
        }
        if moves && self.v.is_empty() {
            step.q.extend_from_slice(&program.varying);
            self.stiffness.solve(&mut step.q);
            self.v = step.q.split_off(program.varying.len());
        } else {
            self.stiffness.solve(&mut step.q);
        }
        if moves {
            let stiff = cap_stiffness(program, state);
            let capped = program.cap.is_some();
            let right = -residuals.power + if capped { wanted.cap / state.cap[0] - stiff * residuals.cap } else { 0.0 };
            step.theta = (right - inner(&program.varying, &step.q)) / (inner(&program.varying, &self.v) + stiff);
            let theta = step.theta;
            step.q.iter_mut().zip(&self.v).for_each(|(dq, v)| *dq += theta * v);
        }
        let motion = std::mem::take(&mut step.q);
        self.follow(&motion, &mut step);
        step.q = motion;
        self.complete(state, residuals, wanted, &mut step);
        step
    }

    /// Takes off the forces what a change of velocities relieves.
    pub(super) fn follow(&self, motion: &[f64], step: &mut Step) {
        for (index, member) in self.program.members.iter().enumerate() {
            let root = &self.roots[index];
            let relieved = along(root, &self.program.jump(member, motion));
            (0..3).for_each(|k| step.along[index][k] -= relieved[k]);
            step.x[index] = flexed(root, &step.along[index]);
        }
    }

    /// The changes of slacks and multipliers that go with those of forces and θ.
    pub(super) fn complete(&self, state: &State, residuals: &Residuals, wanted: &Wanted, step: &mut Step) {
        let program = self.program;
        for (index, member) in program.members.iter().enumerate() {
            for row in 0..member.rows {
                let ds = -residuals.slacks[index][row] - dot(&self.rows[index][row], &step.along[index]);
                let (s, z) = (state.slacks[index][row], state.multipliers[index][row]);
                step.slacks[index][row] = ds;
                step.multipliers[index][row] = -(wanted.rows[index][row] + z * ds) / s;
            }
        }
        if program.cap.is_some() {
            step.cap[0] = -residuals.cap - step.theta;
            step.cap[1] = -(wanted.cap + state.cap[1] * step.cap[0]) / state.cap[0];
        }
    }
}

/// What the cap adds to the stiffness that θ feels.
pub(super) fn cap_stiffness(program: &Program, state: &State) -> f64 {
    if program.cap.is_some() { state.cap[1] / state.cap[0] } else { 0.0 }
}

/// Rᵀ g.
pub(super) fn along(root: &Root, g: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| root[0][c] * g[0] + root[1][c] * g[1] + root[2][c] * g[2])
}

/// R y.
fn flexed(root: &Root, y: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| dot(&root[k], y))
}
