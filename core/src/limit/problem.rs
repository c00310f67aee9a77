//! The problem of limit analysis and its results: the input and output of a limit solver.
//!
//! Rigid bodies b have the wrenches `fixed + λ varying`; joints have strengths in (N_0, N_1, T). The static form is the
//! greatest λ with equilibrium and strengths. Its dual, the kinematic form, is the least λ = D(q̇) − fixed·q̇ over
//! motions with varying·q̇ = 1, where D is the power dissipated in the joints. Rows also have the flow of their facets
//! ([`crate::law::ForceRow::flow`]). Solvers that use it return [`NonAssociated`]; all others treat joints with
//! associated flow.

use crate::law::{FacetMode, ForceRow, JointStrength, Tangential, UnitStrength, is_associated};
use crate::model::geometry::{Vec2, bounding_box, cross, turned};
use crate::model::{Assembly, Bond, StageLoads, Wrenches, add_force};
use std::collections::BTreeMap;

/// Bound of the shear, relative to the loads. Equilibrium never needs more; divided by the friction above which nothing
/// slides, it is below the rounding error of a normal force.
const BOUNDED_SHEAR: f64 = 10.0;

/// Forces of a joint: normal forces at its two ends, shear along it \[N\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointForce {
    /// N_0 and N_1, positive in compression.
    pub normal: [f64; 2],
    /// T, along t on the plus body.
    pub shear: f64,
}

/// Velocity of a body as a rigid motion about the origin: \[v_x, v_y, ω\].
pub type Velocity = [f64; 3];

/// A joint between two free groups, or between a group and the ground (`None`). It can also represent the fill at a
/// chord, whose pressure acts on the group as N_0 along the normal.
#[derive(Debug, Clone)]
pub struct LimitJoint {
    /// Index of the joint in the assembly; reactions of the fill have the indices after all joints.
    pub joint: usize,
    /// Index of the reaction if this is fill. N_0 is the force above the least force, which is a fixed load.
    pub fill: Option<usize>,
    /// Group on the minus side.
    pub minus: Option<usize>,
    /// Group on the plus side.
    pub plus: Option<usize>,
    /// Ends of the joint \[m\].
    pub ends: [Vec2; 2],
    /// Unit normal from minus to plus.
    pub normal: Vec2,
    /// Unit tangent.
    pub tangent: Vec2,
    /// Strength of the joint.
    pub strength: JointStrength,
}

impl LimitJoint {
    /// Returns the number of forces among N_0, N_1, T.
    pub fn components(&self) -> usize {
        match (self.fill, self.strength.tangential()) {
            (Some(_), _) => 1,
            (None, Tangential::Free) => 2,
            (None, _) => 3,
        }
    }

    /// Returns the wrenches about `pole` on the plus body per unit of N_0, N_1 and T; the minus body gets the opposite.
    pub fn wrenches(&self, pole: Vec2) -> [[f64; 3]; 3] {
        let at = |point: Vec2, direction: Vec2| [direction.x, direction.y, cross(point - pole, direction)];
        [at(self.ends[0], self.normal), at(self.ends[1], self.normal), at(self.ends[0], self.tangent)]
    }
}

/// The reduced problem of one stage.
#[derive(Debug, Clone)]
pub struct LimitProblem {
    /// Free group of each body of the assembly; `None` if the body is held.
    pub group_of: Vec<Option<usize>>,
    /// Number of free groups.
    pub groups: usize,
    /// Joints between different groups, or between a group and the ground.
    pub joints: Vec<LimitJoint>,
    /// Fixed wrench of each group about `pole` \[N, N m\].
    pub fixed: Wrenches,
    /// Wrench of each group about `pole` for λ = 1 \[N, N m\].
    pub varying: Wrenches,
    /// Centre of the scene, the pole of all moments \[m\].
    pub pole: Vec2,
    /// Length scale \[m\].
    pub length: f64,
    /// True if the flow of a law is not associated.
    pub non_associated: bool,
}

impl LimitProblem {
    /// Reduces an assembly: bonded bodies form one group, held bodies are the ground, joints inside a group are left
    /// out. An error names the law that limit analysis does not support.
    pub fn new(assembly: &Assembly, loads: &StageLoads) -> Result<Self, String> {
        let (group_of, groups) = assembly.rigid_groups();
        let points = assembly.joints.iter().flat_map(|joint| &joint.ends);
        let (low, high) = bounding_box(points);
        let pole = if assembly.joints.is_empty() { Vec2::zeros() } else { (low + high) / 2.0 };
        let mut read: BTreeMap<usize, UnitStrength> = BTreeMap::new();
        let mut non_associated = false;
        let mut joints = Vec::with_capacity(assembly.joints.len() + loads.fill_bounds.len());
        for (index, joint) in assembly.joints.iter().enumerate() {
            let (minus, plus) = (group_of[joint.minus], group_of[joint.plus]);
            let Bond::Law(law) = joint.bond else {
                continue;
            };
            if minus == plus {
                continue;
            }
            let (name, interface) = &assembly.catalogue.laws[law];
            if let std::collections::btree_map::Entry::Vacant(place) = read.entry(law) {
                let facets = interface.facets().ok_or_else(|| {
                    format!("joint law \"{name}\" is not given by facets: limit analysis cannot read it")
                })?;
                non_associated |= !is_associated(&facets);
                place.insert(UnitStrength::of(&facets).map_err(|why| format!("joint law \"{name}\": {why}"))?);
            }
            let strength = read[&law].over(joint.height() * assembly.width);
            let (normal, tangent) = joint.frame();
            joints.push(LimitJoint {
                joint: index,
                fill: None,
                minus,
                plus,
                ends: joint.ends,
                normal,
                tangent,
                strength,
            });
        }
        let least = fill_joints(assembly, loads, &group_of, &mut joints);
        let gather = |wrenches: &Wrenches| {
            let mut sum = vec![[0.0; 3]; groups];
            for (group, wrench) in group_of.iter().zip(wrenches) {
                if let Some(group) = group {
                    let [x, y, moment] = wrench;
                    sum[*group][0] += x;
                    sum[*group][1] += y;
                    sum[*group][2] += moment - (pole.x * y - pole.y * x);
                }
            }
            sum
        };
        Ok(LimitProblem {
            fixed: gather(&least),
            varying: gather(&loads.varying),
            group_of,
            groups,
            joints,
            pole,
            length: if low.x.is_finite() { (high - low).norm() } else { 1.0 },
            non_associated,
        })
    }

    /// Returns true if several facets bound sliding in one sense in some joint, so that its rows alone are too weak.
    pub fn has_envelopes(&self) -> bool {
        self.joints.iter().any(|joint| !joint.strength.envelopes.is_empty())
    }

    /// Returns a better conditioned problem, in which crushing and cohesion that the loads cannot reach are unlimited.
    /// Its solution solves this problem if the certificate confirms it. `None` if nothing changes.
    pub fn within_reach(&self) -> Option<Self> {
        let force = self.magnitude(&self.fixed) + self.magnitude(&self.varying);
        let mut changed = self.clone();
        let mut any = false;
        for joint in changed.joints.iter_mut().filter(|joint| joint.fill.is_none()) {
            if let Some(strength) = joint.strength.within_reach(force) {
                joint.strength = strength;
                any = true;
            }
        }
        any.then_some(changed)
    }

    /// Returns a problem in which unbounded shear is limited to ten times the loads. Self-equilibrated forces then have
    /// a bound; this matters if the law bounds them by a friction that is too great to slide. `None` if every joint
    /// already has bounds.
    pub fn with_bounded_shear(&self) -> Option<Self> {
        let most = BOUNDED_SHEAR * (self.magnitude(&self.fixed) + self.magnitude(&self.varying));
        let stuck = |joint: &&mut LimitJoint| joint.fill.is_none() && joint.strength.tangential() == Tangential::Stuck;
        let mut changed = self.clone();
        let mut any = false;
        for joint in changed.joints.iter_mut().filter(stuck) {
            let bound = |sense| ForceRow::associated(FacetMode::Sliding, [0.0, 0.0, sense], most);
            joint.strength.rows.extend([1.0, -1.0].map(bound));
            any = true;
        }
        any.then_some(changed)
    }

    /// Returns the forces of the fill \[N\], one for each reaction, from the forces of the problem's joints. `bounds`
    /// are the least and greatest force of each reaction.
    pub fn fill_forces(&self, forces: &[JointForce], bounds: &[[f64; 2]]) -> Vec<f64> {
        let mut fill: Vec<f64> = bounds.iter().map(|bounds| bounds[0]).collect();
        for (joint, force) in self.joints.iter().zip(forces) {
            if let Some(index) = joint.fill {
                fill[index] += force.normal[0];
            }
        }
        fill
    }

    /// Returns the sum of the sizes of wrenches as forces \[N\]; moments are divided by the length of the scene.
    pub fn magnitude(&self, wrenches: &Wrenches) -> f64 {
        // Most wrenches are vertical or zero: this avoids a square root.
        let force = |w: &[f64; 3]| if w[0] == 0.0 { w[1].abs() } else { w[0].hypot(w[1]) };
        wrenches.iter().map(|w| force(w).max(w[2].abs() / self.length)).sum()
    }
}

/// Adds the reactions of the fill as joints and returns the fixed loads plus the least force of each reaction. The
/// remaining force of a reaction lies between zero and the rest of its range.
fn fill_joints(
    assembly: &Assembly,
    loads: &StageLoads,
    group_of: &[Option<usize>],
    joints: &mut Vec<LimitJoint>,
) -> Wrenches {
    let mut fixed = loads.fixed.clone();
    for (index, (reaction, [least, greatest])) in assembly.fill_reactions().iter().zip(&loads.fill_bounds).enumerate() {
        add_force(&mut fixed[reaction.body], reaction.point, reaction.direction, *least);
        let plus = group_of[reaction.body];
        if plus.is_none() || greatest <= least {
            continue;
        }
        let (normal, tangent) = (reaction.direction, turned(reaction.direction));
        let rows = vec![
            ForceRow::associated(FacetMode::Opening, [-1.0, 0.0, 0.0], 0.0),
            ForceRow::associated(FacetMode::Crushing, [1.0, 0.0, 0.0], greatest - least),
        ];
        joints.push(LimitJoint {
            joint: assembly.joints.len() + index,
            fill: Some(index),
            minus: None,
            plus,
            ends: [reaction.point, reaction.point + tangent],
            normal,
            tangent,
            strength: JointStrength { rows, block: None, envelopes: Vec::new() },
        });
    }
    fixed
}
