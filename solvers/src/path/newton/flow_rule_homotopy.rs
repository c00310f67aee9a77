//! Flow that is not associated, turned into it from associated flow, with which every step is a monotone
//! problem.

use super::control::Control;
use super::state::State;
use super::step::solve_step;
use super::system::StepSystem;
use crate::contact::facet::{FLOW_SHARES, with_flow_between};
use crate::contact::yield_polygon::YieldPolygon;

/// Takes slip to be associated; the laws as they were.
pub(super) fn take_associated(system: &mut StepSystem) -> Vec<YieldPolygon> {
    let own = system.laws.polygons.clone();
    blend(system, &own, 0.0);
    own
}

/// Turns the flow from the facets' normals (0) to the given laws' own (1).
fn blend(system: &mut StepSystem, laws: &[YieldPolygon], own: f64) {
    let turned = |law: &YieldPolygon| YieldPolygon::new(&with_flow_between(&law.facets, own));
    system.laws.polygons = laws.iter().map(turned).collect();
}

/// A state at a factor by turning the flow of associated slip, which has one where any has, step by
/// step into the laws' own.
pub(super) fn by_flow_rule_homotopy(system: &mut StepSystem, start: &State, factor: f64) -> Option<State> {
    let own = system.laws.polygons.clone();
    let mut guess = start.clone();
    let mut found = None;
    for share in FLOW_SHARES {
        blend(system, &own, share);
        guess.factor = factor;
        found = solve_step(system, start, guess.clone(), &Control::Factor(factor)).ok().map(|(state, _)| state);
        match &found {
            Some(state) => guess = state.clone(),
            None if share == 0.0 => break,
            None => {}
        }
    }
    system.laws.polygons = own;
    found
}
