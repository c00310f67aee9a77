//! `solver = "auto"`: chosen automatically, the fastest solver that supports the case.
//!
//! The cards of solvers decide: `cost` gives the order, `provides` lists features that a question needs (finite displacements,
//! settlements, non-associated flow), and `requires` lists the requirements on laws and materials. The first of the remaining
//! solvers that does not refuse the problem solves it.

use super::case_input::CaseInput;
use crate::config::default_table::default_table;
use crate::study::SelectedSolver;
use std::sync::{Arc, LazyLock};
use voussoir_core::limit::{LimitProblem, LimitSolver};
use voussoir_core::model::Assembly;
use voussoir_core::path::{PathProblem, PathSettings, PathSolver};
use voussoir_core::plugin::{Capability, Card, PluginKind, Requirement, card, cards_of};

/// A limit solver with its tag.
pub type TaggedLimitSolver<'a> = (&'a str, &'a dyn LimitSolver);
/// A path solver with its tag.
pub type TaggedPathSolver = (String, Arc<dyn PathSolver>);

/// Returns the solvers of a kind that `auto` may choose, in order of their cost.
fn by_cost(kind: PluginKind) -> Vec<&'static Card> {
    let mut all: Vec<_> = cards_of(kind).into_iter().filter(|card| card.cost.is_some()).collect();
    all.sort_by_key(|card| card.cost);
    all
}

/// Returns true if the laws of all joints and the materials of all free blocks meet a requirement.
fn met(assembly: &Assembly, need: Requirement) -> bool {
    let meets = |kind: PluginKind, tag: &str| card(kind, tag).is_some_and(|card| card.meets(need));
    let laws = assembly.joints.iter().filter_map(|joint| assembly.law(joint));
    let free = assembly.bodies.iter().filter(|body| !body.fixed);
    laws.map(|law| law.typetag_name()).all(|tag| meets(PluginKind::InterfaceLaw, tag))
        && free
            .map(|body| assembly.catalogue.materials[body.material].1.typetag_name())
            .all(|tag| meets(PluginKind::BulkMaterial, tag))
}

/// Returns the path solvers to try, in order; empty if limit analysis solves the case.
pub fn path_solvers(input: &CaseInput) -> Vec<TaggedPathSolver> {
    match input.solver {
        SelectedSolver::Limit(..) => return Vec::new(),
        SelectedSolver::Path(tag, solver) => return vec![(tag.clone(), solver.clone())],
        SelectedSolver::Auto => {}
    }
    let (assembly, finite) = (input.assembly, input.settings.finite);
    let settles = input.stages.iter().any(|stage| !stage.settlements.is_empty());
    if !assembly.deforms() && !finite {
        return Vec::new();
    }
    let all = by_cost(PluginKind::PathSolver);
    let fits = |card: &&&Card| {
        (!finite || card.offers(Capability::FINITE_DISPLACEMENTS))
            && (!settles || card.offers(Capability::SETTLEMENT))
            && card.requires.iter().all(|need| met(assembly, need))
    };
    let mut chosen: Vec<&Card> = all.iter().filter(fits).copied().collect();
    if chosen.is_empty() {
        // The most general solver explains in its refusal why the case is not supported.
        chosen.extend(all.last());
    }
    chosen
        .into_iter()
        .filter_map(|card| Some((card.tag.to_string(), Arc::from(built::<dyn PathSolver>(card)?))))
        .collect()
}

/// Returns the first path solver that accepts the problem; otherwise the tag of the last one and its reason.
pub fn willing<'a>(
    solvers: &'a [TaggedPathSolver],
    problem: &PathProblem,
    settings: &PathSettings,
) -> Result<&'a TaggedPathSolver, (String, String)> {
    let mut refusal = (String::new(), "no path solver is registered".to_string());
    for tagged in solvers {
        match tagged.1.refuses(problem, settings) {
            None => return Ok(tagged),
            Some(why) => refusal = (tagged.0.clone(), why),
        }
    }
    Err(refusal)
}

/// Returns the limit solvers to try, in order; solvers that `auto` chooses do not refuse the problem.
pub fn limit_solvers<'a>(
    selected: &'a SelectedSolver,
    problem: &'a LimitProblem,
) -> impl Iterator<Item = TaggedLimitSolver<'a>> {
    // Built once, because every case of a study needs them.
    static BUILT: LazyLock<Vec<(&Card, Arc<dyn LimitSolver>)>> = LazyLock::new(|| {
        let solvers = by_cost(PluginKind::LimitSolver).into_iter();
        solvers.filter_map(|card| Some((card, Arc::from(built::<dyn LimitSolver>(card)?)))).collect()
    });
    let named = match selected {
        SelectedSolver::Limit(tag, solver) => Some((tag.as_str(), solver.as_ref())),
        _ => None,
    };
    let fits = |card: &Card| problem.non_associated || !card.offers(Capability::NON_ASSOCIATED);
    let all: &[_] = if named.is_some() { &[] } else { &BUILT };
    let willing = all.iter().filter(move |(card, solver)| fits(card) && solver.refuses(problem).is_none());
    named.into_iter().chain(willing.map(|(card, solver)| (card.tag, solver.as_ref())))
}

/// Returns the limit solvers to try for a scene in space, in order. Searches for loads with the laws' own flow take long, and are used only
/// if the study names them.
pub fn space_solvers(selected: &SelectedSolver) -> Vec<(&str, Arc<dyn LimitSolver>)> {
    if let SelectedSolver::Limit(tag, solver) = selected {
        return vec![(tag, solver.clone())];
    }
    let cards = by_cost(PluginKind::LimitSolver).into_iter().filter(|card| card.offers(Capability::SPACE));
    let cards = cards.filter(|card| !card.offers(Capability::NON_ASSOCIATED));
    cards.filter_map(|card| Some((card.tag, Arc::from(built::<dyn LimitSolver>(card)?)))).collect()
}

/// Returns a solver with the defaults of its keys.
fn built<T: ?Sized>(card: &Card) -> Option<Box<T>>
where
    Box<T>: serde::de::DeserializeOwned,
{
    serde_json::from_value(default_table(card)).ok()
}
