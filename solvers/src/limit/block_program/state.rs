//! Iterates of the interior point method.

use super::cone::ROWS;
use super::program::Program;

/// A point of the method: forces and motions.
#[derive(Debug, Clone)]
pub struct State {
    /// Forces of each joint.
    pub x: Vec<[f64; 3]>,
    /// θ.
    pub theta: f64,
    /// b − A x of the rows of each joint, > 0; 1 for rows that a joint does not have.
    pub slacks: Vec<[f64; ROWS]>,
    /// Multipliers of rows, > 0; 0 for rows that a joint does not have.
    pub multipliers: Vec<[f64; ROWS]>,
    /// t − θ and its multiplier; 1 and 0 without a cap.
    pub cap: [f64; 2],
    /// Velocities: the multipliers of equilibrium.
    pub q: Vec<f64>,
}

/// A change of a state.
#[derive(Debug, Clone)]
pub struct Step {
    /// Change of x.
    pub x: Vec<[f64; 3]>,
    /// Change of θ.
    pub theta: f64,
    /// Changes of the slacks.
    pub slacks: Vec<[f64; ROWS]>,
    /// Changes of the multipliers.
    pub multipliers: Vec<[f64; ROWS]>,
    /// Changes of the cap's slack and multiplier.
    pub cap: [f64; 2],
    /// Change of q.
    pub q: Vec<f64>,
    /// The longest steps ≤ 1 that keep slacks and multipliers positive.
    pub longest: [f64; 2],
    /// Change of x in the coordinates of the roots: R times this, with R Rᵀ the flexibility of the joint. Its entries
    /// are of similar size even if flexibilities differ greatly.
    pub along: Vec<[f64; 3]>,
}

impl Step {
    /// Creates a zero step for a program.
    pub fn none(program: &Program) -> Self {
        let count = program.members.len();
        Step {
            x: vec![[0.0; 3]; count],
            theta: 0.0,
            slacks: vec![[0.0; ROWS]; count],
            multipliers: vec![[0.0; ROWS]; count],
            cap: [0.0; 2],
            q: vec![0.0; program.fixed.len()],
            longest: [1.0; 2],
            along: vec![[0.0; 3]; count],
        }
    }
}

impl State {
    /// Creates a state without forces and motion. Slacks and multipliers are `size`, or the bounds if they are greater.
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

    /// Returns Σ s z.
    pub fn gap(&self) -> f64 {
        let mut sums = [0.0; ROWS];
        for (s, z) in self.slacks.iter().zip(&self.multipliers) {
            (0..ROWS).for_each(|row| sums[row] += s[row] * z[row]);
        }
        sums.iter().sum::<f64>() + self.cap[0] * self.cap[1]
    }

    /// Returns Σ s z after the longest step that keeps all values positive.
    pub fn gap_after(&self, step: &Step) -> f64 {
        let [primal, dual] = step.longest;
        let ahead = |s: f64, ds: f64, z: f64, dz: f64| (s + primal * ds) * (z + dual * dz);
        let mut sums = [0.0; ROWS];
        let changes = step.slacks.iter().zip(&step.multipliers);
        for ((s, z), (ds, dz)) in self.slacks.iter().zip(&self.multipliers).zip(changes) {
            (0..ROWS).for_each(|row| sums[row] += ahead(s[row], ds[row], z[row], dz[row]));
        }
        sums.iter().sum::<f64>() + ahead(self.cap[0], step.cap[0], self.cap[1], step.cap[1])
    }

    /// Moves along a step, with one length for forces and one for motions.
    pub fn go(&mut self, step: &Step, [primal, dual]: [f64; 2]) {
        let add = |own: &mut [f64], change: &[f64], share: f64| {
            own.iter_mut().zip(change).for_each(|(own, change)| *own += share * change);
        };
        add(self.x.as_flattened_mut(), step.x.as_flattened(), primal);
        add(self.slacks.as_flattened_mut(), step.slacks.as_flattened(), primal);
        add(self.multipliers.as_flattened_mut(), step.multipliers.as_flattened(), dual);
        add(&mut self.q, &step.q, dual);
        self.theta += primal * step.theta;
        self.cap[0] += primal * step.cap[0];
        self.cap[1] += dual * step.cap[1];
    }

    /// Returns b − A x of the rows of a joint; 1 for rows that it does not have.
    #[inline(always)]
    pub fn true_slacks(&self, program: &Program, index: usize) -> [f64; ROWS] {
        let member = &program.members[index];
        let values = program.cones[member.cone].values(&self.x[index]);
        std::array::from_fn(|row| member.bounds[row] - values[row])
    }
}
