//! The yield polygon of a law and the modes of a step.
//!
//! With Δg = g − s, s the irreversible gap at the last converged state, facets a·r ≤ b A and flow d, the law of a step
//! is Δg = −Σ γ d, 0 ≤ γ ⟂ b A − a·r ≥ 0: the return of z = r − ρ Δg to the polygon along ρ d. The return gives the
//! mode: inside (stuck), on one facet, or at a corner. Opening is reversible: s does not contain opening, so its
//! multiplier is the total one. Sources: Alart & Curnier 1991 (the return as a projection, ρ); Simo & Hughes 1998, ch.
//! 5 (several facets, non-associated flow); De Saxcé & Feng 1998 (the same law as a bi-potential).

use super::facet::{dot, multipliers, norm, slack};
use super::mode::ContactMode;
use voussoir_core::law::{Facet, FacetMode};

/// Facets of a law and the corners of two facets, for unit area.
#[derive(Debug, Clone, Default)]
pub struct YieldPolygon {
    /// Its half planes.
    pub facets: Vec<Facet>,
    /// Position \[Pa\] of each corner and its possible pairs of active facets.
    corners: Vec<Corner>,
}

/// Position and pairs of facets.
type Corner = ([f64; 2], Vec<[usize; 2]>);

impl YieldPolygon {
    /// Creates the polygon of the facets of a law.
    pub fn new(facets: &[Facet]) -> Self {
        let mut corners: Vec<Corner> = Vec::new();
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
                let tolerance = 1e-12 * scale.max(norm(corner));
                if facets.iter().any(|h| dot(h.normal, corner) > h.bound + tolerance * norm(h.normal)) {
                    continue;
                }
                let near = |c: &[f64; 2]| norm([c[0] - corner[0], c[1] - corner[1]]) <= tolerance;
                match corners.iter_mut().find(|(c, _)| near(c)) {
                    Some((_, pairs)) => pairs.push([i, j]),
                    None => corners.push((corner, vec![[i, j]])),
                }
            }
        }
        // At corners with opening, opening covers as much of the gap as possible.
        for (_, pairs) in &mut corners {
            let opening = |p: &[usize; 2]| p.iter().any(|&i| facets[i].mode == FacetMode::Opening);
            if pairs.iter().any(opening) {
                pairs.retain(opening);
            }
        }
        YieldPolygon { facets: facets.to_vec(), corners }
    }

    /// Returns the position \[Pa\] of the corner of a mode; `None` if the mode is not a corner.
    pub fn corner(&self, mode: ContactMode) -> Option<[f64; 2]> {
        self.at(mode).map(|corner| corner.0)
    }

    fn at(&self, mode: ContactMode) -> Option<&Corner> {
        let pair = match mode {
            ContactMode::Open => return self.corners.iter().find(|corner| self.is_apex(corner)),
            ContactMode::Corner(i, j) => [i as usize, j as usize],
            ContactMode::Stick | ContactMode::Facet(_) => return None,
        };
        self.corners.iter().find(|(_, pairs)| pairs.contains(&pair))
    }

    /// Returns true if opening and both senses of slip meet without strength: the apex of dry friction.
    fn is_apex(&self, (place, pairs): &Corner) -> bool {
        *place == [0.0; 2] && pairs.len() > 1 && self.opening_in(&pairs[0]).is_some()
    }

    fn opening_in(&self, pair: &[usize; 2]) -> Option<usize> {
        pair.iter().copied().find(|i| self.facets[*i].mode == FacetMode::Opening)
    }

    /// Returns the mode of a corner, which is the same for all pairs of its facets.
    fn mode_at(&self, corner: &Corner) -> ContactMode {
        let [i, j] = corner.1[0];
        if self.is_apex(corner) { ContactMode::Open } else { ContactMode::Corner(i as u8, j as u8) }
    }

    /// Returns the mode of the corner of two facets, or of the apex if they meet only there.
    pub fn mode_of_pair(&self, i: usize, j: usize) -> Option<ContactMode> {
        let pair = |p: &[usize; 2]| p.contains(&i) && p.contains(&j);
        let own = self.corners.iter().find(|(_, pairs)| pairs.iter().any(pair));
        own.or_else(|| self.corners.iter().find(|c| c.0 == [0.0; 2])).map(|corner| self.mode_at(corner))
    }

    /// Returns the projection of z onto a facet along ρ d, and its multiplier times ρ.
    fn return_to_facet(&self, i: usize, z: [f64; 2], rho: [f64; 2], area: f64) -> ([f64; 2], f64) {
        let f = &self.facets[i];
        let d = [rho[0] * f.flow[0], rho[1] * f.flow[1]];
        let gamma = -slack(f, z, area) / dot(f.normal, d);
        ([z[0] - gamma * d[0], z[1] - gamma * d[1]], gamma)
    }

    /// Returns the pair of facets of a corner with the least negative multipliers for Δg, and these multipliers. `None`
    /// without a corner.
    pub fn pair(&self, mode: ContactMode, gap: [f64; 2]) -> Option<([usize; 2], [f64; 2])> {
        self.at(mode).map(|corner| self.pair_of(corner, gap))
    }

    fn pair_of(&self, (_, pairs): &Corner, gap: [f64; 2]) -> ([usize; 2], [f64; 2]) {
        let of = |pair: [usize; 2]| multipliers(self.facets[pair[0]].flow, self.facets[pair[1]].flow, gap);
        let mut best = (pairs[0], of(pairs[0]));
        for &pair in &pairs[1..] {
            let gamma = of(pair);
            if gamma[0].min(gamma[1]) > best.1[0].min(best.1[1]) {
                best = (pair, gamma);
            }
        }
        best
    }

    /// Returns the distance of a mode from the return of z = r − ρ Δg, as a force \[N\]; 0 if the mode is right.
    pub fn violation(&self, mode: ContactMode, z: [f64; 2], rho: [f64; 2], area: f64) -> f64 {
        match (mode, self.at(mode)) {
            (ContactMode::Facet(i), _) => {
                let (r, gamma) = self.return_to_facet(i as usize, z, rho, area);
                let d = self.facets[i as usize].flow;
                self.outside(r, area, Some(i as usize)).max(-gamma * norm([rho[0] * d[0], rho[1] * d[1]]))
            }
            (_, Some(corner)) => self.violation_at(corner, z, rho, area),
            _ => self.outside(z, area, None),
        }
    }

    /// Returns the distance of a force outside the polygon \[N\]; 0 inside.
    pub fn excess(&self, r: [f64; 2], area: f64) -> f64 {
        self.outside(r, area, None)
    }

    /// Returns the distance of a force outside the polygon without one facet.
    fn outside(&self, r: [f64; 2], area: f64, except: Option<usize>) -> f64 {
        let others = self.facets.iter().enumerate().filter(|(i, _)| Some(*i) != except);
        others.map(|(_, f)| -slack(f, r, area) / norm(f.normal)).fold(0.0, f64::max)
    }

    fn violation_at(&self, corner: &Corner, z: [f64; 2], rho: [f64; 2], area: f64) -> f64 {
        let r = corner.0.map(|x| x * area);
        let gap = [(r[0] - z[0]) / rho[0], (r[1] - z[1]) / rho[1]];
        let (pair, gamma) = self.pair_of(corner, gap);
        let force = |i: usize| {
            let d = self.facets[pair[i]].flow;
            -gamma[i] * norm([rho[0] * d[0], rho[1] * d[1]])
        };
        force(0).max(force(1)).max(0.0)
    }

    /// Returns the mode of z = r − ρ Δg: `present` if it is right, otherwise the least violated mode.
    pub fn mode(&self, present: ContactMode, z: [f64; 2], rho: [f64; 2], area: f64, tolerance: f64) -> ContactMode {
        if self.violation(present, z, rho, area) <= tolerance {
            return present;
        }
        let mut best = (ContactMode::Stick, self.violation(ContactMode::Stick, z, rho, area));
        for corner in &self.corners {
            let violation = self.violation_at(corner, z, rho, area);
            if violation < best.1 {
                best = (self.mode_at(corner), violation);
            }
        }
        for mode in (0..self.facets.len() as u8).map(ContactMode::Facet) {
            let violation = self.violation(mode, z, rho, area);
            if violation < best.1 {
                best = (mode, violation);
            }
        }
        best.0
    }

    /// Returns the irreversible gap after Δg in a mode, without opening, and the multiplier of the opening. The gap
    /// lies along the flow: other parts of Δg are errors of the solution, which would accumulate from step to step.
    pub fn irreversible(&self, mode: ContactMode, gap: [f64; 2]) -> ([f64; 2], f64) {
        if let ContactMode::Facet(i) = mode {
            let f = &self.facets[i as usize];
            let multiplier = -dot(f.flow, gap) / dot(f.flow, f.flow);
            return match f.mode {
                FacetMode::Opening => ([0.0; 2], norm(gap)),
                _ => ([-multiplier * f.flow[0], -multiplier * f.flow[1]], 0.0),
            };
        }
        let (mut kept, mut opening) = ([0.0; 2], 0.0);
        if let Some((pair, gamma)) = self.pair(mode, gap) {
            for (i, gamma) in pair.into_iter().zip(gamma) {
                let f = &self.facets[i];
                if f.mode == FacetMode::Opening {
                    opening = gamma;
                } else {
                    kept = [kept[0] - gamma * f.flow[0], kept[1] - gamma * f.flow[1]];
                }
            }
        }
        (kept, opening)
    }

    /// Returns true if the point is open in a mode: an opening facet is active.
    pub fn opens(&self, mode: ContactMode) -> bool {
        match mode {
            ContactMode::Facet(i) => self.facets[i as usize].mode == FacetMode::Opening,
            _ => self.at(mode).is_some_and(|(_, pairs)| pairs.iter().any(|pair| self.opening_in(pair).is_some())),
        }
    }

    /// Returns the violation of a mode by a rate (ṙ, ġ) of unit size that continues without end: ṙ must be in the
    /// recession cone and multipliers must grow.
    pub fn ray_violation(&self, mode: ContactMode, force: [f64; 2], gap: [f64; 2]) -> f64 {
        let outwards = self.facets.iter().map(|f| dot(f.normal, force) / norm(f.normal)).fold(0.0, f64::max);
        let backwards = match mode {
            ContactMode::Facet(i) => {
                let d = self.facets[i as usize].flow;
                let along = -dot(d, gap) / norm(d);
                (norm([gap[0] + along * d[0] / norm(d), gap[1] + along * d[1] / norm(d)])).max(-along)
            }
            _ => self.pair(mode, gap).map_or(norm(gap), |(_, gamma)| (-gamma[0]).max(-gamma[1])),
        };
        outwards.max(backwards)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coulomb(mu: f64, psi: f64) -> YieldPolygon {
        let [left, right] = Facet::friction(mu, 0.0, psi);
        YieldPolygon::new(&[Facet::opening(0.0), left, right])
    }

    /// Without dilatancy the return of z is the projection of Alart and Curnier.
    #[test]
    fn modes_of_coulomb_are_those_of_alart_and_curnier() {
        let p = coulomb(0.5, 0.0);
        let of = |z: [f64; 2]| p.mode(ContactMode::Stick, z, [1.0, 1.0], 1.0, 1e-12);
        assert_eq!(of([1.0, 0.4]), ContactMode::Stick);
        assert_eq!(of([1.0, 0.6]), ContactMode::Facet(1));
        assert_eq!(of([1.0, -0.6]), ContactMode::Facet(2));
        for t in [-3.0, -0.1, 0.0, 0.2, 5.0] {
            assert_eq!(of([-0.1, t]), ContactMode::Open);
        }
        assert_eq!(p.corners.len(), 1);
    }

    /// The opening of an open dilatant joint is its gap above the dilated surface.
    #[test]
    fn opening_is_measured_from_the_dilated_surface() {
        let p = coulomb(0.5, 0.3);
        let (kept, opening) = p.irreversible(ContactMode::Open, [1.0, -2.0]);
        assert!((opening - (1.0 - 0.6)).abs() < 1e-15);
        assert!((kept[0] - 0.6).abs() < 1e-15 && (kept[1] + 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_strength_polygon_has_its_corners() {
        let [left, right] = Facet::friction(0.5, 1.0, 0.0);
        let p = YieldPolygon::new(&[Facet::opening(0.4), left, right, Facet::crushing(10.0)]);
        assert_eq!(p.corners.len(), 4);
        assert_eq!(p.mode(ContactMode::Stick, [12.0, 0.0], [1.0; 2], 1.0, 1e-12), ContactMode::Facet(3));
        assert!(matches!(p.mode(ContactMode::Stick, [12.0, 20.0], [1.0; 2], 1.0, 1e-12), ContactMode::Corner(..)));
    }
}
