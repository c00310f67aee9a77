//! Witnesses for the certificate: rates at a state, and proofs that no rate raises the load or continues the path.

use super::piece::point::{Point, active_points};
use super::piece::rates::Direction;
use super::piece::schur::SchurComplement;
use super::trace::Trace;
use crate::contact::mode::ContactMode;
use crate::path::dual_vector::{self, MOST_FACETS, Response};
use crate::path::system::{Load, System};
use crate::rate::problem::RateProblem;
use crate::rate::proof::NoRate;
use voussoir_core::path::{PathRate, RateClaim, Witness};

/// Returns the witness that no rate raises the load at the present state: by a proof over its active set, or by a
/// search. `None` if the search does not find a proof within its budget.
pub fn none_rises(trace: &mut Trace, load: &Load, proof: Option<&NoRate>) -> Option<Witness> {
    let Some(proof) = proof else {
        return prove(trace, load, |problem, active, trials, response| {
            dual_vector::none_rises(problem, active, trials, response).map(RateClaim::NoneRises)
        });
    };
    let active = active_set(trace);
    factorise_closed(trace)?;
    let state = trace.present();
    let Trace { system, state: present, factors, .. } = &mut *trace;
    let base = factors.present.as_mut()?;
    let points = active_points(system, &present.points, &active);
    let response = |gaps: &[[f64; 2]], _: f64| base.opened(system, &active, gaps);
    let tree = dual_vector::certified(proof, (&points, system), &active, &response)?;
    Some(Witness { state, claim: RateClaim::NoneRises(tree) })
}

/// Returns the proof that no rate continues the path from the present state; `sense` of λ in the load step.
pub fn none_continues(trace: &mut Trace, load: &Load, sense: f64) -> Option<Witness> {
    prove(trace, load, |problem, active, trials, response| {
        dual_vector::none_continues(problem, (active, sense), trials, response).map(RateClaim::NoneContinues)
    })
}

/// Returns the numbers of the points that may change their modes.
fn active_set(trace: &Trace) -> Vec<usize> {
    let points = &trace.state.points;
    (0..points.len()).filter(|c| points[*c].settled().is_none()).collect()
}

/// Factorises the structure with these points closed. Returns the modes of all points.
fn factorise_closed(trace: &mut Trace) -> Option<Vec<ContactMode>> {
    let closed = |point: &Point| point.settled().unwrap_or(ContactMode::Stick);
    let modes: Vec<ContactMode> = trace.state.points.iter().map(closed).collect();
    trace.factorise(modes.clone(), true).then_some(modes)
}

/// Returns a witness at the present state by a search over the modes of the active points.
fn prove(
    trace: &mut Trace,
    load: &Load,
    search: impl FnOnce((&RateProblem, &System), &[usize], &mut u64, Response) -> Option<RateClaim>,
) -> Option<Witness> {
    let active = active_set(trace);
    if active.iter().map(|c| trace.state.points[*c].active.len()).sum::<usize>() > MOST_FACETS {
        return None;
    }
    let modes = factorise_closed(trace)?;
    let state = trace.present();
    let Trace { system, state: present, factors, log, .. } = &mut *trace;
    let base = factors.present.as_mut()?;
    let at = (present.load_step, load);
    let local = SchurComplement::new((system, &present.points), base, at, &active, &modes, &mut log.counts.solves)?;
    let driven = base.load_rate(system, present.load_step, load)?.clone();
    let response = |gaps: &[[f64; 2]], factor: f64| {
        let mut x = base.opened(system, &active, gaps)?;
        x.iter_mut().zip(&driven).for_each(|(x, by)| *x += factor * by);
        Some(x)
    };
    let claim = search((&local.rate, system), &active, &mut log.counts.rates.trials, &response)?;
    Some(Witness { state, claim })
}

/// Returns the rates of a direction from the present state; `sense` of λ in the load step.
pub fn rate_witness(trace: &Trace, direction: &Direction, sense: f64) -> Witness {
    let (system, units) = (&trace.system, trace.system.units);
    let (forces, motions) = direction.x.split_at(2 * system.contacts);
    let loading = &trace.problem.load_steps[trace.state.load_step].loading;
    let factor = sense * direction.factor;
    let mut motion = system.motions(motions);
    for (body, settlement) in &loading.settlements {
        (0..3).for_each(|i| motion[*body][i] += factor * settlement[i]);
    }
    let rate = PathRate {
        factor,
        force: forces.chunks_exact(2).map(|own| [0, 1].map(|i| own[i] * units.force)).collect(),
        gap: direction.gaps.iter().map(|own| own.map(|gap| gap * units.displacement)).collect(),
        motion,
    };
    Witness { state: trace.present(), claim: RateClaim::Rate(rate) }
}
