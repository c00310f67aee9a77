//! The problem of limit analysis as sparse matrices, for solvers of linear programs.
//!
//! ```text
//! equilibrium   E r + w + λ p = 0        E: three rows for each group, moments divided by the length
//! strength      S r ≤ b                  r: N_0, N_1 and T of the joints [N]
//! ```

use super::force_variables::{ForceVariables, SparseRow};
use super::problem::{JointForce, LimitProblem, Velocity};
use super::scale::force_scale;
use crate::model::Wrenches;

/// The force of one column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ForceColumn {
    /// Index of the joint in the problem.
    pub joint: usize,
    /// 0 for N_0, 1 for N_1, 2 for T.
    pub component: usize,
}

/// Equilibrium and strengths of a problem as sparse matrices. Forces are in N, and moments are divided by
/// [`LimitMatrices::length`]. No entry of the matrices depends on the units of the loads.
#[derive(Debug, Clone)]
pub struct LimitMatrices {
    /// The forces in the order of the columns.
    pub columns: Vec<ForceColumn>,
    /// E: the rows (x, y, moment about the pole) of each group.
    pub equilibrium: Vec<SparseRow>,
    /// w: the fixed load in the rows of equilibrium \[N\].
    pub fixed: Vec<f64>,
    /// p: the load for λ = 1 in the rows of equilibrium \[N\].
    pub varying: Vec<f64>,
    /// S: the linear rows of strength.
    pub strength: Vec<SparseRow>,
    /// b \[N\].
    pub bounds: Vec<f64>,
    /// Index of the joint of each row of strength.
    pub joint_of_row: Vec<usize>,
    /// Length that divides moments \[m\].
    pub length: f64,
    /// Size of the fixed loads, or of the varying ones if there are no fixed loads \[N\]. Divide loads and bounds by it
    /// to solve a program in numbers of size one.
    pub force_unit: f64,
    /// The reason why the rows of strength are necessary only: `None` if they are exact.
    pub left_out: Option<&'static str>,
    variables: ForceVariables,
}

impl LimitProblem {
    /// Returns the problem as sparse matrices. Check [`LimitMatrices::left_out`] before you use the rows of strength.
    pub fn matrices(&self) -> LimitMatrices {
        let variables = ForceVariables::new(self);
        let mut columns = Vec::with_capacity(variables.count);
        let (mut strength, mut bounds, mut joint_of_row) = (Vec::new(), Vec::new(), Vec::new());
        for (index, (joint, &(first, own))) in self.joints.iter().zip(&variables.joints).enumerate() {
            columns.extend((0..own).map(|component| ForceColumn { joint: index, component }));
            for row in &joint.strength.rows {
                let taken = (0..own).filter(|&k| row.normal[k] != 0.0);
                let entries: SparseRow = taken.map(|k| (first + k, row.normal[k])).collect();
                if !entries.is_empty() {
                    strength.push(entries);
                    bounds.push(row.bound);
                    joint_of_row.push(index);
                }
            }
        }
        let mut matrices = LimitMatrices {
            columns,
            equilibrium: variables.equilibrium(self),
            fixed: Vec::new(),
            varying: Vec::new(),
            strength,
            bounds,
            joint_of_row,
            length: self.length,
            force_unit: force_scale(self, &self.fixed, &self.varying),
            left_out: self.beyond_rows(),
            variables,
        };
        matrices.fixed = matrices.loads(&self.fixed);
        matrices.varying = matrices.loads(&self.varying);
        matrices
    }

    /// Returns the reason why the linear rows of the joints are weaker than their strengths, or `None`.
    pub fn beyond_rows(&self) -> Option<&'static str> {
        if self.has_envelopes() {
            return Some("several facets of a joint law bound sliding in one sense: its strength is not linear");
        }
        let crushes = self.joints.iter().any(|joint| joint.strength.block.is_some());
        crushes.then_some("a joint can crush: its stress block is a cone, which is not linear")
    }
}

impl LimitMatrices {
    /// Returns wrenches of the groups about the pole as right-hand sides of the rows of equilibrium \[N\].
    pub fn loads(&self, wrenches: &Wrenches) -> Vec<f64> {
        wrenches.iter().flat_map(|w| [w[0], w[1], w[2] / self.length]).collect()
    }

    /// Returns the joint forces of a vector of forces \[N\].
    pub fn joint_forces(&self, r: &[f64]) -> Vec<JointForce> {
        self.variables.joint_forces(r, 1.0)
    }

    /// Returns the vector of joint forces \[N\]. A force without a column is left out.
    pub fn forces(&self, joints: &[JointForce]) -> Vec<f64> {
        let of = |column: &ForceColumn| {
            let force = &joints[column.joint];
            [force.normal[0], force.normal[1], force.shear][column.component]
        };
        self.columns.iter().map(of).collect()
    }

    /// Returns the velocities of the groups of the duals of the rows of equilibrium. The sign of the duals decides the
    /// sign of the motion: scale it with [`with_unit_power`](super::with_unit_power).
    pub fn motion(&self, duals: &[f64]) -> Vec<Velocity> {
        duals.chunks_exact(3).map(|y| [y[0], y[1], y[2] / self.length]).collect()
    }

    /// Returns the loads that the forces leave without balance at a factor, in the rows of equilibrium \[N\].
    pub fn unbalanced(&self, r: &[f64], factor: f64) -> Vec<f64> {
        let loads = self.fixed.iter().zip(&self.varying).map(|(w, p)| w + factor * p);
        let carried = |row: &SparseRow| row.iter().map(|&(k, e)| e * r[k]).sum::<f64>();
        self.equilibrium.iter().zip(loads).map(|(row, load)| carried(row) + load).collect()
    }
}
