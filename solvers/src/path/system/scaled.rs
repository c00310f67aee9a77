//! The scaled problem: G, C, laws and initial gaps in units.

use super::chain::ranks;
use super::rows::{flexibility_rows, kinematic_rows, merged};
use super::units::Units;
use crate::contact::mode::ContactMode;
use crate::linear::csr::CsrMatrix;
use std::sync::Arc;
use voussoir_core::law::Facet;
use voussoir_core::path::{Contact, PathProblem};

/// The scaled problem.
#[derive(Debug, Clone)]
pub struct System {
    /// Units of the unknowns.
    pub units: Units,
    /// Number of contact points.
    pub contacts: usize,
    /// Free body of each body.
    pub free: Vec<Option<usize>>,
    /// Number of free bodies.
    pub bodies: usize,
    /// Facets of each contact point, bounds times area in the unit of force; `None` if its law has no facets.
    pub facets: Vec<Option<Vec<Facet>>>,
    /// Initial gaps.
    pub gap: Vec<f64>,
    /// Rows of C: (column, value) for 2c and 2c + 1.
    pub flexibility: CsrMatrix,
    /// Rows of G: (index of q from 0, value).
    pub kinematics: CsrMatrix,
    /// Compliance of every contact point with all other points held: the diagonal of C, plus the compliance of laws
    /// that give tractions from gaps \[m/N\].
    pub compliance: Vec<[f64; 2]>,
    /// Ranks of the unknowns along a chain of bodies, if they form one.
    pub chain: Option<Arc<[usize]>>,
}

impl System {
    /// Scales a problem; `softening`: additional compliance of contact points from laws of tractions from gaps.
    pub fn new(problem: &PathProblem, softening: impl Fn(usize) -> [f64; 2]) -> Self {
        let contacts = problem.contacts.len();
        let mut indices = 0..;
        let mut index = |held: bool| if held { None } else { indices.next() };
        let free: Vec<Option<usize>> = problem.bodies.iter().map(|body| index(body.held)).collect();
        let flexibility = flexibility_rows(problem);
        let diagonal = |row: usize| flexibility[row].iter().filter(|e| e.0 == row).map(|e| e.1).sum::<f64>();
        let own = |c: usize, softening: [f64; 2]| [0, 1].map(|k| diagonal(2 * c + k) + softening[k]);
        let compliance: Vec<[f64; 2]> = (0..contacts).map(|c| own(c, softening(c))).collect();
        let soft = compliance.iter().flatten().filter(|c| **c > 0.0);
        let (count, sum) = soft.fold((0, 0.0), |(count, sum), c| (count + 1, sum + c));
        let units = Units::new(problem, sum / f64::from(count.max(1)));
        let scaled = |value: f64| value * units.force / units.displacement;
        let flexibility: Vec<_> = flexibility.into_iter().map(|row| merged(row, scaled)).collect();
        let facets_of = |contact: &Contact| {
            let scaled = |f: &Facet| Facet { bound: f.bound * contact.area / units.force, ..*f };
            contact.law.facets().map(|facets| facets.iter().map(scaled).collect())
        };
        let chain = ranks(problem, &free).map(Arc::from);
        System {
            units,
            contacts,
            bodies: free.iter().flatten().count(),
            facets: problem.contacts.iter().map(facets_of).collect(),
            gap: problem.contacts.iter().map(|c| c.gap / units.displacement).collect(),
            flexibility: CsrMatrix::from_rows(&flexibility),
            kinematics: CsrMatrix::from_rows(&kinematic_rows(problem, &free)),
            free,
            compliance,
            chain,
        }
    }

    /// Returns the two rows of a contact point in a mode over (ṙ_n, ṙ_t, ġ_n, ġ_t). `None` if a facet of the mode does
    /// not exist.
    pub fn rows(&self, c: usize, mode: ContactMode) -> Option<[[f64; 4]; 2]> {
        mode.rows(self.facets[c].as_deref().unwrap_or_default())
    }

    /// Returns the number of forces and motions.
    pub fn size(&self) -> usize {
        2 * self.contacts + 3 * self.bodies
    }

    /// Returns the index among the unknowns and the unit of a component (n or t of a contact point's force, then x, y,
    /// θ of every body, held ones included); `None` for held bodies.
    pub fn column(&self, index: usize) -> Option<(usize, f64)> {
        let base = 2 * self.contacts;
        if index < base {
            return Some((index, self.units.force));
        }
        let (body, k) = ((index - base) / 3, (index - base) % 3);
        self.free[body].map(|free| (base + 3 * free + k, self.units.motion()[k]))
    }

    /// Returns the motions of all bodies in physical units from those of the free ones; held bodies do not move.
    pub fn motions(&self, q: &[f64]) -> Vec<[f64; 3]> {
        let unit = self.units.motion();
        let own = |f: usize| [0, 1, 2].map(|k| q[3 * f + k] * unit[k]);
        self.free.iter().map(|free| free.map_or([0.0; 3], own)).collect()
    }

    /// Returns the gaps that forces and motions open: C r + G q, for a vector of all unknowns.
    pub fn gaps(&self, x: &[f64]) -> Vec<[f64; 2]> {
        let (r, q) = x.split_at(2 * self.contacts);
        let row = |i: usize| self.flexibility.row_dot(i, r) + self.kinematics.row_dot(i, q);
        (0..self.contacts).map(|c| [row(2 * c), row(2 * c + 1)]).collect()
    }

    /// Returns Gᵀ r: generalised forces of contact forces on the free bodies.
    pub fn resultants(&self, x: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; 3 * self.bodies];
        for (i, force) in x[..2 * self.contacts].iter().enumerate() {
            for &(j, v) in self.kinematics.row(i) {
                sum[j] += v * force;
            }
        }
        sum
    }
}
