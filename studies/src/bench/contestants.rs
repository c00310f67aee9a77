//! The contestants of a bench: the variants of a study, or solvers with ladders of the settings of their accuracy.

use super::measured::Refinement;
use serde_json::json;
use voussoir_core::plugin::{Card, PluginKind, candidates};
use voussoir_study::solve::knobs::{Sets, finer_mesh, other_grading, other_order, smaller_steps};
use voussoir_study::solve::restated::restated;
use voussoir_study::study::Case;

/// A name with its case, or the reason why the case is not possible.
pub(super) struct Contestant {
    pub name: String,
    /// The setting that differs from the study, if one does.
    pub rung: Option<Refinement>,
    pub case: Result<Case, String>,
}

/// Numbers of elements of the ladder of meshes, divided by the numbers in the study.
const MESHES: [f64; 4] = [0.5, 1.5, 2.0, 3.0];
/// Orders of the elements.
const ORDERS: [usize; 3] = [1, 2, 3];
/// Gradings of the elements towards the ends of joints.
const GRADINGS: [f64; 5] = [1.0, 3.0, 6.0, 10.0, 20.0];
/// Lengths of the steps, divided by the lengths in the study.
const STEPS: [f64; 4] = [0.5, 0.25, 0.125, 0.0625];

/// Returns the variants of a study.
pub(super) fn of_variants<'a>(cases: impl Iterator<Item = &'a Case>) -> Vec<Contestant> {
    let own =
        |case: &Case| Contestant { name: case.variant.clone().unwrap_or_default(), rung: None, case: Ok(case.clone()) };
    cases.map(own).collect()
}

/// Returns every solver; a solver that does not support the case has the reason instead. A path solver also takes part with the
/// rungs of its ladders: other meshes, orders, gradings and steps.
pub(super) fn contestants(case: &Case) -> Vec<Contestant> {
    let mut found = Vec::new();
    for card in candidates(PluginKind::LimitSolver) {
        let plain = with(case, card, Vec::new());
        let takes = plain.is_ok();
        found.push(Contestant { name: card.tag.into(), rung: None, case: plain });
        if card.kind == PluginKind::PathSolver && takes {
            let rungs = rungs(case, card).into_iter().filter(|(_, sets)| !sets.is_empty());
            found.extend(rungs.map(|(rung, sets)| Contestant {
                name: format!("{}, {rung}", card.tag),
                rung: Some(rung),
                case: with(case, card, sets),
            }));
        }
    }
    found
}

/// Returns the case with a solver and some keys changed.
pub(super) fn with(case: &Case, card: &Card, sets: Sets) -> Result<Case, String> {
    let solver = [("solver.solver".to_string(), json!(card.tag))];
    restated(case, solver.into_iter().chain(sets))
}

/// Returns the rungs of all ladders of a path solver; a rung that the scene does not have changes nothing.
fn rungs(case: &Case, card: &Card) -> Vec<(Refinement, Sets)> {
    let rung = |ladder, value| Refinement { ladder, value };
    let steps = STEPS.map(|share| (rung("steps", share), smaller_steps(case, card, share)));
    let orders = ORDERS.map(|order| (rung("order", order as f64), other_order(case, order)));
    let gradings = GRADINGS.map(|grading| (rung("grading", grading), other_grading(case, grading)));
    let meshes = MESHES.map(|times| (rung("mesh", times), finer_mesh(case, times)));
    steps.into_iter().chain(orders).chain(gradings).chain(meshes).collect()
}
