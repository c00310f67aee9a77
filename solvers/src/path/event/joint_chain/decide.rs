//! The rate problem on the chain: modes change until no point violates its mode, before refinement of the rates and after it.

use super::chain::JointChain;
use crate::contact::mode::ContactMode;
use crate::linear::largest;
use crate::path::event::piece::factorisation::REFINEMENTS;
use crate::path::event::piece::point::Point;
use crate::path::event::piece::rates::{Rates, leaving};
use crate::path::system::{Load, System};
use crate::settings::SETTINGS;

/// Greatest number of rounds of the active set, and the number of first rounds in which all points change at once.
const ROUNDS: [usize; 2] = [40, 12];
/// Number of corrections after which rates are examined again; each adds rounding errors of its change. Resultants,
/// which determine the collapse load, are examined each time.
const UNCHECKED: usize = 8;

/// A rate problem of the chain.
pub struct Question<'a> {
    /// The problem in its units.
    pub system: &'a System,
    /// All contact points.
    pub points: &'a [Point],
    /// The load that grows.
    pub load: &'a Load,
    /// Points that have a choice.
    pub active: &'a [usize],
}

/// Returns the modes of all points, starting from a guess, and the rates in them with λ̇ = 1. `None` if the whole
/// system must be solved. `trials` counts rounds.
pub fn by_joint_chain(
    chain: &mut JointChain,
    question: &Question,
    load_step: usize,
    mut modes: Vec<ContactMode>,
    trials: &mut u64,
) -> Option<(Vec<ContactMode>, Rates)> {
    let Question { system, points, load, active } = *question;
    for round in 0..ROUNDS[0] {
        *trials += 1;
        chain.set_modes(system, (load_step, load), &modes)?;
        chain.find_rates()?;
        let mut rates = chain.rates(system, load)?;
        let mut moved = leaving((system, points), (&rates, load), active, &modes)?;
        if moved.is_empty() {
            if rates.nears_mechanism(2 * system.contacts) {
                return None;
            }
            let sizes = sizes((system, load), &rates);
            let good = chain.unchecked()? < UNCHECKED && chain.unbalanced() <= enough(&sizes) * sizes[0];
            if !good {
                rates = refined(chain, (system, load), &modes, rates)?;
                moved = leaving((system, points), (&rates, load), active, &modes)?;
            }
        }
        if moved.is_empty() {
            return Some((modes, rates));
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

/// Returns the sizes of forces and motions to which residuals are relative.
fn sizes((system, load): (&System, &Load), rates: &Rates) -> [f64; 2] {
    let (forces, motions) = rates.x.split_at(2 * system.contacts);
    let forces = largest(forces).max(load.size).max(f64::MIN_POSITIVE);
    [forces, largest(motions).max(forces)]
}

/// Returns the relative residual up to which rates of these sizes need no refinement.
fn enough([forces, motions]: &[f64; 2]) -> f64 {
    SETTINGS.refined.max(SETTINGS.error_of_forces() * forces / motions)
}

/// Returns rates refined with the equations of all joints. `None` if they are not accurate.
fn refined(
    chain: &mut JointChain,
    (system, load): (&System, &Load),
    modes: &[ContactMode],
    mut rates: Rates,
) -> Option<Rates> {
    let sizes = |rates: &Rates| sizes((system, load), rates);
    let (mut worst, mut left) = chain.examined(load, sizes(&rates))?;
    if worst > SETTINGS.shift() {
        chain.factorise(system, load, modes)?;
        chain.find_rates()?;
        rates = chain.rates(system, load)?;
        (worst, left) = chain.examined(load, sizes(&rates))?;
    }
    let enough = enough(&sizes(&rates));
    let calm = worst <= SETTINGS.calm * enough;
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
    if worst > SETTINGS.residual() {
        chain.set_rates(None);
        return None;
    }
    chain.checked(if calm { 0 } else { UNCHECKED });
    (rates.worst, rates.refinements) = (worst, refinements);
    Some(rates)
}
