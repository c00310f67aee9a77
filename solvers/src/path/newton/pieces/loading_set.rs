//! The rate of a state whose blocks and bonds yield on or unload as this very rate asks for.
//!
//! A point at its strength has one tangent if it yields on and another one if it unloads. The points that yield on are the loading
//! set of a rate. A rate leads on if the tangents ahead of the state along it are those that it was computed with.

use super::super::ahead::{AHEAD, facing_ahead};
use super::super::inelastic::plastic_power;
use super::super::nearby::Accuracy;
use super::super::state::{State, Tangent};
use super::super::system::StepSystem;
use super::super::tangent::tangent_of_modes;
use super::piece::{Piece, scaled_row};
use crate::linear::inner;

/// Loading sets that are tried one after the other.
const MOST_SETS: usize = 30;
/// Difference from 1 of the cosine of two rates that are the same.
const SAME: f64 = 1e-9;

/// A rate with the state whose tangents it has.
pub(super) struct LoadingRate {
    pub state: State,
    pub rate: Tangent,
}

/// A rate with motions and factor of size 1, and these over the scaled unknowns.
struct Unit {
    rate: Tangent,
    row: Vec<f64>,
}

impl Unit {
    fn of(system: &StepSystem, rate: &Tangent) -> Option<Unit> {
        let mut row = scaled_row(system, rate);
        let size = inner(&row, &row).sqrt();
        row.iter_mut().for_each(|x| *x /= size);
        (size.is_finite() && size > 0.0).then(|| Unit { rate: rate.scaled(1.0 / size), row })
    }

    fn turned(&self) -> Unit {
        Unit { rate: self.rate.scaled(-1.0), row: self.row.iter().map(|x| -x).collect() }
    }
}

/// The rate that leads on from a state in its modes, at which a piece arrives. Unloading, on which the factor turns and nothing dissipates, is no way on. `None` if no loading set is consistent.
pub(super) fn loading_rate(system: &mut StepSystem, state: &State, arrival: &Piece) -> Option<LoadingRate> {
    let mut along = Unit::of(system, &arrival.tangent)?;
    for _ in 0..MOST_SETS {
        let facing = facing_ahead(system, state, &along.rate)?;
        let found = rate_of(system, &facing, &arrival.row)?;
        let turned = found.turned();
        let mut power = [f64::NEG_INFINITY; 2];
        for (power, rate) in power.iter_mut().zip([&found, &turned]) {
            let Some(ahead) = facing_ahead(system, state, &rate.rate) else { continue };
            *power = dissipation(system, state, &ahead, &rate.rate);
            let turns = rate.rate.factor * arrival.tangent.factor < 0.0;
            let again = rate_of(system, &ahead, &arrival.row)?;
            if inner(&again.row, &rate.row).abs() >= 1.0 - SAME && !(turns && *power <= 0.0) {
                return Some(LoadingRate { state: ahead, rate: rate.rate.clone() });
            }
        }
        let forwards = inner(&found.row, &arrival.row) >= 0.0;
        let keeps = if power[0] == power[1] { forwards } else { power[0] > power[1] };
        along = if keeps { found } else { turned };
    }
    None
}

/// The rate with the tangents of a state, of size 1.
fn rate_of(system: &mut StepSystem, state: &State, row: &[f64]) -> Option<Unit> {
    let equations = system.equations(state);
    let rate = tangent_of_modes(system, state, &equations, row, Accuracy::Rounding)?;
    Unit::of(system, &rate)
}

/// Dissipation of blocks and bonds in a short step along a rate \[J\].
fn dissipation(system: &StepSystem, state: &State, ahead: &State, rate: &Tangent) -> f64 {
    let mut sum = AHEAD * plastic_power(system, ahead, rate);
    for c in system.laws.responses.points() {
        let gap = [0, 1].map(|k| state.gap[c][k] + AHEAD * rate.gap[c][k]);
        if let Some(point) = system.laws.responses.at(c, gap, &state.updates.memory) {
            sum += system.problem.contacts[c].area * point.dissipated;
        }
    }
    sum
}
