//! Witnesses for the certificate: rates at a state, and the proof that no rate raises the load.

use super::direction::factorise;
use super::point::{Point, active_points};
use super::rates::Direction;
use super::schur::SchurComplement;
use super::trace::Trace;
use crate::contact::mode::ContactMode;
use crate::path::dual_vector::{self, MOST_FACETS};
use crate::path::system::Load;
use crate::rate::proof::NoRate;
use voussoir_core::path::{PathRate, RateClaim, Witness};

/// The witness that no rate raises the load at the present state: by a proof over its active set, or by a search. `None` if
/// the search does not find a proof within its budget.
pub fn none_rises(trace: &mut Trace, load: &Load, proof: Option<&NoRate>) -> Option<Witness> {
    let points = &trace.state.points;
    let active: Vec<usize> = (0..points.len()).filter(|c| points[*c].settled().is_none()).collect();
    if proof.is_none() && active.iter().map(|c| points[*c].active.len()).sum::<usize>() > MOST_FACETS {
        return None;
    }
    let closed = |point: &Point| point.settled().unwrap_or(ContactMode::Stick);
    let modes: Vec<ContactMode> = points.iter().map(closed).collect();
    factorise(trace, modes.clone(), true).then_some(())?;
    let state = trace.present();
    let Trace { system, state: present, factors, log, .. } = &mut *trace;
    let base = factors.present.as_mut()?;
    let tree = if let Some(proof) = proof {
        let points = active_points(system, &present.points, &active);
        dual_vector::certified(proof, (&points, system), &active, |gaps| base.opened(system, &active, gaps))?
    } else {
        let at = (present.load_step, load);
        let local = SchurComplement::new((system, &present.points), base, at, &active, &modes, &mut log.counts.solves)?;
        let response = |gaps: &[[f64; 2]]| base.opened(system, &active, gaps);
        dual_vector::none_rises((&local.rate, system), &active, &mut log.counts.rates.trials, response)?
    };
    Some(Witness { state, claim: RateClaim::NoneRises(tree) })
}

/// The rates of a direction from the present state; `sense` of λ in the load step.
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
