//! The contestants of a bench: the variants of a study, or solvers with accuracy settings that differ one at a time.

use serde_json::json;
use voussoir_core::plugin::{Card, PluginKind, candidates};
use voussoir_study::solve::knobs::{Sets, finer_mesh, other_order, smaller_steps};
use voussoir_study::solve::restated::restated;
use voussoir_study::study::Case;

/// A name with its case, or the reason why the case is not possible.
pub(super) struct Contestant {
    pub name: String,
    pub case: Result<Case, String>,
}

/// Returns the variants of a study.
pub(super) fn of_variants<'a>(cases: impl Iterator<Item = &'a Case>) -> Vec<Contestant> {
    let own = |case: &Case| Contestant { name: case.variant.clone().unwrap_or_default(), case: Ok(case.clone()) };
    cases.map(own).collect()
}

/// Returns every solver; a solver that does not support the case has the reason instead. A path solver also takes part with
/// meshes half and twice as fine, with elements of lower and higher order, and with steps of a half and of a quarter. Its
/// finest mesh is the last one.
pub(super) fn contestants(case: &Case) -> Vec<Contestant> {
    let mut found = Vec::new();
    for card in candidates(PluginKind::LimitSolver) {
        let own = |sets: Sets| {
            let solver = [("solver.solver".to_string(), json!(card.tag))];
            restated(case, solver.into_iter().chain(sets))
        };
        let plain = own(Vec::new());
        let takes = plain.is_ok();
        found.push(Contestant { name: card.tag.into(), case: plain });
        if card.kind == PluginKind::PathSolver && takes {
            let knobs = knobs(case, card).into_iter().filter(|(_, sets)| !sets.is_empty());
            found.extend(
                knobs.map(|(name, sets)| Contestant { name: format!("{}, {name}", card.tag), case: own(sets) }),
            );
        }
    }
    found
}

fn knobs(case: &Case, card: &Card) -> Vec<(&'static str, Sets)> {
    vec![
        ("half the step", smaller_steps(case, card, 0.5)),
        ("a quarter of the step", smaller_steps(case, card, 0.25)),
        ("order 1", other_order(case, 1)),
        ("order 3", other_order(case, 3)),
        ("half the mesh", finer_mesh(case, 0.5)),
        ("twice the mesh", finer_mesh(case, 2.0)),
    ]
}
