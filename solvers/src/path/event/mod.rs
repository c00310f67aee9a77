//! `event_path`: elastic blocks with facet laws and small displacements, exactly from event to event.
//!
//! Between events everything is linear. At an event the points of the active set define a rate problem (`rate`); its
//! solution is the direction of the next piece of the path. λ is not the parameter of the path: it may be constant (a
//! mechanism) or fall.
#![doc = include_str!("event_path.md")]

mod direction;
mod energy;
mod first_modes;
mod follow;
mod joint_chain;
mod next_event;
mod piece;
mod stability;
mod trace;
mod unique;
mod witness;

pub(super) use self::first_modes::first_modes;
pub(super) use self::follow::follow;
use voussoir_core::path::{PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver};
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};

/// Returns true if the path consists of linear pieces.
pub(super) fn is_piecewise_linear(problem: &PathProblem, settings: &PathSettings) -> bool {
    obstacle(problem, settings).is_none()
}

/// Returns the obstacle to linear pieces, which need small displacements, facet laws and linear blocks.
fn obstacle(problem: &PathProblem, settings: &PathSettings) -> Option<&'static str> {
    if settings.finite {
        return Some("it follows small displacements only; newton_path follows finite ones");
    }
    if (0..problem.contacts.len()).any(|c| problem.response(c).is_some()) {
        return Some("it takes laws of facets only; newton_path follows laws of tractions from gaps");
    }
    if !problem.deforms() {
        return Some(
            "all blocks are rigid and no joint is compliant: there is no path before the collapse; limit analysis answers this scene",
        );
    }
    problem.yields().then_some("it follows linear blocks only; newton_path follows blocks that yield")
}

/// The exact path of piecewise linear problems.
#[derive(Debug, Clone, Default, Keys)]
pub struct EventPath {}

#[typetag::serde(name = "event_path")]
impl PathSolver for EventPath {
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
        follow(problem, settings, observer)
    }

    fn energy_tolerance(&self) -> f64 {
        1e-9
    }

    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String> {
        let has_strategy = settings.strategies().next().is_some();
        let why = "it goes from event to event without steps, so a continuation strategy has no meaning here";
        obstacle(problem, settings).or(has_strategy.then_some(why)).map(Into::into)
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::PathSolver,
        tag: "event_path",
        summary: "exact path of elastic blocks and facet laws, small displacements, from event to event, to rounding",
        provides: &[Capability::SETTLEMENT],
        requires: &[&[Capability::FACETS], &[Capability::LINEAR]],
        cost: Some(10),
        sources: &[
            "Klarbring 1990, Ingenieur-Archiv 60, 529-541 (the frictional rate problem)",
            "Maier 1970, Meccanica 5, 54-66 (piecewise linear laws as complementarity problems)",
            "Alart & Curnier 1991, Comput. Methods Appl. Mech. Engng 92, 353-375",
            "Lemke 1965, Management Science 11, 681-689",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("event_path.md"),
        ..Card::of::<EventPath>()
    }
}

#[cfg(test)]
mod tests;
