//! What is left of the conditions of an optimum.

use super::cone::ROWS;
use super::program::Program;
use super::state::State;
use crate::linear::inner;

/// Residuals of a state.
pub struct Residuals {
    /// E x + θ p + w.
    pub equilibrium: Vec<f64>,
    /// A x + s − b.
    pub slacks: Vec<[f64; ROWS]>,
    /// Eᵀ q + Aᵀ z.
    pub flow: Vec<[f64; 3]>,
    /// p·q + z_cap − 1.
    pub power: f64,
    /// θ + s_cap − t.
    pub cap: f64,
}

/// E x + θ p + w.
pub fn imbalance(program: &Program, x: &[[f64; 3]], theta: f64) -> Vec<f64> {
    let mut sum: Vec<f64> = program.fixed.iter().zip(&program.varying).map(|(w, p)| w + theta * p).collect();
    program.members.iter().zip(x).for_each(|(member, x)| program.press(member, x, &mut sum));
    sum
}

impl Residuals {
    /// Of a state.
    pub fn new(program: &Program, state: &State) -> Self {
        let count = program.members.len();
        let (mut slacks, mut flow) = (vec![[0.0; ROWS]; count], vec![[0.0; 3]; count]);
        for (index, member) in program.members.iter().enumerate() {
            let real = state.true_slacks(program, index);
            flow[index] = program.jump(member, &state.q);
            for (row, normal) in program.cones[member.cone].normals.iter().enumerate() {
                slacks[index][row] = state.slacks[index][row] - real[row];
                let z = state.multipliers[index][row];
                (0..3).for_each(|k| flow[index][k] += normal[k] * z);
            }
        }
        Residuals {
            equilibrium: imbalance(program, &state.x, state.theta),
            slacks,
            flow,
            power: inner(&program.varying, &state.q) + state.cap[1] - 1.0,
            cap: program.cap.map_or(0.0, |cap| state.theta + state.cap[0] - cap),
        }
    }

    /// Greatest residual of statics and of kinematics.
    pub fn greatest(&self) -> [f64; 2] {
        // NaN counts as greatest.
        let worse = |m: f64, v: f64| if v.abs() <= m { m } else { v.abs() };
        let over = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, worse);
        let statics = over(&mut self.equilibrium.iter().chain(self.slacks.iter().flatten()).copied());
        let kinematics = over(&mut self.flow.iter().flatten().copied());
        [statics.max(self.cap.abs()), kinematics.max(self.power.abs())]
    }
}
