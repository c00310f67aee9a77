//! The path problem in units of its own: forces by the loads, displacements by what those loads do
//! to a mean contact point, so that the units of a study do not matter.
//!
//! Unknowns x = (r, q): (r_n, r_t) of every contact point, then (u_x, u_y, θ L) of every free body.

use crate::path::rows::Rows;
use voussoir_core::law::{Facet, FacetMode};
use voussoir_core::path::{ContactLaw, Loading, PathProblem};

/// A facet at a contact point: slack s = bound − a·r, flow ġ = −γ d.
#[derive(Debug, Clone, Copy)]
pub struct PointFacet {
    /// What happens when it yields.
    pub mode: FacetMode,
    /// a.
    pub normal: [f64; 2],
    /// b × area, in the unit of force.
    pub bound: f64,
    /// d.
    pub flow: [f64; 2],
}

impl PointFacet {
    /// b − a·r.
    pub fn slack(&self, force: [f64; 2]) -> f64 {
        self.bound - dot(self.normal, force)
    }
}

/// Scalar product.
pub fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// A loading in scaled units.
#[derive(Debug, Clone)]
pub struct Load {
    /// Generalised force on each free body, per unit of λ.
    pub wrench: Vec<[f64; 3]>,
    /// Gap that it opens at each contact point, per unit of λ.
    pub gap: Vec<[f64; 2]>,
    /// Whether it opens any.
    pub opens: bool,
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
    /// Facets of each contact point; `None` where it is bonded.
    pub facets: Vec<Option<Vec<PointFacet>>>,
    /// Initial gaps.
    pub gap: Vec<f64>,
    /// Rows of C: (column, value) for 2c and 2c + 1.
    pub flexibility: Rows,
    /// Rows of G: (index of q from 0, value).
    pub kinematics: Rows,
    /// Unit of force \[N\].
    pub force_unit: f64,
    /// Unit of displacement \[m\].
    pub displacement_unit: f64,
    /// Unit of length \[m\].
    pub length: f64,
}

impl System {
    /// Scales a problem.
    pub fn new(problem: &PathProblem) -> Self {
        let contacts = problem.contacts.len();
        let length = problem.length;
        let magnitude = |loading: &Loading| -> f64 {
            let wrenches = problem.wrenches(loading);
            let own = |(w, body): (&[f64; 3], &voussoir_core::path::PathBody)| {
                if body.held { 0.0 } else { w[0].hypot(w[1]).max(w[2].abs() / length) }
            };
            wrenches.iter().zip(&problem.bodies).map(own).sum()
        };
        let loads: Vec<f64> = problem.load_steps.iter().map(|load_step| magnitude(&load_step.loading)).collect();
        let largest = loads.iter().copied().fold(0.0, f64::max);
        let force_unit = loads.iter().copied().find(|m| *m > 0.0).unwrap_or(if largest > 0.0 { largest } else { 1.0 });
        let mut free = Vec::with_capacity(problem.bodies.len());
        let mut bodies = 0;
        for body in &problem.bodies {
            free.push((!body.held).then(|| {
                bodies += 1;
                bodies - 1
            }));
        }
        // Rows of C in physical units: points of a body feel each other.
        let mut on_body: Vec<Vec<(usize, usize, f64)>> = vec![Vec::new(); problem.bodies.len()];
        for (index, contact) in problem.contacts.iter().enumerate() {
            for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
                if let Some(slot) = side.slot {
                    on_body[side.body].push((index, slot, sign));
                }
            }
        }
        let mut flexibility: Vec<Vec<(usize, f64)>> = vec![Vec::new(); 2 * contacts];
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
                            flexibility[2 * a + i].push((2 * b + j, sign_a * sign_b * value));
                        }
                    }
                }
            }
        }
        for (index, contact) in problem.contacts.iter().enumerate() {
            for i in 0..2 {
                if contact.compliance[i] > 0.0 {
                    flexibility[2 * index + i].push((2 * index + i, contact.compliance[i]));
                }
            }
        }
        let diagonal = |row: usize| flexibility[row].iter().filter(|e| e.0 == row).map(|e| e.1).sum::<f64>();
        let mean = (0..2 * contacts).map(diagonal).sum::<f64>() / (2 * contacts).max(1) as f64;
        let displacement_unit = if mean > 0.0 { force_unit * mean } else { length };
        for row in &mut flexibility {
            row.sort_by_key(|e| e.0);
            let mut merged: Vec<(usize, f64)> = Vec::with_capacity(row.len());
            for &(column, value) in row.iter() {
                let value = value * force_unit / displacement_unit;
                match merged.last_mut() {
                    Some(last) if last.0 == column => last.1 += value,
                    _ => merged.push((column, value)),
                }
            }
            *row = merged;
        }
        let mut kinematics: Vec<Vec<(usize, f64)>> = Vec::with_capacity(2 * contacts);
        for contact in &problem.contacts {
            let rows = [problem.kinematics(contact, false), problem.kinematics(contact, true)];
            for i in 0..2 {
                let mut row = Vec::new();
                for (side, body) in rows.iter().zip([contact.minus.body, contact.plus.body]) {
                    if let Some(free) = free[body] {
                        let [x, y, theta] = side[i];
                        row.extend([(3 * free, x), (3 * free + 1, y), (3 * free + 2, theta / length)]);
                    }
                }
                kinematics.push(row);
            }
        }
        let facets = problem
            .contacts
            .iter()
            .map(|contact| match contact.law {
                ContactLaw::Bonded => None,
                ContactLaw::Law(law) => {
                    let scaled = |f: &Facet| PointFacet {
                        mode: f.mode,
                        normal: f.normal,
                        bound: f.bound * contact.area / force_unit,
                        flow: f.flow,
                    };
                    Some(problem.facets[law].iter().map(scaled).collect())
                }
            })
            .collect();
        let gap = problem.contacts.iter().map(|c| c.gap / displacement_unit).collect();
        let (flexibility, kinematics) = (Rows::collect(&flexibility), Rows::collect(&kinematics));
        System { contacts, free, bodies, facets, gap, flexibility, kinematics, force_unit, displacement_unit, length }
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
        Load { wrench, gap, opens, size }
    }

    /// Gaps that forces and motions open: C r + G q, for a vector of all unknowns.
    pub fn gaps(&self, x: &[f64]) -> Vec<[f64; 2]> {
        let (r, q) = x.split_at(2 * self.contacts);
        let row = |i: usize| self.flexibility.along(i, r) + self.kinematics.along(i, q);
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
