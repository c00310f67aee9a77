//! The mechanism of limit analysis as a candidate for the rate at the end of a path that its solver left open.
//!
//! With small displacements and joints that resist by friction alone, no state of a path is above the associated load. A last
//! state at this load, with velocities that obey the laws' own flow at its forces, is a collapse: the load is stationary along
//! the velocities, and no rate raises it. The velocities may come from any source.

use super::associated_load::AssociatedLoad;
use super::path_status::meeting_bounds;
use crate::results::path_state::small;
use voussoir_core::certificate::{flow_residual, power_residual};
use voussoir_core::limit::Status;
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{PathAnswer, PathProblem};

/// Ends a path that is open at the associated load with the mechanism of this load, if its last state allows it.
pub(super) fn end_in_limit_mechanism(
    assembly: &Assembly,
    problem: &PathProblem,
    load: &AssociatedLoad,
    solved: &mut PathAnswer,
) {
    let is_open = matches!(solved.status, Status::Open | Status::Stalled);
    let Some(step) = problem.load_steps.last().filter(|step| is_open && !step.gravity) else { return };
    let state = &solved.state;
    let at_load = state.load_step + 1 == problem.load_steps.len() && meeting_bounds(state.factor, load).is_some();
    if !at_load || load.motion.len() != assembly.bodies.len() || state.force.len() != problem.contacts.len() {
        return;
    }
    let rates = about_poles(assembly, problem, load);
    let flows = small("path_flow", flow_residual(problem, &state.force, &rates));
    if flows && small("path_power", power_residual(problem, &step.loading, &rates)) {
        solved.notes.push("the mechanism of limit analysis proves the end of the path".into());
        (solved.status, solved.factor, solved.last) = (Status::Collapse, Some(state.factor), None);
        (solved.load_step, solved.motion, solved.unique) = (state.load_step, Some(rates), None);
    }
}

/// Returns velocities of the path's bodies about their poles.
fn about_poles(assembly: &Assembly, problem: &PathProblem, load: &AssociatedLoad) -> Vec<[f64; 3]> {
    let mut rates = vec![[0.0; 3]; problem.bodies.len()];
    for (block, entry) in load.motion.iter().enumerate() {
        let [x, y, omega] = entry.velocity;
        let body = problem.body_of[block];
        let v = Vec2::new(x, y) + turned(problem.bodies[body].pole - assembly.inertia(block).centroid) * omega;
        rates[body] = [v.x, v.y, omega];
    }
    rates
}
