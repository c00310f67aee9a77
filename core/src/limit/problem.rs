//! The problem of limit analysis and its answers: what a limit solver is given and gives back.
//!
//! Rigid bodies b with wrenches `fixed + λ varying`, joints with strengths over (N_0, N_1, T).
//! Static form: the greatest λ with equilibrium and strengths. Kinematic form (its dual): the least
//! λ = D(q̇) − fixed·q̇ over motions with varying·q̇ = 1, D the power dissipated in the joints.
//! Rows carry the flow of their facets too ([`crate::law::ForceRow::flow`]). Solvers that read
//! it answer with [`NonAssociated`]; all others read joints with associated flow.

use crate::law::{FacetMode, ForceRow, JointStrength, Tangential, UnitStrength, is_associated};
use crate::model::geometry::{Vec2, bounding_box, cross, turned};
use crate::model::{Assembly, Bond, StageLoads, Wrenches, add_force};
use std::collections::BTreeMap;

/// Shear over the loads that no equilibrium needs to exceed; divided by friction from which on nothing slides it is no more
/// than the rounding of a normal force.
const BOUNDED_SHEAR: f64 = 10.0;

/// Forces carried by a joint: normal forces at its two ends, shear along it \[N\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointForce {
    /// N_0, N_1 ≥ 0 in compression.
    pub normal: [f64; 2],
    /// T, along t on the plus body.
    pub shear: f64,
}

/// Velocity of a body as a rigid motion seen at the origin: \[v_x, v_y, ω\].
pub type Velocity = [f64; 3];

/// A joint between two free groups, or a group and the ground (`None`); or the fill at a chord, which presses its
/// group with N_0 along the normal.
#[derive(Debug, Clone)]
pub struct LimitJoint {
    /// Index of the joint in the assembly; reactions of the fill follow after all joints.
    pub joint: usize,
    /// Index of the reaction, for fill. N_0 is its force beyond the least one, which is a fixed load.
    pub fill: Option<usize>,
    /// Group on the minus side.
    pub minus: Option<usize>,
    /// Group on the plus side.
    pub plus: Option<usize>,
    /// Its ends \[m\].
    pub ends: [Vec2; 2],
    /// Unit normal from minus to plus.
    pub normal: Vec2,
    /// Unit tangent.
    pub tangent: Vec2,
    /// What it can carry.
    pub strength: JointStrength,
}

impl LimitJoint {
    /// Number of forces among N_0, N_1, T that it has.
    pub fn components(&self) -> usize {
        match (self.fill, self.strength.tangential()) {
            (Some(_), _) => 1,
            (None, Tangential::Free) => 2,
            (None, _) => 3,
        }
    }

    /// Wrenches about `pole` on the plus body per unit of N_0, N_1 and T; minus gets the opposite.
    pub fn wrenches(&self, pole: Vec2) -> [[f64; 3]; 3] {
        let at = |point: Vec2, direction: Vec2| [direction.x, direction.y, cross(point - pole, direction)];
        [at(self.ends[0], self.normal), at(self.ends[1], self.normal), at(self.ends[0], self.tangent)]
    }
}

/// The reduced problem of one stage.
#[derive(Debug, Clone)]
pub struct LimitProblem {
    /// For each body of the assembly its free group, `None` where held.
    pub group_of: Vec<Option<usize>>,
    /// Number of free groups.
    pub groups: usize,
    /// Joints that remain.
    pub joints: Vec<LimitJoint>,
    /// Wrench per group about `pole` \[N, N m\].
    pub fixed: Wrenches,
    /// Wrench per group about `pole` for λ = 1.
    pub varying: Wrenches,
    /// Middle of the scene, about which moments are taken \[m\].
    pub pole: Vec2,
    /// Length scale \[m\].
    pub length: f64,
    /// Whether some law's own flow is not associated.
    pub non_associated: bool,
}

impl LimitProblem {
    /// Reduces an assembly: bonded bodies become one, held ones the ground, joints inside a group
    /// vanish. An error names the law that limit analysis cannot read.
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

    /// The same with crushing and cohesion that the loads never come near taken for unlimited: a problem of better numbers,
    /// whose answer is one of this problem where the certificate says so. `None` where there are none such.
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

    /// The same with shear bounded by ten times the loads where nothing bounds it: forces that hold each other in balance then
    /// cannot be as great as they like, which matters where a law does bound them by friction too great to slide. `None`
    /// where every joint has bounds.
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

    /// Forces of the fill \[N\] given those of the problem's joints: one for each of its reactions, of which `bounds`
    /// are the least and greatest.
    pub fn fill_forces(&self, forces: &[JointForce], bounds: &[[f64; 2]]) -> Vec<f64> {
        let mut fill: Vec<f64> = bounds.iter().map(|bounds| bounds[0]).collect();
        for (joint, force) in self.joints.iter().zip(forces) {
            if let Some(index) = joint.fill {
                fill[index] += force.normal[0];
            }
        }
        fill
    }

    /// Sum of the sizes of some wrenches as forces \[N\], moments divided by the scene's length.
    pub fn magnitude(&self, wrenches: &Wrenches) -> f64 {
        // Most wrenches are vertical, or nothing.
        let force = |w: &[f64; 3]| if w[0] == 0.0 { w[1].abs() } else { w[0].hypot(w[1]) };
        wrenches.iter().map(|w| force(w).max(w[2].abs() / self.length)).sum()
    }
}

/// Adds the reactions of the fill as joints, and returns the fixed loads with the least force of each: what is left
/// of a reaction lies between zero and what its law allows beyond.
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
            strength: JointStrength { rows, block: None },
        });
    }
    fixed
}
