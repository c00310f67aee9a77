//! The rate of a state whose blocks and bonds yield or unload consistently with this rate.
//!
//! A point at its strength has one tangent if it yields and another one if it unloads. The yielding points are the
//! loading set of a rate. A rate continues the path if the tangents just ahead along it are those with which it was
//! computed.

use super::piece::Piece;
use crate::linear::inner;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::model::tractions::at;
use crate::path::newton::quantities::ahead::{facing_ahead, length_ahead};
use crate::path::newton::quantities::control_row::scaled_row;
use crate::path::newton::quantities::inelastic::plastic_power;
use crate::path::newton::solve::nearby::Accuracy;
use crate::path::newton::solve::tangent::tangent_of_modes;
use crate::settings::SETTINGS;

/// Greatest number of successive loading sets.
const MAX_SETS: usize = 30;
/// Greatest number of combinations of tangents that are tried if the sets do not converge.
const MAX_COMBINATIONS: usize = 256;

/// A rate with the state that has its tangents.
pub(super) struct LoadingRate {
    pub state: State,
    pub rate: Tangent,
}

/// A rate scaled to motions and factor of size 1, and the same over the scaled unknowns.
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

/// Returns the rate that continues from a state in its modes, at which a piece arrives. `None` if there is none.
pub(super) fn loading_rate(system: &mut StepSystem, state: &State, arrival: &Piece) -> Option<LoadingRate> {
    match system.laws.responses.is_empty() {
        true => dissipating_rate(system, state, arrival),
        false => bond_rate(system, state, arrival),
    }
}

/// Returns the rate by loading sets of bonds. Unloading, on which the factor turns and nothing dissipates, is not a
/// continuation. `None` if no loading set is consistent, or if there are no bonds.
pub(super) fn bond_rate(system: &mut StepSystem, state: &State, arrival: &Piece) -> Option<LoadingRate> {
    if system.laws.responses.is_empty() {
        return None;
    }
    let mut along = Unit::of(system, &arrival.tangent)?;
    let mut seen: Vec<State> = Vec::new();
    for _ in 0..MAX_SETS {
        let facing = facing_ahead(system, state, &along.rate)?;
        let found = rate_of(system, &facing, &arrival.row)?;
        let found = with_load(system, state, found);
        if seen.iter().any(|known| same_set(known, &facing)) {
            break;
        }
        seen.push(facing.clone());
        let turned = found.turned();
        let mut power = [f64::NEG_INFINITY; 2];
        for (power, rate) in power.iter_mut().zip([&found, &turned]) {
            let Some(ahead) = facing_ahead(system, state, &rate.rate) else { continue };
            *power = dissipation(system, state, &ahead, &rate.rate);
            seen.push(ahead.clone());
            let turns = rate.rate.factor * arrival.tangent.factor < 0.0;
            let again = rate_of(system, &ahead, &arrival.row)?;
            if inner(&again.row, &rate.row).abs() >= 1.0 - SETTINGS.admissible && !(turns && *power <= 0.0) {
                return Some(LoadingRate { state: ahead, rate: rate.rate.clone() });
            }
        }
        let forwards = inner(&found.row, &arrival.row) >= 0.0;
        let keeps = if power[0] == power[1] { forwards } else { power[0] > power[1] };
        along = if keeps { found } else { turned };
    }
    combined(system, state, arrival, &seen)
}

/// Returns a rate with a constant factor in the sense in which the load does work; other rates unchanged.
fn with_load(system: &mut StepSystem, state: &State, found: Unit) -> Unit {
    let stands = found.rate.factor.abs() <= SETTINGS.residual() * system.units().factor;
    match stands && inner(&found.row, &system.equations(state).factor) < 0.0 {
        true => found.turned(),
        false => found,
    }
}

/// Returns true if all bonds have the same branches in two states.
fn same_set(one: &State, other: &State) -> bool {
    one.updates.points.iter().zip(&other.updates.points).all(|(a, b)| a.branch == b.branch)
}

/// Returns the consistent rate with the greatest dissipation among all combinations of the tangents that the bonds of
/// each joint have in some states. `None` if there is none or if there are too many combinations.
fn combined(system: &mut StepSystem, state: &State, arrival: &Piece, seen: &[State]) -> Option<LoadingRate> {
    let first = seen.first()?;
    let mut joints: Vec<Vec<usize>> = Vec::new();
    for c in system.laws.responses.points() {
        let joint = system.problem.contacts[c].joint;
        match joints.iter_mut().find(|points| system.problem.contacts[points[0]].joint == joint) {
            Some(points) => points.push(c),
            None => joints.push(vec![c]),
        }
    }
    let options = |points: Vec<usize>| {
        let same = |a: usize, b: usize| {
            points.iter().all(|c| seen[a].updates.points[*c].branch == seen[b].updates.points[*c].branch)
        };
        let mut own: Vec<usize> = Vec::new();
        for index in 0..seen.len() {
            if !own.iter().any(|known| same(*known, index)) {
                own.push(index);
            }
        }
        (points, own)
    };
    let active: Vec<(Vec<usize>, Vec<usize>)> =
        joints.into_iter().map(options).filter(|(_, own)| own.len() > 1).collect();
    let count = active.iter().fold(1usize, |n, (_, own)| n.saturating_mul(own.len()));
    if count > MAX_COMBINATIONS {
        return None;
    }
    let mut best: Option<(f64, LoadingRate)> = None;
    for combination in 0..count {
        let (mut facing, mut rest) = (first.clone(), combination);
        for (points, own) in &active {
            for c in points {
                let from = &seen[own[rest % own.len()]].updates.points[*c];
                let to = &mut facing.updates.points[*c];
                (to.tangent, to.branch) = (from.tangent, from.branch);
            }
            rest /= own.len();
        }
        let Some(found) = rate_of(system, &facing, &arrival.row) else { continue };
        for rate in [found.turned(), found] {
            let Some(ahead) = facing_ahead(system, state, &rate.rate) else { continue };
            let power = dissipation(system, state, &ahead, &rate.rate);
            let unloads = rate.rate.factor * arrival.tangent.factor < 0.0 && power <= 0.0;
            if same_set(&ahead, &facing) && !unloads && best.as_ref().is_none_or(|(most, _)| power > *most) {
                best = Some((power, LoadingRate { state: ahead, rate: rate.rate.clone() }));
            }
        }
    }
    best.map(|(_, found)| found)
}

/// Returns the rate of blocks with the tangents just ahead along the arrival, in the sense that dissipates. Sets of
/// yielding points are not iterated: on coarse meshes they are consistent at fewer corners than a single look ahead.
fn dissipating_rate(system: &mut StepSystem, state: &State, arrival: &Piece) -> Option<LoadingRate> {
    let arrives = Unit::of(system, &arrival.tangent)?;
    let facing = facing_ahead(system, state, &arrives.rate)?;
    let found = rate_of(system, &facing, &arrival.row)?;
    let power = plastic_power(system, &facing, &found.rate);
    if !facing.yields() || power == 0.0 {
        return None;
    }
    let rate = if power < 0.0 { found.turned().rate } else { found.rate };
    Some(LoadingRate { state: facing, rate })
}

/// Returns the rate with the tangents of a state, of size 1.
fn rate_of(system: &mut StepSystem, state: &State, row: &[f64]) -> Option<Unit> {
    let equations = system.equations(state);
    let rate = tangent_of_modes(system, state, &equations, row, Accuracy::Fine)?;
    Unit::of(system, &rate)
}

/// Returns the dissipation of blocks and bonds in a short step along a rate \[J\].
fn dissipation(system: &StepSystem, state: &State, ahead: &State, rate: &Tangent) -> f64 {
    let length = length_ahead(system, state);
    let mut sum = length * plastic_power(system, ahead, rate);
    let gap = |c: usize| (c, [0, 1].map(|k| state.gap[c][k] + length * rate.gap[c][k]));
    let asked: Vec<(usize, [f64; 2])> = system.laws.responses.points().map(gap).collect();
    let points = at(&system.laws.responses, &asked, &state.updates.memory, &system.instant(state));
    let areas = asked.iter().map(|(c, _)| system.problem.contacts[*c].area);
    for (point, area) in points.into_iter().zip(areas).filter_map(|(point, area)| Some((point?, area))) {
        sum += area * point.dissipated;
    }
    sum
}
