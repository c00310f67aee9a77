//! The programs of a sequence, solved by the simplex method from the basis of the previous program.
//!
//! The programs differ only in the bounds of rows: fictitious cohesion changes with the normal forces. An optimal basis
//! stays dual feasible, and a few pivots of the dual simplex method lead to the next vertex.

use crate::limit::settings::SETTINGS;
use crate::limit::systems::{LARGEST, PIVOTS, Systems, greatest_shares};
use crate::optimise::dense_simplex::{Dictionary, Feasibility};
use voussoir_core::limit::{Counters, GreatestFactor, JointForce, LimitJoint, LimitProblem};

/// Programs with associated rows that differ in their bounds.
pub struct Vertices {
    statics: Dictionary,
    /// The rows of the present program; non-associated rows have their flow as normal.
    systems: Systems,
    /// Contribution of a unit of each slack to the weighted sum of fictitious cohesion.
    weights: Vec<(usize, f64)>,
}

impl Vertices {
    /// Creates the programs with the bounds of the laws. `None` if the scene is too large or a joint crushes.
    pub fn new(problem: &LimitProblem, systems: &Systems) -> Option<Self> {
        if systems.entries() > LARGEST || problem.joints.iter().any(|joint| joint.strength.block.is_some()) {
            return None;
        }
        let mut systems = systems.clone();
        systems.pairs.iter_mut().for_each(|pair| pair.normal.clone_from(&pair.flow));
        let weights = cohesion_weights(problem, &systems);
        Some(Vertices { statics: systems.statics(None)?, systems, weights })
    }

    /// Returns the greatest factor with fictitious cohesion d·r ≤ b + (d − a)·r̄, at a vertex of its fields; rows of
    /// `own` have the laws' flow. `None` if rounding makes the result unusable.
    pub fn greatest(
        &mut self,
        problem: &LimitProblem,
        own: &Systems,
        reference: &[JointForce],
        counters: &mut Counters,
    ) -> Option<GreatestFactor> {
        let z = own.force_variables(reference);
        let along = |row: &[(usize, f64)]| -> f64 { row.iter().map(|&(j, v)| v * z[j]).sum() };
        let mut moved = Vec::new();
        for (i, (pair, law)) in self.systems.pairs.iter_mut().zip(&own.pairs).enumerate() {
            if law.non_associated() {
                let bound = law.bound + (along(&law.flow) - along(&law.normal)).max(0.0);
                moved.push((i, bound - pair.bound));
                pair.bound = bound;
            }
        }
        self.statics.relax(&moved);
        let before = self.statics.pivots;
        let greatest = self.vertex(problem);
        *counters.entry("pivots".into()).or_default() += self.statics.pivots - before;
        greatest
    }

    fn vertex(&mut self, problem: &LimitProblem) -> Option<GreatestFactor> {
        let (statics, systems) = (&mut self.statics, &self.systems);
        if statics.feasible() != Feasibility::Point {
            return None;
        }
        let primary = [(systems.theta(), -1.0)];
        let (_, true) = statics.minimise(&primary, PIVOTS)? else { return None };
        let gamma: Vec<f64> = (0..systems.pairs.len()).map(|i| statics.reduced_cost(i).max(0.0)).collect();
        least_cohesion(statics, &gamma, &self.weights);
        let moving: Vec<(usize, f64)> = greatest_shares(&gamma).into_iter().map(|i| (i, gamma[i])).collect();
        // Restores the costs of the factor; the next program starts from them.
        statics.minimise(&primary, 0);
        let zero: Vec<usize> = (0..systems.pairs.len()).filter(|&i| statics.at_zero(i)).collect();
        let (z, violation) = systems.field(&zero, vec![0.0; systems.forces + 1])?;
        let (motion, wrong) = systems.motion(problem, &moving)?;
        (violation <= SETTINGS.balanced && wrong <= SETTINGS.admissible).then(|| GreatestFactor::Collapse {
            factor: z[systems.forces] * systems.unit,
            field: systems.joint_forces(&z),
            motion,
            unique: None,
        })
    }
}

/// Moves from a vertex with the greatest factor to the one whose normal forces give the least cohesion in the next
/// program. If many fields exist, the result then does not depend on the numbering of joints.
fn least_cohesion(statics: &mut Dictionary, gamma: &[f64], weights: &[(usize, f64)]) {
    let costly: Vec<usize> = (0..gamma.len()).filter(|&i| gamma[i] > SETTINGS.active).collect();
    costly.iter().for_each(|&i| statics.fix(i, true));
    statics.minimise(weights, PIVOTS);
    costly.iter().for_each(|&i| statics.fix(i, false));
}

/// Returns (d − a)·r of all non-associated rows as weights of the slacks of openings, s_k = b_k + N_k. Joints far from
/// the middle of the scene have greater weights: with equal weights the field would not be unique.
fn cohesion_weights(problem: &LimitProblem, systems: &Systems) -> Vec<(usize, f64)> {
    let far = |joint: &LimitJoint| (joint.ends[0] + joint.ends[1] - 2.0 * problem.pole).norm();
    let mean = problem.joints.iter().map(far).sum::<f64>() / problem.joints.len() as f64;
    let mut weights = vec![0.0; systems.pairs.len()];
    for pair in systems.pairs.iter().filter(|pair| pair.relief > 0.0) {
        let weight = if mean > 0.0 { 1.0 + far(&problem.joints[pair.joint]) / mean } else { 1.0 };
        pair.openings.iter().for_each(|&k| weights[k] += pair.relief * weight);
    }
    weights.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0).collect()
}
