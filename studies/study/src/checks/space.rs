//! Checks a result of limit analysis in space: the certificate from the stored forces and motion, bounds and factors.

use crate::checks::findings::Findings;
use crate::checks::limit::{compare_verdict, verify_reached};
use crate::checks::mechanism::compare;
use crate::results::stage_start::search_start;
use crate::results::{CaseResult, SpaceMotionEntry};
use crate::solve::ours::is_ours;
use crate::solve::space::space_problem;
use crate::solve::space_entries::{StoredInSpace, gap_in_space, stored_mechanism};
use crate::solve::space_settlement::Moved;
use crate::study::{Case, SpaceCase};
use std::collections::BTreeMap;
use voussoir_core::certificate::{Certificate, Verdict};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{Greatest, LowerProofKind, Status};
use voussoir_core::model::Target;
use voussoir_core::space::{SpaceClaim, SpaceField, SpaceNonAssociated, SpaceProblem, SpaceVerdict, certify_space};

/// Greatest difference of stored and given motions of supports, relative to the greatest motion: rounding.
const SAME_MOTION: f64 = 1e-12;

/// Checks the result of a case in space that ended in stage `last`.
pub(crate) fn verify(
    case: &Case,
    space: &SpaceCase,
    result: &CaseResult,
    last: usize,
    findings: &mut Findings,
) -> Result<(), String> {
    let stage = &case.stages[last];
    let (start, target) = match stage.target {
        Target::Collapse => (search_start(stage), stage.factor_max),
        Target::Factor(factor) => (factor.min(0.0), factor),
    };
    let problem = space_problem(space, &space.loads(&case.stages)[last])?;
    let proof = result.proof.space.as_deref().cloned().unwrap_or_default();
    let stored = StoredInSpace::read(space, &problem, &proof)?;
    let read = result.flow_read_as.as_deref() == Some("associated");
    let flows = space.non_associated() && result.status != Status::Stalled;
    let bounded = matches!(result.status, Status::Collapse | Status::Open);
    let searched = result.status == Status::Stands && is_ours(&result.solver);
    let own = (flows && !read && (bounded || searched)).then(|| SpaceNonAssociated {
        associated_factor: result.non_associated.associated_load_factor,
        associated_motion: stored.associated_motion.clone(),
        searched: lower_end(result, start),
    });
    let field_factor = result.proof.field_factor.unwrap_or(start);
    let claim = SpaceClaim {
        hint: result.status,
        target,
        start,
        factor: result.load_factor,
        field_factor,
        field: stored.field.as_ref(),
        motion: stored.motion.as_deref(),
        ray: stored.ray.as_ref(),
        non_associated: own.as_ref(),
        search_is_trusted: is_ours(&result.solver),
    };
    let gap = gap_in_space(case.solver.settings.tolerance);
    let moved = space.settles(last).then(|| Moved::new(space, &case.stages, last, &problem, field_factor));
    let moved = moved.filter(|moved| !moved.is_idle());
    // If no motion refutes the loads, the motion of the supports is refuted.
    let blocked = moved.as_ref().filter(|_| result.status == Status::NoEquilibrium && stored.motion.is_none());
    let SpaceVerdict { mut certificate, status, bounds, greatest } = match blocked {
        Some(moved) => refuted(moved, stored.ray.as_ref()),
        None => certify_space(&problem, &claim, gap),
    };
    if let Some(moved) = moved.filter(|_| status == Status::Stands) {
        match followed(&moved, &stored, gap) {
            Ok(residuals) => certificate.residuals.extend(residuals),
            Err(why) => findings.expect(false, &why),
        }
    }
    let verdict = Verdict { certificate, status, bounds, greatest, start_is_carried: false };
    compare_verdict(result, &verdict, findings);
    let idle = problem.varying.iter().flatten().all(|component| *component == 0.0);
    verify_reached(result, stage, (idle, field_factor), last, findings);
    findings.expect(
        read == (flows && own.is_none()) && (read || result.flow_read_as.is_none()),
        "flow_read_as must be \"associated\" if some law of the study has another flow that the result does not prove, and null otherwise",
    );
    findings.expect(
        (own.is_some() && bounded)
            || (result.non_associated.associated_load_factor.is_none() && stored.associated_motion.is_none()),
        "associated_load_factor and associated_motion belong to collapse with the laws' own flow",
    );
    let flow = if own.is_some() { FlowRule::NonAssociated } else { FlowRule::Associated };
    verify_mechanism(space, &problem, (result, proof.motion.as_deref()), flow, findings);
    let plane = result.feasible_interval.is_some() || result.proof.thrust_line.is_some();
    findings.expect(!plane, "feasible_interval and thrust_line belong to plane scenes");
    let hinges = result.stages.iter().all(|stage| stage.hinges.is_empty());
    findings.expect(hinges, "hinges of a stage belong to plane scenes");
    if verdict.status != result.status {
        findings.0.extend(verdict.certificate.failures);
    }
    Ok(())
}

/// Returns the lower end of the least load by a search, if the result states one.
fn lower_end(result: &CaseResult, start: f64) -> Option<f64> {
    let proof = result.non_associated.lower_proof.as_ref()?;
    match proof.by {
        LowerProofKind::Search => result.bounds.and_then(|bounds| bounds[0]).or(Some(f64::NAN)),
        LowerProofKind::Start => Some(start),
        LowerProofKind::Products | LowerProofKind::Associated => Some(f64::NAN),
    }
}

/// Compares the mechanism with the one that the stored velocities give. Displacements of a case that stands are no mechanism.
fn verify_mechanism(
    space: &SpaceCase,
    problem: &SpaceProblem,
    (result, motion): (&CaseResult, Option<&[SpaceMotionEntry]>),
    flow: FlowRule,
    findings: &mut Findings,
) {
    let unique = result.mechanism.as_ref().and_then(|stored| stored.unique);
    let moving = motion.filter(|_| result.status != Status::Stands);
    let recomputed = moving.and_then(|motion| stored_mechanism(space, problem, motion, (unique, flow)));
    compare(result.mechanism.as_ref(), recomputed.as_ref(), findings);
}

/// Returns the residuals of stored displacements of blocks that follow their supports; fails with the reason.
fn followed(moved: &Moved, stored: &StoredInSpace, gap: f64) -> Result<BTreeMap<String, f64>, String> {
    let (Some(field), Some(motion), Some(of_all)) = (&stored.field, &stored.motion, &stored.of_all) else {
        return Err("field and motion must be given for a stage in which supports have moved".into());
    };
    let given = moved.all(motion);
    let greatest = given.iter().flatten().fold(0.0f64, |most, v| most.max(v.abs()));
    let off = given.iter().flatten().zip(of_all.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if off > SAME_MOTION * greatest {
        return Err(format!("motion: supports differ from the study by {off:.1e}"));
    }
    moved.check(field, motion, gap)
}

/// Returns the verdict on forces that prove that no motion is compatible with the supports.
fn refuted(moved: &Moved, ray: Option<&SpaceField>) -> SpaceVerdict {
    let found = ray.ok_or_else(|| "ray is missing".to_string()).and_then(|ray| moved.check_ray(ray));
    let (status, residuals, failures) = match found {
        Ok(value) => (Status::NoEquilibrium, BTreeMap::from([("settlement_ray".to_string(), value)]), Vec::new()),
        Err(why) => (Status::Stalled, BTreeMap::new(), vec![why]),
    };
    let certificate = Certificate { passed: failures.is_empty(), residuals, failures };
    SpaceVerdict { certificate, status, bounds: [None; 2], greatest: Greatest::Open }
}
