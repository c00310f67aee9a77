//! The rate problem on the chain: modes change until no point leaves its own.

use super::chain::ElasticChain;
use crate::contact::mode::ContactMode;
use crate::linear::largest;
use crate::path::event::rates::{Rates, leaving};
use crate::path::event::trace::Trace;
use crate::path::system::{Load, System};

/// Residual, in terms of that which needs no refinement, above which the next correction is examined too.
const CALM: f64 = 64.0;
/// Rounds of the active set, and those in which all points change at once.
const ROUNDS: [usize; 2] = [40, 12];
/// Residuals: up to which rates need no refinement, up to which they are believed, and from which on everything is
/// factorised anew.
const RESIDUAL: [f64; 3] = [2e-15, 1e-12, 1e-11];
/// Residual of gaps beside the rates of forces up to which rates need no refinement either: the error of the forces.
const ERROR: f64 = 2e-13;
/// Steps of refinement.
const REFINEMENTS: usize = 3;
/// Corrections after which rates are examined again: each errs by rounding of what it changes. Resultants, on which the
/// load at collapse rests, are examined each time.
const UNCHECKED: usize = 8;

/// Modes of all points from a guess, and the rates in them with λ̇ = 1. `None` where the whole system is to be asked.
pub fn by_elastic_chain(
    trace: &mut Trace,
    load: &Load,
    active: &[usize],
    mut modes: Vec<ContactMode>,
) -> Option<(Vec<ContactMode>, Rates)> {
    // From nothing every point is in the active set; a moving support is followed with its own care.
    if load.settles || trace.state.x.iter().all(|v| *v == 0.0) {
        return None;
    }
    let mut chain = trace.factors.chain.take()?;
    let before = chain.factorisations;
    let rates = decided(&mut chain, trace, load, active, &mut modes);
    trace.log.counts.factorisations += chain.factorisations - before;
    trace.factors.chain = Some(chain);
    rates.map(|rates| (modes, rates))
}

fn decided(
    chain: &mut ElasticChain,
    trace: &mut Trace,
    load: &Load,
    active: &[usize],
    modes: &mut [ContactMode],
) -> Option<Rates> {
    let at = (trace.state.load_step, load);
    for round in 0..ROUNDS[0] {
        trace.log.counts.rates.trials += 1;
        let (system, points) = (&trace.system, trace.state.points.as_slice());
        chain.set_modes(system, at, modes)?;
        chain.find_rates()?;
        let rates = chain.rates(system, load)?;
        let mut moved = leaving((system, points), (&rates, load), active, modes)?;
        if moved.is_empty() {
            if rates.nears_mechanism(2 * system.contacts) {
                return None;
            }
            let sizes = sizes((system, load), &rates);
            let good = chain.unchecked()? < UNCHECKED && chain.unbalanced() <= enough(&sizes) * sizes[0];
            let rates = if good { rates } else { refined(chain, (system, load), modes, rates)? };
            trace.log.counts.solves += rates.refinements;
            return Some(rates);
        }
        if round >= ROUNDS[1] {
            moved.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            moved.truncate(1);
        }
        for (_, c, to) in moved {
            modes[c] = to;
        }
    }
    None
}

/// Sizes of forces and motions to which residuals are relative.
fn sizes((system, load): (&System, &Load), rates: &Rates) -> [f64; 2] {
    let (forces, motions) = rates.x.split_at(2 * system.contacts);
    let forces = largest(forces).max(load.size).max(f64::MIN_POSITIVE);
    [forces, largest(motions).max(forces)]
}

/// Relative residual up to which rates of these sizes need no refinement.
fn enough([forces, motions]: &[f64; 2]) -> f64 {
    RESIDUAL[0].max(ERROR * forces / motions)
}

/// Rates refined against the equations of all joints. `None` where they are not believed.
fn refined(
    chain: &mut ElasticChain,
    (system, load): (&System, &Load),
    modes: &[ContactMode],
    mut rates: Rates,
) -> Option<Rates> {
    let sizes = |rates: &Rates| sizes((system, load), rates);
    let (mut worst, mut left) = chain.examined(load, sizes(&rates))?;
    if worst > RESIDUAL[2] {
        chain.factorise(system, load, modes)?;
        chain.find_rates()?;
        rates = chain.rates(system, load)?;
        (worst, left) = chain.examined(load, sizes(&rates))?;
    }
    let enough = enough(&sizes(&rates));
    let calm = worst <= CALM * enough;
    let mut refinements = 0;
    while refinements < REFINEMENTS as u64 && worst > enough {
        refinements += 1;
        let before = chain.refine(left)?;
        let better = chain.rates(system, load)?;
        let (now, still) = chain.examined(load, sizes(&better))?;
        if now >= worst {
            chain.set_rates(Some(before));
            break;
        }
        let rounding = now > 0.5 * worst;
        (rates, worst, left) = (better, now, still);
        if rounding {
            break;
        }
    }
    if worst > RESIDUAL[1] {
        chain.set_rates(None);
        return None;
    }
    chain.checked(if calm { 0 } else { UNCHECKED });
    (rates.worst, rates.refinements) = (worst, refinements);
    Some(rates)
}
