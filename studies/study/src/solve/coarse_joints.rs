//! Joints whose contact points are too far apart for the fracture energy of their law.

use voussoir_core::law::PlaneElasticity;
use voussoir_core::model::Assembly;
use voussoir_core::path::PathProblem;

/// Least number of contact points over the length of a cohesive zone; a joint with fewer points is coarse (Turon, Dávila,
/// Camanho & Costa 2007, Engng Fract. Mech. 74: three elements and more).
const POINTS_IN_ZONE: f64 = 3.0;

/// A joint whose contact points are too far apart for the fracture energy of its law.
#[derive(Debug, Clone, PartialEq)]
pub struct SoftensOver {
    /// Index of the joint.
    pub joint: usize,
    /// ℓ = E G_I / f_t² with E/(1 − ν²) in plane strain \[m\] (Hillerborg, Modéer & Petersson 1976).
    pub length: f64,
    /// Greatest distance between two contact points \[m\].
    pub spacing: f64,
}

/// Returns the joints between elastic blocks whose contact points are farther apart than a third of the characteristic length
/// of their law: the path then has a peak and a snap-back for every point.
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
