//! Witnesses for the certificate: proofs at a state that no rate raises the load, or that none continues the path.

use crate::path::dual_vector::{self, MOST_FACETS, Response};
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::control_row::scaled_row;
use crate::path::newton::solve::active_set::active_set;
use crate::path::newton::solve::nearby::Accuracy;
use crate::path::newton::solve::rate_after_event::rate_problem;
use crate::path::newton::solve::responses::Responses;
use crate::path::newton::solve::tangent::tangent_at;
use crate::path::system::System;
use crate::rate::problem::RateProblem;
use std::rc::Rc;
use voussoir_core::path::{FarkasVector, ModeTree, PathRate, PathState, RateClaim, Witness};

/// Returns proofs that no rate raises the load at a state that an observer has `seen`: by the rate with a constant
/// load, which is a dual vector if flow is associated, and by a search over the modes. For laws with a history, returns
/// the rate just beyond the state.
pub fn none_rises(
    system: &mut StepSystem,
    (state, seen): (&State, &PathState),
    rate: &Tangent,
    direction: f64,
) -> Vec<Witness> {
    if system.limits.remembers {
        return vec![beyond(seen, rate)];
    }
    // Behind a turn the path follows a chord; the proof needs the rate.
    let along = Control::Along { row: Rc::new(scaled_row(system, rate)), length: 0.0 };
    let own = tangent_at(system, state, &along, Accuracy::Fine).map(|own| by_rate(&own));
    let trees = own.into_iter().chain(by_search(system, state, direction));
    trees.map(|tree| Witness { state: seen.clone(), claim: RateClaim::NoneRises(tree) }).collect()
}

/// Returns the rate just beyond a limit point: for laws with a history the proof is about its loading set.
pub fn beyond(seen: &PathState, rate: &Tangent) -> Witness {
    let Tangent { factor, force, gap, motion } = rate.clone();
    Witness { state: seen.clone(), claim: RateClaim::Rate(PathRate { factor, force, gap, motion }) }
}

/// Returns the negative rate as multipliers.
fn by_rate(rate: &Tangent) -> ModeTree {
    ModeTree::Leaf(FarkasVector {
        equilibrium: rate.motion.iter().map(|own| own.map(|v| -v)).collect(),
        gap: rate.force.iter().map(|own| own.map(|r| -r)).collect(),
        work: 0.0,
    })
}

fn by_search(system: &mut StepSystem, state: &State, direction: f64) -> Option<ModeTree> {
    search(system, state, direction, |problem, (contacts, _), programs, response| {
        dual_vector::none_rises(problem, contacts, programs, response)
    })
}

/// Returns the proof that no rate continues the path from a state that an observer has `seen`.
pub fn none_continues(system: &mut StepSystem, (state, seen): (&State, &PathState), direction: f64) -> Option<Witness> {
    let trees = search(system, state, direction, dual_vector::none_continues)?;
    Some(Witness { state: seen.clone(), claim: RateClaim::NoneContinues(trees) })
}

/// Searches for a proof at a state over the modes of the active points, which are given with λ for a unit of the load.
fn search<T>(
    system: &mut StepSystem,
    state: &State,
    direction: f64,
    prove: impl FnOnce((&RateProblem, &System), (&[usize], f64), &mut u64, Response) -> Option<T>,
) -> Option<T> {
    let active = active_set(system, state, &[]);
    if active.facets.iter().map(|(facets, _)| facets.len()).sum::<usize>() > MOST_FACETS {
        return None;
    }
    system.count("factorisations", 1);
    let equations = system.equations(state);
    let responses = Responses::new(system, state, &active, &equations, direction)?;
    let problem = rate_problem(system, &active, &responses.unit);
    let mut programs = 0;
    let unit = direction * system.units().factor;
    let response = |gaps: &[[f64; 2]], factor: f64| responses.combined(gaps, factor);
    prove((&problem, &system.scaled), (&active.contacts, unit), &mut programs, &response)
}
