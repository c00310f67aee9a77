//! Tests of pieces: their monitors, and steps along them up to events and targets.

mod monitors;
mod steps;

use super::piece::Piece;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::loads::StagedLoads;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::solve::nearby::Accuracy;
use crate::path::newton::solve::step::solve_step;
use crate::path::newton::solve::tangent::tangent_at;
use voussoir_core::path::PathProblem;

/// The system of the second load step, and the state at its start.
fn second_step(problem: &PathProblem) -> (StepSystem<'_>, State) {
    let mut system = StepSystem::new(problem, true).expect("a system");
    let [first, second] = [0, 1].map(|k| &problem.load_steps[k].loading);
    system.load(0, StagedLoads::new(Vec::new(), first, 0.0));
    let start = system.undeformed();
    let (mut state, _) = solve_step(&mut system, &start, start.clone(), &Control::Factor(1.0)).expect("a state");
    system.keep(&start, &mut state);
    system.load(1, StagedLoads::new(vec![(1.0, first)], second, 0.0));
    state.factor = 0.0;
    (system, state)
}

/// The piece of a state on which its modes hold and the factor grows.
fn piece_at(system: &mut StepSystem, state: &State) -> Piece {
    let rate = tangent_at(system, state, &Control::Factor(1.0), Accuracy::Fine).expect("a rate");
    Piece::new(system, state, &rate).expect("a piece")
}
