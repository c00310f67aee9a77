//! `newton_path`: semismooth Newton on the modes of contact points, small and finite displacements.
#![doc = include_str!("newton_path.md")]

mod load_steps;
mod load_to_factor;
mod model;
mod pieces;
mod quantities;
mod solve;
mod step_equations;
mod time_steps;
mod tracing;

pub use self::step_equations::{PathPoint, StepEquations, Trial};

use super::event::{self, is_piecewise_linear};
use crate::path::newton::quantities::monitors::resolve;
use voussoir_core::path::{PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver};
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};

/// Steps with Newton's method.
#[derive(Debug, Clone, Default, Keys)]
pub struct NewtonPath {}

#[typetag::serde(name = "newton_path")]
impl PathSolver for NewtonPath {
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
        if let Some(why) = self.refuses(problem, settings) {
            return PathAnswer::stalled(why);
        }
        if is_piecewise_linear(problem, settings) {
            return event::follow(problem, settings, observer);
        }
        load_steps::trace(problem, settings, observer)
    }

    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String> {
        if problem.load_steps.is_empty() {
            return Some("nothing is loaded".into());
        }
        if !problem.deforms() {
            let why =
                "rigid blocks without joint compliance have no path before their collapse: limit analysis answers them";
            return Some(why.into());
        }
        settings.strategies().find_map(|strategy| resolve(problem, &strategy.monitors()).err())
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::PathSolver,
        tag: "newton_path",
        summary: "paths with any joint law, blocks that yield, small or finite displacements: pieces between located events, or load steps by semismooth Newton",
        provides: &[Capability::FINITE_DISPLACEMENTS, Capability::SETTLEMENT],
        requires: &[&[Capability::FACETS, Capability::RESPONSE]],
        cost: Some(20),
        sources: &[
            "Alart & Curnier 1991, Comput. Methods Appl. Mech. Engng 92, 353-375",
            "De Saxce & Feng 1998, Math. Comput. Modelling 28, 225-245",
            "Crisfield 1981, Computers & Structures 13, 55-62",
            "Wriggers 2006, Computational Contact Mechanics, Springer",
            "de Borst 1987, Computers & Structures 25, 211-224",
            "Judice & Pires 1994, Computers & Operations Research 21, 587-596",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("newton_path.md"),
        ..Card::of::<NewtonPath>()
    }
}

#[cfg(test)]
mod tests;
