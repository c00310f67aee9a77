//! `event_path`: elastic blocks with facet laws and small displacements, exactly from event to event.
//!
//! Between events everything is linear. At an event the points at the verge of a change pose a rate
//! problem ([`rate`]); its solution is the direction of the next piece of the path. λ is no
//! parameter of the path: it may stand still (a mechanism) or fall.

mod base;
mod energy;
mod lcp;
mod rate;
mod system;
mod trace;

use serde::{Deserialize, Serialize};
use voussoir_core::path::{PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver};

/// The exact path of piecewise linear problems.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EventPath {}

#[typetag::serde(name = "event_path")]
impl PathSolver for EventPath {
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
        trace::Tracer::new(problem, settings, observer).run()
    }

    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String> {
        if settings.finite {
            return Some("it follows small displacements only; newton_path follows finite ones".into());
        }
        if settings.continuation.as_ref().is_some_and(|c| !c.exact_events()) {
            return Some("it goes from event to event and knows no other continuation than exact_events".into());
        }
        if !problem.deforms() {
            return Some("all blocks are rigid and no joint is compliant: there is no path before the collapse; limit analysis answers this scene".into());
        }
        None
    }
}
