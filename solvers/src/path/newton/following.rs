//! A load step that is followed by its strategy: predictor, length of the next step, and what has been tried.

use super::control::Control;
use super::limit_point::test_limit_point;
use super::measure::{cosine, increment_along, motion_size, tangent_size};
use super::orientation::Orientation;
use super::response::update_at_rest;
use super::state::{State, Tangent};
use super::system::StepSystem;
use super::tangent::tangent_at;
use super::tracer::{LoadStepEnding, Tracer, end_path};
use crate::contact::mode::ContactMode;
use crate::path::continuation::LARGEST_FINITE_STEP;
use crate::path::continuation::arc_length::ArcLength;
use crate::path::energy::load_size;
use std::any::Any;
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{Continuation, Increment, LoadStep, LoadStepEnd};

/// Length of the first step on another branch, relative to that of the load step.
const BRANCH: f64 = 0.1;

/// Cosine of the angle between a step and the rate of arrival below which it takes the way back.
const BACK: f64 = -1.0 + 1e-3;

/// Rates per unit Λ of the factor, relative to those at the beginning, from which on a smooth limit point is near: at a
/// distance of a millionth of the load.
const SMOOTH_PEAK: f64 = 1e3;

/// Length of the first step of all, relative to the strategy's, where friction that is not associated may slide at once:
/// from nothing a load has no scale, and what slides first may come to rest within any step that is not short.
const FROM_NOTHING: f64 = 1e-3;

/// What bounds and shapes the steps of a load step.
pub(super) struct StepLimits {
    /// Length of the first step.
    pub first: f64,
    /// The same by arc lengths.
    pub by_arc: f64,
    /// Greatest motion of a step.
    pub largest: f64,
    /// Whether the path, with finite displacements, ends at its first limit point: by a strategy that passes none.
    pub ends_at_peak: bool,
}

/// A branch of the path: its tangent, with the contact modes where they are not those of the state.
pub(super) struct Branch {
    pub tangent: Tangent,
    pub modes: Option<Vec<ContactMode>>,
}

/// What has been tried near the present state.
#[derive(Default)]
pub(super) struct Tried {
    /// Number of the step at which another branch was looked for last.
    pub branch: Option<u64>,
    /// Modes and rate of the last step on which no point changed its mode, while the path has hardly moved since: the way
    /// on which it came here, over however many changes of mode at one place.
    pub arrived: Option<(Vec<ContactMode>, Tangent)>,
}

impl Tried {
    /// Takes note of a step that is taken; `whole` where no point changes its mode, `moves` where it is more than a corner.
    pub fn note(&mut self, next: &State, tangent: &Tangent, whole: bool, moves: bool) {
        if whole {
            self.arrived = Some((next.mode.clone(), tangent.clone()));
        } else if moves {
            self.arrived = None;
        }
    }

    /// Whether a step from one state to the next takes the way back on which the path came here.
    pub fn leads_back(&self, state: &State, next: &State) -> bool {
        self.arrived.as_ref().is_some_and(|(modes, rate)| {
            let moved = |(after, before): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| after[k] - before[k]);
            let step: Vec<[f64; 3]> = next.motion.iter().zip(&state.motion).map(moved).collect();
            next.mode == *modes && cosine(&step, &rate.motion) < BACK
        })
    }
}

/// A place within the next steps at which a point comes to rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrest {
    /// Length of the step that missed it first.
    pub whole: f64,
    /// Length from the present state to the nearest state known to lie beyond it.
    pub beyond: f64,
}

impl Arrest {
    /// Length of the next step after one that was taken with a length before the place, and what is known of it then.
    pub fn after(self, taken: f64, length: f64) -> (Option<Arrest>, f64) {
        let beyond = self.beyond - taken;
        if beyond <= 1e-9 * self.whole {
            return (None, length.max(self.whole));
        }
        (Some(Arrest { beyond, ..self }), beyond)
    }
}

/// A load step that is followed.
pub(super) struct Following<'d> {
    pub load_step: &'d LoadStep,
    pub target: f64,
    /// Sense of λ.
    pub direction: f64,
    pub limits: StepLimits,
    /// The tangent predictor.
    pub branch: Branch,
    /// Growth of the load along the last tangent.
    pub slope: f64,
    /// Increment of the last step.
    pub previous: Option<Increment>,
    /// Length of the next step.
    pub length: f64,
    /// Times that the step has been refined for its energy.
    pub refinements: u32,
    /// Where a point comes to rest within the next steps.
    pub arrest: Option<Arrest>,
    /// Sense of the factor and second-order work at the last state (finite displacements).
    pub orientation: Option<Orientation>,
    pub tried: Tried,
}

impl<'d> Following<'d> {
    /// At the beginning of a load step, or how it ends there.
    pub fn begin(tracer: &mut Tracer, load_step: &'d LoadStep, target: f64) -> Result<Self, LoadStepEnding> {
        let direction = if target < load_step.start { -1.0 } else { 1.0 };
        if target == tracer.state.factor {
            return Err(LoadStepEnding::Reached);
        }
        tracer.limit.rose = None;
        update_at_rest(&mut tracer.system, &mut tracer.state);
        let Some(tangent) = first_tangent(tracer, target, direction) else {
            let factor = tracer.state.factor;
            let why = format!("at factor {factor} there is no rate of equilibrium under the growing load");
            return Err(end_path(tracer, Status::Stalled, why));
        };
        let nothing = |one: f64, tracer: &Tracer| one.is_nan() || one <= 1e-14 * tangent_size(&tracer.system, &tangent);
        if nothing(per_tangent(tracer, &tangent, None), tracer)
            && load_size(tracer.system.problem, tracer.system.loads.growing) == 0.0
        {
            // Without a load there is no displacement of one to control.
            tracer.strategy = Arc::new(ArcLength::default());
        }
        let one = per_tangent(tracer, &tangent, None);
        if nothing(one, tracer) {
            let why = "what the continuation strategy controls does not change under this load";
            return Err(end_path(tracer, Status::Stalled, why.into()));
        }
        let units = tracer.system.units();
        let mut length = tracer.strategy.first_step() * one;
        if matches!(load_step.end, LoadStepEnd::Factor(_)) {
            // A load history: never coarser than a sixteenth of it.
            length = length.min(one * (target - tracer.state.factor).abs() / units.factor / 16.0);
        }
        let largest = match tracer.strategy.largest_step() {
            step if step.is_finite() => step,
            _ if tracer.system.finite() => LARGEST_FINITE_STEP,
            step => step,
        };
        let arc = ArcLength::default();
        let limits = StepLimits {
            first: length,
            by_arc: arc.first_step()
                * arc.constraint(&increment_along(&tracer.system, &tracer.state, &tangent), None).value,
            largest: largest * units.length / units.displacement,
            ends_at_peak: tracer.system.finite()
                && tracer.system.laws.responses.is_empty()
                && !tracer.strategy.passes_limit_points(),
        };
        let slope = tangent.factor * direction;
        let here = tracer.state.clone();
        let from_nothing = here.force.iter().flatten().all(|r| *r == 0.0);
        if from_nothing && tracer.system.finite() && !tracer.system.joints_flow_associated() {
            length *= FROM_NOTHING;
        }
        Ok(Following {
            load_step,
            target,
            direction,
            limits,
            slope,
            orientation: Orientation::of(&mut tracer.system, &here, slope > 0.0),
            branch: Branch { tangent, modes: None },
            previous: None,
            length,
            refinements: 0,
            arrest: None,
            tried: Tried::default(),
        })
    }

    /// Goes on by arc lengths where another strategy has lost a path with finite displacements: beyond a peak what it
    /// measures may turn back; one that passes no limit point leaves it to them to come to the first. Whether it does.
    pub fn takes_arc_lengths(&mut self, tracer: &mut Tracer) -> bool {
        let strategy: &dyn Any = &*tracer.strategy;
        if !tracer.system.finite() || !tracer.system.laws.responses.is_empty() || strategy.is::<ArcLength>() {
            return false;
        }
        let why = match (self.limits.ends_at_peak, tracer.limit.peak.is_some()) {
            (false, true) => {
                ", beyond its peak, the path is lost by its strategy, whose measure turns back: arc lengths follow it on"
            }
            (true, false) if !self.is_at_limit_point(tracer) => {
                " no further step of its strategy converges: arc lengths lead to the limit point"
            }
            _ => return false,
        };
        tracer.strategy = Arc::new(ArcLength::default());
        tracer.record.notes.push(format!("at factor {}{why}", tracer.state.factor));
        self.limits.first = self.limits.by_arc;
        self.length = BRANCH * self.limits.first;
        (self.previous, self.arrest, self.tried) = (None, None, Tried::default());
        true
    }

    /// Whether a path that ends at its first limit point comes to a smooth one: the rates per unit Λ of the factor grow
    /// beyond all bounds there, and steps of the factor soon go beyond it by what Newton's method leaves.
    pub fn comes_to_smooth_peak(&self, tracer: &Tracer) -> bool {
        let arc = ArcLength::default();
        let rate = increment_along(&tracer.system, &tracer.state, &self.branch.tangent);
        let at_first = self.limits.by_arc / arc.first_step();
        self.limits.ends_at_peak && arc.constraint(&rate, None).value > SMOOTH_PEAK * at_first
    }

    /// Whether the test of limit points leaves no doubt of the present state; of blocks that yield it asks nothing.
    fn is_at_limit_point(&self, tracer: &mut Tracer) -> bool {
        let state = tracer.state.clone();
        test_limit_point(tracer, &state, self.direction);
        tracer.limit.unproven.take().is_none()
    }

    /// Whether the present state is not known to be unstable under its loads: what an unstable branch carries is no peak of
    /// the path under its loads.
    pub fn comes_stable(&self) -> bool {
        self.orientation.as_ref().is_none_or(|before| !before.unstable)
    }

    /// Goes on along another branch, with short steps at first.
    pub fn switch_to(&mut self, system: &mut StepSystem, state: &State, branch: Branch) {
        self.slope = branch.tangent.factor * self.direction;
        let mode = branch.modes.clone().unwrap_or_else(|| state.mode.clone());
        self.orientation = Orientation::of(system, &State { mode, ..state.clone() }, self.slope > 0.0);
        self.branch = branch;
        (self.previous, self.arrest) = (None, None);
        self.length = BRANCH * self.limits.first;
    }
}

/// The rate with which a load step begins, per unit Λ of the factor. What a settlement has left as a mechanism, small
/// displacements, moves under a constant load until a joint closes: per unit of the work that the load does on it.
fn first_tangent(tracer: &mut Tracer, target: f64, direction: f64) -> Option<Tangent> {
    let first = tangent_at(&mut tracer.system, &tracer.state, &tracer.state, &Control::Factor(target));
    if first.is_some() || tracer.system.finite() {
        return first.map(|first| first.scaled(direction));
    }
    let control = Control::Mixed { weight: 1.0, length: 1.0 };
    let mut rate = tangent_at(&mut tracer.system, &tracer.state, &tracer.state, &control)?;
    let still = 1e-9 * tracer.system.units().factor * motion_size(&tracer.system, &rate);
    if rate.factor.abs() <= still {
        rate.factor = 0.0;
        rate.force.iter_mut().flatten().for_each(|r| *r = 0.0);
    }
    Some(rate.scaled(direction))
}

/// What the strategy measures along a tangent.
pub(super) fn per_tangent(tracer: &Tracer, tangent: &Tangent, previous: Option<&Increment>) -> f64 {
    tracer.strategy.constraint(&increment_along(&tracer.system, &tracer.state, tangent), previous).value
}
