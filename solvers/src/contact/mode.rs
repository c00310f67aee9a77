//! The mode of a contact point: the facets of its law that flow, and the two resulting equations.
//!
//! ```text
//! stick   ġ = 0                         facet i      a_i·ṙ = 0,  ġ = −γ d_i
//! open    ṙ = 0 (apex of dry friction)  corner i, j  ṙ = 0,      ġ = −γ_i d_i − γ_j d_j
//! ```

use super::facet::{across, dilatancy, dot, multipliers};
use voussoir_core::law::{Facet, FacetMode};

/// The mode of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ContactMode {
    /// No facet flows.
    #[default]
    Stick,
    /// One facet flows.
    Facet(u8),
    /// Two facets flow.
    Corner(u8, u8),
    /// No force at the apex of dry friction; the gap is free.
    Open,
}

impl ContactMode {
    /// Returns true if a facet flows.
    pub fn flows_on(self, facet: usize) -> bool {
        match self {
            ContactMode::Facet(i) => i as usize == facet,
            ContactMode::Corner(i, j) => i as usize == facet || j as usize == facet,
            ContactMode::Stick | ContactMode::Open => false,
        }
    }

    /// Returns true if the mode dissipates: a facet flows that does not open.
    pub fn slides(self, facets: &[Facet]) -> bool {
        facets.iter().enumerate().any(|(f, facet)| self.flows_on(f) && facet.mode != FacetMode::Opening)
    }

    /// Returns the directions of ġ, one per unknown.
    pub fn flows(self, facets: &[Facet]) -> Vec<[f64; 2]> {
        self.by_facet(|f| facets[f].flow.map(|d| -d))
    }

    /// Returns the functionals of ṙ that vanish, as many as unknowns.
    pub fn force_rows(self, facets: &[Facet]) -> Vec<[f64; 2]> {
        self.by_facet(|f| facets[f].normal.map(|a| -a))
    }

    fn by_facet(self, of: impl Fn(usize) -> [f64; 2]) -> Vec<[f64; 2]> {
        match self {
            ContactMode::Stick => Vec::new(),
            ContactMode::Facet(f) => vec![of(f as usize)],
            ContactMode::Corner(i, j) => vec![of(i as usize), of(j as usize)],
            ContactMode::Open => vec![[1.0, 0.0], [0.0, 1.0]],
        }
    }

    /// Returns the unknowns (multipliers, or the gap rate of an open point) of a gap rate.
    pub fn unknowns(self, facets: &[Facet], gap: [f64; 2]) -> Vec<f64> {
        match self {
            ContactMode::Stick => Vec::new(),
            ContactMode::Facet(f) => {
                let d = facets[f as usize].flow;
                vec![-dot(gap, d) / dot(d, d)]
            }
            ContactMode::Corner(i, j) => multipliers(facets[i as usize].flow, facets[j as usize].flow, gap).to_vec(),
            ContactMode::Open => gap.to_vec(),
        }
    }

    /// Returns the two equations as rows over (ṙ_n, ṙ_t, ġ_n, ġ_t). `None` if a facet of the mode does not exist.
    pub fn rows(self, facets: &[Facet]) -> Option<[[f64; 4]; 2]> {
        Some(match self {
            ContactMode::Stick => [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
            ContactMode::Open | ContactMode::Corner(..) => [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
            ContactMode::Facet(f) => {
                let facet = facets.get(f as usize)?;
                let (a, n) = (facet.normal, across(facet.flow));
                [[-a[0], -a[1], 0.0, 0.0], [0.0, 0.0, n[0], n[1]]]
            }
        })
    }

    /// Returns the opening above the dilated surface per unit gap. Open points slip in a `sense`, −1 or 1.
    pub fn opening(self, facets: &[Facet], sense: f64) -> [f64; 2] {
        let by_corner = |i: u8, j: u8, which: usize| {
            let of = |gap| multipliers(facets[i as usize].flow, facets[j as usize].flow, gap)[which];
            [[1.0, 0.0], [0.0, 1.0]].map(of)
        };
        let opens = |f: u8| facets[f as usize].mode == FacetMode::Opening;
        match self {
            ContactMode::Open => [1.0, -dilatancy(facets) * sense],
            ContactMode::Facet(f) if opens(f) => {
                let d = facets[f as usize].flow;
                d.map(|x| -x / dot(d, d))
            }
            ContactMode::Corner(i, j) if opens(i) => by_corner(i, j, 0),
            ContactMode::Corner(i, j) if opens(j) => by_corner(i, j, 1),
            _ => [0.0; 2],
        }
    }
}

/// Returns the part by forces and the part by gaps of each of the two equations of a point.
pub fn parts(rows: &[[f64; 4]; 2], force: [f64; 2], gap: [f64; 2]) -> [[f64; 2]; 2] {
    rows.map(|row| [row[0] * force[0] + row[1] * force[1], row[2] * gap[0] + row[3] * gap[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dry(dilatancy: f64) -> Vec<Facet> {
        [vec![Facet::opening(0.0)], Facet::friction(0.6, 0.0, dilatancy).to_vec()].concat()
    }

    /// Flows and unknowns are inverse to each other, and gap rates along the flows satisfy the rows of their mode.
    #[test]
    fn gap_rates_along_flows_satisfy_the_rows() {
        let facets = dry(0.2);
        for mode in [ContactMode::Facet(0), ContactMode::Facet(2), ContactMode::Corner(0, 1), ContactMode::Open] {
            let flows = mode.flows(&facets);
            let rates: Vec<f64> = (0..flows.len()).map(|k| 0.7 + k as f64).collect();
            let gap = [0, 1].map(|i| flows.iter().zip(&rates).map(|(f, v)| f[i] * v).sum::<f64>());
            for (a, b) in mode.unknowns(&facets, gap).iter().zip(&rates) {
                assert!((a - b).abs() < 1e-14, "{mode:?}");
            }
            for row in mode.rows(&facets).expect("rows") {
                assert!((row[2] * gap[0] + row[3] * gap[1]).abs() < 1e-15, "{mode:?}");
            }
        }
        assert_eq!(ContactMode::Facet(7).rows(&facets), None);
    }

    /// Only the gap above the dilated surface counts as opening: slip along the flow of a facet does not.
    #[test]
    fn dilatant_slip_does_not_open() {
        let facets = dry(0.3);
        for (f, sense) in [(1u8, -1.0), (2, 1.0)] {
            let slip = ContactMode::Facet(f).flows(&facets)[0];
            assert!(dot(ContactMode::Open.opening(&facets, sense), slip).abs() < 1e-15);
            assert!(dot(ContactMode::Corner(0, f).opening(&facets, sense), slip).abs() < 1e-15);
        }
        assert_eq!(ContactMode::Facet(0).opening(&facets, 1.0), [1.0, 0.0]);
        assert_eq!(ContactMode::Stick.opening(&facets, 1.0), [0.0; 2]);
    }
}
