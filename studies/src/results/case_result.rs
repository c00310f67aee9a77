//! The result of a case, as it stands in `results.json`.

use super::carried::CarriedLoad;
use super::entries::{
    DisplacementEntry, EventEntry, FieldEntry, FillEntry, LoadEntry, MotionEntry, StateEntry, YieldedEntry,
};
use super::limit_points::{BranchEntry, FollowedTo, LimitPointEntry, StabilityEntry};
use super::load_factor_error::LoadFactorError;
use super::sensitivity::SensitivityEntry;
use super::stored_path::StoredPath;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use std::sync::Arc;
use voussoir_core::certificate::{Certificate, Hinge, Mechanism};
use voussoir_core::limit::{BracketPoint, Counters, Greatest, LowerProof, Status};
use voussoir_core::path::LimitPointEnd;

/// Relative difference of two factors that belong to one limit point.
const SAME_POINT: f64 = 1e-9;

/// The first limit point, if the load factor is another one.
pub fn other_limit_point(load_factor: Option<f64>, first_limit_point: Option<f64>) -> Option<f64> {
    let (factor, first) = load_factor.zip(first_limit_point)?;
    ((first - factor).abs() > SAME_POINT * factor.abs()).then_some(first)
}

/// Which case of its study it is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CaseLabel {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Which resolved case it answers: [`crate::study::Case::hash`].
    #[serde(default)]
    pub case_hash: String,
    /// Name of the variant, if the study has variants.
    pub variant: Option<String>,
    /// Name of the scene, where the study compares several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
}

/// What a non-associated answer says besides: the associated answer, and what its own lower bound rests on.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct NonAssociatedAnswer {
    /// The factor with associated flow, where the solver answers another question.
    pub associated_load_factor: Option<f64>,
    /// Velocities of the mechanism that proves `associated_load_factor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub associated_motion: Option<Vec<MotionEntry>>,
    /// What the lower bound rests on where joints flow as their laws say, with what `verify` needs to check it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_proof: Option<LowerProof>,
    /// The bracket of the least load over the work of those who closed it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bracket: Vec<BracketPoint>,
}

/// Forces and velocities that prove an answer.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ProofFields {
    /// The factor at which `field` is in equilibrium.
    pub field_factor: Option<f64>,
    /// Contact forces.
    pub field: Option<Vec<FieldEntry>>,
    /// Forces of the fill that belong to `field`, where fill resists.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fill: Vec<FillEntry>,
    /// Velocities of the mechanism.
    pub motion: Option<Vec<MotionEntry>>,
    /// Contact forces that balance the live load alone, for `unbounded`; nothing, for supports that blocks cannot follow.
    pub ray: Option<Vec<FieldEntry>>,
    /// On arches, where the resultant crosses each joint \[m\]; `null` where a joint carries nothing.
    pub thrust_line: Option<Vec<Option<[f64; 2]>>>,
}

/// What only a path leaves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PathRecord {
    /// What happened at the contact points, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventEntry>,
    /// On request: \[displacement of the load point \[m\], factor\] of the last stage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Vec<[f64; 2]>>,
    /// On request: states of the path in order, for drawings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<StateEntry>,
    /// Displacement of every body as a rigid motion at the state of the field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacements: Option<Vec<DisplacementEntry>>,
    /// With laws of tractions from gaps: their states (such as damage) at the start of the step that ended at
    /// the field, contact point after contact point, from which the laws give its forces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_states: Option<Vec<f64>>,
    /// Blocks whose material has yielded at the state of the field.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub yielded: Vec<YieldedEntry>,
    /// Proven peaks of the factor in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limit_points: Vec<LimitPointEntry>,
    /// Factor of the first limit point of the stage that `load_factor` speaks of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_limit_point: Option<f64>,
    /// The reason why a path with the status `limit_point` ends at it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub continuation: Option<LimitPointEnd>,
    /// True if the end is proved by the states and witnesses alone, whoever has found them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_is_checked: Option<bool>,
    /// What that proof is about; `None` without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_proof: Option<EndProof>,
    /// The last state of the path: the range that `greatest` is about ends there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub followed_to: Option<FollowedTo>,
    /// Where the path left an equilibrium that became unstable.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub branches: Vec<BranchEntry>,
}

/// The proof of the end of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EndProof {
    /// No rate at all raises the load at its limit points.
    StatesAndWitnesses,
    /// Laws with a history: no rate of the loading set that was found raises the load.
    LoadingSet,
}

/// What proves that a case stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Proof {
    /// An admissible field: flow is associated and displacements are small.
    Static,
    /// The path to its loads.
    Path,
}

/// What one stage came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageResult {
    /// Its name.
    pub name: String,
    /// How it ended.
    pub status: Status,
    /// The factor it reached; `null` where it reached none, or any.
    pub factor: Option<f64>,
    /// Hinges of the mechanism that ended it, rotations per unit of motion; of a path's stage that stands the joints
    /// that are open over three quarters of their height at its end, with their rotation \[rad\].
    pub hinges: Vec<Hinge>,
    /// Stability of its last state.
    #[serde(flatten)]
    pub stability: StabilityEntry,
}

/// The answer to one case with what proves it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CaseResult {
    /// Which case it is.
    #[serde(flatten)]
    pub label: CaseLabel,
    /// How it ends.
    pub status: Status,
    /// The collapse factor.
    pub load_factor: Option<f64>,
    /// On request: how far the factor may be off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_factor_error: Option<LoadFactorError>,
    /// Proved ends of the load factor, \[lower, upper\]: from the field and from the mechanism. An end that nothing proves is
    /// `null`.
    pub bounds: Option<[Option<f64>; 2]>,
    /// How well the greatest load factor is known; with the laws' own flow in limit analysis, the least one.
    #[serde(default)]
    pub greatest: Greatest,
    /// What a non-associated answer says besides.
    #[serde(flatten)]
    pub non_associated: NonAssociatedAnswer,
    /// All factors with an admissible field, where dead load alone has none; `null` ends are infinite.
    pub feasible_interval: Option<[Option<f64>; 2]>,
    /// `"associated"` where a non-associated law was read so.
    pub flow_read_as: Option<String>,
    /// What proves that it stands, where it does.
    #[serde(rename = "proof", default, skip_serializing_if = "Option::is_none")]
    pub proved_by: Option<Proof>,
    /// The solver that answered.
    pub solver: String,
    /// What a user should know.
    pub notes: Vec<String>,
    /// The collapse mechanism, or the one that refutes equilibrium.
    pub mechanism: Option<Mechanism>,
    /// Forces and velocities that prove the answer.
    #[serde(flatten)]
    pub proof: ProofFields,
    /// Named residuals.
    pub certificate: Certificate,
    /// Work done.
    pub counters: Counters,
    /// Wall time \[s\].
    pub seconds: f64,
    /// Each stage in turn.
    pub stages: Vec<StageResult>,
    /// What a path leaves.
    #[serde(flatten)]
    pub path: PathRecord,
    /// On request: how the load factor changes with the numbers of the study.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensitivities: Vec<SensitivityEntry>,
    /// The partial factors that its values were multiplied or divided by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub partial_factors: Option<Json>,
    /// On bridges, what stands on which block.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<LoadEntry>,
    /// What is said of a load that is carried.
    #[serde(flatten)]
    pub carried: CarriedLoad,
    /// The states and witnesses that prove the end of its path, if they are stored. They are not in results.json.
    #[serde(skip)]
    pub stored_path: Option<Arc<StoredPath>>,
}

impl CaseResult {
    /// An answer that nothing proves, with the reason.
    pub fn stalled(why: impl Into<String>) -> Self {
        CaseResult { notes: vec![why.into()], ..CaseResult::empty() }
    }

    /// Both ends of the load factor, if both are proved.
    pub fn both_bounds(&self) -> Option<[f64; 2]> {
        let [lower, upper] = self.bounds?;
        Some([lower?, upper?])
    }

    /// The load factor, where it is a certified collapse or limit point.
    pub fn collapse_load(&self) -> Option<f64> {
        let ends = matches!(self.status, Status::Collapse | Status::LimitPoint);
        self.load_factor.filter(|_| self.certificate.passed && ends)
    }

    /// The first limit point of the path, if the load factor is another one: a dead load snaps there.
    pub fn snaps_from(&self) -> Option<f64> {
        other_limit_point(self.load_factor, self.path.first_limit_point)
    }

    /// Whether rigid blocks cannot follow their supports: its ray then refutes their motion, not the loads.
    pub fn supports_cannot_move(&self) -> bool {
        self.status == Status::NoEquilibrium && self.proof.ray.is_some()
    }

    /// Leaves out all forces and motions of blocks and joints, once certificates have read them; but for a ray that
    /// refutes the motion of supports, which is what such an answer says.
    pub fn leave_out_fields(&mut self) {
        let ray = self.proof.ray.take().filter(|_| self.status == Status::NoEquilibrium);
        self.proof = ProofFields { field_factor: self.proof.field_factor, ray, ..ProofFields::default() };
        self.carried.joints.clear();
        self.non_associated.associated_motion = None;
        self.non_associated.lower_proof.iter_mut().for_each(|proof| proof.steps.clear());
        (self.path.displacements, self.path.joint_states) = (None, None);
        self.path.yielded.clear();
    }

    /// The result for what a study kind adds.
    pub fn brief(&self) -> Self {
        CaseResult { carried: CarriedLoad::default(), ..self.without_drawings() }
    }

    /// The result without what only drawings of the case itself and its proof read.
    pub fn without_drawings(&self) -> Self {
        let path = PathRecord { states: Vec::new(), joint_states: None, yielded: Vec::new(), ..self.path.clone() };
        CaseResult {
            label: self.label.clone(),
            load_factor_error: self.load_factor_error,
            greatest: self.greatest,
            non_associated: NonAssociatedAnswer {
                associated_load_factor: self.non_associated.associated_load_factor,
                ..NonAssociatedAnswer::default()
            },
            flow_read_as: self.flow_read_as.clone(),
            solver: self.solver.clone(),
            notes: self.notes.clone(),
            mechanism: self.mechanism.clone(),
            proof: ProofFields::default(),
            certificate: self.certificate.clone(),
            counters: self.counters.clone(),
            stages: self.stages.clone(),
            path,
            sensitivities: self.sensitivities.clone(),
            partial_factors: None,
            loads: Vec::new(),
            carried: self.carried.clone(),
            stored_path: None,
            ..*self
        }
    }

    /// Whether nothing is left of the forces and motions that would prove it.
    pub fn has_no_fields(&self) -> bool {
        self.proof.field.is_none() && self.proof.motion.is_none() && self.path.displacements.is_none()
    }

    /// A stalled answer that says nothing, to be filled in.
    pub fn empty() -> Self {
        CaseResult {
            label: CaseLabel::default(),
            status: Status::Stalled,
            load_factor: None,
            load_factor_error: None,
            bounds: None,
            greatest: Greatest::Open,
            non_associated: NonAssociatedAnswer::default(),
            feasible_interval: None,
            flow_read_as: None,
            proved_by: None,
            solver: String::new(),
            notes: Vec::new(),
            mechanism: None,
            proof: ProofFields::default(),
            certificate: Certificate {
                passed: false,
                residuals: Default::default(),
                failures: vec!["not proven".into()],
            },
            counters: Counters::new(),
            seconds: 0.0,
            stages: Vec::new(),
            path: PathRecord::default(),
            sensitivities: Vec::new(),
            partial_factors: None,
            loads: Vec::new(),
            carried: CarriedLoad::default(),
            stored_path: None,
        }
    }
}
