//! The modes after an event, from the rate problem of the points whose modes end.

use super::monitors::{Monitor, Monitors, What};
use super::piece::Piece;
use crate::contact::active_point::ActivePoint;
use crate::contact::facet::dot;
use crate::contact::mode::ContactMode;
use crate::linear::largest;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::solve::active_set::active_facets;
use crate::path::newton::solve::nearby::Accuracy;
use crate::path::newton::solve::rate_after_event::{AfterEvent, EventPoints, normalised, rate_after_event};
use crate::path::newton::solve::tangent::tangent_of_modes;
use voussoir_core::law::FacetMode;

/// A rate with its modes.
pub(super) type Start = (Tangent, Vec<ContactMode>);

/// The continuation after an event.
pub(super) enum NextPiece {
    /// A rate with its modes.
    Goes {
        rate: Tangent,
        modes: Vec<ContactMode>,
        /// Number of other rates that the rule does not distinguish from it.
        twins: usize,
        /// If it is not decided that no rate has a growing factor: the reason.
        open: Option<String>,
    },
    /// No continuation: the reason, if no rate has a growing factor, and if it is proved that none continues.
    Nothing { why: String, none_rises: bool, proved: bool },
}

/// Returns the modes that a point of an event may enter.
fn candidates(system: &StepSystem, state: &State, contact: usize, closes: bool) -> Vec<ContactMode> {
    let Some(law) = system.law(contact) else { return Vec::new() };
    let Some((active, open)) = active_facets(system, state, contact, (largest(state.force.as_flattened()), closes))
    else {
        return Vec::new();
    };
    let apex = open.is_none() && ActivePoint::is_apex(&law.facets, &active);
    let point = ActivePoint { facets: &law.facets, active, open, apex, guess: ContactMode::Stick, stiffness: 1.0 };
    point.candidates()
}

/// Returns the facets that flow in a mode.
fn flowing(system: &StepSystem, contact: usize, mode: ContactMode) -> Vec<u8> {
    let facets = system.law(contact).map_or(&[][..], |law| &law.facets);
    match mode {
        ContactMode::Stick => Vec::new(),
        ContactMode::Facet(i) => vec![i],
        ContactMode::Corner(i, j) => vec![i, j],
        ContactMode::Open => {
            (0..facets.len() as u8).filter(|f| facets[*f as usize].mode == FacetMode::Opening).collect()
        }
    }
}

/// Returns the sum of the rates of quantities that grow when a point changes from one mode to another: the multipliers of
/// facets that begin to flow, the slack of facets that stop.
fn entering(system: &StepSystem, rate: &Tangent, contact: usize, [from, to]: [ContactMode; 2]) -> f64 {
    let facets = system.law(contact).map_or(&[][..], |law| &law.facets);
    let [before, after] = [from, to].map(|mode| flowing(system, contact, mode));
    let u = system.units();
    let multiplier = |f: &u8| {
        let d = facets[*f as usize].flow;
        -dot(d, rate.gap[contact]) / dot(d, d) / u.displacement
    };
    let slack = |f: &u8| -dot(facets[*f as usize].normal, rate.force[contact]) / u.force;
    let begin: f64 = after.iter().filter(|f| !before.contains(f)).map(multiplier).sum();
    begin + before.iter().filter(|f| !after.contains(f)).map(slack).sum::<f64>()
}

/// Returns the rate with some modes, in the sense in which points enter them. `None` if there is none.
fn entering_rate(
    system: &mut StepSystem,
    state: &State,
    piece: &Piece,
    monitors: &[Monitor],
    modes: &[ContactMode],
) -> Option<Tangent> {
    let equations = system.equations(state);
    let turned = State { mode: modes.to_vec(), ..state.clone() };
    let rate = tangent_of_modes(system, &turned, &equations, &piece.row, Accuracy::Fine)?;
    let stops_flowing = |c: usize| monitors.iter().any(|m| m.contact == c && matches!(m.what, What::Flow(_)));
    let enters = (0..modes.len()).filter(|c| modes[*c] != state.mode[*c] && !stops_flowing(*c));
    // A point that stops flowing has the same rate on both sides of the event.
    let sense: f64 = enters.map(|c| entering(system, &rate, c, [state.mode[c], modes[c]])).sum();
    Some(if sense < 0.0 { rate.scaled(-1.0) } else { rate })
}

/// Returns true if a rate violates none of its modes immediately.
pub(super) fn is_admissible(system: &StepSystem, state: &State, modes: &[ContactMode], rate: &Tangent) -> bool {
    let turned = State { mode: modes.to_vec(), ..state.clone() };
    let monitors = Monitors::of(system, &turned);
    !monitors.read(system, &turned, &turned, rate).iter().any(|reading| reading.leaves())
}

/// Returns the rates with which the only point of an event enters a new mode; all others keep theirs. Rates of a falling
/// path that only unload are left out, as in [`Arrival`](crate::rate::arrival::Arrival).
fn crossings(system: &mut StepSystem, state: &State, piece: &Piece, hits: &[Monitor], rises: bool) -> Vec<Start> {
    let contact = hits[0].contact;
    let closes = hits.iter().any(|hit| hit.what == What::Opening);
    let stops = rises || hits.iter().any(|hit| matches!(hit.what, What::Flow(_)));
    let slides = system.law(contact).is_some_and(|law| state.mode[contact].slides(&law.facets));
    let mut found: Vec<Start> = Vec::new();
    for mode in candidates(system, state, contact, closes) {
        let mut modes = state.mode.clone();
        modes[contact] = normalised(system, contact, mode);
        let only_unloads = modes[contact] == ContactMode::Stick && slides && !stops;
        if modes[contact] == state.mode[contact] || only_unloads {
            continue;
        }
        if let Some(rate) = entering_rate(system, state, piece, hits, &modes)
            && is_admissible(system, state, &modes, &rate)
        {
            found.push((rate, modes));
        }
    }
    found
}

/// Returns the contact points of monitors.
fn event_points(hits: &[Monitor]) -> EventPoints {
    let of = |belongs: &dyn Fn(What) -> bool| {
        let mut contacts: Vec<usize> = hits.iter().filter(|hit| belongs(hit.what)).map(|hit| hit.contact).collect();
        contacts.sort_unstable();
        contacts.dedup();
        contacts
    };
    EventPoints {
        all: of(&|_| true),
        stopping: of(&|what| matches!(what, What::Flow(_))),
        closing: of(&|what| what == What::Opening),
    }
}

/// Returns the piece after an event at a state, for the monitors that end there. `direction`: the sense in which the
/// factor should grow; `rises`: true if it has grown up to the event.
///
/// If one point ends its mode, the solution curve crosses into a neighbouring cell, and the rate in it is the
/// continuation. The whole rate problem is solved if there are several points, if there is not exactly one admissible
/// crossing, and before the factor turns, because another rate may rise.
pub(super) fn after_event(
    system: &mut StepSystem,
    state: &State,
    piece: &Piece,
    hits: &[Monitor],
    (direction, rises): (f64, bool),
) -> NextPiece {
    let single = hits.iter().all(|m| m.contact == hits[0].contact);
    let mut crossing = if single { crossings(system, state, piece, hits, rises) } else { Vec::new() }.into_iter();
    if let (Some((rate, modes)), None) = (crossing.next(), crossing.next())
        && (!rises || rate.factor * direction > 0.0)
    {
        return NextPiece::Goes { rate, modes, twins: 0, open: None };
    }
    system.count("rate_problems", 1);
    let sense = if rises { 1.0 } else { -1.0 };
    match rate_after_event(system, state, &event_points(hits), (direction, sense)) {
        AfterEvent::Goes { rate, modes, twins, none_rises } => {
            let open = (!none_rises).then(|| "a rate with a growing factor is not excluded".to_string());
            NextPiece::Goes { rate, modes, twins, open }
        }
        AfterEvent::Nothing => NextPiece::Nothing {
            why: "no rate of equilibrium leads on from the event".into(),
            none_rises: true,
            proved: true,
        },
        AfterEvent::Unknown(why, none_rises) => {
            NextPiece::Nothing { why: format!("the rate is not decided: {why}"), none_rises, proved: false }
        }
    }
}
