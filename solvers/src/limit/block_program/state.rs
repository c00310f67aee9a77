//! Iterates of the interior point method.

use super::cone::{ROWS, dot};
use super::program::Program;

/// A point in forces and motions.
#[derive(Debug, Clone)]
pub struct State {
    /// Forces of each joint.
    pub x: Vec<[f64; 3]>,
    /// θ.
    pub theta: f64,
    /// b − A x of the rows of each joint, > 0; of rows that a joint does not have 1.
    pub slacks: Vec<[f64; ROWS]>,
    /// Multipliers of rows, > 0; of rows that a joint does not have 0.
    pub multipliers: Vec<[f64; ROWS]>,
    /// t − θ and its multiplier; 1 and 0 without a cap.
    pub cap: [f64; 2],
    /// Velocities: the multipliers of equilibrium.
    pub q: Vec<f64>,
}

/// A change of a state.
#[derive(Debug, Clone)]
pub struct Step {
    /// Of x.
    pub x: Vec<[f64; 3]>,
    /// Of θ.
    pub theta: f64,
    /// Of the slacks.
    pub slacks: Vec<[f64; ROWS]>,
    /// Of the multipliers.
    pub multipliers: Vec<[f64; ROWS]>,
    /// Of the cap's slack and multiplier.
    pub cap: [f64; 2],
    /// Of q.
    pub q: Vec<f64>,
    /// Of x as R of each joint's flexibility R Rᵀ times these: of size one however far flexibilities differ.
    pub along: Vec<[f64; 3]>,
}

impl Step {
    /// No change of a program of so many joints; of velocities nothing at all.
    pub fn none(count: usize) -> Self {
        Step {
            x: vec![[0.0; 3]; count],
            theta: 0.0,
            slacks: vec![[0.0; ROWS]; count],
            multipliers: vec![[0.0; ROWS]; count],
            cap: [0.0; 2],
            q: Vec::new(),
            along: vec![[0.0; 3]; count],
        }
    }
}

impl State {
    /// No forces, no motion; slacks and multipliers at `size` or, where bounds are greater, theirs.
    pub fn start(program: &Program, size: f64) -> Self {
        let count = program.members.len();
        let (mut slacks, mut multipliers) = (vec![[1.0; ROWS]; count], vec![[0.0; ROWS]; count]);
        for ((member, s), z) in program.members.iter().zip(&mut slacks).zip(&mut multipliers) {
            for row in 0..member.rows {
                s[row] = member.bounds[row].max(size);
                z[row] = size * size / s[row];
            }
        }
        let cap = program.cap.map_or([1.0, 0.0], |cap| [cap.max(size), size * size / cap.max(size)]);
        State { x: vec![[0.0; 3]; count], theta: 0.0, slacks, multipliers, cap, q: vec![0.0; program.fixed.len()] }
    }

    /// Σ s z.
    pub fn gap(&self) -> f64 {
        let joints = self.slacks.iter().zip(&self.multipliers);
        joints.map(|(s, z)| (0..ROWS).map(|row| s[row] * z[row]).sum::<f64>()).sum::<f64>() + self.cap[0] * self.cap[1]
    }

    /// The longest steps ≤ 1 in slacks and in multipliers that keep both positive.
    pub fn longest(&self, program: &Program, step: &Step) -> [f64; 2] {
        // −min(ds/s): no branch.
        let mut worst = [0.0f64; 2];
        for (index, member) in program.members.iter().enumerate() {
            for row in 0..member.rows {
                worst[0] = worst[0].max(-step.slacks[index][row] / self.slacks[index][row]);
                worst[1] = worst[1].max(-step.multipliers[index][row] / self.multipliers[index][row]);
            }
        }
        if program.cap.is_some() {
            (0..2).for_each(|i| worst[i] = worst[i].max(-step.cap[i] / self.cap[i]));
        }
        worst.map(|worst| if worst > 1.0 { 1.0 / worst } else { 1.0 })
    }

    /// Goes along a step, by one share in forces and by another in motions.
    pub fn go(&mut self, step: &Step, [primal, dual]: [f64; 2]) {
        for index in 0..self.x.len() {
            (0..3).for_each(|k| self.x[index][k] += primal * step.x[index][k]);
            for row in 0..ROWS {
                self.slacks[index][row] += primal * step.slacks[index][row];
                self.multipliers[index][row] += dual * step.multipliers[index][row];
            }
        }
        self.theta += primal * step.theta;
        self.cap[0] += primal * step.cap[0];
        self.cap[1] += dual * step.cap[1];
        self.q.iter_mut().zip(&step.q).for_each(|(q, dq)| *q += dual * dq);
    }

    /// b − A x of the rows of a joint.
    pub fn true_slacks(&self, program: &Program, index: usize) -> [f64; ROWS] {
        let member = &program.members[index];
        let mut slacks = [1.0; ROWS];
        for (row, normal) in program.cones[member.cone].normals.iter().enumerate() {
            slacks[row] = member.bounds[row] - dot(normal, &self.x[index]);
        }
        slacks
    }
}
