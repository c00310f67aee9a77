//! The run on the tree: from event to event.

use super::examine::{examine, may_leave};
use super::state::{Run, Waiting};
use crate::contact::mode::ContactMode;
use crate::path::event::event_run::{
    Change, EventRun, Followed, Hit, ROUNDS, add_work_between, changes_of_round, follow_events,
};
use crate::path::event::next_event::{MOMENT, arrive, stepped};
use crate::path::event::trace::Trace;
use crate::path::system::Load;
use std::collections::BinaryHeap;

/// Share of a room that may be used up before a joint or a node is looked at.
const USED: f64 = 0.5;
/// Share of the last step in the mean arc between events.
const SPACING: f64 = 0.05;
/// Forces below this share of the gaps: a mechanism is near.
const NEAR_MECHANISM: f64 = 1e-4;

/// The rates at an event.
pub struct Going {
    /// Of redundants, load and twists of weak joints.
    rates: Vec<f64>,
    /// Of the displacement at the load.
    displacement: f64,
}

/// Follows the path from event to event as far as it goes, in a sense of λ to a target, until `steps`, which counts,
/// are as many as `bounds` allow.
pub fn by_joint_tree(trace: &mut Trace, load: &Load, bounds: (f64, f64, usize), steps: &mut usize) -> Followed {
    follow_events(trace, |trace| Run::new(trace, load), bounds, steps)
}

impl EventRun for Run {
    type Rates = Going;

    fn before(&mut self) -> &mut Vec<(usize, ContactMode)> {
        &mut self.before
    }

    fn next(&mut self, trace: &mut Trace, bound: f64) -> Option<(Going, f64, Vec<Hit>)> {
        next(self, trace, bound)
    }

    fn advance(&mut self, trace: &mut Trace, rates: &Going, step: (f64, f64), hits: &[Hit]) {
        advance(self, trace, rates, step, hits);
    }

    fn record(&mut self, trace: &mut Trace) -> bool {
        record(self, trace)
    }
}

/// Gives the tree the modes of the points that have changed theirs. `None` where that is singular.
fn refresh(run: &mut Run, trace: &mut Trace) -> Option<()> {
    for e in std::mem::take(&mut run.stale) {
        let joint = run.tree.joints[e].clone();
        let mut settled = false;
        for &c in &joint.contacts {
            let point = &mut trace.state.points[c];
            point.mode = point.settled().unwrap_or(point.mode);
            let mode = point.mode;
            if mode == run.tree.modes[c] {
                continue;
            }
            if !std::mem::replace(&mut settled, true) {
                let openings = run.settle(trace, e);
                debug_assert!(openings.is_empty());
            }
            run.tree.set_mode(&trace.system, c, mode)?;
        }
        run.fresh.push(e);
        run.quiet.own[e].always = true;
        run.tree.taint(e);
    }
    Some(())
}

fn next(run: &mut Run, trace: &mut Trace, bound: f64) -> Option<(Going, f64, Vec<Hit>)> {
    for round in 0..ROUNDS[0] {
        trace.log.counts.rates.trials += 1;
        refresh(run, trace)?;
        let (rates, displacement) = run.tree.close()?;
        let mut changes: Vec<Change> = Vec::new();
        let best = look(run, trace, &rates, bound, &mut changes);
        if changes.is_empty() {
            run.quiet.events += 1;
            for m in std::mem::take(&mut run.seen).into_iter().rev() {
                run.quiet.bound(&mut run.tree, m, &run.out[m]);
            }
            run.sizes = run.quiet.below[run.tree.root()].sizes;
            if run.sizes[0] < NEAR_MECHANISM * run.sizes[1] {
                return None;
            }
            let mut hits: Vec<Hit> = run.hits.iter().filter(|hit| (hit.0 - best) * hit.1 <= MOMENT).copied().collect();
            hits.sort_by_key(|hit| (hit.2, hit.3));
            return Some((Going { rates, displacement }, best, hits));
        }
        for (_, c, to) in changes_of_round(round, changes) {
            run.before.push((c, trace.state.points[c].mode));
            trace.state.points[c].mode = to;
            run.stale.push(run.tree.at[c].0);
        }
    }
    None
}

/// Looks at the joints in which something may happen before the nearest event, which is returned.
fn look(run: &mut Run, trace: &mut Trace, rates: &[f64], bound: f64, changes: &mut Vec<Change>) -> f64 {
    let root = run.tree.root();
    run.hits.clear();
    run.seen.clear();
    run.tree.moved[root].rates.copy_from_slice(rates);
    let mut best = bound;
    let mut open = vec![root];
    let (mut found, mut waiting) = (std::mem::take(&mut run.memory.waiting), BinaryHeap::new());
    loop {
        while let Some(m) = open.pop() {
            best = best.min(visit(run, trace, m, (&mut open, &mut found), changes));
        }
        // Most wait for longer than until the nearest event that is known by now.
        let until = run.arc() + best;
        waiting.extend(found.drain(..).filter(|next| next.deadline < until));
        let Some(next) = waiting.pop().filter(|next| changes.is_empty() && next.deadline - run.arc() < best) else {
            run.memory.waiting = found;
            return best;
        };
        match next.own {
            true => best = best.min(examine(run, trace, next.node, changes)),
            false => open.push(next.node),
        }
    }
}

/// Looks at a node whose rates from outside are known: its joint, and those of the nodes below.
fn visit(
    run: &mut Run,
    trace: &mut Trace,
    m: usize,
    (open, waiting): (&mut Vec<usize>, &mut Vec<Waiting>),
    changes: &mut Vec<Change>,
) -> f64 {
    run.seen.push(m);
    let outer = std::mem::take(&mut run.tree.moved[m].rates);
    run.tree.tables[m].answer(&outer, &mut run.out[m]);
    if run.tree.places[m].children != [None, None] {
        ask_below(run, m, &outer, (open, waiting));
    }
    run.tree.moved[m].rates = outer;
    let own = &run.quiet.own[m];
    let left = || {
        let rates = run.out[m].iter().zip(&own.reference).zip(&own.room);
        rates.fold(false, |left, ((now, then), room)| left | ((now - then).abs() > USED * room))
    };
    if own.always || left() {
        return examine(run, trace, m, changes);
    }
    waiting.push(Waiting { deadline: own.deadline, node: m, own: true });
    f64::INFINITY
}

/// Finds the rates from outside of the nodes below one, which are to be looked at or wait.
fn ask_below(run: &mut Run, m: usize, outer: &[f64], (open, waiting): (&mut Vec<usize>, &mut Vec<Waiting>)) {
    let mut forces = std::mem::take(&mut run.memory.forces);
    run.tree.tables[m].forces(&run.out[m], &mut forces);
    for (side, child) in run.tree.places[m].children.into_iter().enumerate() {
        let Some(child) = child else { continue };
        let mut below = std::mem::take(&mut run.tree.moved[child].rates);
        below.clear();
        run.tree.hand_down((m, side), outer, &forces).into_iter().for_each(|part| below.extend_from_slice(part));
        run.tree.moved[child].rates = below;
        let used = run.quiet.use_up(&run.tree, child, USED);
        if used.is_nan() || used > USED {
            open.push(child);
        } else {
            waiting.push(Waiting { deadline: run.quiet.below[child].deadline, node: child, own: false });
        }
    }
    run.memory.forces = forces;
}

fn advance(run: &mut Run, trace: &mut Trace, going: &Going, (step, sense): (f64, f64), hits: &[Hit]) {
    let root = run.tree.root();
    let moved = &mut run.tree.moved[root];
    moved.pending.iter_mut().zip(&going.rates).for_each(|(pending, rate)| *pending += step * rate);
    moved.any = true;
    run.progress.place.iter_mut().zip(&going.rates).for_each(|(place, rate)| *place += step * rate);
    run.progress.spacing += SPACING * (step - run.progress.spacing);
    let before = trace.state.factor;
    trace.state.factor += sense * step;
    let moved = sense * going.displacement * step;
    run.progress.since[0] += 0.5 * (before + trace.state.factor) * moved;
    run.progress.since[1] += moved;
    let mut ended = std::mem::take(&mut run.fresh);
    // Those above first: on the way to one below nobody would know that their points are about to open.
    ended.sort_unstable_by_key(|e| (run.tree.path(*e).len(), *e));
    ended.dedup();
    let mut stepping: Vec<(usize, [f64; 2], f64)> = Vec::new();
    for &e in &ended {
        let openings = run.settle(trace, e);
        for (k, c) in run.tree.joints[e].contacts.iter().enumerate() {
            let [rate, _] = run.tree.tables[e].point(k, &run.out[e]);
            stepping.push((*c, rate, openings.get(k).copied().unwrap_or(0.0)));
        }
    }
    stepping.sort_by_key(|point| point.0);
    for (c, rate, opening) in stepping {
        stepped(trace, c, rate, opening, before, run.sizes[0]);
    }
    for hit in hits {
        let e = run.tree.at[hit.2].0;
        run.settle_joint(trace, e);
        ended.push(e);
    }
    let hits: Vec<(usize, usize)> = hits.iter().map(|hit| (hit.2, hit.3)).collect();
    arrive(trace, &hits);
    ended.sort_unstable();
    ended.dedup();
    for e in ended {
        after(run, trace, e, &hits);
    }
}

/// What a joint whose points have stepped or arrived is at the next event.
fn after(run: &mut Run, trace: &Trace, e: usize, hits: &[(usize, usize)]) {
    let points = run.tree.joints[e].contacts.iter().map(|c| (*c, &trace.state.points[*c]));
    let (mut stale, mut leaves) = (false, false);
    for (c, point) in points {
        stale |= point.settled().unwrap_or(point.mode) != run.tree.modes[c] || hits.iter().any(|hit| hit.0 == c);
        leaves |= may_leave(point);
    }
    run.quiet.own[e].always = true;
    run.tree.taint(e);
    if stale {
        run.stale.push(e);
    } else if leaves {
        run.fresh.push(e);
    }
}

fn record(run: &mut Run, trace: &mut Trace) -> bool {
    let mut open = vec![run.tree.root()];
    while let Some(m) = open.pop() {
        run.settle_node(trace, m);
        open.extend(run.tree.places[m].children.into_iter().flatten());
    }
    let mut twists = run.progress.twists.clone();
    for (joint, twist) in run.tree.joints.iter().zip(&run.progress.twists) {
        twists[joint.section] = *twist;
    }
    let start = 2 * trace.system.contacts;
    for (b, motion) in run.tree.sections.motions(&twists).into_iter().enumerate() {
        (0..3).for_each(|i| trace.state.x[start + 3 * b + i] = run.progress.motions[3 * b + i] + motion[i]);
    }
    add_work_between(trace, &mut run.progress.since);
    trace.record()
}
