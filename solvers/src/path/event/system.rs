//! The path problem in units of its own: forces by the loads, displacements by what those loads do
//! to a mean contact point, so that the units of a study do not matter.
//!
//! Unknowns x = (r, q): (r_n, r_t) of every contact point, then (u_x, u_y, θ L) of every free body.

use crate::contact::mode::ContactMode;
use crate::linear::csr::CsrMatrix;
use voussoir_core::law::Facet;
use voussoir_core::path::{Contact, Loading, PathBody, PathProblem};

/// A loading in scaled units.
#[derive(Debug, Clone)]
pub struct Load {
    /// Generalised force on each free body, per unit of λ.
    pub wrench: Vec<[f64; 3]>,
    /// Gap that it opens at each contact point, per unit of λ.
    pub gap: Vec<[f64; 2]>,
    /// Whether it opens any.
    pub opens: bool,
    /// Whether it moves supports: then what is statically determinate moves at constant forces while λ goes on.
    pub settles: bool,
    /// Greatest of them all: the size of forces that it causes, in scaled units.
    pub size: f64,
}

/// The scaled problem.
#[derive(Debug)]
pub struct System {
    /// Number of contact points.
    pub contacts: usize,
    /// Free body of each body.
    pub free: Vec<Option<usize>>,
    /// Number of free bodies.
    pub bodies: usize,
    /// Facets of each contact point, bounds times area in the unit of force; `None` where it is bonded.
    pub facets: Vec<Option<Vec<Facet>>>,
    /// Initial gaps.
    pub gap: Vec<f64>,
    /// Rows of C: (column, value) for 2c and 2c + 1.
    pub flexibility: CsrMatrix,
    /// Rows of G: (index of q from 0, value).
    pub kinematics: CsrMatrix,
    /// Unit of force \[N\].
    pub force_unit: f64,
    /// Unit of displacement \[m\].
    pub displacement_unit: f64,
    /// Unit of length \[m\].
    pub length: f64,
}

/// Size of a loading: the generalised forces on all free bodies \[N\].
fn magnitude(problem: &PathProblem, loading: &Loading) -> f64 {
    let own = |(w, body): (&[f64; 3], &PathBody)| {
        if body.held { 0.0 } else { w[0].hypot(w[1]).max(w[2].abs() / problem.length) }
    };
    problem.wrenches(loading).iter().zip(&problem.bodies).map(own).sum()
}

/// Rows of C in physical units: points of a body feel each other.
fn flexibility_rows(problem: &PathProblem) -> Vec<Vec<(usize, f64)>> {
    let mut on_body: Vec<Vec<(usize, usize, f64)>> = vec![Vec::new(); problem.bodies.len()];
    for (index, contact) in problem.contacts.iter().enumerate() {
        for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
            if let Some(slot) = side.slot {
                on_body[side.body].push((index, slot, sign));
            }
        }
    }
    let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); 2 * problem.contacts.len()];
    for (points, body) in on_body.iter().zip(&problem.bodies) {
        let Some(matrix) = &body.flexibility else { continue };
        for &(a, slot_a, sign_a) in points {
            let (ca, sa) = (&problem.contacts[a], 2 * slot_a);
            for &(b, slot_b, sign_b) in points {
                let (cb, sb) = (&problem.contacts[b], 2 * slot_b);
                let at = |i: usize, j: usize| matrix[(sa + i, sb + j)];
                for (i, ea) in [ca.normal, ca.tangent].into_iter().enumerate() {
                    for (j, eb) in [cb.normal, cb.tangent].into_iter().enumerate() {
                        let value =
                            ea.x * (at(0, 0) * eb.x + at(0, 1) * eb.y) + ea.y * (at(1, 0) * eb.x + at(1, 1) * eb.y);
                        rows[2 * a + i].push((2 * b + j, sign_a * sign_b * value));
                    }
                }
            }
        }
    }
    for (index, contact) in problem.contacts.iter().enumerate() {
        for i in 0..2 {
            if contact.compliance[i] > 0.0 {
                rows[2 * index + i].push((2 * index + i, contact.compliance[i]));
            }
        }
    }
    rows
}

/// Entries of a row sorted, repeated ones added, by a factor.
fn merged(mut row: Vec<(usize, f64)>, scaled: impl Fn(f64) -> f64) -> Vec<(usize, f64)> {
    row.sort_by_key(|e| e.0);
    let mut merged: Vec<(usize, f64)> = Vec::with_capacity(row.len());
    for (column, value) in row {
        match merged.last_mut() {
            Some(last) if last.0 == column => last.1 += scaled(value),
            _ => merged.push((column, scaled(value))),
        }
    }
    merged
}

/// Rows of G over the motions of the free bodies.
fn kinematic_rows(problem: &PathProblem, free: &[Option<usize>]) -> Vec<Vec<(usize, f64)>> {
    let mut kinematics: Vec<Vec<(usize, f64)>> = Vec::with_capacity(2 * problem.contacts.len());
    for contact in &problem.contacts {
        let rows = [problem.kinematics(contact, false), problem.kinematics(contact, true)];
        for i in 0..2 {
            let mut row = Vec::new();
            for (side, body) in rows.iter().zip([contact.minus.body, contact.plus.body]) {
                if let Some(free) = free[body] {
                    let [x, y, theta] = side[i];
                    row.extend([(3 * free, x), (3 * free + 1, y), (3 * free + 2, theta / problem.length)]);
                }
            }
            kinematics.push(row);
        }
    }
    kinematics
}

impl System {
    /// Scales a problem.
    pub fn new(problem: &PathProblem) -> Self {
        let contacts = problem.contacts.len();
        let loads: Vec<f64> = problem.load_steps.iter().map(|step| magnitude(problem, &step.loading)).collect();
        let force_unit = loads.iter().copied().find(|m| *m > 0.0).unwrap_or(1.0);
        let mut indices = 0..;
        let mut index = |held: bool| if held { None } else { indices.next() };
        let free: Vec<Option<usize>> = problem.bodies.iter().map(|body| index(body.held)).collect();
        let bodies = free.iter().flatten().count();
        let flexibility = flexibility_rows(problem);
        let diagonal = |row: usize| flexibility[row].iter().filter(|e| e.0 == row).map(|e| e.1).sum::<f64>();
        let mean = (0..2 * contacts).map(diagonal).sum::<f64>() / (2 * contacts).max(1) as f64;
        let displacement_unit = if mean > 0.0 { force_unit * mean } else { problem.length };
        let scaled = |value: f64| value * force_unit / displacement_unit;
        let flexibility: Vec<_> = flexibility.into_iter().map(|row| merged(row, scaled)).collect();
        let facets_of = |contact: &Contact| {
            let scaled = |f: &Facet| Facet { bound: f.bound * contact.area / force_unit, ..*f };
            contact.law.facets().map(|facets| facets.iter().map(scaled).collect())
        };
        System {
            contacts,
            bodies,
            facets: problem.contacts.iter().map(facets_of).collect(),
            gap: problem.contacts.iter().map(|c| c.gap / displacement_unit).collect(),
            flexibility: CsrMatrix::from_rows(&flexibility),
            kinematics: CsrMatrix::from_rows(&kinematic_rows(problem, &free)),
            free,
            force_unit,
            displacement_unit,
            length: problem.length,
        }
    }

    /// The two rows of a contact point in a mode over (ṙ_n, ṙ_t, ġ_n, ġ_t). `None` where it has no such facet.
    pub fn rows(&self, c: usize, mode: ContactMode) -> Option<[[f64; 4]; 2]> {
        mode.rows(self.facets[c].as_deref().unwrap_or_default())
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        2 * self.contacts + 3 * self.bodies
    }

    /// A loading in scaled units.
    pub fn load(&self, problem: &PathProblem, loading: &Loading) -> Load {
        let mut wrench = vec![[0.0; 3]; self.bodies];
        for (w, free) in problem.wrenches(loading).into_iter().zip(&self.free) {
            if let Some(free) = free {
                let [x, y, moment] = w;
                wrench[*free] = [x / self.force_unit, y / self.force_unit, moment / (self.force_unit * self.length)];
            }
        }
        let gap: Vec<[f64; 2]> =
            problem.loading_gaps(loading).into_iter().map(|g| g.map(|g| g / self.displacement_unit)).collect();
        let opens = gap.iter().flatten().any(|g| *g != 0.0);
        let all = wrench.iter().flatten().chain(gap.iter().flatten());
        let size = all.fold(0.0, |a: f64, v| a.max(v.abs()));
        let settles = loading.settlements.iter().any(|(_, motion)| *motion != [0.0; 3]);
        Load { wrench, gap, opens, settles, size }
    }

    /// Gaps that forces and motions open: C r + G q, for a vector of all unknowns.
    pub fn gaps(&self, x: &[f64]) -> Vec<[f64; 2]> {
        let (r, q) = x.split_at(2 * self.contacts);
        let row = |i: usize| self.flexibility.row_dot(i, r) + self.kinematics.row_dot(i, q);
        (0..self.contacts).map(|c| [row(2 * c), row(2 * c + 1)]).collect()
    }

    /// Gᵀ r: generalised forces of contact forces on the free bodies.
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
