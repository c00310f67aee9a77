//! Fields and mechanisms to rounding from the known yielding and moving rows.

use super::nearest::nearest;
use super::systems::Systems;
use voussoir_core::limit::{JointForce, LimitProblem, SparseRow, Velocity, with_unit_power};

impl Systems {
    /// Returns the force variables and θ nearest to `start` in equilibrium with these pairs on their yield surface, and
    /// the greatest residual or violation of any pair.
    pub fn field(&self, yielding: &[usize], start: Vec<f64>) -> Option<(Vec<f64>, f64)> {
        self.nearest_field(yielding.iter().map(|&i| (i, 0.0)), start)
    }

    /// Returns the force variables and θ in equilibrium with these slacks s_i, and the greatest residual or violation.
    pub fn field_with(&self, slacks: &[f64]) -> Option<(Vec<f64>, f64)> {
        self.nearest_field(slacks.iter().copied().enumerate(), vec![0.0; self.forces + 1])
    }

    /// Returns the field nearest to `start` with these slacks of some pairs, and its greatest residual or violation.
    fn nearest_field(&self, slacks: impl Iterator<Item = (usize, f64)>, start: Vec<f64>) -> Option<(Vec<f64>, f64)> {
        let mut rows: Vec<SparseRow> = self.equilibrium.clone();
        rows.iter_mut().zip(&self.varying).for_each(|(row, &p)| row.push((self.forces, p)));
        let mut right: Vec<f64> = self.fixed.iter().map(|w| -w).collect();
        for (i, slack) in slacks {
            rows.push(self.pairs[i].normal.clone());
            right.push(self.pairs[i].bound - slack);
        }
        let (z, error) = nearest(&rows, &right, start)?;
        let violation = (0..self.pairs.len()).map(|i| -self.slack(i, &z)).fold(error, f64::max);
        Some((z, violation))
    }

    /// Returns s_i at force variables.
    pub fn slack(&self, pair: usize, z: &[f64]) -> f64 {
        let pair = &self.pairs[pair];
        pair.bound - pair.normal.iter().map(|&(j, v)| v * z[j]).sum::<f64>()
    }

    /// Returns the motion with multipliers nearest to γ_i of the pairs `moving`, scaled to p·q̇ = 1, and the greatest
    /// residual or violation of γ ≥ 0, relative to the greatest multiplier.
    pub fn motion(&self, problem: &LimitProblem, moving: &[(usize, f64)]) -> Option<(Vec<Velocity>, f64)> {
        let bodies = self.equilibrium.len();
        let mut rows: Vec<SparseRow> = vec![Vec::new(); self.forces + 1];
        for (i, entries) in self.equilibrium.iter().enumerate() {
            entries.iter().for_each(|&(j, v)| rows[j].push((i, v)));
            if self.varying[i] != 0.0 {
                rows[self.forces].push((i, self.varying[i]));
            }
        }
        for (k, &(i, _)) in moving.iter().enumerate() {
            self.pairs[i].flow.iter().for_each(|&(j, v)| rows[j].push((bodies + k, v)));
        }
        let mut right = vec![0.0; self.forces + 1];
        right[self.forces] = 1.0;
        let mut start = vec![0.0; bodies];
        start.extend(moving.iter().map(|m| m.1));
        let greatest = start.iter().fold(f64::MIN_POSITIVE, |m, g| m.max(g.abs()));
        let (z, error) = nearest(&rows, &right, start)?;
        let violation = z[bodies..].iter().map(|g| -g).fold(error, f64::max);
        let motion = z[..bodies].chunks(3).map(|q| [q[0], q[1], q[2] / self.length]).collect();
        Some((with_unit_power(&problem.varying, motion), violation / greatest))
    }

    /// Returns the joint forces \[N\] of force variables.
    pub fn joint_forces(&self, z: &[f64]) -> Vec<JointForce> {
        self.variables.joint_forces(z, self.force)
    }

    /// Returns the force variables of joint forces \[N\].
    pub fn force_variables(&self, forces: &[JointForce]) -> Vec<f64> {
        let mut z = Vec::with_capacity(self.forces + 1);
        for (force, &(_, own)) in forces.iter().zip(&self.variables.joints) {
            let components = [force.normal[0], force.normal[1], force.shear];
            z.extend(components.iter().take(own).map(|n| n / self.force));
        }
        z
    }

    /// Returns the multipliers of a motion with the pairs' own flow: slip gives the multipliers of sliding, the rest of
    /// the opening gives the multipliers of opening.
    pub fn multipliers(&self, problem: &LimitProblem, motion: &[Velocity]) -> Vec<f64> {
        let mut jumps = vec![0.0; self.forces];
        for (group, q) in motion.iter().enumerate().take(problem.groups) {
            for (i, q) in [q[0], q[1], q[2] * self.length].into_iter().enumerate() {
                self.equilibrium[3 * group + i].iter().for_each(|&(j, v)| jumps[j] += v * q);
            }
        }
        let mut gamma = vec![0.0; self.pairs.len()];
        for slides in [true, false] {
            for (i, pair) in self.pairs.iter().enumerate().filter(|(_, pair)| pair.slides() == slides) {
                let Some(&(j, v)) = pair.flow.last() else { continue };
                gamma[i] = (-jumps[j] / v).max(0.0);
                if slides {
                    pair.flow.iter().for_each(|&(j, v)| jumps[j] += v * gamma[i]);
                }
            }
        }
        gamma
    }
}
