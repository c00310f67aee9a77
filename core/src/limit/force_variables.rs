//! The force variables of a problem, and the rows of equilibrium in them.

use super::problem::{JointForce, LimitProblem};

/// Entries of a row: (variable, coefficient).
pub type SparseRow = Vec<(usize, f64)>;

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
    pub fn equilibrium(&self, problem: &LimitProblem) -> Vec<SparseRow> {
        let mut rows = vec![SparseRow::new(); 3 * problem.groups];
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
