//! Search directions of the interior point method at a state: one factorisation, several right-hand sides.
//!
//! Steps, residuals and the wanted changes of the products are allocated once and overwritten in each iteration.
//! Divisions by slacks and multipliers use inverses, which are computed once a state.

use super::cone::{ROWS, combination, dot};
use super::program::Program;
use super::residuals::Residuals;
use super::state::{State, Step};
use super::stiffness::{Root, Stiffness};
use super::wanted::Wanted;
use crate::limit::settings::SETTINGS;
use crate::linear::inner;
use voussoir_core::linear::vectors::Simd;
use voussoir_core::with_vectors;

/// The linear response of a joint to motions at a state.
#[derive(Debug, Clone, Default)]
pub(super) struct Response {
    /// R of the flexibility R Rᵀ.
    root: Root,
    /// A R, by columns.
    rows: [[f64; ROWS]; 3],
    /// Inverse slacks.
    slacks: [f64; ROWS],
    /// Inverse multipliers; 0 for rows that the joint does not have.
    multipliers: [f64; ROWS],
}

/// The stiffness matrix at a state, factorised.
pub struct Directions<'a> {
    pub(super) program: &'a Program,
    /// The matrices of the program.
    pub stiffness: Stiffness,
    pub(super) responses: Vec<Response>,
    /// The motion caused by the varying load; empty until it is needed.
    pub(super) v: Vec<f64>,
}

impl<'a> Directions<'a> {
    /// Creates directions for a program. `None` if the pattern cannot be analysed.
    pub fn new(program: &'a Program) -> Option<Self> {
        let responses = vec![Response::default(); program.members.len()];
        Some(Directions { program, stiffness: Stiffness::new(program)?, responses, v: Vec::new() })
    }

    /// Factorises the stiffness at a state.
    pub fn factorise(&mut self, state: &State) -> Option<()> {
        self.v.clear();
        let (program, responses) = (self.program, self.responses.as_mut_slice());
        with_vectors!('a, respond(program: &'a Program, state: &'a State, responses: &'a mut [Response]) -> ());
        let roots = self.responses.iter().map(|response| &response.root);
        self.stiffness.factorise(self.program, roots, 0.0, SETTINGS.pivot).then_some(())
    }

    /// Computes the direction that makes all residuals and `wanted` vanish; θ changes if `moves`.
    pub fn towards(&mut self, state: &State, residuals: &Residuals, wanted: &Wanted, moves: bool, step: &mut Step) {
        let program = self.program;
        self.loads(state, residuals, wanted, step);
        if moves && self.v.is_empty() {
            step.q.extend_from_slice(&program.varying);
            self.stiffness.solve(&mut step.q);
            self.v.extend(step.q.drain(program.varying.len()..));
        } else {
            self.stiffness.solve(&mut step.q);
        }
        step.theta = 0.0;
        if moves {
            let stiff = cap_stiffness(program, state);
            let capped = program.cap.is_some();
            let right = -residuals.power + if capped { wanted.cap / state.cap[0] - stiff * residuals.cap } else { 0.0 };
            let theta = (right - inner(&program.varying, &step.q)) / (inner(&program.varying, &self.v) + stiff);
            step.theta = theta;
            step.q.iter_mut().zip(&self.v).for_each(|(dq, v)| *dq += theta * v);
        }
        let motion = std::mem::take(&mut step.q);
        self.follow(&motion, step);
        step.q = motion;
        self.complete(state, residuals, wanted, step);
    }

    /// Stores the forces of joints without a motion as `along`, and the remaining error of equilibrium as `q`.
    fn loads(&self, state: &State, residuals: &Residuals, wanted: &Wanted, step: &mut Step) {
        let all = (self, state, residuals, wanted);
        type All<'a> = (&'a Directions<'a>, &'a State, &'a Residuals, &'a Wanted);
        with_vectors!('a, load(all: All<'a>, step: &'a mut Step) -> ());
    }

    /// Subtracts from the forces the part that a change of velocities relieves.
    pub(super) fn follow(&self, motion: &[f64], step: &mut Step) {
        let (program, responses) = (self.program, self.responses.as_slice());
        with_vectors!('a, relieve(program: &'a Program, responses: &'a [Response], motion: &'a [f64], step: &'a mut Step) -> ());
    }

    /// Computes the changes of slacks and multipliers from the changes of forces and θ, and the greatest step length.
    pub(super) fn complete(&self, state: &State, residuals: &Residuals, wanted: &Wanted, step: &mut Step) {
        let all = (self, state, residuals, wanted);
        type All<'a> = (&'a Directions<'a>, &'a State, &'a Residuals, &'a Wanted);
        let mut worst = with_vectors!('a, follow_rows(all: All<'a>, step: &'a mut Step) -> [f64; 2]);
        if self.program.cap.is_some() {
            step.cap[0] = -residuals.cap - step.theta;
            step.cap[1] = -(wanted.cap + state.cap[1] * step.cap[0]) / state.cap[0];
            (0..2).for_each(|i| worst[i] = worst[i].max(-step.cap[i] / state.cap[i]));
        }
        step.longest = worst.map(|worst| if worst > 1.0 { 1.0 / worst } else { 1.0 });
    }

    /// Returns twice the energy of a change of velocities in the joints.
    pub(super) fn resisted(&self, motion: &[f64]) -> f64 {
        let energy = |(member, response): (_, &Response)| {
            let y = along(&response.root, &self.program.jump(member, motion));
            dot(&y, &y)
        };
        self.program.members.iter().zip(&self.responses).map(energy).sum()
    }
}

#[inline(always)]
fn respond<S: Simd>(_: S, program: &Program, state: &State, responses: &mut [Response]) {
    let joints = program.members.iter().zip(state.slacks.iter().zip(&state.multipliers));
    for (response, (member, (s, z))) in responses.iter_mut().zip(joints) {
        response.slacks = s.map(|s| 1.0 / s);
        response.multipliers = z.map(|z| if z > 0.0 { 1.0 / z } else { 0.0 });
        let weights = std::array::from_fn(|row| (z[row] * response.slacks[row]).max(SETTINGS.exhausted));
        (response.root, response.rows) = program.cones[member.cone].root(&weights);
    }
}

#[inline(always)]
fn load<S: Simd>(
    _: S,
    (directions, state, residuals, wanted): (&Directions, &State, &Residuals, &Wanted),
    step: &mut Step,
) {
    let program = directions.program;
    step.q.copy_from_slice(&residuals.equilibrium);
    let joints = program.members.iter().zip(&directions.responses);
    let of_rows = wanted.rows.iter().zip(&residuals.slacks).zip(&state.multipliers);
    let all = joints.zip(of_rows).zip(residuals.flow.iter().zip(&mut step.along));
    for (((member, response), ((wanted, missed), z)), (flow, own)) in all {
        let by = std::array::from_fn(|row| (wanted[row] - z[row] * missed[row]) * response.slacks[row]);
        let pushed = program.cones[member.cone].weighted(&by);
        *own = along(&response.root, &std::array::from_fn(|k| pushed[k] - flow[k]));
        program.press(member, &flexed(&response.root, own), &mut step.q);
    }
}

#[inline(always)]
fn relieve<S: Simd>(_: S, program: &Program, responses: &[Response], motion: &[f64], step: &mut Step) {
    let joints = program.members.iter().zip(responses);
    for ((member, response), (own, x)) in joints.zip(step.along.iter_mut().zip(&mut step.x)) {
        let relieved = along(&response.root, &program.jump(member, motion));
        (0..3).for_each(|k| own[k] -= relieved[k]);
        *x = flexed(&response.root, own);
    }
}

/// Returns the greatest relative decrease of slacks and of multipliers in a full step.
#[inline(always)]
fn follow_rows<S: Simd>(
    _: S,
    (directions, state, residuals, wanted): (&Directions, &State, &Residuals, &Wanted),
    step: &mut Step,
) -> [f64; 2] {
    let mut worst = [[0.0f64; ROWS]; 2];
    let of_rows = wanted.rows.iter().zip(&residuals.slacks).zip(&state.multipliers);
    let changes = step.slacks.iter_mut().zip(&mut step.multipliers).zip(&step.along);
    for ((response, ((wanted, missed), z)), ((ds, dz), along)) in directions.responses.iter().zip(of_rows).zip(changes)
    {
        let carried = combination(&response.rows, along);
        *ds = std::array::from_fn(|row| -missed[row] - carried[row]);
        *dz = std::array::from_fn(|row| -(wanted[row] + z[row] * ds[row]) * response.slacks[row]);
        for row in 0..ROWS {
            let shares = [-ds[row] * response.slacks[row], -dz[row] * response.multipliers[row]];
            (0..2).for_each(|i| worst[i][row] = if shares[i] > worst[i][row] { shares[i] } else { worst[i][row] });
        }
    }
    worst.map(|worst| worst.into_iter().fold(0.0, f64::max))
}

/// Returns the contribution of the cap to the stiffness of θ.
pub(super) fn cap_stiffness(program: &Program, state: &State) -> f64 {
    if program.cap.is_some() { state.cap[1] / state.cap[0] } else { 0.0 }
}

/// Rᵀ g.
#[inline(always)]
fn along(root: &Root, g: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| root[0][c] * g[0] + root[1][c] * g[1] + root[2][c] * g[2])
}

/// R y.
#[inline(always)]
fn flexed(root: &Root, y: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| dot(&root[k], y))
}
