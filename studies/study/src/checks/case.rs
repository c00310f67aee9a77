//! Checks one case: its label, its stages, and the claims of limit analysis or of a path.

use crate::checks::findings::Findings;
use crate::checks::misfits;
use crate::checks::tolerances::GEOMETRY;
use crate::checks::{carried, limit, outputs, path, space};
use crate::results::{CaseResult, LoadEntry};
use crate::solve::load_entries::load_entries;
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
    let (label, has) = (&result.label, "the study has");
    findings.expect_entry(label.variant == case.variant, "variant", (&label.variant, has, &case.variant));
    findings.expect_entry(label.scene == case.scene, "scene", (&label.scene, has, &case.scene));
    let same = label.parameters == case.parameters;
    findings.expect_entry(same, "parameters", (&label.parameters, has, &case.parameters));
    let loads = load_entries(case);
    let same = same_loads(&result.loads, &loads);
    findings.expect(same, "loads: the stored weights and forces differ from those that the study gives");
    let last = result.stages.len().checked_sub(1).ok_or("stages is empty; every case has at least one stage")?;
    case.stages.get(last).ok_or("stages has more entries than the study has stages")?;
    verify_stages(case, result, last, findings);
    if result.status == Status::Stalled {
        findings.expect(
            result.load_factor.is_none(),
            "load_factor is a number, but a case with the status stalled proves none",
        );
        return Ok(());
    }
    // No stored data can prove this case. It is solved again, and every number is compared.
    if !case.output_fields && result.has_no_fields() {
        return Ok(());
    }
    if let Some(space) = &case.space {
        return space::verify(case, space, result, last, findings);
    }
    outputs::verify_origin(result, findings);
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
    let done: Vec<&String> = result.stages.iter().map(|stage| &stage.name).collect();
    let names: Vec<&String> = case.stages.iter().take(done.len()).map(|stage| &stage.name).collect();
    findings.expect_entry(done == names, "the list of names in stages", (&done, "the study has", &names));
    let end = result.stages[last].status;
    findings.expect_entry(end == result.status, "status", (result.status, "the last entry of stages has", end));
    let fallen = result.stages[..last].iter().find(|stage| stage.status != Status::Stands);
    if let Some(stage) = fallen.filter(|_| !matches!(result.status, Status::NoEquilibrium | Status::Stalled)) {
        let entry = format!("the status of stage \"{}\"", stage.name);
        findings.expect_entry(
            false,
            &entry,
            (stage.status, "a later stage was computed, so it must be", Status::Stands),
        );
    }
    for (done, stage) in result.stages[..last].iter().zip(&case.stages) {
        let reached = matches!(stage.target, Target::Factor(factor) if done.factor == Some(factor));
        let fine = reached || done.status != Status::Stands;
        if let (false, Target::Factor(factor)) = (fine, stage.target) {
            let entry = format!("the factor of stage \"{}\"", done.name);
            findings.expect_entry(false, &entry, (done.factor, "the study asks for", factor));
        } else {
            findings
                .expect(fine, &format!("stage \"{}\" stands, but the study raises its load until collapse", done.name));
        }
        let by_path = card(PluginKind::PathSolver, &result.solver).is_some();
        let settled = by_path || case.stages.iter().any(|stage| !stage.settlements.is_empty());
        findings.expect(
            settled || done.hinges.is_empty(),
            &format!("stage \"{}\" has hinges, but limit analysis gives none to a stage that stands", done.name),
        );
    }
}
