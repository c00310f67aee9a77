//! The law of a contact point as modes of a return map.
//!
//! With Δg = g − s, s the irreversible gap at the last converged state, facets a·r ≤ b A and flow d,
//! the law of a step is Δg = −Σ γ d, 0 ≤ γ ⟂ b A − a·r ≥ 0: the return of z = r − ρ Δg to the polygon
//! along ρ d. The mode of z is that of the return: inside (stuck), on one facet, or at a corner.
//! Opening is reversible: its multiplier is the total one, since s leaves opening out.
//! Sources: Alart & Curnier 1991 (the return as a projection, ρ); Simo & Hughes 1998, ch. 5 (several
//! facets, flow not along the normal); De Saxcé & Feng 1998 (the same law as a bi-potential).

use crate::path::cells::{Cell, Cells};
use voussoir_core::law::{Facet, FacetMode};

/// What a contact point does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(in crate::path) enum ContactMode {
    /// No facet: Δg = 0.
    #[default]
    Stick,
    /// On one facet.
    Facet(u8),
    /// At one corner of the polygon.
    Corner(u8),
}

/// Facets of a law and the corners at which two of them meet, for one unit of area.
#[derive(Debug, Clone, Default)]
pub(in crate::path) struct Polygon {
    pub facets: Vec<Facet>,
    /// Place \[Pa\] and the pairs of facets that may be active there.
    pub corners: Vec<([f64; 2], Vec<[usize; 2]>)>,
    /// Cells and their walls.
    pub cells: Cells,
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn size(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

impl Polygon {
    pub fn new(facets: &[Facet]) -> Self {
        let mut corners: Vec<([f64; 2], Vec<[usize; 2]>)> = Vec::new();
        let scale = facets.iter().map(|f| f.bound).fold(0.0, f64::max);
        for (i, f) in facets.iter().enumerate() {
            for (j, g) in facets.iter().enumerate().skip(i + 1) {
                let determinant = f.normal[0] * g.normal[1] - f.normal[1] * g.normal[0];
                let flows = f.flow[0] * g.flow[1] - f.flow[1] * g.flow[0];
                if determinant.abs() < 1e-12 || flows.abs() < 1e-12 {
                    continue;
                }
                let corner = [
                    (f.bound * g.normal[1] - g.bound * f.normal[1]) / determinant,
                    (g.bound * f.normal[0] - f.bound * g.normal[0]) / determinant,
                ];
                let tolerance = 1e-12 * scale.max(size(corner));
                if facets.iter().any(|h| dot(h.normal, corner) > h.bound + tolerance * size(h.normal)) {
                    continue;
                }
                let near = |c: &[f64; 2]| size([c[0] - corner[0], c[1] - corner[1]]) <= tolerance;
                match corners.iter_mut().find(|(c, _)| near(c)) {
                    Some((_, pairs)) => pairs.push([i, j]),
                    None => corners.push((corner, vec![[i, j]])),
                }
            }
        }
        // Where opening takes part, it takes as much of the gap as it can.
        for (_, pairs) in &mut corners {
            let opening = |p: &[usize; 2]| p.iter().any(|&i| facets[i].mode == FacetMode::Opening);
            if pairs.iter().any(opening) {
                pairs.retain(opening);
            }
        }
        let cells = Cells::new(facets, &corners);
        Polygon { facets: facets.to_vec(), corners, cells }
    }

    /// The mode of a cell.
    pub fn mode_of(&self, cell: usize) -> ContactMode {
        match self.cells.cells[cell].0 {
            Cell::Inside => ContactMode::Stick,
            Cell::Facet(i) => ContactMode::Facet(i as u8),
            Cell::Pair(k, _) => ContactMode::Corner(k as u8),
        }
    }

    /// The cell of z = r − ρ Δg and its return r.
    pub fn returned(&self, z: [f64; 2], rho: [f64; 2], area: f64) -> (usize, [f64; 2]) {
        match self.mode(ContactMode::Stick, z, rho, area, 0.0) {
            ContactMode::Stick => (0, z),
            ContactMode::Facet(i) => {
                let f = &self.facets[i as usize];
                let d = [rho[0] * f.flow[0], rho[1] * f.flow[1]];
                let gamma = (dot(f.normal, z) - f.bound * area) / dot(f.normal, d);
                (1 + i as usize, [z[0] - gamma * d[0], z[1] - gamma * d[1]])
            }
            ContactMode::Corner(k) => {
                let r = self.corners[k as usize].0.map(|x| x * area);
                let gap = [(r[0] - z[0]) / rho[0], (r[1] - z[1]) / rho[1]];
                let (pair, _) = self.pair(k, gap);
                (self.cells.at(k as usize, pair), r)
            }
        }
    }

    /// Multipliers (γ_i, γ_j) of −Δg over a pair of facets.
    pub fn multipliers(&self, pair: [usize; 2], gap: [f64; 2]) -> [f64; 2] {
        let (d, e) = (self.facets[pair[0]].flow, self.facets[pair[1]].flow);
        let determinant = d[0] * e[1] - d[1] * e[0];
        [(-gap[0] * e[1] + gap[1] * e[0]) / determinant, (-d[0] * gap[1] + d[1] * gap[0]) / determinant]
    }

    /// The pair whose multipliers for Δg are least negative, with them.
    pub fn pair(&self, corner: u8, gap: [f64; 2]) -> ([usize; 2], [f64; 2]) {
        let pairs = &self.corners[corner as usize].1;
        let mut best = (pairs[0], self.multipliers(pairs[0], gap));
        for &pair in &pairs[1..] {
            let gamma = self.multipliers(pair, gap);
            if gamma[0].min(gamma[1]) > best.1[0].min(best.1[1]) {
                best = (pair, gamma);
            }
        }
        best
    }

    /// How far a mode is from being the return of z = r − ρ Δg, as a force \[N\]; 0 where it is.
    pub fn violation(&self, mode: ContactMode, z: [f64; 2], rho: [f64; 2], area: f64) -> f64 {
        let over = |r: [f64; 2], except: Option<usize>| {
            let mut worst: f64 = 0.0;
            for (i, f) in self.facets.iter().enumerate() {
                if Some(i) != except {
                    worst = worst.max((dot(f.normal, r) - f.bound * area) / size(f.normal));
                }
            }
            worst
        };
        let pull = |d: [f64; 2]| [rho[0] * d[0], rho[1] * d[1]];
        match mode {
            ContactMode::Stick => over(z, None),
            ContactMode::Facet(i) => {
                let f = &self.facets[i as usize];
                let d = pull(f.flow);
                let gamma = (dot(f.normal, z) - f.bound * area) / dot(f.normal, d);
                let r = [z[0] - gamma * d[0], z[1] - gamma * d[1]];
                over(r, Some(i as usize)).max(-gamma * size(d))
            }
            ContactMode::Corner(k) => {
                let corner = self.corners[k as usize].0.map(|x| x * area);
                let gap = [(corner[0] - z[0]) / rho[0], (corner[1] - z[1]) / rho[1]];
                let (pair, gamma) = self.pair(k, gap);
                let force = |i: usize| -gamma[i] * size(pull(self.facets[pair[i]].flow));
                force(0).max(force(1)).max(0.0)
            }
        }
    }

    /// The mode of z = r − ρ Δg: `present` where it is one, else the one that is least violated.
    pub fn mode(&self, present: ContactMode, z: [f64; 2], rho: [f64; 2], area: f64, tolerance: f64) -> ContactMode {
        if self.violation(present, z, rho, area) <= tolerance {
            return present;
        }
        let facets = (0..self.facets.len() as u8).map(ContactMode::Facet);
        let corners = (0..self.corners.len() as u8).map(ContactMode::Corner);
        let mut best = (ContactMode::Stick, self.violation(ContactMode::Stick, z, rho, area));
        for mode in corners.chain(facets) {
            let violation = self.violation(mode, z, rho, area);
            if violation < best.1 {
                best = (mode, violation);
            }
        }
        best.0
    }

    /// Irreversible gap after Δg in a mode, opening left out, and the opening's own multiplier.
    pub fn irreversible(&self, mode: ContactMode, gap: [f64; 2]) -> ([f64; 2], f64) {
        match mode {
            ContactMode::Stick => ([0.0; 2], 0.0),
            ContactMode::Facet(i) => match self.facets[i as usize].mode {
                FacetMode::Opening => ([0.0; 2], size(gap)),
                _ => (gap, 0.0),
            },
            ContactMode::Corner(k) => {
                let (pair, gamma) = self.pair(k, gap);
                let (mut kept, mut opening) = ([0.0; 2], 0.0);
                for (i, gamma) in pair.into_iter().zip(gamma) {
                    let f = &self.facets[i];
                    if f.mode == FacetMode::Opening {
                        opening = gamma;
                    } else {
                        kept = [kept[0] - gamma * f.flow[0], kept[1] - gamma * f.flow[1]];
                    }
                }
                (kept, opening)
            }
        }
    }

    /// Whether the point is open in a mode: a facet of opening is active.
    pub fn opens(&self, mode: ContactMode) -> bool {
        let opening = |i: usize| self.facets[i].mode == FacetMode::Opening;
        match mode {
            ContactMode::Stick => false,
            ContactMode::Facet(i) => opening(i as usize),
            ContactMode::Corner(k) => self.corners[k as usize].1.iter().flatten().any(|i| opening(*i)),
        }
    }

    /// Whether slip is not associated somewhere.
    pub fn has_other_flow(&self) -> bool {
        self.facets.iter().any(|f| f.flow != f.normal)
    }

    /// How much a rate (ṙ, ġ), scaled to forces and gaps of size one, violates the mode if it goes
    /// on for ever: ṙ in the recession cone, multipliers growing.
    pub fn ray_violation(&self, mode: ContactMode, force: [f64; 2], gap: [f64; 2]) -> f64 {
        let outwards = self.facets.iter().map(|f| dot(f.normal, force) / size(f.normal)).fold(0.0, f64::max);
        let backwards = match mode {
            ContactMode::Stick => size(gap),
            ContactMode::Facet(i) => {
                let d = self.facets[i as usize].flow;
                let along = -dot(d, gap) / size(d);
                (size([gap[0] + along * d[0] / size(d), gap[1] + along * d[1] / size(d)])).max(-along)
            }
            ContactMode::Corner(k) => {
                let (_, gamma) = self.pair(k, gap);
                (-gamma[0]).max(-gamma[1])
            }
        };
        outwards.max(backwards)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coulomb(mu: f64, psi: f64) -> Polygon {
        let [left, right] = Facet::friction(mu, 0.0, psi);
        Polygon::new(&[Facet::opening(0.0), left, right])
    }

    /// The return of z is Alart and Curnier's projection where slip does not dilate.
    #[test]
    fn modes_of_coulomb_are_those_of_alart_and_curnier() {
        let p = coulomb(0.5, 0.0);
        let of = |z: [f64; 2]| p.mode(ContactMode::Stick, z, [1.0, 1.0], 1.0, 1e-12);
        assert_eq!(of([1.0, 0.4]), ContactMode::Stick);
        assert_eq!(of([1.0, 0.6]), ContactMode::Facet(1));
        assert_eq!(of([1.0, -0.6]), ContactMode::Facet(2));
        for t in [-3.0, -0.1, 0.0, 0.2, 5.0] {
            assert_eq!(of([-0.1, t]), ContactMode::Corner(0));
        }
        assert_eq!(p.corners.len(), 1);
    }

    /// While a dilatant joint is open its opening is what lies above the dilated surface.
    #[test]
    fn opening_is_measured_from_the_dilated_surface() {
        let p = coulomb(0.5, 0.3);
        let (kept, opening) = p.irreversible(ContactMode::Corner(0), [1.0, -2.0]);
        assert!((opening - (1.0 - 0.6)).abs() < 1e-15);
        assert!((kept[0] - 0.6).abs() < 1e-15 && (kept[1] + 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_strength_polygon_has_its_corners() {
        let [left, right] = Facet::friction(0.5, 1.0, 0.0);
        let p = Polygon::new(&[Facet::opening(0.4), left, right, Facet::crushing(10.0)]);
        assert_eq!(p.corners.len(), 4);
        assert_eq!(p.mode(ContactMode::Stick, [12.0, 0.0], [1.0; 2], 1.0, 1e-12), ContactMode::Facet(3));
        assert!(matches!(p.mode(ContactMode::Stick, [12.0, 20.0], [1.0; 2], 1.0, 1e-12), ContactMode::Corner(_)));
    }
}
