//! From event to event by what knows the rates of a chain without the whole system: what the force method and the tree
//! of joints share.

use super::trace::Trace;
use crate::contact::mode::ContactMode;

/// Events that are all recorded; of more, so many each time their number grows e-fold.
pub const RECORDED: u64 = 512;
/// Rounds of the active set, and those in which all points change at once.
pub const ROUNDS: [usize; 2] = [40, 12];

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Followed {
    /// At the target.
    Reached,
    /// Where the whole system must decide.
    Left,
    /// By its observer.
    Stopped,
}

/// What is nearest: arc until then, rate with which it comes, contact point, facet or `usize::MAX`.
pub type Hit = (f64, f64, usize, usize);

/// A point that leaves its mode: how far, which, and the mode that mends it.
pub type Change = (f64, usize, ContactMode);

/// One load step, or a part of it.
pub trait EventRun {
    /// The rates at an event.
    type Rates;

    /// Modes that points had before the present event.
    fn before(&mut self) -> &mut Vec<(usize, ContactMode)>;

    /// The rates from the present state, how far they hold, `bound` at most, and what ends them. `None` where that is
    /// not decided here.
    fn next(&mut self, trace: &mut Trace, bound: f64) -> Option<(Self::Rates, f64, Vec<Hit>)>;

    /// Goes a step in a sense of λ and notes the events at its end.
    fn advance(&mut self, trace: &mut Trace, rates: &Self::Rates, step: (f64, f64), hits: &[Hit]);

    /// Writes the present state to the path and records it; whether the path goes on.
    fn record(&mut self, trace: &mut Trace) -> bool;
}

/// Follows the path from event to event as far as a `run` goes, in a `sense` of λ to a `target`, until `steps`, which
/// counts, are `most`.
pub fn follow_events<R: EventRun>(
    trace: &mut Trace,
    begin: impl FnOnce(&mut Trace) -> Option<R>,
    (sense, target, most): (f64, f64, usize),
    steps: &mut usize,
) -> Followed {
    // From nothing every point is in the active set.
    if trace.state.x.iter().all(|v| *v == 0.0) {
        return Followed::Left;
    }
    let Some(mut run) = begin(trace) else { return Followed::Left };
    let mut unrecorded = 0;
    loop {
        run.before().clear();
        let bound = (target - trace.state.factor) * sense;
        let next = if *steps < most { run.next(trace, bound) } else { None };
        let Some((rates, step, hits)) = next.filter(|next| next.1.is_finite()) else {
            for (c, mode) in run.before().drain(..).rev() {
                trace.state.points[c].mode = mode;
            }
            return if unrecorded == 0 || run.record(trace) { Followed::Left } else { Followed::Stopped };
        };
        let whole = step >= bound;
        run.advance(trace, &rates, (step, sense), if whole { &[] } else { &hits });
        trace.state.sense = 1.0;
        if whole {
            trace.state.factor = target;
        }
        *steps += 1;
        unrecorded += 1;
        trace.log.counts.rate_problems += 1;
        trace.log.counts.by_force_method += 1;
        if whole || unrecorded * RECORDED >= trace.log.counts.rate_problems {
            unrecorded = 0;
            if !run.record(trace) {
                return Followed::Stopped;
            }
        }
        if whole {
            return Followed::Reached;
        }
    }
}

/// The changes that a round of the active set makes: all of them at first, then the greatest alone.
pub fn changes_of_round(round: usize, mut changes: Vec<Change>) -> Vec<Change> {
    if round >= ROUNDS[1] {
        changes.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        changes.truncate(1);
    }
    changes
}

/// Work, displacement at the load and factor since the last record: what the record itself, by the trapezoidal rule of
/// its two ends, would miss of the work between them.
pub fn add_work_between(trace: &mut Trace, since: &mut [f64; 3]) {
    let [work, moved, factor] = *since;
    let trapezoid = 0.5 * (factor + trace.state.factor) * moved;
    trace.state.energy.work += (work - trapezoid) * trace.system.units.energy();
    *since = [0.0, 0.0, trace.state.factor];
}
