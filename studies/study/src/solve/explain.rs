//! Explains a study: the problem that will be solved, without the parts that the scene does not need.

use super::auto::{TaggedPathSolver, limit_solvers, path_solvers, space_solvers, willing};
use super::case_input::CaseInput;
use super::explain_bridge::explain_bridge;
use crate::results::stage_start::search_start;
use crate::study::{Case, SpaceCase, Study};
use std::fmt::Write;
use voussoir_core::law::Tangential;
use voussoir_core::limit::LimitProblem;
use voussoir_core::model::{Bond, Target, stage_loads};
use voussoir_core::path::{LoadStepEnd, PathProblem};
use voussoir_core::plugin::{PluginKind, card};

/// Describes the problem of the first case in words; the other cases differ only by their parameters.
pub fn explain(study: &Study) -> String {
    explain_first(&study.name, &study.kind, study.count(), study.case(0).as_deref())
}

/// Describes a study by its name, kind, number of cases and first case.
pub fn explain_first(name: &str, kind: &str, cases: usize, first: Option<&Case>) -> String {
    let mut text = format!("study \"{name}\" ({kind}): {cases} case(s)\n");
    match first {
        Some(case) => explain_case(case, &mut text),
        None => text.push_str("nothing to solve\n"),
    }
    text
}

fn explain_case(case: &Case, text: &mut String) {
    if let Some(space) = &case.space {
        return explain_space(case, space, text);
    }
    let assembly = &case.assembly;
    let bonded = assembly.joints.iter().filter(|joint| joint.bond == Bond::Bonded).count();
    let _ = writeln!(
        text,
        "case 0: {} bodies, {} joints, of which {bonded} bonded (they vanish)",
        assembly.bodies.len(),
        assembly.joints.len()
    );
    if let Some(bridge) = &assembly.bridge {
        explain_bridge(case, bridge, text);
    }
    let input = CaseInput::of(case);
    let solvers = path_solvers(&input);
    if !solvers.is_empty() {
        return explain_path(case, &solvers, text);
    }
    for (stage, loads) in case.stages.iter().zip(stage_loads(assembly, &case.stages)) {
        let problem = match LimitProblem::new(assembly, &loads) {
            Ok(problem) => problem,
            Err(why) => {
                let _ = writeln!(text, "stage \"{}\": {why}", stage.name);
                continue;
            }
        };
        let fill = problem.joints.iter().filter(|joint| joint.fill.is_some()).count();
        let joints = || problem.joints.iter().filter(|joint| joint.fill.is_none());
        let count = |kind: Tangential| joints().filter(|j| j.strength.tangential() == kind).count();
        let blocks = problem.joints.iter().filter(|joint| joint.strength.block.is_some()).count();
        let _ = writeln!(
            text,
            "stage \"{}\": {} free bodies (rigid: no mesh), {} joints: {} with friction, {} stuck and {} frictionless (no tangential rows), {blocks} that can crush",
            stage.name,
            problem.groups,
            problem.joints.len() - fill,
            count(Tangential::Friction),
            count(Tangential::Stuck),
            count(Tangential::Free),
        );
        let tag = limit_solvers(input.solver, &problem).next().map_or("no solver", |(tag, _)| tag).to_string();
        let _ = match stage.target {
            Target::Collapse => {
                writeln!(
                    text,
                    "  {tag}: checks that factor {} is carried, then finds the greatest factor",
                    search_start(stage)
                )
            }
            Target::Factor(factor) => {
                writeln!(
                    text,
                    "  {tag}: checks that factor {factor} is carried (left to the next stage if that starts here)"
                )
            }
        };
        if let Some(card) = card(PluginKind::LimitSolver, &tag) {
            let _ = writeln!(text, "  {tag}: {}", card.summary);
        }
    }
}

fn explain_space(case: &Case, space: &SpaceCase, text: &mut String) {
    let bodies = &space.assembly.bodies;
    let held = bodies.iter().filter(|body| body.fixed).count();
    let points: usize = space.assembly.contacts.iter().map(|contact| contact.points.len()).sum();
    let contacts = space.assembly.contacts.len();
    let _ = writeln!(
        text,
        "case 0: {} bodies in space, {held} of them supports; {contacts} plane contacts with {points} points, each with three forces",
        bodies.len()
    );
    let tag = space_solvers(&case.solver.solver).first().map_or("no solver", |(tag, _)| *tag).to_string();
    for stage in &case.stages {
        let until = match stage.target {
            Target::Collapse => {
                format!("checks that factor {} is carried, then finds the greatest factor", search_start(stage))
            }
            Target::Factor(factor) => format!("checks that factor {factor} is carried"),
        };
        let _ = writeln!(text, "stage \"{}\": {tag}: {until}", stage.name);
    }
    if let Some(card) = card(PluginKind::LimitSolver, &tag) {
        let _ = writeln!(text, "  {tag}: {}", card.summary);
    }
}

fn explain_path(case: &Case, solvers: &[TaggedPathSolver], text: &mut String) {
    let settings = &case.solver.settings;
    let problem = match PathProblem::new(&case.assembly, &case.stages) {
        Ok(problem) => problem,
        Err(why) => {
            let _ = writeln!(text, "{}: {why}", solvers[0].0);
            return;
        }
    };
    let tag = match willing(solvers, &problem, settings) {
        Ok((tag, _)) => tag,
        Err((tag, why)) => {
            let _ = writeln!(text, "{tag}: {why}");
            return;
        }
    };
    let free = || problem.bodies.iter().filter(|body| !body.held);
    let yields = free().filter(|body| body.inelastic.is_some()).count();
    let elastic = free().filter(|body| body.flexibility.is_some()).count() - yields;
    let factorisations = problem.counters.get("condensation_factorisations").copied().unwrap_or(0);
    let _ = writeln!(
        text,
        "path: {} free bodies: {} rigid (no mesh), {elastic} elastic (condensed on their contact and load points) and {yields} that may \
         yield (condensed too until they do); {factorisations} factorisation(s), one for each shape",
        free().count(),
        free().count() - elastic - yields,
    );
    let points = problem.contacts.len();
    let bonded = problem.contacts.iter().filter(|contact| contact.law.is_bonded()).count();
    let softening = (0..points).filter(|contact| problem.response(*contact).is_some()).count();
    let _ = writeln!(
        text,
        "{points} contact points: {bonded} bonded, {} with facets, {softening} with tractions from gaps",
        points - bonded - softening,
    );
    let kinematics = if settings.finite { "finite" } else { "small" };
    for load_step in &problem.load_steps {
        let what = if load_step.gravity { "gravity" } else { "loads" };
        let end = match load_step.end {
            LoadStepEnd::Factor(factor) => format!("to factor {factor}"),
            LoadStepEnd::Collapse(most) => {
                let first = settings.ends_at_first_limit_point(load_step.stage);
                let until = if first { "until the first limit point" } else { "until collapse" };
                if most.is_finite() { format!("{until}, up to factor {most}") } else { until.into() }
            }
        };
        let stage = &case.stages[load_step.stage].name;
        let _ = writeln!(text, "  stage \"{stage}\", {what}: {tag}, {kinematics} displacements, {end}");
    }
}
