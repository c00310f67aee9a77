//! The active set of a state: points that may change their modes in its rate.
//!
//! Points with slack in all facets stay stuck; open points without strength stay open. The other points are the active set.

use crate::contact::active_point::complete_corners;
use crate::contact::facet::slack;
use crate::contact::mode::ContactMode;
use crate::linear::largest;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::settings::SETTINGS;
use voussoir_core::law::FacetMode;

/// The active set of a state.
pub struct ActiveSet {
    /// Contact points.
    pub contacts: Vec<usize>,
    /// Facets of each point without slack, and the opening facet if it is open with a strength.
    pub facets: Vec<(Vec<usize>, Option<usize>)>,
    /// Modes of all points; points of the active set are stuck.
    pub modes: Vec<ContactMode>,
}

/// Returns the points that may change their modes: without slack, at the tip of opening, or closing.
pub fn active_set(system: &StepSystem, state: &State, closing: &[usize]) -> ActiveSet {
    let mut active = ActiveSet { contacts: Vec::new(), facets: Vec::new(), modes: state.mode.clone() };
    let largest = largest(state.force.as_flattened());
    for c in 0..active.modes.len() {
        let Some((facets, open)) = active_facets(system, state, c, (largest, closing.contains(&c))) else { continue };
        active.modes[c] = ContactMode::Stick;
        if !facets.is_empty() || open.is_some() {
            active.contacts.push(c);
            active.facets.push((facets, open));
        }
    }
    active
}

/// Returns the facets of a contact point without slack, and its opening facet if it is open and may carry a force.
/// `None` if it stays open without a force, or has no facets.
pub fn active_facets(
    system: &StepSystem,
    state: &State,
    contact: usize,
    (largest, closes): (f64, bool),
) -> Option<(Vec<usize>, Option<usize>)> {
    let law = system.law(contact)?;
    let (area, r) = (system.problem.contacts[contact].area, state.force[contact]);
    let (_, opening) = law.irreversible(state.mode[contact], system.step_gap(state, state, contact));
    let is_open =
        !closes && law.opens(state.mode[contact]) && opening > SETTINGS.admissible * system.units().displacement;
    if is_open && state.mode[contact] == ContactMode::Open {
        return None;
    }
    let open = (0..law.facets.len()).find(|i| is_open && law.facets[*i].mode == FacetMode::Opening);
    let tight = |i: &usize| slack(&law.facets[*i], r, area) <= SETTINGS.active * largest;
    let mut active = (0..law.facets.len()).filter(tight).collect();
    complete_corners(&law.facets, &mut active);
    Some((active, open))
}
