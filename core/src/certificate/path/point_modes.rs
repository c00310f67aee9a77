//! The modes of a contact point in a rate, each as two cones: rates of its force and rates of its gap.
//!
//! | mode | ṙ | ġ |
//! |---|---|---|
//! | stick | a_j·ṙ ≤ 0 on the active facets | 0 |
//! | facet i | the same, with a_i·ṙ = 0 | −γ d_i |
//! | vertex | 0 | −Σ γ_j d_j over the active facets |
//! | open | 0 | any |
//!
//! All γ ≥ 0. An open point without strength has the last mode only. An open point with a tensile strength stays on its
//! opening facet, whose γ may have either sign because it may close. A bonded point has ġ = 0 and any ṙ. Source: the
//! modes of Klarbring (1990), Ing.-Arch. 60, with facets instead of Coulomb's cone.

use super::claims::{length, outside};
use crate::law::{Facet, FacetMode, YieldPolygon};
use crate::path::{Contact, PointLaw, PointMode};
use std::collections::BTreeMap;

/// Greatest slack of an active facet, as a share of the greatest contact force.
pub const ACTIVE: f64 = 1e-8;

/// Greatest cosine between a normal and a direction along its facet.
const ALONG: f64 = 1e-12;

/// All directions of the plane.
const PLANE: [[f64; 2]; 4] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];

/// The modes that are decided on a branch of a tree, by contact point.
pub(super) type Decided = BTreeMap<usize, PointMode>;

/// A mode with the generators of both cones.
#[derive(Debug, Clone)]
pub(super) struct ModeCone {
    pub mode: PointMode,
    pub force: Vec<[f64; 2]>,
    pub gap: Vec<[f64; 2]>,
}

impl ModeCone {
    /// Returns the distances of rates of force and of gap from the cones.
    pub fn distances(&self, force: [f64; 2], gap: [f64; 2]) -> [f64; 2] {
        [outside(force, self.force.iter().copied()), outside(gap, self.gap.iter().copied())]
    }

    /// Returns the least products of the multipliers (α, β) with the generators, each divided by the length of the
    /// generator. Both are ≥ 0 if α·ṙ + β·ġ ≥ 0 in this mode.
    pub fn least_products(&self, [alpha, beta]: [[f64; 2]; 2]) -> [f64; 2] {
        let least = |m: [f64; 2], cone: &[[f64; 2]]| cone.iter().map(|v| dot(m, *v) / length(*v)).fold(0.0, f64::min);
        [least(alpha, &self.force), least(beta, &self.gap)]
    }
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Adds the indices of the facets whose slack, divided by the length of their normal, is at most `tolerance` \[N\] at all of
/// these forces, and of those that pass through a corner of two such facets.
pub(super) fn active_facets(
    active: &mut Vec<usize>,
    (contact, facets): (&Contact, &[Facet]),
    forces: &[[f64; 2]],
    tolerance: f64,
) {
    for (index, facet) in facets.iter().enumerate() {
        let least = facet.bound * contact.area - tolerance * length(facet.normal);
        if forces.iter().all(|force| dot(facet.normal, *force) >= least) {
            active.push(index);
        }
    }
    let few = active.len();
    if few < 2 {
        return;
    }
    for (i, j) in (0..few).flat_map(|i| (i + 1..few).map(move |j| (i, j))) {
        let [(a, p), (b, q)] = [i, j].map(|i| (facets[active[i]].normal, facets[active[i]].bound));
        let determinant = a[0] * b[1] - a[1] * b[0];
        if determinant.abs() <= ALONG * length(a) * length(b) {
            continue;
        }
        let corner = [(p * b[1] - q * a[1]) / determinant, (a[0] * q - b[0] * p) / determinant];
        for (index, facet) in facets.iter().enumerate() {
            let size = facet.bound.abs() + length(facet.normal) * length(corner);
            let meets = (dot(facet.normal, corner) - facet.bound).abs() <= ALONG * size;
            if facet.bound.is_finite() && meets && !active.contains(&index) {
                active.push(index);
            }
        }
    }
    active.sort_unstable();
}

/// Returns true if the active facets meet in the apex of dry friction: opening, and slip in both senses, without strength.
pub(super) fn is_apex(facets: &[Facet], active: &[usize]) -> bool {
    let bare = |own: &dyn Fn(&Facet) -> bool| active.iter().any(|f| facets[*f].bound <= 0.0 && own(&facets[*f]));
    let slides = |sense: f64| bare(&|f| f.mode == FacetMode::Sliding && sense * f.normal[1] > 0.0);
    bare(&|f| f.mode == FacetMode::Opening) && slides(1.0) && slides(-1.0)
}

/// Returns the greatest opening per slip of the sliding facets.
pub(super) fn dilatancy(facets: &[Facet]) -> f64 {
    let slides = facets.iter().filter(|f| f.mode == FacetMode::Sliding && f.flow[1] != 0.0);
    slides.map(|f| -f.flow[0] / f.flow[1].abs()).fold(0.0, f64::max)
}

/// Returns the modes of a contact point at a force; `open` is true if it has opened. Empty for a response. `tolerance`
/// is the greatest slack of active facets \[N\].
pub(super) fn point_modes(contact: &Contact, force: [f64; 2], open: bool, tolerance: f64) -> Vec<ModeCone> {
    match &contact.law {
        PointLaw::Bonded => vec![ModeCone { mode: PointMode::Stick, force: PLANE.into(), gap: Vec::new() }],
        PointLaw::Response(_) => Vec::new(),
        PointLaw::Facets(facets) => {
            let mut active = Vec::new();
            active_facets(&mut active, (contact, facets), &[force], tolerance);
            if open { open_modes(facets, &active) } else { closed_modes(facets, &active) }
        }
    }
}

/// Returns the generators of {ṙ : a_j·ṙ ≤ 0 on the active facets}.
fn admissible_rates(facets: &[Facet], active: &[usize]) -> Vec<[f64; 2]> {
    let own: Vec<Facet> = active.iter().map(|f| Facet { bound: 0.0, ..facets[*f] }).collect();
    if own.is_empty() { PLANE.into() } else { YieldPolygon::of(&own).rays }
}

fn along(normal: [f64; 2], rays: &[[f64; 2]]) -> Vec<[f64; 2]> {
    rays.iter().copied().filter(|ray| dot(normal, *ray).abs() <= ALONG * length(normal)).collect()
}

fn closed_modes(facets: &[Facet], active: &[usize]) -> Vec<ModeCone> {
    let rays = admissible_rates(facets, active);
    let flow = |f: usize| facets[f].flow.map(|d| -d);
    let vertex =
        ModeCone { mode: PointMode::Vertex, force: Vec::new(), gap: active.iter().map(|f| flow(*f)).collect() };
    let on_facet = |f: &usize| {
        let force = along(facets[*f].normal, &rays);
        let mode = PointMode::Facet(*f);
        (!force.is_empty()).then(|| ModeCone { mode, force, gap: vec![flow(*f)] })
    };
    let mut modes = vec![ModeCone { mode: PointMode::Stick, force: rays.clone(), gap: Vec::new() }];
    modes.extend(active.iter().filter_map(on_facet));
    if active.len() > 1 {
        modes.push(vertex);
    }
    modes
}

fn open_modes(facets: &[Facet], active: &[usize]) -> Vec<ModeCone> {
    if is_apex(facets, active) {
        return vec![ModeCone { mode: PointMode::Open, force: Vec::new(), gap: PLANE.into() }];
    }
    let rays = admissible_rates(facets, active);
    let Some(opening) = active.iter().copied().find(|f| facets[*f].mode == FacetMode::Opening) else {
        return Vec::new();
    };
    let [d, back] = [facets[opening].flow.map(|d| -d), facets[opening].flow];
    let force = along(facets[opening].normal, &rays);
    let mut modes = vec![ModeCone { mode: PointMode::Facet(opening), force, gap: vec![d, back] }];
    if active.len() > 1 {
        let others = active.iter().filter(|f| **f != opening).map(|f| facets[*f].flow.map(|d| -d));
        modes.push(ModeCone {
            mode: PointMode::Vertex,
            force: Vec::new(),
            gap: [d, back].into_iter().chain(others).collect(),
        });
    }
    modes
}
