//! What a calculation takes for granted, and from where: the plug-ins of a case in the words of their cards.

use crate::study::Case;
use serde_json::Value as Json;
use voussoir_core::plugin::{Card, PluginKind, card};

/// The plug-ins that a case uses, each with what it is used for.
fn used(case: &Case) -> Vec<(String, &'static Card)> {
    let resolved = &case.resolved;
    let tag = |value: &Json, kind: PluginKind| card(kind, value[kind.tag_key()].as_str()?);
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
    let fill = &resolved["scene"]["fill"];
    add("spread of live loads".into(), &fill["dispersion"], PluginKind::Dispersion);
    add("resistance of the fill".into(), &fill["resistance"], PluginKind::FillResistance);
    let mut kinds: Vec<&Json> = Vec::new();
    for load in
        resolved["stages"].as_array().into_iter().flatten().flat_map(|stage| stage["loads"].as_array()).flatten()
    {
        if !kinds.iter().any(|other| other["kind"] == load["kind"]) {
            kinds.push(load);
        }
    }
    for load in kinds {
        add("load".into(), load, PluginKind::LoadKind);
    }
    for kind in [PluginKind::LimitSolver, PluginKind::PathSolver] {
        add("solver".into(), &resolved["solver"], kind);
    }
    out
}

/// What a case takes for granted.
pub fn assumptions(case: &Case) -> Vec<(String, String)> {
    let assembly = &case.assembly;
    let row = |words: &str, value: &str| (words.to_string(), value.to_string());
    let mut rows = vec![row("dimensions", "a plane model, the same over the width; static loads")];
    rows.extend(used(case).into_iter().map(|(what, card)| (what, format!("{} ({})", card.summary, card.tag))));
    if case.resolved["solver"]["solver"] == "auto" {
        rows.push(row("solver", "the cheapest that answers the question, named beside each answer (auto)"));
    }
    let finite = case.solver.settings.finite;
    rows.push(row("displacements", if finite { "finite" } else { "small: equilibrium of the undeformed scene" }));
    let deforms = (0..assembly.bodies.len()).any(|body| assembly.is_deformable(body));
    rows.push(row("blocks", if deforms { "some deform" } else { "rigid" }));
    if assembly.bridge.as_ref().is_some_and(|bridge| !bridge.road.is_empty()) {
        rows.push(row("fill", "weighs in vertical columns and presses with horizontal forces; it is no continuum"));
        if case.resolved["scene"]["fill"]["dispersion"].is_null() {
            rows.push(row("spread of live loads", "none"));
        }
        if case.resolved["scene"]["fill"]["resistance"].is_null() {
            rows.push(row("resistance of the fill", "none"));
        }
    }
    if case.resolved["factors"].is_null() {
        rows.push(row("partial factors", "none: all are 1"));
    } else {
        rows.push(row("load factor", "multiplies loads that are multiplied by their partial factors: 1 is adequate"));
    }
    rows.push(row(
        "proof",
        "each answer is recomputed from the scene without its solver; the residuals stand under its certificate",
    ));
    rows
}

/// What the plug-ins of a case cite, each once.
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
