//! Equilibrium of groups in scaled force variables of the joints: forces in units of F, moments in F × length.

use voussoir_core::law::StressBlock;
use voussoir_core::limit::{JointForce, LimitProblem};
use voussoir_core::model::Wrenches;

/// Entries of a row: (variable, coefficient).
pub type Row = Vec<(usize, f64)>;

/// The force variables of all joints: N_0, N_1, and T if it is not zero; only N_0 for the fill at a chord.
#[derive(Debug, Clone)]
pub struct ForceVariables {
    /// First variable of each joint, and its number of variables.
    pub joints: Vec<(usize, usize)>,
    /// Number of variables.
    pub count: usize,
}

impl ForceVariables {
    /// Creates the force variables of a problem.
    pub fn new(problem: &LimitProblem) -> Self {
        let mut count = 0;
        let joints = problem.joints.iter().map(|joint| {
            let (first, own) = (count, joint.components());
            count += own;
            (first, own)
        });
        ForceVariables { joints: joints.collect(), count }
    }

    /// Returns the rows of equilibrium, three for each group; moments are divided by the length.
    pub fn equilibrium(&self, problem: &LimitProblem) -> Vec<Row> {
        let mut rows = vec![Row::new(); 3 * problem.groups];
        for (joint, &(first, own)) in problem.joints.iter().zip(&self.joints) {
            let wrenches = joint.wrenches(problem.pole);
            for (group, sign) in [(joint.plus, 1.0), (joint.minus, -1.0)] {
                let Some(group) = group else { continue };
                for (k, wrench) in wrenches.iter().enumerate().take(own) {
                    for (i, scale) in [1.0, 1.0, 1.0 / problem.length].into_iter().enumerate() {
                        if wrench[i] != 0.0 {
                            rows[3 * group + i].push((first + k, sign * wrench[i] * scale));
                        }
                    }
                }
            }
        }
        rows
    }

    /// Returns the joint forces \[N\] of variables in units of `force`.
    pub fn joint_forces(&self, x: &[f64], force: f64) -> Vec<JointForce> {
        let of = |&(first, own): &(usize, usize)| {
            let component = |k: usize| if k < own { x[first + k] * force } else { 0.0 };
            JointForce { normal: [component(0), component(1)], shear: component(2) }
        };
        self.joints.iter().map(of).collect()
    }
}

/// Returns the greatest error of a field relative to the loads: unbalanced force or violated strength.
pub fn field_error(problem: &LimitProblem, loads: &Wrenches, forces: &[JointForce]) -> f64 {
    field_violation(problem, loads, forces) / problem.magnitude(loads).max(f64::MIN_POSITIVE)
}

/// Returns the greatest error of a field \[N\].
pub fn field_violation(problem: &LimitProblem, loads: &Wrenches, forces: &[JointForce]) -> f64 {
    let (mut left, mut worst) = (loads.clone(), 0.0f64);
    for (joint, force) in problem.joints.iter().zip(forces) {
        let components = [force.normal[0], force.normal[1], force.shear];
        for (group, sign) in [(joint.plus, 1.0), (joint.minus, -1.0)] {
            let Some(group) = group else { continue };
            for (wrench, component) in joint.wrenches(problem.pole).iter().zip(components) {
                (0..3).for_each(|i| left[group][i] += sign * wrench[i] * component);
            }
        }
        for row in &joint.strength.rows {
            let reached: f64 = row.normal.iter().zip(components).map(|(normal, component)| normal * component).sum();
            worst = worst.max(reached - row.bound);
        }
        if let Some(block) = joint.strength.block {
            worst = worst.max(excess(block, force));
        }
    }
    let unbalanced = left.iter().map(|w| w[0].abs().max(w[1].abs()).max(w[2].abs() / problem.length));
    unbalanced.fold(worst, f64::max)
}

/// Returns the violation of the stress block of a joint \[N\], at the end with less compression.
pub fn excess(block: StressBlock, force: &JointForce) -> f64 {
    let pressed = force.normal[0] + force.normal[1] + block.tension;
    pressed / block.total * pressed - (2.0 * force.normal[0].min(force.normal[1]) + block.tension)
}
