//! The tree of a chain's joints: every node joins what lies on both sides of its joint.
//!
//! A change at one joint changes the nodes above it only. What joints do, rates as well as increments of forces and
//! twists, is linear in what the joints on both sides of their node do: increments stay with the nodes and are handed
//! down where somebody looks.

use super::super::elastic_chain::{ElasticChain, Joint};
use super::super::force_method::{Sections, solved};
use super::node::{Change, Parts, Table, out_of_axes};
use crate::contact::mode::ContactMode;
use crate::path::event::point::Point;
use crate::path::system::{Load, System};
use nalgebra::{DMatrix, DVector, Matrix3xX};
use std::rc::Rc;

/// Twists of weak joints above which the whole system is asked.
const MOST_WEAK: usize = 24;
/// Changes after which a node is condensed anew.
const CHANGES: usize = 400;

/// Where a node stands.
#[derive(Default, Clone)]
pub struct Place {
    /// The node above, and on which side of it this one lies.
    pub parent: Option<(usize, usize)>,
    /// The nodes on both sides below.
    pub children: [Option<usize>; 2],
    /// The joints outside.
    pub outer: [Option<usize>; 2],
    /// Number of twists of weak joints on both sides below.
    pub below: [usize; 2],
    /// Weak joints below and here, in the order of their columns.
    pub weak: Vec<usize>,
}

/// What waits at a node.
#[derive(Default)]
pub struct Moved {
    /// Increments of its outer unknowns that its joint has not seen.
    pub pending: Vec<f64>,
    /// Whether there are any.
    pub any: bool,
    /// Rates of its outer unknowns, where they have been asked for.
    pub rates: Vec<f64>,
}

/// All joints.
pub struct Tree {
    /// The joints.
    pub joints: Vec<Rc<Joint>>,
    /// The sections that they are.
    pub sections: Rc<Sections>,
    /// R about the centre of every joint from (X, s).
    pub statics: Vec<Matrix3xX<f64>>,
    /// Gaps of every joint's points that the load opens.
    opened: Vec<Vec<f64>>,
    /// Joint and place in it of every contact point.
    pub at: Rc<Vec<(usize, usize)>>,
    /// Node of every joint.
    pub places: Vec<Place>,
    /// Its equations.
    pub tables: Vec<Table>,
    /// Modes of its points.
    pub modes: Vec<ContactMode>,
    /// What waits there.
    pub moved: Vec<Moved>,
    /// Whether the equations of a node are others than when it was last bounded.
    pub dirty: Vec<bool>,
    root: usize,
}

/// The nodes of joints `first..end`, the middle one above the others.
fn grow(places: &mut [Place], (first, end): (usize, usize), parent: Option<(usize, usize)>) -> Option<usize> {
    if first == end {
        return None;
    }
    let middle = first + (end - first) / 2;
    let below = [(first, middle), (middle + 1, end)];
    let children = [0, 1].map(|side| grow(places, below[side], Some((middle, side))));
    let outer = [first.checked_sub(1), Some(end).filter(|e| *e < places.len())];
    places[middle] = Place { parent, children, outer, ..Place::default() };
    Some(middle)
}

impl Tree {
    /// Of a chain under a load, its points in their present modes. `None` where that is singular.
    pub fn new(system: &System, chain: &ElasticChain, load: &Load, points: &[Point]) -> Option<Self> {
        let (joints, sections) = (chain.shared_joints(), chain.sections.clone());
        let resultants = sections.resultants(&load.wrench);
        let statics = |joint: &Rc<Joint>| sections.all[joint.section].statics(&resultants[joint.section]);
        let statics: Vec<_> = joints.iter().map(statics).collect();
        let mut places = vec![Place::default(); joints.len()];
        let root = grow(&mut places, (0, joints.len()), None)?;
        let modes: Vec<ContactMode> = points.iter().map(|p| p.settled().unwrap_or(p.mode)).collect();
        let mut tables = Vec::with_capacity(joints.len());
        for joint in joints.iter() {
            let mut table = Table::new(joint.contacts.len());
            for (k, &c) in joint.contacts.iter().enumerate() {
                table.prepare(k, modes[c], system.facets[c].as_deref())?;
            }
            tables.push(table);
        }
        let weak = (0..joints.len()).filter(|e| joints[*e].is_weak(&modes)).collect::<Vec<_>>();
        let opened = |joint: &Rc<Joint>| joint.contacts.iter().flat_map(|c| load.gap[*c]).collect();
        let count = joints.len();
        let mut tree = Tree {
            at: chain.places.clone(),
            moved: (0..count).map(|_| Moved::default()).collect(),
            dirty: vec![true; count],
            opened: joints.iter().map(opened).collect(),
            joints,
            sections,
            statics,
            places,
            tables,
            modes,
            root,
        };
        for e in weak {
            tree.places[e].weak.push(e);
        }
        tree.condense_below(root)?;
        Some(tree)
    }

    /// The node above all others.
    pub fn root(&self) -> usize {
        self.root
    }

    /// Number of redundants, and the place of the load, among the outer unknowns of the root.
    pub fn redundants(&self) -> usize {
        3 * self.sections.cycles
    }

    /// Number of forces of a joint.
    pub fn forces(&self, e: usize) -> usize {
        2 * self.joints[e].contacts.len()
    }

    /// Number of forces of the joints outside a node.
    pub fn outer(&self, m: usize) -> [usize; 2] {
        self.places[m].outer.map(|e| e.map_or(0, |e| self.forces(e)))
    }

    fn condense_below(&mut self, m: usize) -> Option<()> {
        for child in self.places[m].children.into_iter().flatten() {
            self.condense_below(child)?;
        }
        self.list_weak(m);
        self.condense(m)
    }

    /// The weak joints below and at a node.
    fn list_weak(&mut self, m: usize) {
        let own = self.places[m].weak.contains(&m);
        let lists = self.places[m].children.map(|child| child.map_or(Vec::new(), |c| self.places[c].weak.clone()));
        self.places[m].below = [lists[0].len(), lists[1].len()];
        self.places[m].weak = lists.concat();
        if own {
            self.places[m].weak.push(m);
        }
    }

    fn condense(&mut self, m: usize) -> Option<()> {
        let outer = self.outer(m);
        let mut table = std::mem::replace(&mut self.tables[m], Table::new(0));
        let place = &self.places[m];
        let parts = Parts {
            joint: &self.joints[m],
            statics: &self.statics[m],
            opened: &self.opened[m],
            sides: place.children.map(|child| child.map(|c| &self.tables[c].handed)),
            below: place.below,
            outer,
            weak: place.weak.last() == Some(&m),
        };
        let done = table.condense(&parts);
        let size = table.by_outer.ncols();
        self.tables[m] = table;
        let moved = &mut self.moved[m];
        if moved.pending.len() != size {
            // Nothing waits where the equations change.
            (moved.pending, moved.rates) = (vec![0.0; size], vec![0.0; size]);
        }
        self.dirty[m] = true;
        done
    }

    /// A node and those above it are condensed anew.
    fn condense_above(&mut self, e: usize) -> Option<()> {
        let mut next = Some(e);
        while let Some(m) = next {
            self.list_weak(m);
            self.condense(m)?;
            next = self.places[m].parent.map(|p| p.0);
        }
        Some(())
    }

    /// A node and those above it must be bounded anew.
    pub fn taint(&mut self, e: usize) {
        let mut next = Some(e);
        while let Some(m) = next {
            self.dirty[m] = true;
            next = self.places[m].parent.map(|p| p.0);
        }
    }

    /// Gives a contact point another mode; nothing may wait at the nodes above it. `None` where that is singular.
    pub fn set_mode(&mut self, system: &System, c: usize, mode: ContactMode) -> Option<()> {
        let (e, k) = self.at[c];
        self.modes[c] = mode;
        self.taint(e);
        if !self.places[e].weak.contains(&e) && self.joints[e].is_weak(&self.modes) {
            if self.places[self.root].weak.len() == MOST_WEAK {
                return None;
            }
            self.places[e].weak.push(e);
            self.condense_above(e)?;
        }
        let mut table = std::mem::replace(&mut self.tables[e], Table::new(0));
        let done = table.set_mode((system, c), k, mode, &mut |change| self.hand_up(e, change));
        let many = done.is_none() || self.tables[self.root].changes > CHANGES;
        if done.is_none() {
            table.prepare(k, mode, system.facets[c].as_deref())?;
        }
        self.tables[e] = table;
        if many { self.condense_above(e) } else { Some(()) }
    }

    /// Takes a change of what a node hands on to the nodes above it.
    fn hand_up(&mut self, from: usize, mut change: Change) -> Option<()> {
        let mut below = from;
        while let Some((m, side)) = self.places[below].parent {
            let [a, b] = self.outer(m);
            let own = self.forces(m);
            let base = self.redundants() + 1;
            let mut outer = vec![0.0; self.tables[m].by_outer.ncols()];
            let (here, there) = if side == 0 { ((a, 0), (0, a)) } else { ((0, own), (a, b)) };
            let along = &change.along;
            outer[there.0..there.0 + there.1].copy_from_slice(&along[here.1..here.1 + there.1]);
            let after = own + there.1;
            outer[a + b..a + b + base].copy_from_slice(&along[after..after + base]);
            let twists = a + b + base + if side == 0 { 0 } else { 3 * self.places[m].below[0] };
            outer[twists..twists + along.len() - after - base].copy_from_slice(&along[after + base..]);
            change = self.tables[m].update(change.factor, &along[here.0..here.0 + own], outer)?;
            below = m;
        }
        Some(())
    }

    /// Rates of (X, s, ξ̂) with ṡ = 1, and the rate of the displacement at the load. `None` near a mechanism.
    pub fn close(&self) -> Option<(Vec<f64>, f64)> {
        let (handed, n) = (&self.tables[self.root].handed, self.redundants());
        let rows: Vec<usize> = (0..handed.ncols()).filter(|i| *i != n).collect();
        let matrix = DMatrix::from_fn(rows.len(), rows.len(), |i, j| handed[(rows[i], rows[j])]);
        let right = DVector::from_fn(rows.len(), |i, _| -handed[(rows[i], n)]);
        let found = solved(matrix, &right)?;
        let mut all = vec![0.0; handed.ncols()];
        rows.iter().zip(found.iter()).for_each(|(row, value)| all[*row] = *value);
        all[n] = 1.0;
        let displacement = all.iter().enumerate().map(|(j, v)| handed[(n, j)] * v).sum();
        Some((all, displacement))
    }

    /// Outer unknowns of a node on a side below, part by part, from those of this one and the forces of its joint.
    pub fn hand_down<'a>(&self, (m, side): (usize, usize), outer: &'a [f64], forces: &'a [f64]) -> [&'a [f64]; 4] {
        let [a, b] = self.outer(m);
        let base = self.redundants() + 1;
        let [first, second] = if side == 0 { [&outer[..a], forces] } else { [forces, &outer[a..a + b]] };
        let twists = a + b + base + if side == 0 { 0 } else { 3 * self.places[m].below[0] };
        let twists = &outer[twists..twists + 3 * self.places[m].below[side]];
        [first, second, &outer[a + b..a + b + base], twists]
    }

    /// The nodes from the root to that of a joint.
    pub fn path(&self, e: usize) -> Vec<usize> {
        let mut path = vec![e];
        while let Some((m, _)) = self.places[path[path.len() - 1]].parent {
            path.push(m);
        }
        path.reverse();
        path
    }

    /// Axis `i` of a point over (n, t).
    pub fn axis(&self, e: usize, k: usize, i: usize) -> [f64; 2] {
        let unit = if i == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
        out_of_axes(self.tables[e].axes[k], unit)
    }
}
