//! Modes of contact points under a small load: those with which a structure begins to move from nothing.

use super::control::Control;
use super::loads::StagedLoads;
use super::step::solve_step;
use super::system::StepSystem;
use crate::contact::mode::ContactMode;
use voussoir_core::path::{LoadStepEnd, PathProblem};

/// The small load, relative to the unit of the factor.
pub(in crate::path) const SMALL: f64 = 0.05;

/// The modes of the state under a small load of a load step, without earlier loads.
/// Newton's method keeps the symmetry of a scene, without which friction that is not associated may have other solutions.
pub(in crate::path) fn modes_of_small_load(problem: &PathProblem, load_step: usize) -> Option<Vec<ContactMode>> {
    let load_step = &problem.load_steps[load_step];
    let (LoadStepEnd::Factor(end) | LoadStepEnd::Collapse(end)) = load_step.end;
    let sense = if end < load_step.start { -1.0 } else { 1.0 };
    let mut system = StepSystem::new(problem, false).ok()?;
    system.load(StagedLoads { earlier: Vec::new(), growing: &load_step.loading, start: load_step.start });
    let mut start = system.undeformed();
    start.factor = load_step.start;
    let control = Control::Factor(load_step.start + sense * SMALL * system.units().factor);
    let (state, _) = solve_step(&mut system, &start, start.clone(), &control).ok()?;
    Some(state.mode)
}
