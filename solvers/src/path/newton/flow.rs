//! Flow that is not associated, turned into it from associated flow, with which every step is a monotone
//! problem.

use super::control::Control;
use super::law::Polygon;
use super::state::State;
use super::step::solve_step;
use super::system::StepSystem;
use voussoir_core::law::Facet;

/// Takes slip to be associated; the laws as they were.
pub(super) fn take_associated(system: &mut StepSystem) -> Vec<Polygon> {
    let own = system.laws.polygons.clone();
    blend(system, &own, 0.0);
    own
}

/// Turns the flow from the facets' normals (0) to the given laws' own (1).
fn blend(system: &mut StepSystem, laws: &[Polygon], own: f64) {
    let flow = |f: &Facet| [0, 1].map(|i| (1.0 - own) * f.normal[i] + own * f.flow[i]);
    let turned =
        |law: &Polygon| Polygon::new(&law.facets.iter().map(|f| Facet { flow: flow(f), ..*f }).collect::<Vec<_>>());
    system.laws.polygons = laws.iter().map(turned).collect();
}

/// A state at a factor by turning the flow of associated slip, which has one where any has, step by
/// step into the laws' own.
pub(super) fn by_flow_rule_homotopy(system: &mut StepSystem, start: &State, factor: f64) -> Option<State> {
    let own = system.laws.polygons.clone();
    let mut guess = start.clone();
    let mut found = None;
    for share in [0.0, 0.3, 0.55, 0.75, 0.9, 1.0] {
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
