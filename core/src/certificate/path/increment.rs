//! The check of an increment between two states of a path at one contact point.
//!
//! With small displacements everything except the laws is linear. The straight line between two states is therefore a
//! piece of a path if each point keeps one mode on it: it sticks, or its gap flows along facets that are active at both
//! ends, or it is open and unloaded at both ends. An open point is described by its opening, the gap above the surface
//! that slip with dilatancy has raised.

use super::claims::{length, outside};
use super::point_modes::{active_facets, dilatancy, dot, is_apex};
use super::rate_check::opening_of;
use crate::law::{Facet, FacetMode};
use crate::path::{Contact, PointLaw};

/// Tolerances of an increment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Allowed {
    /// Greatest slack of active facets \[N\].
    pub slack: f64,
    /// Greatest opening of closed points \[m\].
    pub opening: f64,
}

/// A contact point after an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Passed {
    /// Its opening \[m\].
    pub opening: f64,
    /// Distance of the increment from the flow of the law \[m\].
    pub outside: f64,
}

/// The opening of a contact point before any load \[m\].
pub(super) fn first_opening(contact: &Contact) -> f64 {
    if contact.law.facets().is_some() { contact.gap.max(0.0) } else { 0.0 }
}

/// Checks the increment of one contact point from forces and gaps at both ends. `active` is memory for its active facets.
pub(super) fn passed(
    active: &mut Vec<usize>,
    contact: &Contact,
    [forces, gaps]: [[[f64; 2]; 2]; 2],
    opening: f64,
    allowed: Allowed,
) -> Passed {
    let moved = [0, 1].map(|i| gaps[1][i] - gaps[0][i]);
    let open = opening > allowed.opening;
    // A closed point that has not moved can have stuck, whatever its facets.
    if moved == [0.0; 2] && !open {
        return Passed { opening, outside: 0.0 };
    }
    let stuck = Passed { opening, outside: length(moved) };
    let PointLaw::Facets(facets) = &contact.law else { return stuck };
    active.clear();
    active_facets(active, (contact, facets), &forces, allowed.slack);
    if active.is_empty() && !open {
        return stuck;
    }
    if is_apex(facets, active) {
        let opening = opening + moved[0] - dilatancy(facets) * moved[1].abs();
        let free = Passed { opening: opening.max(0.0), outside: (-opening).max(0.0) };
        return if open { free } else { better(free, flowing(facets, active, moved, stuck)) };
    }
    let facet = active.iter().copied().find(|f| facets[*f].mode == FacetMode::Opening);
    match (open, facet) {
        // An open point carries the strength of its opening facet.
        (true, None) => Passed { opening, outside: f64::INFINITY },
        (true, Some(facet)) => reopened(facets, active, facet, moved, opening),
        (false, _) => better(stuck, flowing(facets, active, moved, stuck)),
    }
}

fn better(a: Passed, b: Passed) -> Passed {
    if b.outside < a.outside { b } else { a }
}

/// The increment of a closed point that flows along its active facets.
fn flowing(facets: &[Facet], active: &[usize], moved: [f64; 2], stuck: Passed) -> Passed {
    let flows = active.iter().map(|f| facets[*f].flow.map(|d| -d));
    let outside = outside(moved, flows);
    let facet = active.iter().copied().find(|f| facets[*f].mode == FacetMode::Opening);
    let opened = facet.map_or(0.0, |facet| opened_by(facets, active, facet, moved));
    let slides = |f: &usize| facets[*f].mode != FacetMode::Opening;
    // Slip alone does not open a point above its surface.
    let sliding = active.iter().filter(|f| slides(f)).map(|f| facets[*f].flow.map(|d| -d));
    let closed = super::claims::outside(moved, sliding) <= outside;
    let opened = if closed { 0.0 } else { opened.max(0.0) };
    Passed { opening: stuck.opening + opened, outside }
}

/// The increment of an open point on its opening facet.
fn reopened(facets: &[Facet], active: &[usize], facet: usize, moved: [f64; 2], opening: f64) -> Passed {
    let [d, back] = [facets[facet].flow.map(|d| -d), facets[facet].flow];
    if active.len() == 1 {
        // Its flows in both senses are a line.
        let opened = dot(moved, d) / dot(d, d);
        let (off, after) = (length([moved[0] - opened * d[0], moved[1] - opened * d[1]]), opening + opened);
        return Passed { opening: after.max(0.0), outside: off.max(-after) };
    }
    let others = active.iter().filter(|f| **f != facet).map(|f| facets[*f].flow.map(|d| -d));
    let off = outside(moved, [d, back].into_iter().chain(others));
    let after = opening + opened_by(facets, active, facet, moved);
    Passed { opening: after.max(0.0), outside: off.max(-after) }
}

/// Returns the multiplier of an opening facet in an increment. If rounding keeps the increment from the flow of the
/// facets, returns its component along this facet.
fn opened_by(facets: &[Facet], active: &[usize], facet: usize, moved: [f64; 2]) -> f64 {
    let own = opening_of(facets, active, facet, moved);
    let flow = facets[facet].flow;
    if own.is_finite() { own } else { -dot(moved, flow) / dot(flow, flow) }
}
