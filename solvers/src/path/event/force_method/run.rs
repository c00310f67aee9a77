//! The run of the force method: from event to event by the equations of the cycles.

use super::equations::Solution;
use super::examine::examine;
use super::section::Sections;
use super::state::Run;
use crate::contact::mode::ContactMode;
use crate::path::event::event_run::{
    Change, EventRun, Followed, Hit, ROUNDS, add_work_between, changes_of_round, follow_events,
};
use crate::path::event::next_event::{MOMENT, arrive, stepped};
use crate::path::event::trace::Trace;
use crate::path::system::Load;
use nalgebra::{DVector, Vector3};

/// Follows the path from event to event as far as it goes, in a sense of λ to a target, until `steps`, which counts,
/// are as many as `bounds` allow.
pub fn by_force_method(
    trace: &mut Trace,
    sections: &Sections,
    load: &Load,
    bounds: (f64, f64, usize),
    steps: &mut usize,
) -> Followed {
    follow_events(trace, |trace| Run::new(trace, sections, load), bounds, steps)
}

impl EventRun for Run<'_> {
    type Rates = Solution;

    fn before(&mut self) -> &mut Vec<(usize, ContactMode)> {
        &mut self.before
    }

    fn next(&mut self, trace: &mut Trace, bound: f64) -> Option<(Solution, f64, Vec<Hit>)> {
        next(self, trace, bound)
    }

    fn advance(&mut self, trace: &mut Trace, rates: &Solution, step: (f64, f64), hits: &[Hit]) {
        advance(self, trace, rates, step, hits);
    }

    fn record(&mut self, trace: &mut Trace) -> bool {
        record(self, trace)
    }
}

/// Tangents of sections that have changed. `None` where a point has no rate of its own.
fn refresh(run: &mut Run, trace: &mut Trace) -> Option<()> {
    for e in (0..run.joints.len()).filter(|e| run.joints[*e].stale).collect::<Vec<_>>() {
        for place in &run.sections.all[e].places {
            let point = &mut trace.state.points[place.contact];
            point.mode = point.settled().unwrap_or(point.mode);
        }
        run.fresh.push(e);
        run.joints[e].refresh(&run.sections.all[e], &trace.system.facets, &trace.state.points)?;
        run.joints[e].quiet.deadline = f64::NEG_INFINITY;
        run.equations.changed(e);
    }
    Some(())
}

fn next(run: &mut Run, trace: &mut Trace, bound: f64) -> Option<(Solution, f64, Vec<Hit>)> {
    for round in 0..ROUNDS[0] {
        trace.log.counts.rates.trials += 1;
        refresh(run, trace)?;
        if !trace.associated && run.arrived > 1 {
            return None;
        }
        let weak: Vec<usize> = (0..run.joints.len()).filter(|e| run.joints[*e].flexibility.is_none()).collect();
        let solution = run.equations.solve(run.sections, &run.joints, &weak)?;
        let mut own = solution.weak.iter();
        let mut twists = Vec::with_capacity(run.joints.len());
        for joint in &run.joints {
            twists.push(match joint.twist_rate(&solution.redundants) {
                Some(twist) => twist,
                None => own.next()?.1,
            });
        }
        let mut changes: Vec<Change> = Vec::new();
        let best = examine_all(run, trace, &twists, bound, &mut changes);
        if changes.is_empty() {
            let all = run.examined.iter().flat_map(|(_, hits)| hits);
            let hits = all.filter(|hit| (hit.0 - best) * hit.1 <= MOMENT).copied().collect();
            return Some((solution, best, hits));
        }
        for (_, c, to) in changes_of_round(round, changes) {
            run.before.push((c, trace.state.points[c].mode));
            trace.state.points[c].mode = to;
            run.joints[run.sections.of[c]].stale = true;
        }
    }
    None
}

/// Examines the sections in which something may happen before the nearest event, which is returned.
fn examine_all(
    run: &mut Run,
    trace: &mut Trace,
    twists: &[Vector3<f64>],
    bound: f64,
    changes: &mut Vec<Change>,
) -> f64 {
    let mut best = bound;
    let mut waiting: Vec<(f64, usize)> = Vec::new();
    run.examined.clear();
    // |h| at the points of a section, at most.
    let sections = run.sections;
    let size = |e: usize, v: &Vector3<f64>| v[0].abs() + v[1].abs() + 1.5 * sections.all[e].lever * v[2].abs();
    run.sizes[1] = twists.iter().enumerate().map(|(e, twist)| size(e, twist)).fold(0.0, f64::max);
    for (e, twist) in twists.iter().enumerate() {
        let (joint, section) = (&run.joints[e], &sections.all[e]);
        let turned = |slip: &Vector3<f64>| joint.quiet.slips.is_some_and(|sense| sense * slip.dot(twist) < 0.0);
        let weak = joint.flexibility.is_none();
        let left =
            size(e, &(twist - joint.quiet.twist)) > joint.quiet.allowed || section.slip.as_ref().is_some_and(turned);
        if left || weak || joint.may_leave || joint.quiet.deadline == f64::NEG_INFINITY {
            best = best.min(examine(run, trace, e, *twist, changes));
        } else {
            waiting.push((joint.quiet.deadline - run.progress.arc(), e));
        }
    }
    if changes.is_empty() {
        waiting.retain(|w| w.0 < best);
        waiting.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        for (earliest, e) in waiting {
            if earliest >= best {
                break;
            }
            best = best.min(examine(run, trace, e, twists[e], changes));
        }
    }
    best
}

fn advance(run: &mut Run, trace: &mut Trace, solution: &Solution, (step, sense): (f64, f64), hits: &[Hit]) {
    let last = run.progress.place.len() - 1;
    let rate = DVector::from_fn(last + 1, |i, _| if i < last { solution.redundants[i] } else { 1.0 });
    run.progress.step(&rate, step);
    let before = trace.state.factor;
    trace.state.factor += sense * step;
    let moved = sense * solution.displacement * step;
    run.since[0] += 0.5 * (before + trace.state.factor) * moved;
    run.since[1] += moved;
    let examined = std::mem::take(&mut run.examined);
    let leaving = examined.iter().map(|l| l.0).filter(|e| run.joints[*e].may_leave);
    let mut ended: Vec<usize> = std::mem::take(&mut run.fresh).into_iter().chain(leaving).collect();
    ended.sort_unstable();
    ended.dedup();
    for &(e, twist) in solution.weak.iter().filter(|w| ended.binary_search(&w.0).is_err()) {
        run.update_all(trace, e, Some((twist, step)));
    }
    for e in ended {
        let weak = solution.weak.iter().find(|w| w.0 == e).map(|w| (w.1, step));
        let openings = run.update(trace, e, weak);
        for (k, place) in run.sections.all[e].places.iter().enumerate() {
            let opening = openings.get(k).copied().unwrap_or(0.0);
            stepped(trace, place.contact, run.joints[e].rates[k], opening, before, run.sizes[0]);
        }
        let joint = &mut run.joints[e];
        joint.count(&run.sections.all[e], &trace.state.points);
        joint.quiet.deadline = f64::NEG_INFINITY;
    }
    for hit in hits {
        let e = run.sections.of[hit.2];
        run.update_all(trace, e, None);
        run.joints[e].stale = true;
    }
    let mut hits: Vec<(usize, usize)> = hits.iter().map(|hit| (hit.2, hit.3)).collect();
    arrive(trace, &hits);
    hits.dedup_by_key(|hit| hit.0);
    run.arrived = hits.len();
}

fn record(run: &mut Run, trace: &mut Trace) -> bool {
    for e in 0..run.joints.len() {
        run.update_all(trace, e, None);
    }
    let twists: Vec<Vector3<f64>> = run.joints.iter().map(|j| j.twist).collect();
    let start = 2 * trace.system.contacts;
    for (b, motion) in run.sections.motions(&twists).into_iter().enumerate() {
        (0..3).for_each(|i| trace.state.x[start + 3 * b + i] = run.motions[3 * b + i] + motion[i]);
    }
    add_work_between(trace, &mut run.since);
    trace.record()
}
