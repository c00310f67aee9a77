//! Checks one case: its label, its stages, and the claims of limit analysis or of a path.

use super::findings::Findings;
use super::fit::misfits;
use super::tolerances::GEOMETRY;
use super::{carried, limit, path};
use crate::results::load_entries::load_entries;
use crate::results::{CaseResult, LoadEntry};
use crate::study::Case;
use voussoir_core::limit::Status;
use voussoir_core::model::Target;
use voussoir_core::plugin::{PluginKind, card};

/// Returns the findings about a result.
pub fn verify_case(case: &Case, result: &CaseResult) -> Vec<String> {
    let misfits = misfits(case, result);
    if !misfits.is_empty() {
        return misfits;
    }
    let mut findings = Findings::default();
    match recompute(case, result, &mut findings) {
        Ok(()) => findings.0,
        Err(why) => vec![why],
    }
}

fn recompute(case: &Case, result: &CaseResult, findings: &mut Findings) -> Result<(), String> {
    findings.expect(result.label.variant == case.variant, "variant is not that of the study");
    findings.expect(result.label.scene == case.scene, "scene is not that of the study");
    findings.expect(result.label.parameters == case.parameters, "parameters are not those of the study");
    let loads = load_entries(case);
    findings.expect(same_loads(&result.loads, &loads), "loads do not match the study");
    let last = result.stages.len().checked_sub(1).ok_or("no stage")?;
    case.stages.get(last).ok_or("more stages than the study has")?;
    verify_stages(case, result, last, findings);
    if result.status == Status::Stalled {
        findings.expect(result.load_factor.is_none(), "stalled with a load factor");
        return Ok(());
    }
    // No stored data can prove this case. It is solved again, and every number is compared.
    if !case.output_fields && result.has_no_fields() {
        return Ok(());
    }
    carried::verify(case, result, findings)?;
    match card(PluginKind::PathSolver, &result.solver) {
        Some(_) => path::verify(case, result, findings),
        None => limit::verify(case, result, last, findings),
    }
}

/// Returns true if stored loads match the study; positions and sums may differ by rounding.
fn same_loads(stored: &[LoadEntry], loads: &[LoadEntry]) -> bool {
    let numbers = |list: &[LoadEntry]| list.iter().map(|l| [l.resultant, l.point].concat()).collect::<Vec<_>>();
    let words = |l: &LoadEntry| (l.stage.clone(), l.what, l.block.clone());
    stored.iter().map(words).eq(loads.iter().map(words)) && GEOMETRY.same_rows(&numbers(stored), &numbers(loads))
}

/// Checks names, factors and statuses of the stages up to the last that was begun.
fn verify_stages(case: &Case, result: &CaseResult, last: usize, findings: &mut Findings) {
    let named = result.stages.iter().zip(&case.stages).all(|(done, stage)| done.name == stage.name);
    findings.expect(named, "stages are not those of the study");
    findings.expect(result.stages[last].status == result.status, "status is not that of the last stage");
    let earlier_stand = result.stages[..last].iter().all(|s| s.status == Status::Stands);
    findings.expect(
        earlier_stand || matches!(result.status, Status::NoEquilibrium | Status::Stalled),
        "an earlier stage did not stand",
    );
    for (done, stage) in result.stages[..last].iter().zip(&case.stages) {
        let reached = matches!(stage.target, Target::Factor(factor) if done.factor == Some(factor));
        let fine = reached || done.status != Status::Stands;
        findings.expect(fine, "the factor of an earlier stage is not that of the study");
        let by_path = card(PluginKind::PathSolver, &result.solver).is_some();
        let settled = by_path || case.stages.iter().any(|stage| !stage.settlements.is_empty());
        findings.expect(settled || done.hinges.is_empty(), "an earlier stage has hinges");
    }
}
