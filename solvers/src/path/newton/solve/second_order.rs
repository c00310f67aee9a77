//! Second-order work of a converged state: the flexibility of its bodies with the contact modes held, computed column
//! by column from the factorised equations.

use super::linearised::factorised;
use super::nearby::Accuracy;
use super::tangent::{tangent_at, tangent_from};
use crate::contact::facet::slack;
use crate::contact::mode::ContactMode;
use crate::linear::bordered::BorderedSystem;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::factors::ModeEquations;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::control_row::control_row;
use crate::path::newton::quantities::measure::increment_along;
use crate::path::stability::{SecondOrderWork, over_weak_points, work_by_responses};
use crate::settings::SETTINGS;
use nalgebra::DMatrix;

/// Returns the second-order work of a state with its modes, loads and settlements held; `None` if its equations have no
/// factorisation.
pub fn second_order_work(system: &mut StepSystem, state: &State) -> Option<SecondOrderWork> {
    let held = held_factor(system, state)?;
    let (first, motions) = (2 * system.scaled.contacts, 3 * system.scaled.bodies);
    if motions == 0 {
        return None;
    }
    system.count("second_order_works", 1);
    work_by_responses(motions, |wrenches| images(&held, wrenches, first, system.size()))
}

fn held_factor(system: &mut StepSystem, state: &State) -> Option<BorderedSystem<ModeEquations>> {
    let equations = system.equations(state);
    let row = control_row(system, &Control::Factor(state.factor), &equations);
    let (held, _) = factorised(system, state, &equations, &row)?;
    BorderedSystem::new(held, &row)
}

/// Returns the motions that solve the equations for some right-hand sides.
fn solved(held: &BorderedSystem<ModeEquations>, rights: &[Vec<f64>], first: usize) -> Option<Vec<Vec<f64>>> {
    let mut found = held.equations().motions(first, rights)?;
    for z in &mut found {
        held.onto_control(z, first, 0.0);
        z.pop();
    }
    Some(found)
}

/// Returns S times the columns of a matrix. Balance is −∂V/∂q, so its matrix is −K.
fn images(
    held: &BorderedSystem<ModeEquations>,
    basis: &DMatrix<f64>,
    first: usize,
    size: usize,
) -> Option<DMatrix<f64>> {
    let right = |column: usize| {
        let mut right = vec![0.0; size];
        (0..basis.nrows()).for_each(|j| right[first + j] = -basis[(j, column)]);
        right
    };
    let rights: Vec<Vec<f64>> = (0..basis.ncols()).map(right).collect();
    let columns = solved(held, &rights, first)?;
    Some(DMatrix::from_fn(basis.nrows(), basis.ncols(), |i, j| columns[j][i]))
}

/// Returns the rate with the critical motion at a state whose equations are nearly singular. Loads and settlements are
/// held.
pub fn critical_rate(system: &mut StepSystem, state: &State, work: &SecondOrderWork) -> Option<Tangent> {
    let held = held_factor(system, state)?;
    let (first, mode) = (2 * system.scaled.contacts, work.critical_mode()?);
    let mut right = vec![0.0; system.size()];
    // The critical motion φ is an eigenvector: S φ = s φ.
    right[first..first + mode.len()].copy_from_slice(&mode);
    let mut found = held.apply(&right)?;
    let size = found[first..first + mode.len()].iter().map(|q| q * q).sum::<f64>().sqrt();
    found.iter_mut().for_each(|x| *x /= size);
    let equations = system.equations(state);
    Some(tangent_from(system, &found, state, &equations))
}

/// Stability of a state: true if second-order work is positive with its loads and settlements held, and with the load
/// point held. `None` if that is undecided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateStability {
    pub under_load: Option<bool>,
    pub under_control: Option<bool>,
    /// True if positive second-order work is only sufficient: some point slides without associated flow.
    pub sufficient_only: bool,
}

/// Returns the stability of a state at the end of a stage, in which a load grows or a support `settles`. At rest,
/// points that slide, or are about to, are weakly active: they may continue or stick. Second-order work must be
/// positive on the cone of these rates: positive with all of them free is sufficient; negative with all of them held is
/// instability.
pub fn stability(system: &mut StepSystem, state: &State, settles: bool) -> StateStability {
    let free = with_weak_points(system, state, |released, _| released);
    let held = with_weak_points(system, state, |_, held| held);
    let found = second_order_work(system, &free);
    let sufficient_only = found.as_ref().is_some_and(|work| !work.symmetric);
    let stuck = if free.mode == held.mode { found.clone() } else { second_order_work(system, &held) };
    let positive = |work: &Option<SecondOrderWork>| work.as_ref().map(|work| work.negative == 0);
    let under_load = over_weak_points(positive(&found), positive(&stuck));
    if settles || under_load == Some(true) {
        return StateStability { under_load, under_control: under_load, sufficient_only };
    }
    let mut controlled = |state: &State, work: &Option<SecondOrderWork>| {
        let rate = tangent_at(system, state, &Control::Factor(state.factor), Accuracy::Fine)?;
        let yields = increment_along(system, state, &rate).displacement;
        work.as_ref().map(|work| work.stable_under_control(yields))
    };
    let under_control = over_weak_points(controlled(&free, &found), controlled(&held, &stuck));
    StateStability { under_load, under_control, sufficient_only }
}

/// Returns true if a state is unstable under its loads with the sliding points held, too.
pub fn is_unstable_at_rest(system: &mut StepSystem, state: &State) -> bool {
    let held = with_weak_points(system, state, |_, held| held);
    second_order_work(system, &held).is_some_and(|work| work.turned > 0)
}

/// Returns the state with its weakly active points released or held: points that slide, and stuck points without slack.
fn with_weak_points(
    system: &StepSystem,
    state: &State,
    choose: impl Fn(ContactMode, ContactMode) -> ContactMode,
) -> State {
    let largest = state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    let mut chosen = state.clone();
    for (c, mode) in chosen.mode.iter_mut().enumerate() {
        let Some(law) = system.law(c) else { continue };
        let (force, area) = (state.force[c], system.problem.contacts[c].area);
        let tight = |i: &usize| slack(&law.facets[*i], force, area) <= SETTINGS.admissible * largest;
        let released = match *mode {
            ContactMode::Stick if force.iter().all(|r| r.abs() <= SETTINGS.admissible * largest) => {
                Some(ContactMode::Open)
            }
            ContactMode::Stick => (0..law.facets.len()).find(tight).map(|facet| ContactMode::Facet(facet as u8)),
            own if law.opens(own) => None,
            own => Some(own),
        };
        if let Some(released) = released {
            *mode = choose(released, ContactMode::Stick);
        }
    }
    chosen
}
