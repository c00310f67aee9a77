//! Residuals of the optimality conditions.

use super::cone::ROWS;
use super::program::Program;
use super::state::State;
use crate::linear::inner;
use voussoir_core::linear::vectors::Simd;
use voussoir_core::with_vectors;

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

/// Returns E x + θ p + w.
pub fn imbalance(program: &Program, x: &[[f64; 3]], theta: f64) -> Vec<f64> {
    let mut sum: Vec<f64> = program.fixed.iter().zip(&program.varying).map(|(w, p)| w + theta * p).collect();
    program.members.iter().zip(x).for_each(|(member, x)| program.press(member, x, &mut sum));
    sum
}

/// Returns the greatest absolute value; NaN if a value is NaN.
pub fn greatest(values: &[f64]) -> f64 {
    let worse = |m: f64, v: f64| if m >= v || m.is_nan() { m } else { v };
    let (lanes, rest) = values.as_chunks::<8>();
    let mut worst = [0.0f64; 8];
    for lane in lanes {
        (0..8).for_each(|i| worst[i] = worse(worst[i], lane[i].abs()));
    }
    worst.into_iter().chain(rest.iter().map(|v| v.abs())).fold(0.0, worse)
}

impl Residuals {
    /// Creates zero residuals.
    pub fn none(program: &Program) -> Self {
        let count = program.members.len();
        Residuals {
            equilibrium: vec![0.0; program.fixed.len()],
            slacks: vec![[0.0; ROWS]; count],
            flow: vec![[0.0; 3]; count],
            power: 0.0,
            cap: 0.0,
        }
    }

    /// Computes the residuals of a state.
    pub fn update(&mut self, program: &Program, state: &State) {
        let own = &mut *self;
        with_vectors!('a, of_joints(own: &'a mut Residuals, program: &'a Program, state: &'a State) -> ());
        self.power = inner(&program.varying, &state.q) + state.cap[1] - 1.0;
        self.cap = program.cap.map_or(0.0, |cap| state.theta + state.cap[0] - cap);
    }

    /// Returns the greatest residuals of statics and of kinematics.
    pub fn greatest(&self) -> [f64; 2] {
        let statics = [greatest(&self.equilibrium), greatest(self.slacks.as_flattened()), self.cap];
        [greatest(&statics), greatest(&[greatest(self.flow.as_flattened()), self.power])]
    }
}

#[inline(always)]
fn of_joints<S: Simd>(_: S, own: &mut Residuals, program: &Program, state: &State) {
    for (sum, (w, p)) in own.equilibrium.iter_mut().zip(program.fixed.iter().zip(&program.varying)) {
        *sum = w + state.theta * p;
    }
    for (index, member) in program.members.iter().enumerate() {
        let cone = &program.cones[member.cone];
        program.press(member, &state.x[index], &mut own.equilibrium);
        let (values, slacks) = (cone.values(&state.x[index]), &state.slacks[index]);
        own.slacks[index] = std::array::from_fn(|row| values[row] + slacks[row] - member.bounds[row]);
        let (jump, carried) = (program.jump(member, &state.q), cone.weighted(&state.multipliers[index]));
        own.flow[index] = std::array::from_fn(|k| jump[k] + carried[k]);
    }
}
