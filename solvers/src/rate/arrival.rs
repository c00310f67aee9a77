//! The arrival of a path at an event: modes, forces and the sense of λ on the piece before it.
//!
//! Two kinds of rates exist on every piece before its event, and prove nothing at the event:
//!
//! - *unloading*: λ falls, and no point of the event takes a mode that the event makes possible: one that slipped and stops
//!   could have stopped before, unless the event is the end of its slip;
//! - *going back* on a piece that does not rise: λ rises, and no point of the event changes its mode.
//!
//! An event is a bifurcation if the modes of a rising piece are stable under load and the modes of a rate that rises are
//! unstable: a structure with imperfections leaves this branch. It follows a rate that rises and is stable, or one that falls
//! and is unstable under load, as behind a limit point. A rate that falls and is stable unloads.

use super::problem::{Rate, RateProblem};
use crate::contact::mode::ContactMode;
use crate::settings::SETTINGS;

/// An active contact point at the end of the piece before the event.
#[derive(Debug, Clone, Copy)]
pub struct ArrivalPoint {
    /// Its mode on that piece.
    pub mode: ContactMode,
    /// True if it is a point of the event.
    pub hit: bool,
    /// True if the event is the end of its slip.
    pub stops: bool,
    /// Its contact force at the event \[N\]; zero if it is rounding.
    pub force: [f64; 2],
}

/// The piece before the event, seen from the points of the rate problem.
#[derive(Debug, Clone)]
pub struct Arrival {
    /// The sense of λ on it: 1, 0 or −1.
    pub factor: f64,
    /// One entry for each point of the rate problem, in the same order.
    pub points: Vec<ArrivalPoint>,
}

impl Arrival {
    /// Creates an arrival at a state whose greatest contact force is `greatest`. Forces that are zero within rounding,
    /// as at the apex of friction, are set to zero: they must not decide between rates.
    pub fn new(factor: f64, points: impl Iterator<Item = ArrivalPoint>, greatest: f64) -> Self {
        let rounded = |point: ArrivalPoint| {
            let zero = point.force[0].hypot(point.force[1]) <= SETTINGS.active * greatest;
            ArrivalPoint { force: if zero { [0.0; 2] } else { point.force }, ..point }
        };
        Arrival { factor, points: points.map(rounded).collect() }
    }

    /// Modes of all points on the piece before the event.
    pub fn modes(&self) -> Vec<ContactMode> {
        self.points.iter().map(|point| point.mode).collect()
    }

    /// True if a rate continues the path: it neither unloads nor goes back.
    pub fn continues(&self, problem: &RateProblem, rate: &Rate) -> bool {
        if rate.factor == self.factor && rate.modes == self.modes() {
            return true;
        }
        let existed = rate.factor < 0.0 || (rate.factor > 0.0 && self.factor <= 0.0);
        !existed || self.enters(problem, rate)
    }

    /// True if a structure with imperfections can follow a rate: false if the path rises in stable modes, and the rate
    /// rises in unstable modes or falls in stable modes.
    pub fn is_followed_by(&self, problem: &RateProblem, rate: &Rate) -> bool {
        let rises = self.factor > 0.0 && self.points.iter().any(|point| point.hit);
        if !rises || rate.factor == 0.0 || !problem.stable_under_load(&self.modes()) {
            return true;
        }
        problem.stable_under_load(&rate.modes) == (rate.factor > 0.0)
    }

    /// True if a point of the event takes a mode that the event makes possible.
    pub fn enters(&self, problem: &RateProblem, rate: &Rate) -> bool {
        let sliding = |k: usize| self.points[k].mode.slides(problem.points[k].facets);
        let kept = |k: usize, was: ContactMode, is: ContactMode| was == is || sliding(k) && is == ContactMode::Stick;
        self.points.iter().zip(&rate.modes).enumerate().any(|(k, (point, mode))| {
            point.hit && (!kept(k, point.mode, *mode) || point.stops && *mode == ContactMode::Stick)
        })
    }

    /// Dissipation −r·ġ of a rate.
    pub fn dissipation(&self, rate: &Rate) -> f64 {
        let points = self.points.iter().zip(&rate.gaps);
        -points.map(|(point, gap)| point.force[0] * gap[0] + point.force[1] * gap[1]).sum::<f64>()
    }
}
