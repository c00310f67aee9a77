//! The assumptions of a calculation with their sources: the descriptions of the plug-ins that a case uses.

use serde_json::Value as Json;
use voussoir_core::plugin::{Card, PluginKind, card};
use voussoir_study::config::common_keys::tag_of;
use voussoir_study::study::{Case, SelectedSolver, stage_tables};

/// The laws of a fill: description, key, kind.
const OF_FILL: [(&str, &str, PluginKind); 2] = [
    ("spread of live loads", "scene.fill.dispersion", PluginKind::Dispersion),
    ("resistance of the fill", "scene.fill.resistance", PluginKind::FillResistance),
];

/// The plug-ins that a case uses, each with its purpose.
fn used(case: &Case) -> Vec<(String, &'static Card)> {
    let resolved = &case.resolved;
    let tag = |value: &Json, kind: PluginKind| card(kind, tag_of(kind, value));
    let mut out = Vec::new();
    let mut add = |what: String, value: &Json, kind: PluginKind| {
        out.extend(tag(value, kind).map(|card| (what, card)));
    };
    add("scene".into(), &resolved["scene"], PluginKind::Scene);
    for (table, kind) in [("materials", PluginKind::BulkMaterial), ("joints", PluginKind::InterfaceLaw)] {
        for (name, value) in resolved[table].as_object().into_iter().flatten() {
            add(format!("{table}: {name}"), value, kind);
        }
    }
    for (what, key, kind) in OF_FILL {
        resolved.at(key).into_iter().for_each(|table| add(what.into(), table, kind));
    }
    let mut kinds: Vec<String> = Vec::new();
    for load in stage_tables(resolved).iter().flat_map(|stage| &stage.loads) {
        let kind = tag_of(PluginKind::LoadKind, load);
        if !kinds.iter().any(|other| other == kind) {
            kinds.push(kind.into());
            add("load".into(), load, PluginKind::LoadKind);
        }
    }
    for kind in [PluginKind::LimitSolver, PluginKind::PathSolver] {
        add("solver".into(), &resolved["solver"], kind);
    }
    out
}

/// The model of a plane scene.
const PLANE: &str = "a plane model, the same over the width; static loads";

/// The assumptions of a case.
pub fn assumptions(case: &Case) -> Vec<(String, String)> {
    let assembly = &case.assembly;
    let row = |words: &str, value: &str| (words.to_string(), value.to_string());
    let model = if case.space.is_some() { "blocks in space; static loads" } else { PLANE };
    let mut rows = vec![row("dimensions", model)];
    rows.extend(used(case).into_iter().map(|(what, card)| (what, format!("{} ({})", card.summary, card.tag))));
    if matches!(case.solver.solver, SelectedSolver::Auto) {
        rows.push(row(
            "solver",
            "chosen automatically: the fastest solver that supports the case; each result names it",
        ));
    }
    let finite = case.solver.settings.finite;
    rows.push(row("displacements", if finite { "finite" } else { "small: equilibrium of the undeformed scene" }));
    let deforms = (0..assembly.bodies.len()).any(|body| assembly.is_deformable(body));
    rows.push(row("blocks", if deforms { "some deform" } else { "rigid" }));
    if assembly.bridge.as_ref().is_some_and(|bridge| !bridge.road.is_empty()) {
        rows.push(row(
            "fill",
            "modelled by the weight of vertical columns and by horizontal forces, not as a continuum",
        ));
        let absent = |key: &str| case.resolved.at(key).is_none_or(Json::is_null);
        rows.extend(OF_FILL.iter().filter(|(_, key, _)| absent(key)).map(|(what, ..)| row(what, "none")));
    }
    if case.resolved.get("factors").is_none() {
        rows.push(row("partial factors", "none: all are 1"));
    } else {
        rows.push(row("load factor", "multiplies loads that are multiplied by their partial factors: 1 is adequate"));
    }
    rows.push(row(
        "proof",
        "each result is checked from the scene without the solver; its certificate lists the residuals",
    ));
    rows
}

/// The sources that the plug-ins of a case cite, each once.
pub fn sources(case: &Case) -> Vec<(String, String)> {
    let mut rows: Vec<(String, String)> = Vec::new();
    for (_, card) in used(case) {
        for source in card.sources {
            if !rows.iter().any(|(_, other)| other == source) {
                rows.push((card.tag.to_string(), source.to_string()));
            }
        }
    }
    rows
}
