//! Witnesses of limit points for the certificate: proofs at a state that no rate raises the load.

use super::limit_point_test::{active_set, rate_problem, responses_of};
use super::state::{State, Tangent};
use super::system::StepSystem;
use crate::path::dual_vector::dual_vector;
use crate::rate::answer::Budget;
use crate::rate::tree::search;
use voussoir_core::path::{FarkasVector, ModeTree, PathState, RateClaim, Witness};

/// Facets of the active set up to which the search is tried: its program is dense.
const MOST_FACETS: usize = 160;

/// Proofs that no rate raises the load at a state that an observer has `seen`: by the rate along which the load stands still, which
/// is a dual vector if flow is associated, and by a search over the modes.
pub(super) fn none_rises(
    system: &mut StepSystem,
    (state, seen): (&State, &PathState),
    rate: &Tangent,
    direction: f64,
) -> Vec<Witness> {
    let trees = by_rate(rate).into_iter().chain(by_search(system, state, direction));
    trees.map(|tree| Witness { state: seen.clone(), claim: RateClaim::NoneRises(tree) }).collect()
}

/// The negative rate as multipliers.
fn by_rate(rate: &Tangent) -> Option<ModeTree> {
    let vector = FarkasVector {
        equilibrium: rate.motion.iter().map(|own| own.map(|v| -v)).collect(),
        gap: rate.force.iter().map(|own| own.map(|r| -r)).collect(),
    };
    Some(ModeTree::Leaf(vector))
}

fn by_search(system: &mut StepSystem, state: &State, direction: f64) -> Option<ModeTree> {
    let active = active_set(system, state, &[]);
    if active.facets.iter().map(|(facets, _)| facets.len()).sum::<usize>() > MOST_FACETS {
        return None;
    }
    system.count("factorisations", 1);
    let equations = system.equations(state);
    let responses = responses_of(system, &active, &equations, direction)?;
    let problem = rate_problem(system, &active, &responses);
    let mut programs = 0;
    let proof = search(&problem, 1.0, Budget::default().leaves, &mut programs).proof?;
    let vector = |alpha: &[[f64; 2]]| {
        let mut x = vec![0.0; system.size() - 1];
        for (by, gap) in responses.iter().zip(alpha.as_flattened()) {
            x.iter_mut().zip(by).for_each(|(x, by)| *x += gap * by);
        }
        dual_vector(&system.scaled, &x, alpha)
    };
    proof.certified(&problem, &active.contacts, &vector)
}
