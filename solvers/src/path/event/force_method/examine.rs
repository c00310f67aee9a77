//! Examining a section: its points at the present state, whether ξ̇ moves one out of its mode, what is near and
//! until when nothing else is.

use super::joint::Joint;
use super::section::Section;
use super::state::Run;
use crate::contact::facet::{dilatancy, dot, norm, slack};
use crate::contact::mode::ContactMode;
use crate::path::event::event_run::{Change, Hit};
use crate::path::event::next_event::opening_rate;
use crate::path::event::trace::Trace;
use nalgebra::Vector3;

/// Share of a section's rate by which it may change before its points are examined again.
const NEIGHBOURHOOD: f64 = 0.3;
/// Relative violation up to which a rate keeps to its modes.
const INEQUALITY: f64 = 1e-10;
/// Changes of a section's rate below this share of the greatest rate of a gap are rounding.
const ROUNDING: f64 = 1e-13;

/// Events of the points of a section.
#[derive(Default)]
struct Near {
    hits: Vec<Hit>,
    /// Those that may come: distance, rate, and how the rate depends on h.
    ahead: Vec<(f64, f64, f64)>,
}

impl Near {
    /// Notes what has this distance and rate, to which h contributes with this sensitivity.
    fn note(&mut self, (distance, rate, sensitivity): (f64, f64, f64), least: f64, (c, what): (usize, usize)) {
        if rate > least {
            self.hits.push((distance.max(0.0) / rate, rate, c, what));
        }
        self.ahead.push((distance, rate, sensitivity));
    }
}

/// Examines a section. Returns the arc to the next event in it; points that leave their modes are added to `changes`.
pub fn examine(run: &mut Run, trace: &mut Trace, e: usize, twist: Vector3<f64>, changes: &mut Vec<Change>) -> f64 {
    trace.log.counts.sections += 1;
    run.update_all(trace, e, None);
    let section = &run.sections.all[e];
    let joint = &mut run.joints[e];
    let h = |k: usize| (section.places[k].rows * twist).amax();
    let size = (0..section.places.len()).map(h).fold(0.0, f64::max);
    joint.quiet.slips = None;
    let mut allowed = NEIGHBOURHOOD * size;
    let rates: Vec<_> = section
        .places
        .iter()
        .enumerate()
        .map(|(k, place)| joint.rates_of(k, place, trace.state.points[place.contact].mode, &twist))
        .collect();
    run.sizes[0] = rates.iter().map(|[force, _]| force.amax()).fold(run.sizes[0], f64::max);
    let mut near = Near::default();
    for (k, rate) in rates.iter().enumerate() {
        let rates = rate.map(|v| [v[0], v[1]]);
        joint.rates[k] = rates[0];
        let most = examine_point(trace, (section, joint, k), rates, run.sizes, &mut near, changes);
        allowed = allowed.min(most);
    }
    // Rounding of rates is no change of them.
    allowed = allowed.max(ROUNDING * run.sizes[1]);
    // Nothing happens while ξ̇ stays within `allowed`, before the earliest that this permits.
    let earliest = |(distance, rate, sensitivity): (f64, f64, f64)| {
        let most = rate + sensitivity * allowed;
        if most > 0.0 { distance.max(0.0) / most } else { f64::INFINITY }
    };
    joint.quiet.deadline = run.progress.arc() + near.ahead.into_iter().map(earliest).fold(f64::INFINITY, f64::min);
    (joint.quiet.twist, joint.quiet.allowed) = (twist, allowed);
    let next = near.hits.iter().map(|hit| hit.0).fold(f64::INFINITY, f64::min);
    run.examined.push((e, near.hits));
    next
}

/// One of its points. Returns by how much ξ̇ may change before it may leave its mode.
fn examine_point(
    trace: &Trace,
    (section, joint, k): (&Section, &mut Joint, usize),
    [force, gap]: [[f64; 2]; 2],
    sizes: [f64; 2],
    near: &mut Near,
    changes: &mut Vec<Change>,
) -> f64 {
    let place = &section.places[k];
    let c = place.contact;
    let mut allowed = f64::INFINITY;
    let Some(facets) = &trace.system.facets[c] else { return allowed };
    let point = &trace.state.points[c];
    let [by_force, by_gap] = joint.sensitivity(k, place, point.mode);
    if point.settled().is_none() {
        let active = point.as_active(facets);
        let unknowns = point.mode.unknowns(facets, gap);
        if let Some((size, to)) = active.violation(point.mode, &unknowns, force, sizes)
            && size > INEQUALITY
        {
            changes.push((size, c, to));
        }
        // Flow keeps its sense as long as γ > 0.
        allowed = match point.mode {
            ContactMode::Facet(f) => {
                let flow = norm(facets[f as usize].flow);
                (0.8 * unknowns[0] * flow / by_gap.max(f64::MIN_POSITIVE)).max(0.0)
            }
            _ => 0.0,
        };
    }
    if point.mode == ContactMode::Open {
        joint.turn(k, gap[1]);
        if dilatancy(facets) > 0.0 && section.slip.is_some() {
            joint.quiet.slips = Some(if gap[1] < 0.0 { -1.0 } else { 1.0 });
        } else if dilatancy(facets) > 0.0 {
            allowed = allowed.min(0.5 * gap[1].abs());
        }
    }
    if point.open() {
        let rate = opening_rate(trace, c, gap);
        let opens = joint.opening_sensitivity(k, facets, point.mode);
        near.note((point.opening, -rate, opens * by_gap), 1e-13 * sizes[1], (c, usize::MAX));
        if point.apex {
            return allowed;
        }
    }
    let here = trace.state.force(c);
    for (f, facet) in facets.iter().enumerate().filter(|(f, _)| !point.active.contains(f)) {
        let falls = dot(facet.normal, force);
        let ahead = (slack(facet, here, 1.0), falls, norm(facet.normal) * by_force);
        near.note(ahead, 1e-13 * sizes[0], (c, f));
    }
    allowed
}
