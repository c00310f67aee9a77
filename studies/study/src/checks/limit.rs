//! Checks a result of limit analysis: the certificate from the stored fields, bounds, factors, mechanism.

use crate::checks::fields::{EQUAL, close, contacts, velocities};
use crate::checks::findings::Findings;
use crate::checks::mechanism::{compare, joints, same_line};
use crate::checks::tolerances::GEOMETRY;
use crate::results::stage_start::search_start;
use crate::results::thrust_line::thrust_line;
use crate::results::{CaseResult, FillEntry};
use crate::solve::load_entries::fill_entries;
use crate::solve::ours::is_ours;
use crate::study::Case;
use voussoir_core::certificate::{
    CentroidVelocity, Claim, ContactForce, Hinge, NonAssociatedClaim, Verdict, certify, mechanism, support_motions,
};
use voussoir_core::law::{FlowRule, is_associated};
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Bond, Stage, StageLoads, Target, stage_loads};

/// Stored forces and velocities, in the form that certificates use.
struct Stored {
    field: Option<Vec<ContactForce>>,
    ray: Option<Vec<ContactForce>>,
    motion: Option<Vec<CentroidVelocity>>,
    associated_motion: Option<Vec<CentroidVelocity>>,
}

impl Stored {
    fn read(assembly: &Assembly, result: &CaseResult) -> Result<Self, String> {
        let forces = |entries: Option<&[_]>| entries.map(|entries| contacts(assembly, entries)).transpose();
        let motions = |entries: Option<&[_]>| entries.map(|entries| velocities(assembly, entries)).transpose();
        Ok(Stored {
            field: forces(result.proof.field.as_deref())?,
            ray: forces(result.proof.ray.as_deref())?,
            motion: motions(result.proof.motion.as_deref())?,
            associated_motion: motions(result.proof.associated_motion.as_deref())?,
        })
    }
}

/// Returns true if the flow of some joint is not associated.
fn non_associated(assembly: &Assembly) -> bool {
    assembly.joints.iter().any(|joint| match joint.bond {
        Bond::Bonded => false,
        Bond::Law(law) => {
            let facets = assembly.catalogue.laws[law].1.facets();
            facets.is_some_and(|facets| !is_associated(&facets))
        }
    })
}

/// Checks the result of a case that ended in stage `last`.
pub(crate) fn verify(case: &Case, result: &CaseResult, last: usize, findings: &mut Findings) -> Result<(), String> {
    let (assembly, stage) = (&case.assembly, &case.stages[last]);
    let stored = Stored::read(assembly, result)?;
    let loads = &stage_loads(assembly, &case.stages)[last];
    let fill: Vec<f64> = result.proof.fill.iter().map(|entry| entry.force).collect();
    let expected = if stored.field.is_some() { fill_entries(assembly, &fill, &loads.fill_bounds) } else { Vec::new() };
    let same = same_fill(&result.proof.fill, &expected);
    findings
        .expect(same, "fill: places, directions or bounds of the stored forces differ from those that the study gives");
    let start = match stage.target {
        Target::Collapse => search_start(stage),
        // A stage with decreasing loads is checked at its end, any other stage at its start.
        Target::Factor(factor) => factor.min(0.0),
    };
    let non_associated = non_associated(assembly);
    let associated_factor = result.non_associated.associated_load_factor;
    let own = (non_associated && result.flow_read_as.is_none()) || associated_factor.is_some();
    findings.expect(
        !own || result.flow_read_as.is_none(),
        "flow_read_as and associated_load_factor are both given; a result has only one of them",
    );
    // If no motion refutes the loads, the motion of the supports is refuted.
    let blocked = result.status == Status::NoEquilibrium && stored.motion.is_none();
    let supports = blocked.then(|| support_motions(assembly, &case.stages, last)).transpose()?;
    let infinite = [f64::NEG_INFINITY, f64::INFINITY];
    let claim = Claim {
        hint: result.status,
        target: match stage.target {
            Target::Factor(factor) => factor,
            Target::Collapse => stage.factor_max,
        },
        factor: result.load_factor,
        field_factor: result.proof.field_factor.unwrap_or(start),
        start,
        field: stored.field.as_deref(),
        start_field: None,
        fill: &fill,
        motion: stored.motion.as_deref(),
        ray: stored.ray.as_deref(),
        supports: supports.as_deref(),
        feasible_interval: result.feasible_interval.map(|ends| [0, 1].map(|i| ends[i].unwrap_or(infinite[i]))),
        non_associated: own.then_some(NonAssociatedClaim {
            proved_lower: result.bounds.and_then(|bounds| bounds[0]),
            lower_proof: result.non_associated.lower_proof.as_ref(),
            associated_factor,
            associated_motion: stored.associated_motion.as_deref(),
            search_is_trusted: is_ours(&result.solver),
            associated_field: None,
        }),
    };
    let verdict = certify(assembly, loads, &claim, case.solver.settings.tolerance);
    compare_verdict(result, &verdict, findings);
    verify_factors(result, (stage, loads), &claim, last, findings);
    verify_bracket(result, findings);
    let reading = if own { FlowRule::NonAssociated } else { FlowRule::Associated };
    verify_mechanism(assembly, result, &stored, reading, last, findings);
    let fits = result.flow_read_as.as_deref().is_none_or(|word| word == "associated" && non_associated);
    findings.expect(fits, "flow_read_as must be \"associated\", and only if some law of the study has another flow");
    if verdict.status != result.status {
        findings.0.extend(verdict.certificate.failures);
    }
    Ok(())
}

/// Returns true if forces of the fill act at the places of the scene and are within its bounds.
fn same_fill(stored: &[FillEntry], expected: &[FillEntry]) -> bool {
    let numbers =
        |list: &[FillEntry]| list.iter().map(|f| [f.point, f.direction, f.bounds].concat()).collect::<Vec<_>>();
    let words = |f: &FillEntry| (f.block.clone(), f.force);
    stored.iter().map(words).eq(expected.iter().map(words)) && GEOMETRY.same_rows(&numbers(stored), &numbers(expected))
}

/// The source of values that are recomputed from the stored forces and motion.
const EVIDENCE: &str = "the stored forces and motion give";

/// Compares the stored status, certificate and bounds with those that the stored evidence proves.
pub(super) fn compare_verdict(result: &CaseResult, verdict: &Verdict, findings: &mut Findings) {
    let Verdict { certificate, status, bounds, greatest, .. } = verdict;
    findings.expect_entry(*status == result.status, "status", (result.status, EVIDENCE, status));
    findings.expect_entry(*greatest == result.greatest, "greatest", (result.greatest, EVIDENCE, greatest));
    let passed = result.certificate.passed;
    findings.expect_entry(certificate.passed == passed, "certificate.passed", (passed, EVIDENCE, certificate.passed));
    for (name, value) in &certificate.residuals {
        let stored = result.certificate.residuals.get(name);
        let same = stored.is_some_and(|stored| (stored - value).abs() <= EQUAL);
        findings.expect_entry(same, &format!("certificate.residuals.{name}"), (stored, EVIDENCE, value));
    }
    let fits = match result.status {
        Status::Collapse => result.load_factor.is_some(),
        Status::Open => true,
        _ => result.load_factor.is_none(),
    };
    let expected = if result.status == Status::Collapse { "a number" } else { "null" };
    findings.expect(fits, &format!("load_factor must be {expected} with this status"));
    let stored = result.bounds.unwrap_or_default();
    let bounds_match = (0..2).all(|end| match (stored[end], bounds[end]) {
        (Some(a), Some(b)) => close(a, b),
        (None, None) => true,
        _ => false,
    });
    findings.expect_entry(bounds_match, "bounds", (result.bounds, EVIDENCE, bounds));
}

/// Checks the curve of the bracket: its width never grows, and it ends at the bounds.
fn verify_bracket(result: &CaseResult, findings: &mut Findings) {
    let curve = &result.non_associated.bracket;
    let closes = curve.windows(2).all(|pair| {
        let fell = match (pair[0].found, pair[1].found) {
            (Some(before), Some(after)) => after <= before,
            (before, _) => before.is_none(),
        };
        let later = pair[0].by != pair[1].by || pair[0].work <= pair[1].work;
        pair[0].lower <= pair[1].lower && fell && later
    });
    let ends = curve.last().is_none_or(|end| {
        let (Some([lower, _]), Some(factor)) = (result.bounds, result.load_factor) else { return false };
        let lower = lower.unwrap_or(end.lower);
        // Rounding of multipliers reduces the bound by up to 1e-6 of the factor.
        let near = 2e-6 * factor.abs();
        (end.lower - lower).abs() <= near && end.found.is_some_and(|found| (found - factor).abs() <= near)
    });
    findings
        .expect(closes && ends, "bracket: its two loads must approach each other and end at bounds and load_factor");
}

/// Checks the factors of the last stage, of the field and of the feasible interval.
fn verify_factors(
    result: &CaseResult,
    (stage, loads): (&Stage, &StageLoads),
    claim: &Claim,
    index: usize,
    findings: &mut Findings,
) {
    let start = claim.start;
    if let Some([Some(low), Some(high)]) = result.feasible_interval {
        let apart = low <= high && !(low <= start && start <= high);
        let words = format!(
            "feasible_interval is [{low}, {high}], but it must not contain the factor {start} at which the stage begins"
        );
        findings.expect(apart, &words);
    }
    let idle = loads.varying.iter().all(|w| *w == [0.0; 3]);
    verify_reached(result, stage, (idle, claim.field_factor), index, findings);
}

/// Checks the factor that the last stage reached, and the factor of the field of a case that stands. `idle`: the loads of the
/// stage do not grow.
pub(super) fn verify_reached(
    result: &CaseResult,
    stage: &Stage,
    (idle, field_factor): (bool, f64),
    last: usize,
    findings: &mut Findings,
) {
    let last = &result.stages[last];
    let entry = format!("the factor of stage \"{}\"", last.name);
    if let (Some(reached), Target::Factor(factor)) = (last.factor, stage.target) {
        let found = matches!(result.status, Status::Collapse | Status::Open);
        let (source, expected) = match found {
            true => ("load_factor is", result.load_factor.unwrap_or(f64::NAN)),
            false => ("the study asks for", factor),
        };
        findings.expect_entry(close(reached, expected), &entry, (reached, source, expected));
    }
    if let (Status::Collapse | Status::Open, Target::Collapse) = (result.status, stage.target) {
        let same = last.factor == result.load_factor;
        findings.expect_entry(same, &entry, (last.factor, "load_factor is", result.load_factor));
    }
    if result.status == Status::Stands {
        let reached = match stage.target {
            Target::Factor(factor) => factor,
            Target::Collapse => stage.factor_max,
        };
        let there = idle || close(field_factor, reached);
        let entry = "field_factor";
        findings.expect_entry(
            there,
            entry,
            (field_factor, "the case stands, so it must be the target of the stage,", reached),
        );
    }
}

/// Compares mechanism, hinges of the last stage and thrust line with those computed from motion and forces.
fn verify_mechanism(
    assembly: &Assembly,
    result: &CaseResult,
    stored: &Stored,
    reading: FlowRule,
    last: usize,
    findings: &mut Findings,
) {
    let unique = result.mechanism.as_ref().and_then(|m| m.unique);
    let recomputed = stored.motion.as_ref().and_then(|motion| mechanism(assembly, motion, unique, reading));
    compare(result.mechanism.as_ref(), recomputed.as_ref(), findings);
    let hinges: Vec<Hinge> = result.mechanism.iter().flat_map(|m| &m.hinges).cloned().collect();
    // If supports have moved, the hinges follow from the displacements. They are compared with solving again.
    let settled = result.path.displacements.is_some() && result.mechanism.is_none();
    let own = &result.stages[last];
    if !settled && own.hinges != hinges {
        let entry = format!("stage \"{}\": the list of joints with hinges", own.name);
        let lists = (joints(&own.hinges), "mechanism.hinges has", joints(&hinges));
        let numbers = "hinges differ from mechanism.hinges in side, point or rotation";
        match lists.0 == lists.2 {
            true => findings.expect(false, &format!("stage \"{}\": {numbers}", own.name)),
            false => findings.expect_entry(false, &entry, lists),
        }
    }
    let line = stored.field.as_ref().and_then(|field| thrust_line(assembly, field));
    let same = same_line(&line, &result.proof.thrust_line);
    findings.expect(same, "thrust_line: its points differ from those that the stored forces give");
}
