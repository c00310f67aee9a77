//! The rate that continues a path from a converged state: after an event, or under a load that begins to grow.
//!
//! With the points of the [active set](super::active_set) stuck, equilibrium and elasticity are one factorisation. It gives the
//! rate problem ṙ = S ġ + s λ̇ over these points ([`rate::problem`](crate::rate::problem)).

use super::active_set::{ActiveSet, active_set};
use super::responses::Responses;
use super::tangent::tangent_from;
use crate::contact::active_point::ActivePoint;
use crate::contact::mode::ContactMode;
use crate::linear::{inner, largest};
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::twins::favoured;
use crate::rate::answer::{Budget, Continuation, answer};
use crate::rate::arrival::{Arrival, ArrivalPoint};
use crate::rate::counts::RateCounts;
use crate::rate::problem::{Rate, RateProblem};
use nalgebra::{DMatrix, DVector};

/// The continuation of a path after an event.
pub enum AfterEvent {
    /// A rate with its modes.
    Goes {
        rate: Tangent,
        modes: Vec<ContactMode>,
        /// Number of other rates that the rule does not distinguish from it.
        twins: usize,
        /// Set if it is proved that no rate has a growing factor.
        none_rises: bool,
    },
    /// It is proved that no rate continues the path, so `none_rises` holds.
    Nothing,
    /// Undecided, with the reason; true if it is proved that no rate has a growing factor.
    Unknown(String, bool),
}

/// The contact points of an event.
#[derive(Debug, Default)]
pub struct EventPoints {
    /// All points.
    pub all: Vec<usize>,
    /// Points whose slip ends.
    pub stopping: Vec<usize>,
    /// Points that close.
    pub closing: Vec<usize>,
}

/// Finds the rate that continues a path after an event. `direction`: the sense in which the factor should grow;
/// `sense`: 1 if it has grown up to the event, 0 if it was constant, −1 if it fell.
pub fn rate_after_event(
    system: &mut StepSystem,
    state: &State,
    event: &EventPoints,
    (direction, sense): (f64, f64),
) -> AfterEvent {
    let active = active_set(system, state, &event.closing);
    system.count("factorisations", 1);
    let equations = system.equations(state);
    let Some(responses) = Responses::new(system, state, &active, &equations, direction) else {
        return AfterEvent::Unknown("the stiffness of the active set was not found".into(), false);
    };
    let mut problem = rate_problem(system, &active, &responses.unit);
    let load = responses.unit[2 * active.contacts.len()].iter().zip(&equations.factor);
    problem.load_flexibility = load.map(|(x, p)| x * p * direction).sum();
    problem.settles = system.settles();
    problem.metric = Some(metric(system, &responses.unit));
    let point = |c: &usize| ArrivalPoint {
        mode: state.mode[*c],
        hit: event.all.contains(c),
        stops: event.stopping.contains(c),
        force: state.force[*c],
    };
    let arrival = Arrival::new(sense, active.contacts.iter().map(point), largest(state.force.as_flattened()));
    let mut counts = RateCounts::default();
    let found = answer(&problem, &arrival, &Budget::default(), &mut counts);
    drop(problem);
    system.count("rate_combinations", counts.trials);
    let none_rises = found.none_rises.is_some();
    match found.continuation {
        Continuation::Goes { rate, twins } => {
            let others = twins.len();
            let tangent = |rate: &Rate| {
                let mut x = responses.combined(&rate.gaps, rate.factor)?;
                x.push(rate.factor * direction);
                Some(tangent_from(system, &x, state, &equations))
            };
            let mut rates: Vec<Rate> = std::iter::once(rate).chain(twins).collect();
            let Some(mut tangents) = rates.iter().map(tangent).collect::<Option<Vec<Tangent>>>() else {
                return AfterEvent::Unknown("a rate could not be corrected".into(), none_rises);
            };
            let motions: Vec<&[[f64; 3]]> = tangents.iter().map(|tangent| &tangent.motion[..]).collect();
            let chosen = favoured(system.problem, system.loads.earlier.len(), &motions);
            let (rate, own) = (tangents.swap_remove(chosen), rates.swap_remove(chosen).modes);
            let mut modes = active.modes;
            active.contacts.iter().zip(own).for_each(|(c, mode)| modes[*c] = normalised(system, *c, mode));
            AfterEvent::Goes { rate, modes, twins: others, none_rises }
        }
        Continuation::NoneContinues(_) => AfterEvent::Nothing,
        Continuation::Open(why) => AfterEvent::Unknown(why, none_rises),
    }
}

/// Returns the rate with which the factor grows in the sense `direction` from a state, and its modes; `None` if it is proved that
/// the factor cannot grow.
///
/// # Errors
/// The reason why it is undecided.
pub fn rising_rate(
    system: &mut StepSystem,
    state: &State,
    direction: f64,
) -> Result<Option<(Tangent, Vec<ContactMode>)>, String> {
    match rate_after_event(system, state, &EventPoints::default(), (direction, 1.0)) {
        AfterEvent::Goes { none_rises: true, .. } | AfterEvent::Nothing | AfterEvent::Unknown(_, true) => Ok(None),
        AfterEvent::Goes { rate, modes, .. } if rate.factor * direction > 0.0 => Ok(Some((rate, modes))),
        AfterEvent::Goes { .. } => Err("it is not proved that no rate raises the load".into()),
        AfterEvent::Unknown(why, false) => Err(why),
    }
}

/// Returns the products of the motions for unit gap rates and, last, of motions and factor for λ̇ = 1.
fn metric(system: &StepSystem, responses: &[Vec<f64>]) -> DMatrix<f64> {
    let first = 2 * system.scaled.contacts;
    let n = responses.len();
    let own = |i: usize, j: usize| if i == n - 1 && j == n - 1 { 1.0 } else { 0.0 };
    DMatrix::from_fn(n, n, |i, j| inner(&responses[i][first..], &responses[j][first..]) + own(i, j))
}

/// Returns the mode of a corner, which is the same for all pairs of its facets.
pub fn normalised(system: &StepSystem, contact: usize, mode: ContactMode) -> ContactMode {
    match mode {
        ContactMode::Corner(i, j) => {
            system.law(contact).and_then(|law| law.mode_of_pair(i as usize, j as usize)).unwrap_or(mode)
        }
        other => other,
    }
}

pub fn rate_problem<'s>(system: &'s StepSystem, active: &ActiveSet, responses: &[Vec<f64>]) -> RateProblem<'s> {
    let n = 2 * active.contacts.len();
    let force = |i: usize, x: &[f64]| x[2 * active.contacts[i / 2] + i % 2];
    let point = |(c, (facets, open)): (&usize, &(Vec<usize>, Option<usize>))| {
        let law = system.law(*c).map_or(&[][..], |law| &law.facets);
        ActivePoint {
            facets: law,
            active: facets.clone(),
            open: *open,
            apex: open.is_none() && ActivePoint::is_apex(law, facets),
            guess: ContactMode::Stick,
            stiffness: 1.0,
        }
    };
    RateProblem {
        points: active.contacts.iter().zip(&active.facets).map(point).collect(),
        s: DMatrix::from_fn(n, n, |i, j| force(i, &responses[j])),
        load_rate: DVector::from_fn(n, |i, _| force(i, &responses[n])),
        load_force: largest(&responses[n][..2 * system.scaled.contacts]),
        load_flexibility: 0.0,
        metric: None,
        settles: false,
    }
}
