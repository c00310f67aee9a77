//! The program of one optimisation in scaled, sparse form.

use voussoir_core::law::StressBlock;
use voussoir_core::limit::{ForceVariables, JointForce, LimitJoint, LimitProblem, SparseRow, Velocity};
use voussoir_core::model::Wrenches;

/// A joint's stress block as a constraint φ = u²/F − w ≤ 0, u = N_0 + N_1 + F_t, w = 2 N_end + F_t.
#[derive(Debug, Clone)]
pub struct Block {
    /// Variables of N_0, N_1.
    pub normal: [usize; 2],
    /// Index of the end.
    pub end: usize,
    /// Scaled strengths.
    pub strength: StressBlock,
}

impl Block {
    /// Returns (u, w) at x.
    pub fn state(&self, x: &[f64]) -> (f64, f64) {
        let u = x[self.normal[0]] + x[self.normal[1]] + self.strength.tension;
        (u, 2.0 * x[self.normal[self.end]] + self.strength.tension)
    }

    /// Returns φ at x.
    pub fn value(&self, x: &[f64]) -> f64 {
        let (u, w) = self.state(x);
        u * u / self.strength.total - w
    }

    /// Returns ∇φ at x.
    pub fn gradient(&self, x: &[f64]) -> SparseRow {
        let slope = 2.0 * self.state(x).0 / self.strength.total;
        (0..2).map(|i| (self.normal[i], slope - if i == self.end { 2.0 } else { 0.0 })).collect()
    }
}

/// Maximise x_θ subject to `equations` x = `right`, `rows` x ≤ `bounds` and blocks.
pub struct System {
    /// Number of variables.
    pub variables: usize,
    /// Index of θ, the last variable.
    pub theta: usize,
    /// Equations of equilibrium, three per group.
    pub equations: Vec<SparseRow>,
    /// Right-hand sides of the equations.
    pub right: Vec<f64>,
    /// Linear rows.
    pub rows: Vec<SparseRow>,
    /// Bounds of the rows.
    pub bounds: Vec<f64>,
    /// Index of the row θ ≤ cap, if any.
    pub cap: Option<usize>,
    /// Stress blocks of crushing joints.
    pub blocks: Vec<Block>,
    forces: ForceVariables,
    force: f64,
    length: f64,
}

/// The loads and bounds of a system.
#[derive(Clone, Copy)]
pub struct Loads<'a> {
    /// Loads with factor one.
    pub constant: Option<&'a Wrenches>,
    /// Loads multiplied by θ, and the load factor for θ = 1.
    pub varying: (&'a Wrenches, f64),
    /// Loads multiplied by a free variable, and the load factor for its unit.
    pub free: Option<(&'a Wrenches, f64)>,
    /// Upper bound of θ in its unit.
    pub cap: Option<f64>,
    /// True with strengths; false for the recession cone.
    pub strengths: bool,
    /// Force scale \[N\].
    pub force: f64,
}

/// Adds the rows and stress blocks of one joint, whose first variable and number of variables are given.
fn strength_rows(
    joint: &LimitJoint,
    (first, own): (usize, usize),
    loads: &Loads,
    (rows, bounds, blocks): (&mut Vec<SparseRow>, &mut Vec<f64>, &mut Vec<Block>),
) {
    for row in &joint.strength.rows {
        let bound = if loads.strengths { row.bound / loads.force } else { 0.0 };
        // Bounds of the fill may be much greater than the loads: their rows are scaled to size one.
        let scale = if joint.fill.is_some() { 1.0 / bound.max(1.0) } else { 1.0 };
        let entries: SparseRow =
            (0..own).filter(|&k| row.normal[k] != 0.0).map(|k| (first + k, row.normal[k] * scale)).collect();
        if !entries.is_empty() {
            rows.push(entries);
            bounds.push(bound * scale);
        }
    }
    match joint.strength.block {
        Some(block) if loads.strengths => {
            let strength = StressBlock { tension: block.tension / loads.force, total: block.total / loads.force };
            blocks.extend((0..2).map(|end| Block { normal: [first, first + 1], end, strength }));
        }
        Some(_) => {
            // A bounded normal force is zero in the recession cone.
            for (k, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
                rows.push(vec![(first + k, sign)]);
                bounds.push(0.0);
            }
        }
        None => {}
    }
}

impl System {
    /// Builds the scaled system.
    pub fn new(problem: &LimitProblem, loads: &Loads) -> Self {
        let forces = ForceVariables::new(problem);
        let mut variables = forces.count;
        let free = loads.free.map(|f| {
            variables += 1;
            (variables - 1, f)
        });
        let theta = variables;
        variables += 1;
        let (force, length) = (loads.force, problem.length);
        let scale = [1.0, 1.0, 1.0 / length];
        let mut equations = forces.equilibrium(problem);
        let mut right = vec![0.0; 3 * problem.groups];
        let (mut rows, mut bounds, mut blocks) = (Vec::new(), Vec::new(), Vec::new());
        for (joint, &own) in problem.joints.iter().zip(&forces.joints) {
            strength_rows(joint, own, loads, (&mut rows, &mut bounds, &mut blocks));
        }
        for group in 0..problem.groups {
            for i in 0..3 {
                let index = 3 * group + i;
                if let Some(constant) = loads.constant {
                    right[index] = -constant[group][i] * scale[i] / force;
                }
                let mut add = |variable: usize, (wrenches, unit): (&Wrenches, f64)| {
                    let value = wrenches[group][i] * scale[i] * unit / force;
                    if value != 0.0 {
                        equations[index].push((variable, value));
                    }
                };
                add(theta, loads.varying);
                if let Some((variable, load)) = free {
                    add(variable, load);
                }
            }
        }
        let cap = loads.cap.map(|cap| {
            rows.push(vec![(theta, 1.0)]);
            bounds.push(cap);
            rows.len() - 1
        });
        System { variables, theta, equations, right, rows, bounds, cap, blocks, forces, force, length }
    }

    /// Makes θ the value of a form over (N_0, N_1, T) of a joint. The loads must not vary with θ.
    pub fn aim_at(&mut self, joint: usize, form: [f64; 3]) {
        let (first, own) = self.forces.joints[joint];
        let mut row: SparseRow = (0..own).filter(|&k| form[k] != 0.0).map(|k| (first + k, form[k])).collect();
        row.push((self.theta, -1.0));
        self.equations.push(row);
        self.right.push(0.0);
    }

    /// Sets the normal force of a joint to one unit of force.
    pub fn press(&mut self, joint: usize) {
        let (first, _) = self.forces.joints[joint];
        self.equations.push(vec![(first, 1.0), (first + 1, 1.0)]);
        self.right.push(1.0);
    }

    /// Returns the joint forces \[N\].
    pub fn forces(&self, x: &[f64]) -> Vec<JointForce> {
        self.forces.joint_forces(x, self.force)
    }

    /// Returns the velocities about the pole from the multipliers of equilibrium, up to a common factor.
    pub fn motion(&self, multipliers: &[f64]) -> Vec<Velocity> {
        multipliers.chunks(3).map(|q| [q[0], q[1], q[2] / self.length]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The gradient of φ is its difference quotient; φ = 0 if the stress block fills the compressed part.
    #[test]
    fn the_gradient_of_a_block_is_its_slope() {
        for end in [0, 1] {
            let block = Block { normal: [1, 2], end, strength: StressBlock { tension: 0.1, total: 5.0 } };
            let x = [9.0, 0.7, 1.1];
            for (j, slope) in block.gradient(&x) {
                let at = |by: f64| {
                    let mut moved = x;
                    moved[j] += by;
                    block.value(&moved)
                };
                assert!(((at(1e-5) - at(-1e-5)) / 2e-5 - slope).abs() < 1e-9);
            }
            let mut crushed = [0.0; 3];
            let (u, least) = (2.0f64, (2.0 * 2.0 / 5.0 - 0.1) / 2.0);
            crushed[block.normal[end]] = least;
            crushed[block.normal[1 - end]] = u - 0.1 - least;
            assert!(block.value(&crushed).abs() < 1e-14 && (block.state(&crushed).0 - u).abs() < 1e-14);
        }
    }
}
