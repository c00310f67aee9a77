//! Stages of scenes in space that move supports: rigid blocks, small displacements, associated flow.
//!
//! The loads alone decide if a stage stands: the positions of supports do not change them. The solver computes the motion of
//! the blocks and the forces; all settlements so far are added.

use super::auto::space_solvers;
use super::case_input::CaseInput;
use super::space_entries::{entries_of_all, field_entries, gap_in_space};
use crate::results::{CaseResult, ProofFields, SpaceProof};
use crate::study::SpaceCase;
use std::collections::BTreeMap;
use voussoir_core::certificate::Certificate;
use voussoir_core::limit::Status;
use voussoir_core::model::Stage;
use voussoir_core::space::{
    SpaceClaim, SpaceField, SpaceProblem, SpaceSettled, SpaceVelocity, certify_space, space_openings,
    space_settlement_ray, space_settlement_residuals, space_support_motions,
};

/// Residual up to which a settlement is proved.
const PROVED: f64 = 1e-8;
/// Residual up to which a ray is proved.
const RAY: f64 = 1e-6;

/// The motions of supports in a stage, about the pole, and the gaps that they alone cause.
pub(crate) struct Moved {
    supports: Vec<Option<SpaceVelocity>>,
    openings: SpaceField,
    /// The problem with the loads at the factor of the stage as fixed loads.
    problem: SpaceProblem,
}

impl Moved {
    /// Returns the motions of supports at the end of stage `index`, with the loads at `factor`.
    pub(crate) fn new(space: &SpaceCase, stages: &[Stage], index: usize, problem: &SpaceProblem, factor: f64) -> Self {
        let supports = space_support_motions(&space.assembly, &space.stages(stages), index, &problem.pole);
        let openings = space_openings(&space.assembly, problem, &supports);
        let mut fixed = problem.fixed.clone();
        for (sum, own) in fixed.iter_mut().flatten().zip(problem.varying.iter().flatten()) {
            *sum += factor * own;
        }
        let problem = SpaceProblem { fixed, varying: vec![[0.0; 6]; problem.bodies], ..problem.clone() };
        Moved { supports, openings, problem }
    }

    /// Checks field and motion of the free bodies; fails with the reason.
    pub(crate) fn check(
        &self,
        field: &SpaceField,
        motion: &[SpaceVelocity],
        gap: f64,
    ) -> Result<BTreeMap<String, f64>, String> {
        let claim = SpaceClaim {
            hint: Status::Stands,
            target: 0.0,
            start: 0.0,
            factor: None,
            field_factor: 0.0,
            field: Some(field),
            motion: Some(motion),
            ray: None,
            non_associated: None,
            search_is_trusted: false,
        };
        let verdict = certify_space(&self.problem, &claim, gap);
        if verdict.status != Status::Stands {
            return Err(verdict.certificate.failures.join("; "));
        }
        let mut residuals = verdict.certificate.residuals;
        for (name, value) in space_settlement_residuals(&self.problem, &self.openings, field, motion) {
            residuals.insert(name.into(), value);
            if value.is_nan() || value > PROVED {
                return Err(format!("{name}: {value:.3e} exceeds {PROVED:.1e}"));
            }
        }
        Ok(residuals)
    }

    /// Checks forces that prove that no motion is compatible with the supports.
    pub(crate) fn check_ray(&self, ray: &SpaceField) -> Result<f64, String> {
        if self.problem.non_associated() {
            return Err("without associated flow blocks have more motions than the forces refute".into());
        }
        let value = space_settlement_ray(&self.problem, &self.openings, ray);
        if value <= RAY { Ok(value) } else { Err(format!("settlement_ray: {value:.3e} exceeds {RAY:.1e}")) }
    }

    /// Returns the motions of all bodies from the motions of the free bodies.
    pub(crate) fn all(&self, motion: &[SpaceVelocity]) -> Vec<SpaceVelocity> {
        let of = |(free, own): (&Option<usize>, &Option<SpaceVelocity>)| match free {
            Some(free) => motion[*free],
            None => own.unwrap_or([0.0; 6]),
        };
        self.problem.free.iter().zip(&self.supports).map(of).collect()
    }

    /// Returns true if no support moves against another body.
    pub(crate) fn is_idle(&self) -> bool {
        self.openings.iter().flatten().flatten().all(|gap| *gap == 0.0)
    }
}

/// Adds field, displacements and residuals of the blocks due to their settlements to the result of a stage that stands. If
/// nothing is proved, the stage is stalled. Returns true if some support has moved against another body.
pub(super) fn follow_supports(
    input: &CaseInput,
    space: &SpaceCase,
    (index, problem): (usize, &SpaceProblem),
    result: &mut CaseResult,
) -> bool {
    let factor = result.proof.field_factor.unwrap_or(0.0);
    let moved = Moved::new(space, input.stages, index, problem, factor);
    if moved.is_idle() {
        return false;
    }
    let selected = input.of_stages.get(index).and_then(Option::as_ref).unwrap_or(input.solver);
    let mut refusal = "no solver supports scenes in space".to_string();
    for (_, solver) in space_solvers(selected) {
        let found = match solver.settle_space(&moved.problem, &moved.openings) {
            SpaceSettled::Follows { field, motion } => {
                let gap = gap_in_space(input.settings.tolerance);
                moved.check(&field, &motion, gap).map(|residuals| {
                    result.certificate.residuals.extend(residuals);
                    result.proof = proof(SpaceProof {
                        field: Some(field_entries(problem, &field)),
                        motion: Some(entries_of_all(space, problem, &moved.all(&motion))),
                        ..SpaceProof::default()
                    });
                    result.proof.field_factor = Some(factor);
                    if problem.non_associated() {
                        result.flow_read_as = Some("associated".into());
                        result.notes.push(ASSOCIATED.into());
                    }
                })
            }
            SpaceSettled::Blocked(ray) => moved.check_ray(&ray).map(|residual| {
                result.status = Status::NoEquilibrium;
                result.certificate = Certificate {
                    passed: true,
                    residuals: BTreeMap::from([("settlement_ray".to_string(), residual)]),
                    failures: Vec::new(),
                };
                result.proof = proof(SpaceProof { ray: Some(field_entries(problem, &ray)), ..SpaceProof::default() });
                result.notes.push(BLOCKED.into());
            }),
            SpaceSettled::Refused(why) => Err(why),
        };
        match found {
            Ok(()) => return true,
            Err(why) => refusal = why,
        }
    }
    result.status = Status::Stalled;
    result.certificate.passed = false;
    result.certificate.failures.push(refusal.clone());
    result.notes.push(refusal);
    true
}

fn proof(space: SpaceProof) -> ProofFields {
    ProofFields { space: Some(Box::new(space)), ..ProofFields::default() }
}

const ASSOCIATED: &str =
    "blocks follow their supports with associated flow: slip opens a contact by its friction angle";

const BLOCKED: &str = "rigid blocks cannot follow their supports: no motion that the contacts allow is compatible with the support \
     displacements, and forces would grow without bound";
