//! A step along a direction: the distance to the next events, and their changes.

use super::piece::rates::Direction;
use super::trace::Trace;
use crate::contact::active_point::complete_corners;
use crate::contact::facet::{dot, slack};
use crate::contact::mode::ContactMode;
use crate::linear::largest;
use crate::path::events::{ContactStatus, transition};
use crate::settings::SETTINGS;
use voussoir_core::law::Facet;
use voussoir_core::path::{ContactEvent, PathEvent};

/// Returns the distance to the next events along a direction, and their points with facets (`usize::MAX` for a
/// closing). Slacks and gaps below `same` are events at the same moment.
pub fn next_event(trace: &Trace, direction: &Direction, same: f64) -> (f64, Vec<(usize, usize)>) {
    // A rate within rounding of zero causes no event.
    let size = largest(&direction.x[..2 * trace.system.contacts]);
    let gap_size = largest(direction.gaps.as_flattened());
    let (of_forces, share) =
        if direction.factor == 0.0 { (size.max(gap_size), SETTINGS.active) } else { (size, 1e-13) };
    let (least_force, least_gap) = (share * of_forces, share * gap_size);
    let mut step = f64::INFINITY;
    let mut hits: Vec<(f64, f64, usize, usize)> = Vec::new();
    let mut meet = |when: f64, speed: f64, c: usize, what: usize| {
        if (when - step) * speed <= same {
            hits.push((when, speed, c, what));
        }
        step = step.min(when);
    };
    for (c, point) in trace.state.points.iter().enumerate() {
        let Some(facets) = &trace.system.facets[c] else { continue };
        if point.open() {
            let rate = opening_rate(trace, c, direction.gaps[c]);
            if -rate > least_gap {
                meet(point.opening / -rate, -rate, c, usize::MAX);
            }
            if point.apex {
                continue;
            }
        }
        let force = trace.state.force(c);
        let rate = [direction.x[2 * c], direction.x[2 * c + 1]];
        for (f, facet) in facets.iter().enumerate() {
            let falls = dot(facet.normal, rate);
            if falls > least_force && !point.active.contains(&f) {
                meet(slack(facet, force, 1.0).max(0.0) / falls, falls, c, f);
            }
        }
    }
    let now = |e: &&(f64, f64, usize, usize)| (e.0 - step) * e.1 <= same;
    (step, hits.iter().filter(now).map(|e| (e.2, e.3)).collect())
}

/// Returns the rate of the opening above the dilated surface.
pub fn opening_rate(trace: &Trace, c: usize, gap: [f64; 2]) -> f64 {
    let Some(facets) = &trace.system.facets[c] else { return 0.0 };
    dot(trace.state.points[c].mode.opening(facets, if gap[1] < 0.0 { -1.0 } else { 1.0 }), gap)
}

/// Returns the rate of the gap without its `opening` rate, which is reversible: a tensile strength that opens stores
/// the work of its force and releases it.
fn irreversible(trace: &Trace, c: usize, gap: [f64; 2], opening: f64) -> [f64; 2] {
    match (&trace.system.facets[c], trace.state.points[c].opening_facet) {
        (Some(facets), Some(open)) if trace.state.points[c].mode != ContactMode::Open => {
            [0, 1].map(|i| gap[i] + opening * facets[open].flow[i])
        }
        _ => gap,
    }
}

/// Moves a step along a direction and records the events at its end.
pub fn advance(trace: &mut Trace, direction: &Direction, step: f64, sense: f64, hits: &[(usize, usize)]) {
    let before = trace.state.factor;
    for (x, rate) in trace.state.x.iter_mut().zip(&direction.x) {
        *x += step * rate;
    }
    for (gap, rate) in trace.state.gaps.as_flattened_mut().iter_mut().zip(direction.gaps.as_flattened()) {
        *gap += step * rate;
    }
    trace.state.factor += sense * step * direction.factor;
    trace.state.sense = direction.factor;
    let size = largest(&direction.x[..2 * trace.system.contacts]);
    for c in 0..trace.system.contacts {
        stepped(trace, direction, c, (step, before), size);
    }
    arrive(trace, hits);
}

/// Applies a step to a contact point: its opening, the energy that it dissipates, the facets that it leaves, and the
/// events recorded at the factor `before` the step. `size`: greatest rate of force.
fn stepped(trace: &mut Trace, direction: &Direction, c: usize, (step, before): (f64, f64), size: f64) {
    let point = &mut trace.state.points[c];
    let (was_open, was_hit) = (point.open(), point.arrived_from.take().is_some());
    let flows = was_open || point.mode != ContactMode::Stick;
    if !flows && point.active.is_empty() {
        return;
    }
    let [force, rate] = [&trace.state.x, &direction.x].map(|x| [x[2 * c], x[2 * c + 1]]);
    let opening = if flows { opening_rate(trace, c, direction.gaps[c]) } else { 0.0 };
    if !matches!(trace.state.points[c].mode, ContactMode::Stick | ContactMode::Open) {
        let mean = [0, 1].map(|i| force[i] - 0.5 * step * rate[i]);
        let flow = irreversible(trace, c, direction.gaps[c], opening);
        trace.state.energy.dissipated -= dot(mean, flow) * step * trace.system.units.energy();
    }
    let Some(facets) = &trace.system.facets[c] else { return };
    let point = &mut trace.state.points[c];
    point.opening = if flows { (point.opening + step * opening).max(0.0) } else { 0.0 };
    let mut happened = begun(point.mode, facets, was_hit, !was_open && point.open());
    // Facets that this direction leaves become inactive.
    if !(point.open() && point.apex) {
        let had = point.active.len();
        point.active.retain(|f| {
            let facet = &facets[*f];
            dot(facet.normal, rate) > -1e-11 * size || slack(facet, force, 1.0) <= SETTINGS.residual()
        });
        if had > 0 && point.active.is_empty() && !was_hit && point.noted {
            happened.push(ContactEvent::Sticks);
        }
    }
    point.noted |= !happened.is_empty();
    let (load_step, factor, contact) = (trace.state.load_step, before, c);
    trace.log.events.extend(happened.into_iter().map(|what| PathEvent { load_step, factor, contact, what }));
}

/// Returns the events at a point at the start of a piece: it opens, or, if it has just reached a facet, it flows.
fn begun(mode: ContactMode, facets: &[Facet], arrived: bool, opens: bool) -> Vec<ContactEvent> {
    let mut happened = Vec::new();
    if opens {
        happened.push(ContactEvent::Opens);
    }
    if let ContactMode::Facet(f) = mode
        && arrived
    {
        let status = ContactStatus::of_facet(&facets[f as usize]);
        happened.extend(transition(ContactStatus::Sticks, status).filter(|_| status != ContactStatus::Open));
    }
    happened
}

/// Records the events at the start of a piece without an end.
pub fn begin_without_end(trace: &mut Trace, direction: &Direction) {
    let least = SETTINGS.active * largest(direction.gaps.as_flattened());
    let (load_step, factor) = (trace.state.load_step, trace.state.factor);
    for (c, point) in trace.state.points.iter().enumerate() {
        let Some(facets) = &trace.system.facets[c] else { continue };
        let flows = point.mode != ContactMode::Stick;
        let opens = flows && !point.open() && opening_rate(trace, c, direction.gaps[c]) > least;
        let happened = begun(point.mode, facets, point.arrived_from.is_some(), opens);
        trace.log.events.extend(happened.into_iter().map(|what| PathEvent { load_step, factor, contact: c, what }));
    }
}

/// Updates contact points that reach a facet or (`usize::MAX`) close.
pub fn arrive(trace: &mut Trace, hits: &[(usize, usize)]) {
    let state = &mut trace.state;
    for &(c, f) in hits {
        let Some(facets) = &trace.system.facets[c] else { continue };
        let point = &mut state.points[c];
        point.arrived_from.get_or_insert(point.mode);
        // At the apex all facets meet.
        let bare = || (0..facets.len()).filter(|f| facets[*f].bound <= 0.0).collect();
        if f == usize::MAX {
            point.opening = 0.0;
            if point.apex {
                point.active = bare();
            }
            point.mode = ContactMode::Stick;
            point.noted = true;
            let (load_step, factor) = (state.load_step, state.factor);
            trace.log.events.push(PathEvent { load_step, factor, contact: c, what: ContactEvent::Closes });
            continue;
        }
        point.active.push(f);
        complete_corners(facets, &mut point.active);
        point.mode = ContactMode::Facet(f as u8);
        if point.apex && point.opening_facet.is_some_and(|open| point.active.contains(&open)) {
            point.active = bare();
            point.mode = ContactMode::Open;
        } else if let (true, Some(open)) = (point.open(), point.opening_facet) {
            point.mode = ContactMode::Corner(open as u8, f as u8);
        }
    }
}
