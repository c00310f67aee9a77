//! From one expanded case of a study file to bodies, joints, stages and the solver.

use super::assemble::{Built, built, catalogue};
use super::diagnostics::DiagnosticList;
use super::keys::{case_keys, study_keys};
use super::model::{Case, SelectedSolver, ZoneOfThrust};
use super::numeric_keys::numeric_keys;
use super::partial_factors::{check, design, multiply_loads, note_of_yielding};
use super::plausibility::{space_warnings, warnings};
use super::resolved::Resolved;
use super::solver::{choose_solver, unused_by_limit_analysis};
use super::space::{SpaceCase, check_space_solver, space_stages, subdivisions, unused_subdivisions};
use super::stages::build_stages;
use super::tables::{OutputKeys, stage_tables};
use crate::config::check::{Checker, Unused};
use crate::config::checked_keys::{CheckedKey, CheckedKeys};
use crate::config::common_keys::own_keys;
use crate::config::diagnostic::{LocatedDiagnostic, suggest};
use crate::config::document::Node;
use crate::config::expand::{Expanded, Expansion};
use crate::config::synonyms::nearest_name;
use serde_json::Value as Json;
use std::sync::Arc;
use voussoir_core::model::Assembly;
use voussoir_core::plugin::{PluginKind, card, cards_of};

/// The load factor is not differentiated with respect to longer lists of numbers: they are data, not parameters.
const LONGEST: usize = 12;

/// A function that returns the checked value of a top-level key if other cases have the same value.
pub(crate) type KnownKeys<'a> = dyn Fn(&str) -> Option<&'a CheckedKey> + 'a;

/// Returns the checked value of a top-level key that all cases of an expansion share.
pub(crate) fn shared_key<'a>(checked: &'a CheckedKeys, expansion: &Expansion, name: &str) -> Option<&'a CheckedKey> {
    checked.get(expansion, case_keys(), name)
}

/// Checks and builds one case.
pub(crate) fn build_case(id: usize, expanded: Expanded, known: &KnownKeys<'_>) -> Result<Case, Vec<LocatedDiagnostic>> {
    let Expanded { variant, scene, parameters, root } = expanded;
    let (resolved, found, unused) = check_keys(&root, known)?;
    let mut diagnostics = DiagnosticList::new(&root, found);
    let mut notes: Vec<String> =
        unused.into_iter().map(|unused| format!("{} is not used by {}", unused.key, unused.by)).collect();
    check_kind(&mut diagnostics, &resolved);
    let tables = design(&resolved, &mut notes);
    let written = stage_tables(&resolved);
    check(&mut diagnostics, &resolved, &tables, &written);
    let catalogue = catalogue(&mut diagnostics, &tables);
    let (assembly, blocks) = match catalogue.and_then(|catalogue| built(&mut diagnostics, &tables, &catalogue)) {
        Some(Built::Plane(assembly)) => (Some(*assembly), None),
        Some(Built::Space(blocks)) => (None, Some(blocks)),
        None => (None, None),
    };
    let mut stages = build_stages(&mut diagnostics, &tables, &written, assembly.as_ref(), &mut notes);
    let mut space = blocks.map(|assembly| {
        let stages = space_stages(&mut diagnostics, &written, stages.as_deref().unwrap_or_default(), &assembly);
        let parts = subdivisions(resolved.get("solver"));
        SpaceCase { assembly, stages, parts }
    });
    let in_space = space.as_mut().map_or(&mut [][..], |space| &mut space.stages);
    multiply_loads(stages.as_deref_mut().unwrap_or_default(), in_space, &resolved);
    let solver = resolved
        .get("solver")
        .and_then(|solver| choose_solver(&mut diagnostics, solver, &resolved, &written, assembly.as_ref()));
    if let (Some(space), Some(solver)) = (&space, resolved.get("solver")) {
        check_space_solver(&mut diagnostics, solver, space);
    }
    let limit = solver.as_ref().is_some_and(|choice| matches!(choice.solver, SelectedSolver::Limit(..)));
    let rigid = assembly.as_ref().is_some_and(|assembly| !assembly.deforms()) || space.is_some();
    if limit || rigid {
        notes.extend(unused_by_limit_analysis(&resolved, &written));
    }
    let output = resolved.get("output").and_then(own_keys::<OutputKeys>);
    if output.is_none() && resolved.get("output").is_some() {
        diagnostics.wrong("output", "cannot be read", "correct this table");
    }
    let assembly = assembly.or_else(|| Some(Assembly::without_blocks(space.as_ref()?.assembly.catalogue.clone())));
    match (assembly, stages, solver, output) {
        (Some(assembly), Some(stages), Some(solver), Some(output)) if diagnostics.found.is_empty() => {
            if !output.fields && output.vtu {
                notes.push("output.vtu is not used: output.fields = false leaves nothing to write there".into());
            }
            let output_zone = match output.thrust_zone {
                Some(true) => ZoneOfThrust::Always,
                None if parameters.is_empty() => ZoneOfThrust::Cheap,
                _ => ZoneOfThrust::Never,
            };
            notes.extend(warnings(&resolved, &assembly, &stages));
            notes.extend(space.iter().flat_map(|space| space_warnings(&resolved, &space.assembly)));
            notes.extend(unused_subdivisions(resolved.get("solver"), space.as_ref()));
            note_of_yielding(&assembly, &resolved, &mut notes);
            let numbers = || numeric_keys(study_keys(), &resolved.to_json(), LONGEST);
            let output_sensitivities = if output.sensitivities { numbers() } else { Vec::new() };
            let brief = false;
            Ok(Case {
                id,
                variant,
                scene,
                parameters,
                assembly,
                space: space.map(Arc::new),
                stages,
                solver,
                output_curve: output.curve,
                output_states: output.states.unwrap_or(0),
                output_sensitivities,
                output_accuracy: output.accuracy.is_some(),
                output_joints: output.joints,
                output_zone,
                output_fields: output.fields,
                output_path_proofs: if output.path_proofs == Some(true) { usize::MAX } else { 0 },
                notes,
                brief,
                resolved,
            })
        }
        _ => Err(diagnostics.found),
    }
}

type Checked = (Resolved, Vec<LocatedDiagnostic>, Vec<Unused>);

/// Returns the top-level keys with their normalised values, the mistakes in them, and unused keys.
fn check_keys(root: &Node, known: &KnownKeys<'_>) -> Result<Checked, Vec<LocatedDiagnostic>> {
    let mut checker = Checker::new(root);
    let Some(table) = root.table() else {
        return Err(vec![LocatedDiagnostic::new(&root.origin, "", "must be a table")]);
    };
    let keys = study_keys();
    let names: Vec<_> = keys.iter().map(|parameter| parameter.name).collect();
    // A misspelt key is not reported as missing too.
    let mut misspelt = Vec::new();
    for entry in table.entries.iter().filter(|entry| !names.contains(&entry.key.as_str())) {
        misspelt.extend(nearest_name(&entry.key, names.iter().copied()));
        let help = suggest(&entry.key, &names, "keys here");
        let wrong = LocatedDiagnostic::new(&entry.origin, &entry.key, "is not a key of a study").help(help);
        checker.diagnostics.push(wrong);
    }
    let mut resolved = Resolved::default();
    for parameter in case_keys() {
        if table.get(parameter.name).is_none() && misspelt.contains(&parameter.name) {
            continue;
        }
        if let Some(key) = known(parameter.name).filter(|key| key.holds_for(&checker)) {
            if let Some(value) = &key.value {
                resolved.insert(parameter.name, Arc::clone(value));
            }
            checker.unused.extend(key.unused.iter().cloned());
            continue;
        }
        if let Ok(Some(value)) = checker.parameter(root, table, parameter, "") {
            resolved.insert(parameter.name, Arc::new(value.into()));
        }
    }
    Ok((resolved, checker.diagnostics, checker.unused))
}

fn check_kind(diagnostics: &mut DiagnosticList<'_>, resolved: &Resolved) {
    let Some(kind) = resolved.get("kind").and_then(Json::as_str) else { return };
    if card(PluginKind::StudyKind, kind).is_none() {
        let kinds: Vec<_> = cards_of(PluginKind::StudyKind).iter().map(|card| card.tag).collect();
        let help = suggest(kind, &kinds, "kinds available");
        diagnostics.wrong("kind", format!("there is no study kind \"{kind}\""), help);
    }
}
