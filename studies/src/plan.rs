//! The plan of a study: what will be solved, after everything that the scene does not need is gone.

use crate::answer::start_of;
use crate::kinds::run::choice;
use crate::study::{Case, Study};
use std::fmt::Write;
use voussoir_core::assembly::{Bond, Target, stage_loads};
use voussoir_core::limit::LimitProblem;
use voussoir_core::strength::Tangential;

/// The plan in words, for the first case; the others differ by their parameters only.
pub fn plan(study: &Study) -> String {
    let mut text = format!("study \"{}\" ({}): {} case(s)\n", study.name, study.kind, study.cases.len());
    match study.cases.first() {
        Some(case) => plan_case(case, &mut text),
        None => text.push_str("nothing to solve\n"),
    }
    text
}

fn plan_case(case: &Case, text: &mut String) {
    let assembly = &case.assembly;
    let bonded = assembly.joints.iter().filter(|joint| joint.bond == Bond::Bonded).count();
    let _ = writeln!(
        text,
        "case 0: {} bodies, {} joints, of which {bonded} bonded (they vanish)",
        assembly.bodies.len(),
        assembly.joints.len()
    );
    for (stage, loads) in case.stages.iter().zip(stage_loads(assembly, &case.stages)) {
        let problem = match LimitProblem::new(assembly, &loads) {
            Ok(problem) => problem,
            Err(why) => {
                let _ = writeln!(text, "stage \"{}\": {why}", stage.name);
                continue;
            }
        };
        let count = |kind: Tangential| problem.joints.iter().filter(|j| j.strength.tangential() == kind).count();
        let blocks = problem.joints.iter().filter(|joint| joint.strength.block.is_some()).count();
        let _ = writeln!(
            text,
            "stage \"{}\": {} free bodies (rigid: no mesh), {} joints: {} with friction, {} stuck and {} frictionless (no tangential rows), {blocks} that can crush",
            stage.name,
            problem.groups,
            problem.joints.len(),
            count(Tangential::Friction),
            count(Tangential::Stuck),
            count(Tangential::Free),
        );
        let tag = crate::answer::first_solver(&choice(case), &problem);
        let _ = match stage.target {
            Target::Collapse => {
                writeln!(text, "  {tag}: stands at factor {}? then the greatest factor", start_of(stage))
            }
            Target::Factor(factor) => {
                writeln!(text, "  {tag}: stands up to factor {factor}? (left to the next stage where that starts here)")
            }
        };
        if tag == "limit_chain" {
            let _ = writeln!(
                text,
                "  chains of bodies: three redundants each and the factor, instead of {} equations",
                3 * problem.groups
            );
        }
    }
}
