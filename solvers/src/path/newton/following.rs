//! A load step that is followed by its strategy: predictor, length of the next step, and what has been tried.

use super::control::Control;
use super::measure::{cosine, increment_along, motion_size, tangent_size};
use super::response::update_at_rest;
use super::state::{State, Tangent};
use super::tangent::tangent_at;
use super::tracer::{LoadStepEnding, Tracer, direction, end_path};
use crate::contact::mode::ContactMode;
use crate::path::continuation::arc_length::ArcLength;
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{Increment, LoadStep, LoadStepEnd};

/// Length of the first step on another branch, relative to that of the load step.
const BRANCH: f64 = 0.1;

/// Cosine of the angle between a step and the rate of arrival below which it takes the way back.
const BACK: f64 = -1.0 + 1e-3;

/// What bounds and shapes the steps of a load step.
pub(super) struct StepLimits {
    /// Length of the first step.
    pub first: f64,
    /// Greatest motion of a step.
    pub largest: f64,
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
    pub tried: Tried,
}

impl<'d> Following<'d> {
    /// At the beginning of a load step, or how it ends there.
    pub fn begin(tracer: &mut Tracer, load_step: &'d LoadStep, target: f64) -> Result<Self, LoadStepEnding> {
        let direction = direction(tracer);
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
        if nothing(per_tangent(tracer, &tangent, None), tracer) && tracer.system.settles() {
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
        let limits =
            StepLimits { first: length, largest: tracer.strategy.largest_step() * units.length / units.displacement };
        let slope = tangent.factor * direction;
        Ok(Following {
            load_step,
            target,
            direction,
            limits,
            slope,
            branch: Branch { tangent, modes: None },
            previous: None,
            length,
            refinements: 0,
            tried: Tried::default(),
        })
    }

    /// Goes on along another branch, with short steps at first.
    pub fn switch_to(&mut self, branch: Branch) {
        self.slope = branch.tangent.factor * self.direction;
        self.branch = branch;
        self.previous = None;
        self.length = BRANCH * self.limits.first;
    }
}

/// The rate with which a load step begins, per unit Λ of the factor. What a settlement has left as a mechanism, small
/// displacements, moves under a constant load until a joint closes: per unit of the work that the load does on it.
fn first_tangent(tracer: &mut Tracer, target: f64, direction: f64) -> Option<Tangent> {
    let first = tangent_at(&mut tracer.system, &tracer.state, &tracer.state, &Control::Factor(target));
    if first.is_some() {
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
