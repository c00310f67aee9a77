//! Which solver answers a case, and what it needs.

use super::case::Builder;
use super::{Kinematics, SolverChoice};
use crate::config::overlay::join;
use serde_json::{Map, Value as Json};
use voussoir_core::model::{Assembly, Bond};
use voussoir_core::plugin::{
    Capability, Card, PluginKind, Requirement, candidate, candidates, card, cards_of, describe,
};

fn solvers_that(fit: impl Fn(&Card) -> bool) -> Vec<&'static str> {
    candidates(PluginKind::LimitSolver).into_iter().filter(|card| fit(card)).map(|card| card.tag).collect()
}

fn offers(capability: Capability) -> bool {
    !solvers_that(|card| card.offers(capability)).is_empty()
}

fn or_none(tags: &[&str]) -> String {
    if tags.is_empty() { "none registered".into() } else { tags.join(", ") }
}

/// The solver that is asked for, and a mistake for each thing it needs and does not get.
pub(super) fn choose_solver(
    builder: &mut Builder<'_>,
    solver: &Json,
    resolved: &Map<String, Json>,
    assembly: Option<&Assembly>,
) -> Option<SolverChoice> {
    let tag = solver["solver"].as_str()?.to_string();
    let chosen = candidate(PluginKind::LimitSolver, &tag);
    let kinematics = if solver["kinematics"] == "finite" { Kinematics::Finite } else { Kinematics::Small };
    let finite = |card: &Card| card.offers(Capability::FINITE_DISPLACEMENTS);
    if kinematics == Kinematics::Finite && !chosen.map_or_else(|| offers(Capability::FINITE_DISPLACEMENTS), finite) {
        let able = solvers_that(finite);
        let message = match able.is_empty() {
            true => "no registered solver offers finite displacements".to_string(),
            false => {
                format!("solver \"{tag}\" does not offer finite displacements; solvers that do: {}", able.join(", "))
            }
        };
        builder.wrong("solver.kinematics", message, "set kinematics = \"small\"");
    }
    // `auto` needs at least what every solver needs.
    let everyone: Vec<Requirement> = cards_of(PluginKind::LimitSolver)
        .iter()
        .flat_map(|card| card.requires)
        .filter(|need| solvers_that(|solver| !solver.requires.contains(need)).is_empty())
        .copied()
        .collect();
    let asked = chosen.map_or(everyone.as_slice(), |chosen| chosen.requires);
    if let Some(assembly) = assembly {
        let used = |law: usize| assembly.joints.iter().any(|joint| joint.bond == Bond::Law(law));
        let laws = assembly.catalogue.laws.iter().enumerate().filter(|(law, _)| used(*law));
        let laws = laws.map(|(_, (name, _))| ("joints", name, PluginKind::InterfaceLaw));
        let materials =
            assembly.catalogue.materials.iter().map(|(name, _)| ("materials", name, PluginKind::BulkMaterial));
        for (table, name, kind) in laws.chain(materials) {
            let law = resolved[table][name]["law"].as_str().unwrap_or_default();
            let Some(card) = card(kind, law) else {
                continue;
            };
            for need in asked.iter().filter(|need| !card.meets(need)) {
                let able = solvers_that(|solver| solver.requires.iter().all(|need| card.meets(need)));
                let message = format!(
                    "solver \"{tag}\" needs {}, which {} \"{law}\" of [{table}.{name}] does not give",
                    describe(need),
                    kind.describe()
                );
                let help = format!("solvers that can take it: {}", or_none(&able));
                builder.wrong(&join(&join(table, name), "law"), message, help);
            }
        }
    }
    needs_deformation(builder, resolved, assembly, chosen, kinematics);
    if let Some(assembly) = assembly.filter(|_| chosen.is_none_or(|card| card.kind == PluginKind::PathSolver)) {
        let free = (0..assembly.bodies.len()).filter(|body| !assembly.bodies[*body].fixed);
        if let Some(why) = free.map(|body| assembly.fine_enough(body)).find_map(Result::err) {
            builder.wrong("scene.mesh.elements", why, "raise the numbers of elements of scene.mesh");
        }
    }
    let own = |key: &str| chosen.is_some_and(|card| card.parameters.iter().any(|p| p.name == key));
    let mut table = solver.as_object()?.clone();
    table.retain(|key, _| key == "solver" || own(key));
    let tolerance = solver["tolerance"].as_f64().unwrap_or(1e-9);
    Some(SolverChoice {
        tag,
        table: Json::Object(table),
        tolerance,
        kinematics,
        continuation: solver.get("continuation").cloned(),
        stop_displacement: solver["stop"]["displacement"].as_f64(),
        stop_factor: solver["stop"]["factor"].as_f64(),
    })
}

/// What only a path answers needs something that deforms, and no limit analysis.
fn needs_deformation(
    builder: &mut Builder<'_>,
    resolved: &Map<String, Json>,
    assembly: Option<&Assembly>,
    chosen: Option<&Card>,
    kinematics: Kinematics,
) {
    let limit = chosen.is_some_and(|card| card.kind == PluginKind::LimitSolver);
    let path = chosen.is_some_and(|card| card.kind == PluginKind::PathSolver);
    let rigid = assembly.is_some_and(|assembly| !assembly.deforms());
    let help = "give a material a young_modulus (law = \"elastic\") or a joint law a normal_stiffness";
    let reason = "all blocks are rigid and no joint is compliant: there is no path before the collapse";
    let stages = resolved.get("stages").and_then(Json::as_array).map(Vec::as_slice).unwrap_or_default();
    for (index, stage) in stages.iter().enumerate() {
        if stage["settlement"].as_array().is_none_or(Vec::is_empty) {
            continue;
        }
        let at = format!("stages.{index}.settlement");
        if limit {
            let help = "remove the settlement, or take a path solver: event_path, newton_path";
            builder.wrong(&at, "limit analysis of rigid blocks knows loads only", help);
        } else if rigid {
            builder.wrong(&at, reason, help);
        }
    }
    if rigid && kinematics == Kinematics::Finite && !limit {
        builder.wrong("solver.kinematics", reason, help);
    } else if rigid && path {
        builder.wrong(
            "solver.solver",
            reason,
            "take limit analysis, or give a material a young_modulus (law = \"elastic\")",
        );
    }
}

/// Keys that no limit analysis reads.
pub(super) fn unused_by_limit_analysis(resolved: &Map<String, Json>) -> Vec<String> {
    let mut notes = Vec::new();
    for (name, law) in resolved.get("joints").and_then(Json::as_object).into_iter().flatten() {
        for stiffness in ["normal_stiffness", "shear_stiffness"].iter().filter(|key| law.get(**key).is_some()) {
            notes.push(format!("joints.{name}.{stiffness} has no influence on a limit load"));
        }
    }
    for key in ["continuation", "stop"] {
        if resolved.get("solver").is_some_and(|solver| solver.get(key).is_some()) {
            notes.push(format!("solver.{key} is not used by limit analysis"));
        }
    }
    notes
}
