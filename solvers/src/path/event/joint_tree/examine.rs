//! Examining a joint: its points at the present state, whether its rates move one out of its mode, what is near, and the
//! room in which nothing else happens.

use super::quiet::Own;
use super::state::Run;
use crate::contact::facet::{dilatancy, dot, slack};
use crate::contact::mode::ContactMode;
use crate::path::event::event_run::{Change, Hit};
use crate::path::event::next_event::opening_rate;
use crate::path::event::point::Point;
use crate::path::event::trace::Trace;

/// Share of a joint's greatest rate that is each rate's room.
const NEIGHBOURHOOD: f64 = 0.3;
/// Share of its own rate that is the room of what must keep its sign.
const SIGN: f64 = 0.8;
/// By how much a room is widened at most.
const WIDEST: f64 = 1e4;
/// The share of a room that is left of it at least.
const NARROWEST: f64 = 0.1;
/// Mean arcs between events for which a joint is to be left alone: rates that leave narrow rooms are noticed at less cost
/// than that of examining their joint again.
const QUIET: f64 = 30.0;
/// Relative violation up to which a rate keeps to its modes.
const INEQUALITY: f64 = 1e-10;
/// Changes of a rate below this share of the greatest rate are rounding.
const ROUNDING: f64 = 1e-13;

/// Whether a point stands at facets that it may leave at any time.
pub fn may_leave(point: &Point) -> bool {
    match point.mode {
        ContactMode::Stick => !point.active.is_empty(),
        ContactMode::Open => !point.open(),
        ContactMode::Facet(_) => !point.open() && point.active.len() > 1,
        ContactMode::Corner(..) => point.active.len() > 2,
    }
}

/// A point while its joint is examined.
struct Looked<'a> {
    c: usize,
    /// The first of its rows.
    row: usize,
    force: [f64; 2],
    gap: [f64; 2],
    /// Its axes over (n, t), with the room of the rate along each and whether that is one of the force.
    axes: [([f64; 2], f64, bool); 2],
    hits: &'a mut Vec<Hit>,
    /// What may come: distance, rate, by how much this may grow within the room, and the rows of the joint's rates on
    /// which it depends.
    ahead: &'a mut Vec<(f64, f64, f64, [usize; 2])>,
}

impl Looked<'_> {
    /// Notes what has this distance and, by force or gap, this gradient.
    fn note(&mut self, distance: f64, gradient: [f64; 2], by_force: bool, least: f64, what: usize) {
        let rate = dot(gradient, if by_force { self.force } else { self.gap });
        if rate > least {
            self.hits.push((distance.max(0.0) / rate, rate, self.c, what));
        }
        let own = self.axes.iter().filter(|axis| axis.2 == by_force);
        let more = own.map(|(axis, room, _)| dot(gradient, *axis).abs() * room).sum::<f64>();
        let rows = [0, 1].map(|i| if self.axes[i].2 == by_force { self.row + i } else { usize::MAX });
        self.ahead.push((distance.max(0.0), rate, more, rows));
    }
}

/// Examines a joint. Returns the arc to the next event in it; points that leave their modes are added to `changes`.
pub fn examine(run: &mut Run, trace: &mut Trace, e: usize, changes: &mut Vec<Change>) -> f64 {
    trace.log.counts.sections += 1;
    run.settle_joint(trace, e);
    let joint = run.tree.joints[e].clone();
    let out = run.out[e].clone();
    let table = &run.tree.tables[e];
    let height = out.len() - 3;
    let mut sizes = [0.0f64; 2];
    (0..height).for_each(|i| {
        let kind = usize::from(!table.free[i]);
        sizes[kind] = sizes[kind].max(out[i].abs());
    });
    run.sizes = [0, 1].map(|i| run.sizes[i].max(sizes[i]));
    let room = |i: usize| {
        let kind = usize::from(!table.free[i]);
        (NEIGHBOURHOOD * sizes[kind]).max(ROUNDING * run.sizes[kind])
    };
    let mut room: Vec<f64> = (0..height).map(room).collect();
    let first = run.hits.len();
    let mut ahead = Vec::new();
    let mut signed = vec![false; height];
    let mut always = false;
    for (k, &c) in joint.contacts.iter().enumerate() {
        let [force, gap] = run.tree.tables[e].point(k, &out);
        let point = &trace.state.points[c];
        let Some(facets) = &trace.system.facets[c] else { continue };
        always |= may_leave(point);
        if point.settled().is_none() {
            let active = point.as_active(facets);
            let unknowns = point.mode.unknowns(facets, gap);
            if let Some((size, to)) = active.violation(point.mode, &unknowns, force, run.sizes)
                && size > INEQUALITY
            {
                changes.push((size, c, to));
            }
            always |= !matches!(point.mode, ContactMode::Facet(_));
            // Flow keeps its sense; its gap is along the first axis.
            room[2 * k] = room[2 * k].min(SIGN * out[2 * k].abs()).max(ROUNDING * run.sizes[1]);
            signed[2 * k..2 * k + 2].fill(true);
        }
        let dilates = dilatancy(facets) > 0.0;
        if point.mode == ContactMode::Open {
            run.senses[c] = if gap[1] < 0.0 { -1.0 } else { 1.0 };
            if dilates {
                room[2 * k + 1] = room[2 * k + 1].min(SIGN * gap[1].abs()).max(ROUNDING * run.sizes[1]);
                signed[2 * k + 1] = true;
            }
        }
        let axes = [0, 1].map(|i| (run.tree.axis(e, k, i), room[2 * k + i], run.tree.tables[e].free[2 * k + i]));
        let mut looked = Looked { c, row: 2 * k, force, gap, axes, hits: &mut run.hits, ahead: &mut ahead };
        examine_point(trace, &mut looked, run.sizes);
    }
    let earliest = fit(&mut room, &signed, &ahead, QUIET * run.progress.spacing);
    let deadline = run.arc() + earliest;
    run.quiet.own[e] = Own { reference: out, room, deadline, always, sizes };
    run.hits[first..].iter().map(|hit| hit.0).fold(f64::INFINITY, f64::min)
}

/// Makes rooms so wide that what may come within them comes as late as what comes first, which narrower rooms put off
/// to an arc that is `wanted`; returns when that is. Rates that must keep their sign are given no wider room.
fn fit(room: &mut [f64], signed: &[bool], ahead: &[(f64, f64, f64, [usize; 2])], wanted: f64) -> f64 {
    let earliest = |share: f64| {
        let when = |&(distance, rate, more, _): &(f64, f64, f64, [usize; 2])| match rate + share * more {
            most if most > 0.0 => distance / most,
            _ => f64::INFINITY,
        };
        ahead.iter().map(when).fold(f64::INFINITY, f64::min)
    };
    let mut until = earliest(1.0);
    if until < wanted {
        until = earliest(NARROWEST).min(wanted);
    }
    let mut factors = vec![WIDEST; room.len()];
    for &(distance, rate, more, rows) in ahead {
        let factor = if more > 0.0 { ((distance / until - rate) / more).max(NARROWEST) } else { WIDEST };
        rows.into_iter().filter(|row| *row < room.len()).for_each(|row| factors[row] = factors[row].min(factor));
    }
    for ((room, factor), signed) in room.iter_mut().zip(factors).zip(signed) {
        *room *= if *signed { factor.min(1.0) } else { factor };
    }
    until
}

/// What is ahead of a point.
fn examine_point(trace: &Trace, looked: &mut Looked, sizes: [f64; 2]) {
    let c = looked.c;
    let Some(facets) = &trace.system.facets[c] else { return };
    let point = &trace.state.points[c];
    if point.open() {
        let sense = if looked.gap[1] < 0.0 { -1.0 } else { 1.0 };
        let closes = point.mode.opening(facets, sense).map(|v| -v);
        debug_assert_eq!(dot(closes, looked.gap), -opening_rate(trace, c, looked.gap));
        looked.note(point.opening, closes, false, ROUNDING * sizes[1], usize::MAX);
        if point.apex {
            return;
        }
    }
    let here = trace.state.force(c);
    for (f, facet) in facets.iter().enumerate().filter(|(f, _)| !point.active.contains(f)) {
        looked.note(slack(facet, here, 1.0), facet.normal, true, ROUNDING * sizes[0], f);
    }
}
