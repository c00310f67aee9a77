//! Checks a result of limit analysis in space: the certificate from the stored forces and motion, bounds and factors.

use crate::checks::findings::Findings;
use crate::checks::limit::{compare_verdict, verify_reached};
use crate::results::CaseResult;
use crate::results::stage_start::search_start;
use crate::solve::space::{StoredInSpace, gap_in_space, space_problem};
use crate::study::{Case, SpaceCase};
use voussoir_core::certificate::Verdict;
use voussoir_core::limit::Status;
use voussoir_core::model::Target;
use voussoir_core::space::{SpaceClaim, SpaceNonAssociated, SpaceVerdict, certify_space};

/// Checks the result of a case in space that ended in stage `last`.
pub(crate) fn verify(
    case: &Case,
    space: &SpaceCase,
    result: &CaseResult,
    last: usize,
    findings: &mut Findings,
) -> Result<(), String> {
    let stage = &case.stages[last];
    let problem = space_problem(space, &space.loads(&case.stages)[last])?;
    let proof = result.proof.space.as_deref().cloned().unwrap_or_default();
    let stored = StoredInSpace::read(space, &problem, &proof)?;
    let read = result.flow_read_as.as_deref() == Some("associated");
    let flows = space.non_associated() && result.status != Status::Stalled;
    let ends = matches!(result.status, Status::Collapse | Status::Open);
    let own = (flows && !read && ends).then(|| SpaceNonAssociated {
        associated_factor: result.non_associated.associated_load_factor,
        associated_motion: stored.associated_motion.clone(),
    });
    let (start, target) = match stage.target {
        Target::Collapse => (search_start(stage), stage.factor_max),
        Target::Factor(factor) => (factor.min(0.0), factor),
    };
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
    };
    let SpaceVerdict { certificate, status, bounds, greatest } =
        certify_space(&problem, &claim, gap_in_space(case.solver.settings.tolerance));
    let verdict = Verdict { certificate, status, bounds, greatest, start_is_carried: false };
    compare_verdict(result, &verdict, findings);
    let idle = problem.varying.iter().flatten().all(|component| *component == 0.0);
    verify_reached(result, stage, (idle, field_factor), last, findings);
    findings.expect(
        read == (flows && own.is_none()) && (read || result.flow_read_as.is_none()),
        "flow_read_as must be \"associated\" if some law of the study has another flow that the result does not prove, and null otherwise",
    );
    findings.expect(
        own.is_some() || (result.non_associated.associated_load_factor.is_none() && stored.associated_motion.is_none()),
        "associated_load_factor and associated_motion belong to collapse with the laws' own flow",
    );
    let plane = result.mechanism.is_some() || result.feasible_interval.is_some() || result.proof.thrust_line.is_some();
    findings.expect(!plane, "mechanism, feasible_interval and thrust_line belong to plane scenes");
    let hinges = result.stages.iter().all(|stage| stage.hinges.is_empty());
    findings.expect(hinges, "hinges of a stage belong to plane scenes");
    if verdict.status != result.status {
        findings.0.extend(verdict.certificate.failures);
    }
    Ok(())
}
