//! Events of a step: changes of the status of contact points.

use crate::contact::mode::ContactMode;
use crate::path::events::{ContactStatus, transition};
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use voussoir_core::law::{Effect, TractionPoint};
use voussoir_core::path::PathEvent;

/// Returns the status of a point in a mode of its facets.
fn of_mode(system: &StepSystem, contact: usize, mode: ContactMode, gap: [f64; 2]) -> ContactStatus {
    let Some(law) = system.law(contact) else { return ContactStatus::Sticks };
    match mode {
        ContactMode::Stick => ContactStatus::Sticks,
        ContactMode::Facet(i) => ContactStatus::of_facet(&law.facets[i as usize]),
        _ if law.opens(mode) => ContactStatus::Open,
        _ => {
            law.pair(mode, gap).map_or(ContactStatus::Sticks, |(pair, _)| ContactStatus::of_facet(&law.facets[pair[0]]))
        }
    }
}

/// Returns the status of a point whose law gives tractions from gaps.
fn of_tractions(point: &TractionPoint, gap: [f64; 2], slip: f64) -> ContactStatus {
    match point.branch.effect {
        _ if gap[0] > 0.0 && point.traction == [0.0; 2] && point.tangent == [[0.0; 2]; 2] => ContactStatus::Open,
        Effect::Softening => ContactStatus::Softens,
        Effect::Sliding => ContactStatus::Slides { forward: slip > 0.0 },
        _ => ContactStatus::Sticks,
    }
}

/// Returns the events of a step, in the order of the contact points.
pub fn events(system: &StepSystem, load_step: usize, start: &State, state: &State) -> Vec<PathEvent> {
    let of_point = |contact: usize| {
        let what = if system.laws.responses.is(contact) {
            let slip = state.gap[contact][1] - start.gap[contact][1];
            let status = |of: &State| of_tractions(&of.updates.points[contact], of.gap[contact], slip);
            transition(status(start), status(state))
        } else if start.mode[contact] == state.mode[contact] {
            None
        } else {
            let gap = system.step_gap(start, state, contact);
            let status = |of: &State| of_mode(system, contact, of.mode[contact], gap);
            transition(status(start), status(state))
        }?;
        Some(PathEvent { load_step, factor: state.factor, contact, what })
    };
    (0..state.gap.len()).filter_map(of_point).collect()
}
