//! Contact points with laws of tractions from gaps: the law recomputed from recorded states, motions
//! that leave its forces alone, and whether the points stand close enough for its fracture energy.

use super::problem::PathProblem;
use super::state::PathState;
use crate::law::{PlaneElasticity, TractionPoint};
use crate::model::Assembly;

/// Contact points over the length of a cohesive zone below which a joint counts as coarse (Turon,
/// Dávila, Camanho & Costa 2007, Engng Fract. Mech. 74: three elements and more).
const POINTS_IN_ZONE: f64 = 3.0;

/// A joint whose contact points stand too far apart for the fracture energy of its law.
#[derive(Debug, Clone, PartialEq)]
pub struct SoftensOver {
    /// Index of the joint.
    pub joint: usize,
    /// ℓ = E G_I / f_t² with E/(1 − ν²) in plane strain \[m\] (Hillerborg, Modéer & Petersson 1976).
    pub length: f64,
    /// Greatest distance between two contact points \[m\].
    pub spacing: f64,
}

/// Joints between elastic blocks of which the contact points stand farther apart than a third of the
/// characteristic length of their law: the path then has a peak and a snap-back for every point.
pub fn coarse_joints(problem: &PathProblem, assembly: &Assembly) -> Vec<SoftensOver> {
    let mut found: Vec<SoftensOver> = Vec::new();
    for (index, pair) in problem.contacts.windows(2).enumerate() {
        let Some([strength, energy]) = problem.response(index).and_then(|law| law.tensile_softening()) else {
            continue;
        };
        if pair[0].joint != pair[1].joint {
            continue;
        }
        let joint = &assembly.joints[pair[0].joint];
        let soft = [joint.minus, joint.plus].into_iter().filter_map(|block| {
            let body = &assembly.bodies[block];
            let material = &assembly.catalogue.materials[body.material].1;
            let elasticity = material.elasticity().filter(|_| !body.fixed && material.inelastic().is_none())?;
            Some(elasticity.modulus * PlaneElasticity::new(&elasticity, assembly.plane).softest())
        });
        let modulus = soft.fold(f64::INFINITY, f64::min);
        let length = modulus * energy / (strength * strength);
        let spacing = (pair[1].position - pair[0].position).norm();
        if !(length.is_finite() && POINTS_IN_ZONE * spacing > length) {
            continue;
        }
        match found.last_mut() {
            Some(last) if last.joint == pair[0].joint => last.spacing = last.spacing.max(spacing),
            _ => found.push(SoftensOver { joint: pair[0].joint, length, spacing }),
        }
    }
    found
}

/// Contact points with their answers, and the states of all laws after them.
type Updated = (Vec<(usize, TractionPoint)>, Vec<f64>);

impl PathProblem {
    /// Numbers in the states of all laws of tractions from gaps.
    pub fn memory_size(&self) -> usize {
        (0..self.contacts.len()).filter_map(|c| self.response(c)).map(|law| law.state_size()).sum()
    }

    /// States of untouched joints, contact point after contact point.
    pub fn untouched(&self) -> Vec<f64> {
        let mut memory = vec![0.0; self.memory_size()];
        let mut at = 0;
        for law in (0..self.contacts.len()).filter_map(|c| self.response(c)) {
            law.initial_state(&mut memory[at..at + law.state_size()]);
            at += law.state_size();
        }
        memory
    }

    /// One update of every contact point with a law of tractions from gaps, from `before`: contact
    /// point, answer and the states after it. `None` where `before` has the wrong length or an update fails.
    fn updated(&self, gaps: &[[f64; 2]], before: &[f64]) -> Option<Updated> {
        let (mut after, mut points) = (before.to_vec(), Vec::new());
        if before.len() != self.memory_size() {
            return None;
        }
        let mut at = 0;
        for (contact, gap) in gaps.iter().enumerate().take(self.contacts.len()) {
            let Some(law) = self.response(contact) else { continue };
            let place = at..at + law.state_size();
            at = place.end;
            let point = law.respond_point(*gap, &before[place.clone()], &mut after[place]).ok()?;
            points.push((contact, point));
        }
        Some((points, after))
    }

    /// How far forces are from what laws of tractions from gaps give, relative to the greatest contact
    /// force, and the laws' states afterwards. `None` where there is no such law. Granted is the rounding
    /// of a gap, a difference of displacements (of positions, where they are `finite`), times the
    /// law's stiffness. `least` is the least force \[N\] that anything is
    /// compared with. A `before` that does not fit is that of untouched joints.
    pub fn law_residual(
        &self,
        state: &PathState,
        before: &[f64],
        deformation: f64,
        finite: bool,
        least: f64,
    ) -> Option<(f64, Vec<f64>)> {
        let size = self.memory_size();
        if !(0..self.contacts.len()).any(|c| self.response(c).is_some()) {
            return None;
        }
        let untouched = self.untouched();
        let before = if before.len() == size { before } else { &untouched };
        let Some((points, after)) = self.updated(&state.gap, before) else { return Some((f64::INFINITY, untouched)) };
        let largest = state.force.iter().flatten().fold(0.0, |a: f64, f| a.max(f.abs()));
        let rounding = f64::EPSILON * if finite { 512.0 * self.length } else { 64.0 * deformation };
        let mut scale = largest.max(least);
        let mut worst: f64 = 0.0;
        for (contact, point) in points {
            let area = self.contacts[contact].area;
            for k in 0..2 {
                let stiffness = point.tangent[k][0].abs() + point.tangent[k][1].abs();
                let off = (state.force[contact][k] - area * point.traction[k]).abs() - rounding * area * stiffness;
                scale = scale.max(area * point.traction[k].abs());
                worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
            }
        }
        Some((if worst <= 0.0 { 0.0 } else { worst / scale.max(1e-300) }, after))
    }

    /// How much a motion that goes on far (up to the scene's length) changes the forces of laws of
    /// tractions from gaps, relative to the greatest contact force: 0 for a mechanism.
    pub fn leaves_forces(&self, state: &PathState, motion: &[[f64; 3]]) -> f64 {
        let jump = |contact: usize| {
            let mut jump = [0.0; 2];
            let point = &self.contacts[contact];
            for plus in [false, true] {
                let rows = self.kinematics(point, plus);
                let body = if plus { point.plus.body } else { point.minus.body };
                (0..2).for_each(|i| jump[i] += (0..3).map(|k| rows[i][k] * motion[body][k]).sum::<f64>());
            }
            jump
        };
        let mut jumps: Vec<[f64; 2]> = (0..self.contacts.len()).map(jump).collect();
        let size = jumps.iter().map(|j| j[0].hypot(j[1])).fold(0.0, f64::max);
        // Rounding of the motion is no movement.
        jumps.iter_mut().flatten().filter(|j| j.abs() <= 1e-7 * size).for_each(|j| *j = 0.0);
        let largest = state.force.iter().flatten().fold(0.0, |a: f64, f| a.max(f.abs()));
        let Some((_, after)) = self.updated(&state.gap, &state.memory) else { return 0.0 };
        let mut worst: f64 = 0.0;
        for distance in [1e-9, 1e-6, 1e-3, 1.0] {
            let share = distance * self.length / size.max(1e-300);
            let far = |(g, j): (&[f64; 2], &[f64; 2])| [g[0] + share * j[0], g[1] + share * j[1]];
            let gaps: Vec<[f64; 2]> = state.gap.iter().zip(&jumps).map(far).collect();
            let Some((points, _)) = self.updated(&gaps, &after) else { return f64::INFINITY };
            for (contact, point) in points {
                for k in 0..2 {
                    let off = state.force[contact][k] - self.contacts[contact].area * point.traction[k];
                    worst = worst.max(off.abs() / largest.max(1e-300));
                }
            }
        }
        worst
    }
}
