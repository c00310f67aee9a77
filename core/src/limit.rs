//! The problem of limit analysis and its answers: what a limit solver is given and gives back.
//!
//! Rigid bodies b with wrenches `fixed + λ varying`, joints with strengths over (N_0, N_1, T).
//! Static form: the greatest λ with equilibrium and strengths. Kinematic form (its dual): the least
//! λ = D(q̇) − fixed·q̇ over motions with varying·q̇ = 1, D the power dissipated in the joints.
//! Rows carry the flow of their facets too ([`crate::strength::ForceRow::flow`]). Solvers that read
//! it answer with [`OwnFlow`]; all others read joints with associated flow.

use crate::assembly::{Assembly, StageLoads, Wrenches};
use crate::geometry::{Vec2, cross};
use crate::interface::is_associated;
use crate::product_proof::LowerProof;
use crate::strength::{JointStrength, integrate};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Debug;

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

/// A joint between two free groups, or a group and the ground (`None`).
#[derive(Debug, Clone)]
pub struct LimitJoint {
    /// Index of the joint in the assembly.
    pub joint: usize,
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
        let (low, high) = crate::geometry::bounding_box(points);
        let pole = if assembly.joints.is_empty() { Vec2::zeros() } else { (low + high) / 2.0 };
        let mut read: BTreeMap<usize, Vec<crate::interface::Facet>> = BTreeMap::new();
        let mut non_associated = false;
        let mut joints = Vec::new();
        for (index, joint) in assembly.joints.iter().enumerate() {
            let (minus, plus) = (group_of[joint.minus], group_of[joint.plus]);
            let crate::assembly::Bond::Law(law) = joint.bond else {
                continue;
            };
            if minus == plus {
                continue;
            }
            let (name, interface) = &assembly.catalogue.laws[law];
            if let std::collections::btree_map::Entry::Vacant(place) = read.entry(law) {
                let facets = interface.formulation().facets().ok_or_else(|| {
                    format!("joint law \"{name}\" is not given by facets: limit analysis cannot read it")
                })?;
                non_associated |= !is_associated(&facets);
                place.insert(facets);
            }
            let facets = &read[&law];
            let strength = integrate(facets, joint.height() * assembly.width)
                .map_err(|why| format!("joint law \"{name}\": {why}"))?;
            let (normal, tangent) = joint.frame();
            joints.push(LimitJoint { joint: index, minus, plus, ends: joint.ends, normal, tangent, strength });
        }
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
            fixed: gather(&loads.fixed),
            varying: gather(&loads.varying),
            group_of,
            groups,
            joints,
            pole,
            length: if low.x.is_finite() { (high - low).norm() } else { 1.0 },
            non_associated,
        })
    }

    /// Sum of the sizes of some wrenches as forces \[N\], moments divided by the scene's length.
    pub fn magnitude(&self, wrenches: &Wrenches) -> f64 {
        wrenches.iter().map(|w| w[0].hypot(w[1]).max(w[2].abs() / self.length)).sum()
    }
}

/// What is asked of a limit solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LimitQuestion {
    /// Is there an admissible field at this factor?
    Stand(f64),
    /// From an admissible state at `start`, what is the greatest factor, searched up to `max`?
    Collapse {
        /// Where the search starts.
        start: f64,
        /// Where it ends (may be ∞).
        max: f64,
    },
}

/// How a stage ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// It reached its factor; an admissible field proves it.
    Stands,
    /// It collapses at a factor that both bounds enclose.
    Collapse,
    /// It carries any factor: a ray proves it.
    Unbounded,
    /// The loads present before the stage begins cannot be carried: a motion proves it.
    NoEquilibrium,
    /// No rate of solution with growing factor.
    LimitPoint,
    /// Not proven; the notes say why.
    Stalled,
}

/// Counts of work done.
pub type Counters = BTreeMap<String, u64>;

/// A limit solver's answer for one stage.
#[derive(Debug, Clone)]
pub struct LimitAnswer {
    /// How it ends.
    pub status: Status,
    /// The collapse factor.
    pub factor: Option<f64>,
    /// The factor at which `field` is in equilibrium.
    pub field_factor: f64,
    /// One entry per joint of the problem.
    pub field: Option<Vec<JointForce>>,
    /// One entry per group, about the problem's pole; scaled to varying·q̇ = 1, for `NoEquilibrium`
    /// with a feasible interval to ±1, without one in any scale.
    pub motion: Option<Vec<Velocity>>,
    /// Is the motion the only one?
    pub unique: Option<bool>,
    /// One entry per joint of the problem.
    pub ray: Option<Vec<JointForce>>,
    /// All factors with an admissible field, where that interval leaves out the start.
    pub feasible_interval: Option<[f64; 2]>,
    /// Set where joints were read with their laws' own flow.
    pub own_flow: Option<OwnFlow>,
    /// Work done.
    pub counters: Counters,
    /// What a user should know.
    pub notes: Vec<String>,
}

/// What comes with an answer that reads each joint with its law's own flow. With non-associated
/// flow the factor is not unique: `factor` of the answer is one at which the law's own mechanism
/// and field exist together.
#[derive(Debug, Clone, Default)]
pub struct OwnFlow {
    /// No such factor is less than this.
    pub proved_lower: Option<f64>,
    /// What that rests on.
    pub lower_proof: Option<LowerProof>,
    /// The greatest factor of associated flow, above which nothing can be.
    pub associated_factor: Option<f64>,
    /// Its mechanism, scaled as `motion`, which proves it.
    pub associated_motion: Option<Vec<Velocity>>,
}

/// A way to do limit analysis, chosen by `[solver] solver = …`.
#[typetag::serde(tag = "solver")]
pub trait LimitSolver: Debug + Send + Sync {
    /// Answers the question. Never panics; what cannot be proven is `Stalled` with its reason.
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer;

    /// Why this solver cannot take this problem, if so.
    fn refuses(&self, problem: &LimitProblem) -> Option<String>;
}
