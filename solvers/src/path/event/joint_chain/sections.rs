//! The assembly as sections between bodies, and the section forces that statics does not determine.

use crate::path::system::System;
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Matrix3xX, Vector3};
use std::collections::BTreeMap;
use voussoir_core::path::{Contact, PathProblem};

/// Greatest number of cycles of sections.
const MOST_CYCLES: usize = 8;

/// A contact point of a section.
pub struct Place {
    /// Index of the contact point.
    pub contact: usize,
    /// H: gap from the relative twist about the section's centre.
    pub rows: Matrix2x3<f64>,
}

/// All contact points between two bodies, or one and the ground.
pub struct Section {
    /// Free bodies that it joins; `None`: the ground. Twists are those of the second body relative to the first.
    pub bodies: [Option<usize>; 2],
    /// Its contact points.
    pub places: Vec<Place>,
    /// E: converts resultants about the origin to resultants about the centre, in the axes of the first contact point:
    /// congruent joints then have the same rows H.
    pub to_centre: Matrix3<f64>,
    /// Coefficient of each cycle's redundants in its resultant: −1, 0 or 1.
    pub shares: Vec<f64>,
}

/// A body as a branch of the tree, with the section towards the ground.
struct Branch {
    body: usize,
    section: usize,
    /// 1 if it is the second body of that section, otherwise −1.
    sign: f64,
}

/// Sections, and a tree of them that contains all bodies.
pub struct Sections {
    /// All sections.
    pub all: Vec<Section>,
    /// Section of each contact point.
    pub of: Vec<usize>,
    /// Number of cycles: three redundants each.
    pub cycles: usize,
    /// Bodies from the ground outwards.
    tree: Vec<Branch>,
    /// Poles of the free bodies, in the scene's length.
    poles: Vec<[f64; 2]>,
}

/// Returns the row of a contact point over (u_x, u_y, θ) of a body.
fn row_of(system: &System, row: usize, body: usize) -> Vector3<f64> {
    let mut g = Vector3::zeros();
    for &(j, v) in system.kinematics.row(row).iter().filter(|e| e.0 / 3 == body) {
        g[j % 3] += v;
    }
    g
}

impl Sections {
    /// Groups the contact points. `None` if a contact point is rigid, if a body has no connection to the ground, or if
    /// there are too many cycles.
    pub fn new(system: &System, problem: &PathProblem) -> Option<Self> {
        let mut poles = vec![[0.0; 2]; system.bodies];
        for (free, body) in system.free.iter().zip(&problem.bodies) {
            if let Some(free) = free {
                poles[*free] = [body.pole.x / system.units.length, body.pole.y / system.units.length];
            }
        }
        let mut groups: BTreeMap<[Option<usize>; 2], Vec<usize>> = BTreeMap::new();
        for (c, contact) in problem.contacts.iter().enumerate() {
            let mut bodies = [contact.minus.body, contact.plus.body].map(|b| system.free[b]);
            bodies.sort();
            if bodies[0] == bodies[1] {
                return None;
            }
            groups.entry(bodies).or_default().push(c);
        }
        let mut all = Vec::with_capacity(groups.len());
        let mut of = vec![0; system.contacts];
        for (bodies, contacts) in groups {
            let mut centre = [0.0; 2];
            for &c in &contacts {
                let p = problem.contacts[c].position;
                centre = [centre[0] + p.x, centre[1] + p.y];
            }
            let centre = centre.map(|x| x / contacts.len() as f64 / system.units.length);
            let Contact { normal: n, tangent: t, .. } = problem.contacts[contacts[0]];
            let axes = Matrix3::new(n.x, n.y, 0.0, t.x, t.y, 0.0, 0.0, 0.0, 1.0);
            let mut places = Vec::with_capacity(contacts.len());
            for &c in &contacts {
                of[c] = all.len();
                places.push(Place::new(system, c, (bodies, centre, &axes), &poles)?);
            }
            let to_centre = axes * Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, centre[1], -centre[0], 1.0);
            all.push(Section { bodies, places, to_centre, shares: Vec::new() });
        }
        let mut sections = Sections { all, of, cycles: 0, tree: Vec::new(), poles };
        sections.grow(system.bodies)?;
        Some(sections)
    }

    /// Finds the tree, breadth first, and the cycles that the other sections close.
    fn grow(&mut self, bodies: usize) -> Option<()> {
        let mut at: Vec<Vec<usize>> = vec![Vec::new(); bodies];
        let mut front: Vec<usize> = Vec::new();
        for (s, section) in self.all.iter().enumerate() {
            section.bodies.iter().flatten().for_each(|b| at[*b].push(s));
            if section.bodies[0].is_none() {
                front.push(s);
            }
        }
        let (mut reached, mut used) = (vec![false; bodies], vec![false; self.all.len()]);
        let mut next = 0;
        while next < front.len() {
            let s = front[next];
            next += 1;
            if used[s] {
                continue;
            }
            let new = self.all[s].bodies.iter().position(|b| b.is_some_and(|b| !reached[b]));
            if let Some((side, body)) = new.and_then(|side| self.all[s].bodies[side].map(|b| (side, b))) {
                (reached[body], used[s]) = (true, true);
                self.tree.push(Branch { body, section: s, sign: if side == 1 { 1.0 } else { -1.0 } });
                front.extend(at[body].iter().filter(|s| !used[**s]));
            }
        }
        if reached.contains(&false) {
            return None;
        }
        let closing: Vec<usize> = (0..self.all.len()).filter(|s| !used[*s]).collect();
        self.cycles = closing.len();
        if self.cycles > MOST_CYCLES {
            return None;
        }
        // R of a branch balances the redundants of the cycles beyond it.
        let mut beyond = vec![vec![0.0; self.cycles]; bodies];
        self.all.iter_mut().for_each(|s| s.shares = vec![0.0; closing.len()]);
        for (k, &s) in closing.iter().enumerate() {
            self.all[s].shares[k] = 1.0;
            for (side, body) in self.all[s].bodies.into_iter().enumerate() {
                if let Some(body) = body {
                    beyond[body][k] += if side == 1 { 1.0 } else { -1.0 };
                }
            }
        }
        for branch in self.tree.iter().rev() {
            let own = std::mem::take(&mut beyond[branch.body]);
            self.all[branch.section].shares = own.iter().map(|v| -branch.sign * v).collect();
            if let Some(nearer) = self.all[branch.section].bodies[usize::from(branch.sign < 0.0)] {
                beyond[nearer].iter_mut().zip(&own).for_each(|(sum, v)| *sum += v);
            }
        }
        Some(())
    }

    /// Returns the resultant of each section from forces on the bodies, about the origin, without redundants.
    pub fn resultants(&self, wrench: &[[f64; 3]]) -> Vec<Vector3<f64>> {
        let mut beyond: Vec<Vector3<f64>> = wrench
            .iter()
            .zip(&self.poles)
            .map(|(w, p)| Vector3::new(w[0], w[1], w[2] - p[1] * w[0] + p[0] * w[1]))
            .collect();
        let mut resultants = vec![Vector3::zeros(); self.all.len()];
        for branch in self.tree.iter().rev() {
            let own = beyond[branch.body];
            resultants[branch.section] = -branch.sign * own;
            if let Some(nearer) = self.all[branch.section].bodies[usize::from(branch.sign < 0.0)] {
                beyond[nearer] += own;
            }
        }
        resultants
    }

    /// Returns the motions of the free bodies (u_x, u_y, θ L about their poles) from the relative twists of all
    /// sections about their centres.
    pub fn motions(&self, twists: &[Vector3<f64>]) -> Vec<[f64; 3]> {
        let mut own = vec![Vector3::zeros(); self.poles.len()];
        for branch in &self.tree {
            let section = &self.all[branch.section];
            let nearer = section.bodies[usize::from(branch.sign < 0.0)];
            let base = nearer.map_or_else(Vector3::zeros, |b| own[b]);
            own[branch.body] = base + branch.sign * section.to_centre.transpose() * twists[branch.section];
        }
        own.iter().zip(&self.poles).map(|(t, p)| [t[0] - t[2] * p[1], t[1] + t[2] * p[0], t[2]]).collect()
    }
}

impl Section {
    /// Returns R about the centre as a function of (X, s): redundants and the arc of the load.
    pub fn statics(&self, load: &Vector3<f64>) -> Matrix3xX<f64> {
        let cycles = self.shares.len();
        let mut all = Matrix3xX::zeros(3 * cycles + 1);
        for (k, share) in self.shares.iter().enumerate() {
            all.view_mut((0, 3 * k), (3, 3)).copy_from(&(self.to_centre * *share));
        }
        all.view_mut((0, 3 * cycles), (3, 1)).copy_from(&(self.to_centre * load));
        all
    }
}

impl Place {
    fn new(
        system: &System,
        contact: usize,
        (bodies, centre, axes): ([Option<usize>; 2], [f64; 2], &Matrix3<f64>),
        poles: &[[f64; 2]],
    ) -> Option<Self> {
        let mut compliance: Matrix2<f64> = Matrix2::zeros();
        let mut rows = Matrix2x3::zeros();
        for i in 0..2 {
            for &(j, v) in system.flexibility.row(2 * contact + i) {
                if j / 2 == contact {
                    compliance[(i, j % 2)] += v;
                }
            }
            // From the second body, or with opposite sign from the first.
            let about = |body: usize| {
                let g = row_of(system, 2 * contact + i, body);
                let p = [poles[body][0] - centre[0], poles[body][1] - centre[1]];
                axes * Vector3::new(g[0], g[1], g[2] - g[0] * p[1] + g[1] * p[0])
            };
            let by = bodies.map(|b| b.map(about));
            let row = by[1]?;
            if by[0].is_some_and(|first| (first + row).amax() > 1e-12 * row.amax().max(1.0)) {
                return None;
            }
            rows.set_row(i, &row.transpose());
        }
        let stiffness: Matrix2<f64> = compliance.try_inverse()?;
        let soft = (0..2).all(|i| compliance[(i, i)] > 0.0);
        (soft && stiffness.iter().all(|v: &f64| v.is_finite())).then_some(Place { contact, rows })
    }
}
