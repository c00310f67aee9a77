//! Proofs for the certificate that no rate raises the load, or that none continues the path: trees of modes, with multipliers
//! from the response of the structure.

use super::system::System;
use crate::contact::active_point::ActivePoint;
use crate::linear::largest;
use crate::rate::answer::Budget;
use crate::rate::problem::RateProblem;
use crate::rate::proof::NoRate;
use crate::rate::tree::search;
use crate::settings::SETTINGS;
use voussoir_core::path::{FarkasVector, ModeTree, NoneContinues};

/// Greatest number of facets of the active set for which the search is tried: its program is dense.
pub(super) const MOST_FACETS: usize = 160;

/// Returns all unknowns for gap rates of the active points, which stick otherwise, and a rate of the load.
pub(super) type Response<'a> = &'a dyn Fn(&[[f64; 2]], f64) -> Option<Vec<f64>>;

/// Returns the multipliers that complete `alpha`, the gap rates of the active points, and `work`. They come from the
/// response `x` to both, in scaled units. The active points stick in it, so that the structure is symmetric: y = −q̇, β
/// = −ṙ.
fn dual_vector(system: &System, x: &[f64], alpha: &[[f64; 2]], work: f64) -> FarkasVector {
    let (forces, motions) = x.split_at(2 * system.contacts);
    let unit =
        if largest(forces) <= SETTINGS.inequality() * largest(alpha.as_flattened()) { 0.0 } else { system.units.force };
    let still = SETTINGS.inequality() * largest(motions);
    let moving: Vec<f64> = motions.iter().map(|v| if v.abs() <= still { 0.0 } else { *v }).collect();
    let negative = |force: &[f64]| [0, 1].map(|i| -force[i] * unit);
    FarkasVector {
        equilibrium: system.motions(&moving).into_iter().map(|own| own.map(|v| -v)).collect(),
        gap: forces.chunks_exact(2).map(negative).collect(),
        work,
    }
}

/// Returns the tree that proves that no rate of a problem over the contact points `contacts` raises the load. `None` if
/// the search does not find the proof within its budget.
pub(super) fn none_rises(
    (problem, system): (&RateProblem, &System),
    contacts: &[usize],
    trials: &mut u64,
    response: Response,
) -> Option<ModeTree> {
    let found = search(problem, 1.0, Budget::default().leaves, trials);
    let proof = found.proof.filter(|_| found.rates.is_empty())?;
    certified(&proof, (&problem.points, system), contacts, response)
}

/// Returns the tree of a proof, over the contact points `contacts`, that no rate raises the load.
pub(super) fn certified(
    proof: &NoRate,
    (points, system): (&[ActivePoint], &System),
    contacts: &[usize],
    response: Response,
) -> Option<ModeTree> {
    let vector = |alpha: &[[f64; 2]], _: f64| {
        response(alpha, 0.0).map(|x| dual_vector(system, &x, alpha, 0.0)).unwrap_or_default()
    };
    proof.certified(points, contacts, &vector).filter(|_| proof.factor > 0.0)
}

/// Returns the trees that prove that no rate of a problem over the contact points `contacts` continues the path.
/// `unit`: λ for a unit of the load in the problem. `None` if the search does not find them within its budget.
pub(super) fn none_continues(
    (problem, system): (&RateProblem, &System),
    (contacts, unit): (&[usize], f64),
    trials: &mut u64,
    response: Response,
) -> Option<NoneContinues> {
    let vector = |alpha: &[[f64; 2]], work: f64| {
        response(alpha, -work).map(|x| dual_vector(system, &x, alpha, work * unit)).unwrap_or_default()
    };
    let mut tree = |factor: f64| {
        let proof = search(problem, factor, Budget::default().leaves, trials).proof?;
        proof.certified(&problem.points, contacts, &vector)
    };
    Some(NoneContinues { rises: tree(1.0)?, stands: tree(0.0)?, falls: tree(-1.0)? })
}
