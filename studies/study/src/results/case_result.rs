//! The result of a case, as stored in `results.json`.

use super::carried::CarriedLoad;
use super::entries::{DisplacementEntry, EventEntry, LoadEntry, StateEntry, YieldedEntry};
use super::limit_points::{BranchEntry, FollowedTo, LimitPointEntry, StabilityEntry};
use super::load_factor_error::LoadFactorError;
use super::output_entry::OutputEntry;
use super::proof_fields::{ProofFields, SpaceProof};
use super::sensitivity::SensitivityEntry;
use super::stored_path::PathEntry;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use voussoir_core::certificate::{Certificate, Hinge, Mechanism};
use voussoir_core::limit::{BracketPoint, Counters, Greatest, LowerProof, Status};
use voussoir_core::path::LimitPointEnd;
use voussoir_core::plugin::OutputOf;

/// Two factors with a smaller relative difference belong to the same limit point.
const SAME_POINT: f64 = 1e-9;

/// Returns the first limit point if it differs from the load factor.
pub fn other_limit_point(load_factor: Option<f64>, first_limit_point: Option<f64>) -> Option<f64> {
    let (factor, first) = load_factor.zip(first_limit_point)?;
    ((first - factor).abs() > SAME_POINT * factor.abs()).then_some(first)
}

/// Identifies a case in its study.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CaseLabel {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Hash of the resolved case: [`crate::study::Case::hash`].
    #[serde(default)]
    pub case_hash: String,
    /// Name of the variant, if the study has variants.
    pub variant: Option<String>,
    /// Name of the scene, if the study compares several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
}

/// Additional results for non-associated flow: the associated factor, and the evidence for the lower bound.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct NonAssociatedAnswer {
    /// The factor with associated flow, if the solver did not use associated flow.
    pub associated_load_factor: Option<f64>,
    /// The evidence for the lower bound with the laws' own flow, with the data that `verify` needs to check it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_proof: Option<LowerProof>,
    /// The lower and upper bound of the least load, against the work of the solvers that improved them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bracket: Vec<BracketPoint>,
}

/// Results that only paths have.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PathRecord {
    /// Events at the contact points, in order.
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
    /// For laws of tractions from gaps: their states (such as damage) at the start of the step that ended at the field,
    /// one contact point after another. The laws compute the contact forces from these states.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_states: Option<Vec<f64>>,
    /// If that step has a duration \[s\]: its duration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_time_step: Option<f64>,
    /// If that step has a duration: the gaps (g_n, g_t) at its start \[m\], one contact point after another.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_gaps: Option<Vec<[f64; 2]>>,
    /// Blocks whose material has yielded at the state of the field.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub yielded: Vec<YieldedEntry>,
    /// Proven peaks of the factor in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limit_points: Vec<LimitPointEntry>,
    /// Factor of the first limit point, in the stage that `load_factor` belongs to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_limit_point: Option<f64>,
    /// The reason why a path with the status `limit_point` ends at it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub continuation: Option<LimitPointEnd>,
    /// True if the states and witnesses alone prove the end, independently of the solver that found them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_is_checked: Option<bool>,
    /// The statement that is proved; `None` without a proof.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_proof: Option<EndProof>,
    /// The last state of the path. `greatest` holds for the range up to this state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub followed_to: Option<FollowedTo>,
    /// Points at which the path left an unstable equilibrium.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub branches: Vec<BranchEntry>,
}

/// The proof of the end of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EndProof {
    /// No rate raises the load at the limit points.
    StatesAndWitnesses,
    /// For laws with a history: no rate of the loading sets that were found raises the load.
    LoadingSet,
}

/// The proof that a case stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Proof {
    /// An admissible field: flow is associated and displacements are small.
    Static,
    /// The path to its loads.
    Path,
}

/// The result of one stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageResult {
    /// Its name.
    pub name: String,
    /// Its status at the end.
    pub status: Status,
    /// The factor that it reached; `null` if it reached none, or if every factor is carried.
    pub factor: Option<f64>,
    /// Hinges of the mechanism that ended the stage, with rotations per unit of motion. If a stage of a path stands:
    /// the joints that are open over three quarters of their height at its end, with their rotations \[rad\].
    pub hinges: Vec<Hinge>,
    /// Stability of its last state.
    #[serde(flatten)]
    pub stability: StabilityEntry,
}

/// The result of one case with its proofs.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CaseResult {
    /// Identifies the case.
    #[serde(flatten)]
    pub label: CaseLabel,
    /// The status at the end.
    pub status: Status,
    /// The collapse factor.
    pub load_factor: Option<f64>,
    /// On request: the error of the factor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_factor_error: Option<LoadFactorError>,
    /// Proved bounds of the load factor, \[lower, upper\]: from the field and from the mechanism. `null` for an
    /// unproved bound.
    pub bounds: Option<[Option<f64>; 2]>,
    /// The quality of the greatest load factor; in limit analysis with the laws' own flow, of the least one.
    #[serde(default)]
    pub greatest: Greatest,
    /// Additional results for non-associated flow.
    #[serde(flatten)]
    pub non_associated: NonAssociatedAnswer,
    /// All factors with an admissible field, if the dead load alone has no such field; `null` ends are infinite.
    pub feasible_interval: Option<[Option<f64>; 2]>,
    /// `"associated"` if a non-associated law was solved with associated flow.
    pub flow_read_as: Option<String>,
    /// The proof that it stands, if it stands.
    #[serde(rename = "proof", default, skip_serializing_if = "Option::is_none")]
    pub proved_by: Option<Proof>,
    /// The solver that was used.
    pub solver: String,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// The collapse mechanism, or the mechanism that refutes equilibrium.
    pub mechanism: Option<Mechanism>,
    /// Forces and velocities that prove the result.
    #[serde(flatten)]
    pub proof: ProofFields,
    /// Named residuals.
    pub certificate: Certificate,
    /// Work done.
    pub counters: Counters,
    /// Wall time \[s\].
    pub seconds: f64,
    /// The results of the stages, in order.
    pub stages: Vec<StageResult>,
    /// Results that only paths have.
    #[serde(flatten)]
    pub path: PathRecord,
    /// Outputs that plug-ins declare on their cards.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<OutputEntry>,
    /// On request: how the load factor changes with the numbers of the study.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensitivities: Vec<SensitivityEntry>,
    /// The partial factors that its values were multiplied or divided by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub partial_factors: Option<Json>,
    /// On bridges: the loads on each block.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<LoadEntry>,
    /// Results for a load that is carried.
    #[serde(flatten)]
    pub carried: CarriedLoad,
    /// The states and witnesses that prove the end of the path, if they are stored. They are not written to
    /// results.json.
    #[serde(skip)]
    pub stored_path: Option<PathEntry>,
}

impl CaseResult {
    /// Creates an unproved result with its reason.
    pub fn stalled(why: impl Into<String>) -> Self {
        CaseResult { notes: vec![why.into()], ..CaseResult::empty() }
    }

    /// Returns both bounds of the load factor if both are proved.
    pub fn both_bounds(&self) -> Option<[f64; 2]> {
        let [lower, upper] = self.bounds?;
        Some([lower?, upper?])
    }

    /// Returns the load factor if it is a certified collapse or limit point.
    pub fn collapse_load(&self) -> Option<f64> {
        let ends = matches!(self.status, Status::Collapse | Status::LimitPoint);
        self.load_factor.filter(|_| self.certificate.passed && ends)
    }

    /// Returns the first limit point of the path if it differs from the load factor: under a dead load the structure
    /// snaps there.
    pub fn snaps_from(&self) -> Option<f64> {
        other_limit_point(self.load_factor, self.path.first_limit_point)
    }

    /// Returns true if rigid blocks cannot follow their supports. The ray then refutes the motion of the supports, not
    /// the loads.
    pub fn supports_cannot_move(&self) -> bool {
        let in_space = || self.proof.space.as_ref().is_some_and(|space| space.ray.is_some());
        self.status == Status::NoEquilibrium && (self.proof.ray.is_some() || in_space())
    }

    /// Removes all forces and motions of blocks and joints, after the certificates have been computed. A ray that
    /// refutes the motion of supports stays, because it is the result.
    pub fn leave_out_fields(&mut self) {
        let ray = self.proof.ray.take().filter(|_| self.status == Status::NoEquilibrium);
        let in_space = self.proof.space.take().and_then(|space| space.ray);
        let in_space = in_space.filter(|_| self.status == Status::NoEquilibrium);
        let space = in_space.map(|ray| Box::new(SpaceProof { ray: Some(ray), ..SpaceProof::default() }));
        self.proof = ProofFields { field_factor: self.proof.field_factor, ray, space, ..ProofFields::default() };
        self.carried.joints.clear();
        self.non_associated.lower_proof.iter_mut().for_each(|proof| proof.steps.clear());
        (self.path.displacements, self.path.joint_states) = (None, None);
        (self.path.joint_time_step, self.path.joint_gaps) = (None, None);
        self.path.yielded.clear();
        self.outputs.retain(|entry| entry.of == OutputOf::Case);
    }

    /// Returns the parts of the result that study kinds use.
    pub fn brief(&self) -> Self {
        CaseResult { carried: CarriedLoad::default(), ..self.without_drawings() }
    }

    /// Returns the result without the data that only its own drawings and its proof use.
    pub fn without_drawings(&self) -> Self {
        let path = PathRecord {
            states: Vec::new(),
            joint_states: None,
            joint_gaps: None,
            yielded: Vec::new(),
            ..self.path.clone()
        };
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
            outputs: self.outputs.iter().filter(|entry| entry.of != OutputOf::Point).cloned().collect(),
            sensitivities: self.sensitivities.clone(),
            partial_factors: None,
            loads: Vec::new(),
            carried: self.carried.clone(),
            stored_path: None,
            ..*self
        }
    }

    /// Returns true if the forces and motions that would prove it have been removed.
    pub fn has_no_fields(&self) -> bool {
        let plane = self.proof.field.is_none() && self.proof.motion.is_none() && self.path.displacements.is_none();
        plane && self.proof.space.is_none()
    }

    /// Creates an empty stalled result.
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
            outputs: Vec::new(),
            sensitivities: Vec::new(),
            partial_factors: None,
            loads: Vec::new(),
            carried: CarriedLoad::default(),
            stored_path: None,
        }
    }
}
