//! `[solver]` of a case: the chosen solver, the check of its requirements on the laws, and its construction. A table that
//! cannot be read is a mistake; it never selects another solver silently.

use super::diagnostics::DiagnosticList;
use super::model::{SelectedSolver, SolverChoice};
use super::resolved::Resolved;
use super::tables::{StageTable, Until};
use crate::config::common_keys::{Kinematics, SolverKeys, Stop, own_keys, tag_of};
use crate::config::default_table::default_table;
use crate::config::diagnostic::suggest;
use crate::config::dotted_key::join;
use serde_json::Value as Json;
use std::sync::{Arc, LazyLock};
use voussoir_core::elastic::fine_enough;
use voussoir_core::limit::LimitSolver;
use voussoir_core::model::{Assembly, Bond};
use voussoir_core::path::{Continuation, PathSettings, PathSolver, StageSettings};
use voussoir_core::plugin::{
    Capability, Card, PluginKind, Requirement, candidate, candidates, card, cards_of, describe,
};

/// Returns true if a solver supports plane scenes. A solver that needs cones of friction solves scenes in space only.
fn in_plane(card: &Card) -> bool {
    !card.requires.iter().any(|need| need.contains(&Capability::CONE))
}

/// Returns the tags of the solvers of plane scenes that fit.
fn solvers_that(fit: impl Fn(&Card) -> bool) -> Vec<&'static str> {
    candidates(PluginKind::LimitSolver)
        .into_iter()
        .filter(|card| in_plane(card))
        .filter(|card| fit(card))
        .map(|card| card.tag)
        .collect()
}

fn or_none(tags: &[&str]) -> String {
    if tags.is_empty() { "none registered".into() } else { tags.join(", ") }
}

/// Returns the requested solver. Reports a mistake for each requirement that is not met.
pub(super) fn choose_solver(
    diagnostics: &mut DiagnosticList<'_>,
    solver: &Json,
    resolved: &Resolved,
    stages: &[StageTable],
    assembly: Option<&Assembly>,
) -> Option<SolverChoice> {
    let tag = tag_of(PluginKind::LimitSolver, solver);
    let Some(common) = own_keys::<SolverKeys>(solver) else {
        diagnostics.wrong("solver", "cannot be read", "correct this table");
        return None;
    };
    let chosen = candidate(PluginKind::LimitSolver, tag);
    let finite = common.kinematics == Kinematics::Finite;
    if finite {
        needs_finite_displacements(diagnostics, tag, chosen);
    }
    if let Some(assembly) = assembly {
        needs_capabilities(diagnostics, tag, chosen, resolved, assembly);
    }
    needs_deformation(diagnostics, stages, assembly, chosen, finite);
    if let Some(assembly) = assembly.filter(|_| chosen.is_none_or(|card| card.kind == PluginKind::PathSolver)) {
        let free = (0..assembly.bodies.len()).filter(|body| !assembly.bodies[*body].fixed);
        if let Some(why) = free.map(|body| fine_enough(assembly, body)).find_map(Result::err) {
            diagnostics.wrong("scene.mesh.elements", why, "raise the numbers of elements of scene.mesh");
        }
    }
    let built = build_solver(diagnostics, solver, chosen);
    let settings = build_settings(diagnostics, &common, stages);
    let own = stages.iter().enumerate().map(|(index, stage)| stage_solver(diagnostics, stage, index, chosen)).collect();
    Some(SolverChoice { solver: built?, settings: settings?, of_stages: own })
}

/// Returns the solver of a stage that names its own. A path has one solver from its first stage to its last.
fn stage_solver(
    diagnostics: &mut DiagnosticList<'_>,
    stage: &StageTable,
    index: usize,
    chosen: Option<&Card>,
) -> Option<SelectedSolver> {
    let tag = stage.solver.as_deref()?;
    let at = format!("stages.{index}.solver");
    let Some(card) = candidate(PluginKind::LimitSolver, tag) else {
        let tags: Vec<_> = candidates(PluginKind::LimitSolver).into_iter().map(|card| card.tag).collect();
        diagnostics.wrong(&at, format!("there is no solver \"{tag}\""), suggest(tag, &tags, "solvers"));
        return None;
    };
    let path = |card: &Card| card.kind == PluginKind::PathSolver;
    if chosen.is_some_and(|chosen| chosen.tag == card.tag) {
        return None;
    }
    if path(card) || chosen.is_some_and(path) {
        let message = format!(
            "\"{tag}\" cannot answer one stage of a study that [solver] gives to another solver: a path is followed by one solver from its first stage to its last"
        );
        diagnostics.wrong(&at, message, format!("set [solver] solver = \"{tag}\" for all stages, or remove this key"));
        return None;
    }
    let table = default_table(card);
    let solver: Box<dyn LimitSolver> = read_solver(diagnostics, &at, &table, card)?;
    Some(SelectedSolver::Limit(tag.to_string(), Arc::from(solver)))
}

/// Returns the additional settings of each stage for a path solver.
fn stage_settings(diagnostics: &mut DiagnosticList<'_>, stages: &[StageTable]) -> Option<Vec<StageSettings>> {
    let one = |(index, stage): (usize, &StageTable)| -> Option<StageSettings> {
        let stop = stage.stop.map(|Stop { displacement, factor }| [displacement, factor]);
        let at = format!("stages.{index}.continuation");
        let continuation = strategy(diagnostics, stage.continuation.as_ref(), &at)?;
        let first_limit_point = stage.until == Some(Until::FirstLimitPoint);
        Some(StageSettings { continuation, stop, first_limit_point })
    };
    stages.iter().enumerate().map(one).collect()
}

/// Returns the continuation strategy of a table, if it has one; `None` if it cannot be read.
fn strategy(
    diagnostics: &mut DiagnosticList<'_>,
    table: Option<&Json>,
    at: &str,
) -> Option<Option<Arc<dyn Continuation>>> {
    let Some(table) = table else { return Some(None) };
    let card = card(PluginKind::Continuation, tag_of(PluginKind::Continuation, table))?;
    let strategy: Box<dyn Continuation> = read_solver(diagnostics, at, table, card)?;
    Some(Some(Arc::from(strategy)))
}

/// Returns the solver that the table configures; without a card it is `auto`.
fn build_solver(diagnostics: &mut DiagnosticList<'_>, solver: &Json, chosen: Option<&Card>) -> Option<SelectedSolver> {
    let Some(card) = chosen else { return Some(SelectedSolver::Auto) };
    let mut table = solver.as_object()?.clone();
    table.retain(|key, _| key == "solver" || card.parameters.iter().any(|parameter| parameter.name == key));
    let (tag, table) = (card.tag.to_string(), Json::Object(table));
    if card.kind == PluginKind::LimitSolver {
        let solver: Box<dyn LimitSolver> = read_solver(diagnostics, "solver", &table, card)?;
        Some(SelectedSolver::Limit(tag, Arc::from(solver)))
    } else {
        let solver: Box<dyn PathSolver> = read_solver(diagnostics, "solver", &table, card)?;
        Some(SelectedSolver::Path(tag, Arc::from(solver)))
    }
}

/// Returns the settings of a path solver.
fn build_settings(
    diagnostics: &mut DiagnosticList<'_>,
    common: &SolverKeys,
    stages: &[StageTable],
) -> Option<PathSettings> {
    let continuation = strategy(diagnostics, common.continuation.as_ref(), "solver.continuation");
    let stages = stage_settings(diagnostics, stages);
    Some(PathSettings {
        finite: common.kinematics == Kinematics::Finite,
        tolerance: common.tolerance,
        stop_displacement: common.stop.and_then(|stop| stop.displacement),
        stop_factor: common.stop.and_then(|stop| stop.factor),
        continuation: continuation?,
        stages: stages?,
    })
}

/// Returns the plug-in that a table configures, or a diagnostic at the key that its reader refuses, with the nearest valid
/// name.
fn read_solver<T: serde::de::DeserializeOwned>(
    diagnostics: &mut DiagnosticList<'_>,
    at: &str,
    table: &Json,
    card: &Card,
) -> Option<T> {
    let read = |table: &Json| T::deserialize(table).map_err(|error| error.to_string());
    let error = match read(table) {
        Ok(plugin) => return Some(plugin),
        Err(error) => error,
    };
    // The key without which the reader returns another message.
    let culprit = table.as_object().into_iter().flatten().map(|(key, _)| key).find(|key| {
        let mut rest = table.clone();
        rest.as_object_mut().map(|rest| rest.remove(*key));
        *key != card.kind.tag_key() && read(&rest).err().as_ref() != Some(&error)
    });
    let names: Vec<_> = card.parameters.iter().map(|parameter| parameter.name).collect();
    let help = match culprit {
        Some(name) if !names.contains(&name.as_str()) => suggest(name, &names, &format!("keys of \"{}\"", card.tag)),
        _ => format!("correct it: `voussoir explain {}` lists the keys and their values", card.tag),
    };
    let key = culprit.map_or(at.to_string(), |name| join(at, name));
    diagnostics.wrong(&key, format!("{} \"{}\" cannot be read: {error}", card.kind.describe(), card.tag), help);
    None
}

/// Finite displacements need a solver that offers them.
fn needs_finite_displacements(diagnostics: &mut DiagnosticList<'_>, tag: &str, chosen: Option<&Card>) {
    let offers = |card: &Card| card.offers(Capability::FINITE_DISPLACEMENTS);
    let able = solvers_that(offers);
    if chosen.map_or(!able.is_empty(), offers) {
        return;
    }
    let message = match able.is_empty() {
        true => "no registered solver offers finite displacements".to_string(),
        false => format!("solver \"{tag}\" does not offer finite displacements; solvers that do: {}", able.join(", ")),
    };
    diagnostics.wrong("solver.kinematics", message, "set kinematics = \"small\"");
}

/// Compares the requirements of a solver on laws and materials with their cards.
fn needs_capabilities(
    diagnostics: &mut DiagnosticList<'_>,
    tag: &str,
    chosen: Option<&Card>,
    resolved: &Resolved,
    assembly: &Assembly,
) {
    if chosen.is_some_and(|card| !in_plane(card)) {
        let help = format!("solvers of plane scenes: {}", or_none(&solvers_that(|_| true)));
        diagnostics.wrong("solver.solver", format!("solver \"{tag}\" knows scenes in space only"), help);
        return;
    }
    // `auto` has at least the requirements that all solvers share.
    static EVERYONE: LazyLock<Vec<Requirement>> = LazyLock::new(|| {
        let all = cards_of(PluginKind::LimitSolver).into_iter().flat_map(|card| card.requires);
        all.filter(|need| solvers_that(|solver| !solver.requires.contains(need)).is_empty()).copied().collect()
    });
    let asked = chosen.map_or(EVERYONE.as_slice(), |chosen| chosen.requires);
    let used = |law: usize| assembly.joints.iter().any(|joint| joint.bond == Bond::Law(law));
    let laws = assembly.catalogue.laws.iter().enumerate().filter(|(law, _)| used(*law));
    let laws = laws.map(|(_, (name, _))| ("joints", name, PluginKind::InterfaceLaw));
    let materials = assembly.catalogue.materials.iter().map(|(name, _)| ("materials", name, PluginKind::BulkMaterial));
    for (table, name, kind) in laws.chain(materials) {
        let law = tag_of(kind, &resolved[table][name]);
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
            diagnostics.wrong(&join(&join(table, name), "law"), message, help);
        }
    }
}

/// Output that only a path provides needs a deformable part, and no limit analysis.
fn needs_deformation(
    diagnostics: &mut DiagnosticList<'_>,
    stages: &[StageTable],
    assembly: Option<&Assembly>,
    chosen: Option<&Card>,
    finite: bool,
) {
    let limit = chosen.is_some_and(|card| card.kind == PluginKind::LimitSolver);
    let path = chosen.is_some_and(|card| card.kind == PluginKind::PathSolver);
    let rigid = assembly.is_some_and(|assembly| !assembly.deforms());
    let help = "give a material a young_modulus (law = \"elastic\") or a joint law a normal_stiffness";
    let reason = "all blocks are rigid and no joint is compliant: there is no path before the collapse";
    for (index, stage) in stages.iter().enumerate() {
        if stage.settlement.is_empty() {
            continue;
        }
        if rigid && !limit && (finite || path) {
            diagnostics.wrong(&format!("stages.{index}.settlement"), reason, help);
        }
    }
    for (index, _) in stages.iter().enumerate().filter(|(_, stage)| stage.until == Some(Until::FirstLimitPoint)) {
        let at = format!("stages.{index}.until");
        if limit {
            let message = "limit analysis follows no path, so it finds no first limit point";
            diagnostics.wrong(&at, message, "set until = \"collapse\", or take a path solver");
        } else if rigid && !finite && !path {
            diagnostics.wrong(&at, reason, help);
        }
    }
    if rigid && finite && !limit {
        diagnostics.wrong("solver.kinematics", reason, help);
    } else if rigid && path {
        diagnostics.wrong(
            "solver.solver",
            reason,
            "take limit analysis, or give a material a young_modulus (law = \"elastic\")",
        );
    }
}

/// Returns the keys that no limit analysis reads.
pub(super) fn unused_by_limit_analysis(resolved: &Resolved, stages: &[StageTable]) -> Vec<String> {
    let mut notes = Vec::new();
    for (name, law) in resolved.get("joints").and_then(Json::as_object).into_iter().flatten() {
        for stiffness in ["normal_stiffness", "shear_stiffness"].iter().filter(|key| law.get(**key).is_some()) {
            notes.push(format!("joints.{name}.{stiffness} has no influence on a limit load"));
        }
    }
    let common: Option<SolverKeys> = resolved.get("solver").and_then(own_keys);
    let of_solver = common.map(|common| ("solver".to_string(), common.continuation.is_some(), common.stop.is_some()));
    let of_stage = |(index, stage): (usize, &StageTable)| {
        (format!("stages.{index}"), stage.continuation.is_some(), stage.stop.is_some())
    };
    let tables: Vec<_> = of_solver.into_iter().chain(stages.iter().enumerate().map(of_stage)).collect();
    let note = |at: &String, key: &str| format!("{at}.{key} is not used by limit analysis");
    notes.extend(tables.iter().filter(|(_, continuation, _)| *continuation).map(|(at, ..)| note(at, "continuation")));
    notes.extend(tables.iter().filter(|(.., stop)| *stop).map(|(at, ..)| note(at, "stop")));
    for (index, stage) in stages.iter().enumerate() {
        let at = format!("stages.{index}");
        notes.extend(stage.duration.map(|_| note(&at, "duration")));
        notes.extend(stage.fields.as_ref().map(|_| note(&at, "fields")));
    }
    notes
}
