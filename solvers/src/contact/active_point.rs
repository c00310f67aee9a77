//! A contact point with facets without slack: its possible modes in a rate, and the violation of a mode by a rate.
//!
//! - stick: ġ = 0, and the force rate leaves no active facet (ṡ ≥ 0);
//! - facet i: ṡ_i = 0, ġ = −γ d_i, γ ≥ 0 (any sign for an opening facet that is open);
//! - corner of facets i and j: ṙ = 0, ġ = −γ_i d_i − γ_j d_j;
//! - open (the apex of dry friction): ṙ = 0, ġ_n ≥ tan ψ |ġ_t|.
//!
//! Source of the modes: Alart and Curnier (1991).

use super::facet::{dilatancy, dot, norm, slack};
use super::mode::ContactMode;
use crate::settings::SETTINGS;
use voussoir_core::law::{Facet, FacetMode};

/// A contact point of the active set.
#[derive(Debug, Clone)]
pub struct ActivePoint<'a> {
    /// Facets of the law.
    pub facets: &'a [Facet],
    /// Facets without slack.
    pub active: Vec<usize>,
    /// The opening facet, if the point is open and not at the apex.
    pub open: Option<usize>,
    /// True if it is at the apex, where it may open freely.
    pub apex: bool,
    /// Its present mode; for a point that has just reached a facet, the mode of that facet.
    pub guess: ContactMode,
    /// Unit of its stiffness.
    pub stiffness: f64,
}

/// Returns true if the normals of two facets are not parallel.
fn independent(f: &Facet, g: &Facet) -> bool {
    let (a, b) = (f.normal, g.normal);
    (a[0] * b[1] - a[1] * b[0]).abs() > 1e-9 * (norm(a) * norm(b))
}

/// Adds the facets that pass through a corner of two active ones. Slacks are exact to rounding only: a force can be without
/// slack on both facets of friction and not on the facet of opening, which meets them. A facet without a bound passes
/// through no corner.
pub fn complete_corners(facets: &[Facet], active: &mut Vec<usize>) {
    let (few, tolerance) = (active.clone(), SETTINGS.admissible);
    let pairs = few.iter().enumerate().flat_map(|(k, i)| few[k + 1..].iter().map(move |j| (&facets[*i], &facets[*j])));
    for (f, g) in pairs.filter(|(f, g)| independent(f, g)) {
        let (a, b) = (f.normal, g.normal);
        let determinant = a[0] * b[1] - a[1] * b[0];
        let corner = [f.bound * b[1] - g.bound * a[1], a[0] * g.bound - b[0] * f.bound].map(|x| x / determinant);
        let meets =
            |f: &Facet| slack(f, corner, 1.0).abs() <= tolerance * (f.bound.abs() + norm(f.normal) * norm(corner));
        let bounded = (0..facets.len()).filter(|k| facets[*k].bound.is_finite());
        active.extend(bounded.filter(|k| !few.contains(k) && meets(&facets[*k])));
    }
    active.sort_unstable();
    active.dedup();
}

impl ActivePoint<'_> {
    /// Returns true if the active facets of a law without strength meet at the apex of dry friction: opening and slip
    /// in both senses.
    pub fn is_apex(facets: &[Facet], active: &[usize]) -> bool {
        let bare = |own: &dyn Fn(&Facet) -> bool| active.iter().any(|i| facets[*i].bound <= 0.0 && own(&facets[*i]));
        let slides = |sense: f64| bare(&|f| f.mode == FacetMode::Sliding && sense * f.normal[1] > 0.0);
        bare(&|f| f.mode == FacetMode::Opening) && slides(1.0) && slides(-1.0)
    }

    /// Returns the possible modes.
    pub fn candidates(&self) -> Vec<ContactMode> {
        if let Some(open) = self.open {
            let others = self.active.iter().filter(|f| **f != open);
            let corners = others.map(|f| ContactMode::Corner(open as u8, *f as u8));
            return std::iter::once(ContactMode::Facet(open as u8)).chain(corners).collect();
        }
        let sliding = |f: &&usize| !self.apex || self.facets[**f].mode != FacetMode::Opening;
        let mut modes = vec![ContactMode::Stick];
        modes.extend(self.active.iter().filter(sliding).map(|f| ContactMode::Facet(*f as u8)));
        if self.apex {
            modes.push(ContactMode::Open);
            return modes;
        }
        for (k, i) in self.active.iter().enumerate() {
            let independent = self.active[k + 1..].iter().filter(|j| independent(&self.facets[*i], &self.facets[**j]));
            modes.extend(independent.map(|j| ContactMode::Corner(*i as u8, *j as u8)));
        }
        modes
    }

    /// Returns the worst violation of a mode by a rate, relative to the given sizes of force and gap rates, and the
    /// mode that repairs it. `v`: the unknowns of the mode.
    pub fn violation(
        &self,
        mode: ContactMode,
        v: &[f64],
        force: [f64; 2],
        sizes: [f64; 2],
    ) -> Option<(f64, ContactMode)> {
        let [force_size, gap_size] = sizes;
        let mut worst: Option<(f64, ContactMode)> = None;
        let mut note = |size: f64, to: ContactMode| {
            if size > 0.0 && worst.is_none_or(|w| size > w.0) {
                worst = Some((size, to));
            }
        };
        match mode {
            ContactMode::Stick => {}
            ContactMode::Facet(f) if Some(f as usize) == self.open => {}
            ContactMode::Facet(_) => note(-v[0] / gap_size, ContactMode::Stick),
            ContactMode::Corner(i, j) => {
                for (k, (own, other)) in [(i, j), (j, i)].into_iter().enumerate() {
                    if Some(own as usize) != self.open {
                        note(-v[k] / gap_size, ContactMode::Facet(other));
                    }
                }
            }
            ContactMode::Open => {
                let closing = dilatancy(self.facets) * v[1].abs() - v[0];
                let slide = self.active.iter().copied().find(|f| {
                    let facet = &self.facets[*f];
                    facet.mode == FacetMode::Sliding && facet.flow[1] * v[1] < 0.0
                });
                note(closing / gap_size, slide.map_or(ContactMode::Stick, |f| ContactMode::Facet(f as u8)));
                return worst;
            }
        }
        for &f in self.active.iter().filter(|f| !mode.flows_on(**f)) {
            note(dot(self.facets[f].normal, force) / force_size, self.successor(mode, f));
        }
        worst
    }

    /// Returns the next mode if the force rate would leave another facet.
    fn successor(&self, mode: ContactMode, facet: usize) -> ContactMode {
        let is = |f: usize, what: FacetMode| self.facets[f].mode == what;
        match mode {
            _ if self.apex && is(facet, FacetMode::Opening) => ContactMode::Open,
            ContactMode::Facet(i) if self.apex => {
                match is(i as usize, FacetMode::Sliding) && is(facet, FacetMode::Sliding) {
                    true => ContactMode::Open,
                    false => ContactMode::Facet(facet as u8),
                }
            }
            ContactMode::Facet(i) if independent(&self.facets[i as usize], &self.facets[facet]) => {
                ContactMode::Corner(i, facet as u8)
            }
            _ => ContactMode::Facet(facet as u8),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn completed(friction: f64, bounds: [f64; 3], mut active: Vec<usize>) -> Vec<usize> {
        let facets = [
            Facet::associated(FacetMode::Opening, [-1.0, 0.0], bounds[0]),
            Facet::associated(FacetMode::Sliding, [-friction, 1.0], bounds[1]),
            Facet::associated(FacetMode::Sliding, [-friction, -1.0], bounds[2]),
        ];
        complete_corners(&facets, &mut active);
        active
    }

    /// Both facets of dry friction meet the facet of opening; with strength they do not, and facets without friction are parallel.
    #[test]
    fn facets_that_meet_in_a_corner_are_active_together() {
        assert_eq!(completed(0.5, [0.0; 3], vec![1, 2]), [0, 1, 2]);
        assert_eq!(completed(0.5, [0.0; 3], vec![2]), [2]);
        assert_eq!(completed(0.5, [1.0, 2.0, 2.0], vec![0, 1]), [0, 1]);
        assert_eq!(completed(0.0, [0.0; 3], vec![1, 2]), [1, 2]);
        assert_eq!(completed(0.0, [0.0, f64::INFINITY, 0.0], vec![0, 2]), [0, 2]);
    }
}
