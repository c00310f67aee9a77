//! A joint of the chain: its points, and the flexibilities that couple them and the neighbouring joints.

use super::sections::{Place, Section, Sections};
use crate::contact::mode::ContactMode;
use crate::linear::dense::{add_product, dot};
use crate::linear::largest;
use crate::path::system::System;
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, Vector3};
use std::rc::Rc;

/// Greatest number of points of a joint between rigid blocks: the equations of more points are sparse, and their inverse is not.
const MOST_POINTS: usize = 100;

/// A joint.
pub struct Joint {
    /// Index of its section.
    pub section: usize,
    /// Its contact points.
    pub contacts: Vec<usize>,
    /// H of all its points.
    pub by_twist: Rc<DMatrix<f64>>,
    /// Gaps from the joint's own forces.
    pub own: Rc<DMatrix<f64>>,
    /// Gaps from the forces of the joint before, if a voussoir connects them.
    pub before: Option<Rc<DMatrix<f64>>>,
    /// Gaps from the forces of the joint after, if a voussoir connects them.
    pub after: Option<Rc<DMatrix<f64>>>,
    /// Gaps from all unknowns of the joint, transposed, so that the gap of one point reads columns.
    pub rows: Rc<DMatrix<f64>>,
    /// Gaps from the forces of the joints before and after, transposed.
    beside: [Option<Rc<DMatrix<f64>>>; 2],
    /// κ.
    pub spring: Vector3<f64>,
}

/// Returns an order of the sections in which each is coupled only with its neighbours; true marks the start of a chain.
/// `None` if no such order exists.
fn ordered(system: &System, sections: &Sections) -> Option<Vec<(usize, bool)>> {
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); sections.all.len()];
    for (e, section) in sections.all.iter().enumerate() {
        let rows = section.places.iter().flat_map(|p| [2 * p.contact, 2 * p.contact + 1]);
        for other in rows.flat_map(|row| system.flexibility.row(row)).map(|entry| sections.of[entry.0 / 2]) {
            if other != e && !beside[e].contains(&other) {
                beside[e].push(other);
            }
        }
        if beside[e].len() > 2 {
            return None;
        }
    }
    let mut order: Vec<(usize, bool)> = Vec::with_capacity(beside.len());
    let mut met = vec![false; beside.len()];
    for end in (0..beside.len()).filter(|e| beside[*e].len() < 2) {
        let mut next = Some(end).filter(|e| !met[*e]);
        let mut begins = true;
        while let Some(e) = next {
            met[e] = true;
            order.push((e, begins));
            begins = false;
            next = beside[e].iter().copied().find(|other| !met[*other]);
        }
    }
    (order.len() == beside.len()).then_some(order)
}

/// Returns the gaps at the points of a section from forces at another section.
fn felt(system: &System, at: &Section, from: &Section, place: &[usize]) -> DMatrix<f64> {
    let mut block = DMatrix::zeros(2 * at.places.len(), 2 * from.places.len());
    let own: Vec<usize> = from.places.iter().map(|p| p.contact).collect();
    for (k, p) in at.places.iter().enumerate() {
        for i in 0..2 {
            for &(j, value) in system.flexibility.row(2 * p.contact + i) {
                if own.get(place[j / 2]) == Some(&(j / 2)) {
                    block[(2 * k + i, 2 * place[j / 2] + j % 2)] += value;
                }
            }
        }
    }
    block
}

/// Matrices that differ only by rounding are stored once: the matrices of congruent voussoirs then stay in the cache.
#[derive(Default)]
struct Shared(Vec<Rc<DMatrix<f64>>>);

impl Shared {
    fn of(&mut self, matrix: DMatrix<f64>) -> Rc<DMatrix<f64>> {
        let least = SETTINGS.negligible() * largest(matrix.as_slice());
        let same = |other: &&Rc<DMatrix<f64>>| {
            let mut pairs = other.as_slice().iter().zip(matrix.as_slice());
            other.shape() == matrix.shape() && pairs.all(|(a, b)| (a - b).abs() <= least)
        };
        if let Some(known) = self.0.iter().find(same) {
            return known.clone();
        }
        let new = Rc::new(matrix);
        self.0.push(new.clone());
        new
    }
}

/// The joints in their order, and (joint, position in it) of every contact point.
pub type Ordered = (Vec<Joint>, Vec<(usize, usize)>);

/// Returns the joints of chains. `None` if sections do not form chains, if a section has no flexibility, or if there are too
/// many points between rigid blocks.
pub fn joints(system: &System, sections: &Sections) -> Option<Ordered> {
    let alone = |place: &Place| system.flexibility.row(2 * place.contact).iter().all(|e| e.0 / 2 == place.contact);
    let has_many = |section: &Section| section.places.len() > MOST_POINTS && section.places.iter().all(alone);
    if sections.all.iter().any(has_many) {
        return None;
    }
    let order = ordered(system, sections)?;
    let mut within = vec![usize::MAX; system.contacts];
    for section in &sections.all {
        section.places.iter().enumerate().for_each(|(k, p)| within[p.contact] = k);
    }
    let mut places = vec![(0, 0); system.contacts];
    let (mut all, mut kinds, mut turned) = (Vec::with_capacity(order.len()), Shared::default(), Shared::default());
    for (position, &(e, begins)) in order.iter().enumerate() {
        let section = &sections.all[e];
        let n = section.places.len();
        for (k, p) in section.places.iter().enumerate() {
            places[p.contact] = (position, k);
        }
        let by_twist = kinds.of(DMatrix::from_fn(2 * n, 3, |i, j| section.places[i / 2].rows[(i % 2, j)]));
        let own = kinds.of(felt(system, section, section, &within));
        let congruent = |other: &&Joint| Rc::ptr_eq(&other.own, &own) && Rc::ptr_eq(&other.by_twist, &by_twist);
        let spring = match all.iter().find(congruent) {
            Some(other) => other.spring,
            None => {
                let stiffness = by_twist.transpose() * DMatrix::clone(&own).cholesky()?.solve(&*by_twist);
                Vector3::from_fn(|i, _| SETTINGS.spring * stiffness[(i, i)])
            }
        };
        let last = order.get(position + 1).is_none_or(|next| next.1);
        let beside = |other: usize| felt(system, section, &sections.all[order[other].0], &within);
        let before = (!begins).then(|| kinds.of(beside(position - 1)));
        let after = (!last).then(|| kinds.of(beside(position + 1)));
        let rows = turned.of(DMatrix::from_fn(2 * n + 3, 2 * n, |j, i| match j.checked_sub(2 * n) {
            None => own[(i, j)],
            Some(j) => by_twist[(i, j)],
        }));
        let turned_beside = [&before, &after].map(|block| block.as_ref().map(|b| turned.of(b.transpose())));
        all.push(Joint {
            rows,
            beside: turned_beside,
            section: e,
            contacts: section.places.iter().map(|p| p.contact).collect(),
            by_twist,
            own,
            before,
            after,
            spring,
        });
    }
    Some((all, places))
}

/// The rows of points in their modes.
pub type ModeRows = Vec<[[f64; 4]; 2]>;

impl Joint {
    /// Returns the number of its equations.
    pub fn size(&self) -> usize {
        2 * self.contacts.len() + 3
    }

    /// Returns the rows of its points in given modes of all points. `None` if a facet of a mode does not exist.
    pub fn rows(&self, system: &System, modes: &[ContactMode]) -> Option<ModeRows> {
        self.contacts.iter().map(|c| system.rows(*c, modes[*c])).collect()
    }

    /// Returns true if the joint may not be able to carry every resultant.
    pub fn is_weak(&self, modes: &[ContactMode]) -> bool {
        self.contacts.iter().filter(|c| modes[**c] == ContactMode::Stick).count() < 2
    }

    /// Computes the gaps of the points of joint `e` from the unknowns of the joints.
    pub fn set_gaps<'a>(&self, gaps: &mut Vec<f64>, e: usize, of: &dyn Fn(usize) -> &'a [f64]) {
        let m = 2 * self.contacts.len();
        gaps.clear();
        gaps.resize(m, 0.0);
        add_product(gaps, &self.own, &of(e)[..m]);
        add_product(gaps, &self.by_twist, &of(e)[m..]);
        for (block, other) in [(&self.before, e.wrapping_sub(1)), (&self.after, e + 1)] {
            if let Some(block) = block {
                add_product(gaps, block, &of(other)[..block.ncols()]);
            }
        }
    }

    /// Returns the gap of one of its points.
    pub fn gap<'a>(&self, e: usize, p: usize, of: &dyn Fn(usize) -> &'a [f64]) -> [f64; 2] {
        let mut gap = [0.0; 2];
        let beside = self.beside.iter().zip([e.wrapping_sub(1), e + 1]);
        let beside = beside.filter_map(|(block, other)| Some((block.as_ref()?, other)));
        for (block, other) in std::iter::once((&self.rows, e)).chain(beside) {
            let (height, unknowns) = (block.nrows(), of(other));
            let rows = block.as_slice()[2 * height * p..].chunks_exact(height);
            gap.iter_mut().zip(rows).for_each(|(gap, row)| *gap += dot(row, &unknowns[..height]));
        }
        gap
    }

    /// Returns a component of the resultant of its forces.
    pub fn resultant(&self, i: usize, forces: &[f64]) -> f64 {
        let rows = self.by_twist.nrows();
        dot(&self.by_twist.as_slice()[i * rows..(i + 1) * rows], &forces[..rows])
    }
}
