//! The modes at the first motion of an unloaded structure.
//!
//! Without forces there is no rotation yet, so that the rates with small and with finite displacements are the same:
//! the rate problem of the first piece, with all contact points in its active set.

use super::direction::{Next, next_direction};
use super::trace::Trace;
use crate::contact::mode::ContactMode;
use crate::path::system::Load;
use voussoir_core::path::{PathProblem, PathSettings, Unobserved};

/// Returns the modes of all contact points just after the start of a load step at a state without forces; the factor
/// changes in the sense `sense` (1 or −1).
///
/// # Errors
/// The reason why no such modes are found.
pub fn first_modes(
    problem: &PathProblem,
    settings: &PathSettings,
    load_step: usize,
    sense: f64,
) -> Result<Vec<ContactMode>, String> {
    let mut unobserved = Unobserved;
    let mut trace = Trace::new(problem, settings, &mut unobserved);
    trace.state.load_step = load_step;
    let load = Load::new(&trace.system, problem, &problem.load_steps[load_step].loading).reversed_if(sense < 0.0);
    match next_direction(&mut trace, &load).next {
        Next::Go(_) => Ok(trace.state.points.into_iter().map(|point| point.mode).collect()),
        Next::Falling(_) | Next::Nothing | Next::NoneRises(_) => Err("no rate of equilibrium leads on".into()),
        Next::Lost(why) => Err(why),
    }
}
