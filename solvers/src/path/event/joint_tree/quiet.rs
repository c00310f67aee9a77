//! How far what comes from outside may change before anything can happen in a joint, or in all joints of a node.
//!
//! When a joint is examined each of its rates is given a room: while none leaves it no point leaves its mode, and no
//! event comes before a deadline. All rates below a node are linear in what comes from outside: forces of the two outer
//! joints that have no resultant, whose effect dies away (Saint-Venant), resultants, and twists of weak joints. Norms of
//! these maps, node by node upwards, say which share of all room a change from outside uses up at most.

use super::node::Table;
use super::tree::Tree;
use crate::contact::mode::ContactMode;
use crate::linear::dense::add_block;
use nalgebra::{DMatrix, Matrix3, Vector3};
use voussoir_core::linear::vectors::Simd;
use voussoir_core::path::PathProblem;
use voussoir_core::with_vectors;

/// Events for which a node is not bounded, at most.
const MOST_RESTS: u32 = 8;

/// What holds of a joint while nothing happens in it.
#[derive(Default, Clone)]
pub struct Own {
    /// What it did when it was last examined.
    pub reference: Vec<f64>,
    /// The room of each rate.
    pub room: Vec<f64>,
    /// The arc until which nothing happens within.
    pub deadline: f64,
    /// Whether it is to be examined at every event.
    pub always: bool,
    /// Greatest rates of a force and of a gap.
    pub sizes: [f64; 2],
}

/// The same of all joints of a node.
#[derive(Default, Clone)]
pub struct Below {
    /// What came from outside.
    reference: Vec<f64>,
    /// Share of the room that is used up, at most, by a change of 1 of the forces of an outer joint without resultant,
    by_force: [f64; 2],
    /// of each component of the redundants about the centre of the node's joint,
    by_resultant: Vec<f64>,
    /// of the twists of weak joints.
    by_twist: Vec<f64>,
    /// The arc until which nothing happens.
    pub deadline: f64,
    /// Whether one is to be examined at every event.
    pub always: bool,
    /// Greatest rates of a force and of a gap.
    pub sizes: [f64; 2],
    /// Events for which it is not bounded, since it was of no use before, and how many next time.
    rests: u32,
    patience: u32,
    /// When it was last bounded.
    event: u64,
}

/// A joint's forces with a resultant.
struct Span {
    /// An orthonormal basis of H.
    basis: DMatrix<f64>,
    /// Area of each point, and one by it for each of its rows.
    areas: Vec<f64>,
    by_area: Vec<f64>,
    /// E⁻¹.
    to_origin: Matrix3<f64>,
    /// E.
    to_centre: Matrix3<f64>,
}

/// Of all joints and nodes.
pub struct Quiet {
    spans: Vec<Span>,
    norms: Vec<Norms>,
    /// Events so far.
    pub events: u64,
    /// Of every joint.
    pub own: Vec<Own>,
    /// Of every node.
    pub below: Vec<Below>,
    /// Share of every node's room that is used up at the rates last seen.
    used: Vec<f64>,
    change: Vec<f64>,
}

/// Norms of the maps from outside to what a joint does.
#[derive(Clone, Default)]
struct Norms {
    /// Version of the equations whose norms these are.
    version: u64,
    /// Row by row: from forces without resultant,
    by_force: [Vec<f64>; 2],
    /// from resultants about the joint's centre,
    by_resultant: Vec<Vec<f64>>,
    /// from twists of weak joints.
    by_twist: Vec<Vec<f64>>,
    /// Of the joint's forces together.
    across: [f64; 2],
    across_by_twist: Vec<f64>,
    /// The joint's forces from redundants.
    forces: DMatrix<f64>,
    /// Forces of the outer joints that are taken for those of their resultants, from redundants: without them the others
    /// die away.
    shapes: [DMatrix<f64>; 2],
    /// Whether there are such forces.
    known: bool,
    /// For each side: version of the norms below, and the greatest stress in this joint apart from those.
    apart: [(u64, Vec<f64>); 2],
}

/// Adds, row by row, what forces without resultant do at most whose stresses are 1 at points of these areas; `basis`: of
/// forces with a resultant.
fn add_without_resultant(sums: &mut [f64], columns: &[f64], basis: &DMatrix<f64>, areas: &[f64]) {
    let mut with = [0, 1, 2].map(|_| vec![0.0; sums.len()]);
    let of_basis = basis.as_slice().chunks_exact(basis.nrows());
    with.iter_mut().zip(of_basis).for_each(|(with, basis)| add_block(with, columns, basis));
    let parts = (with, basis, areas);
    let parts = &parts;
    with_vectors!('a, add_sizes(sums: &'a mut [f64], columns: &'a [f64], parts: &'a ([Vec<f64>; 3], &'a DMatrix<f64>, &'a [f64])) -> ());
}

#[inline(always)]
fn add_sizes<S: Simd>(
    _: S,
    sums: &mut [f64],
    columns: &[f64],
    (with, basis, areas): &([Vec<f64>; 3], &DMatrix<f64>, &[f64]),
) {
    let height = sums.len();
    let [x, y, z] = [0, 1, 2].map(|k| &with[k][..height]);
    for (j, column) in columns.chunks_exact(height).enumerate() {
        let (area, [p, q, r]) = (areas[j / 2], [0, 1, 2].map(|k| basis[(j, k)]));
        for i in 0..height {
            sums[i] += area * (column[i] - (x[i] * p + y[i] * q + z[i] * r)).abs();
        }
    }
}

/// The greatest stress, at most, of forces of a joint that are at most these in its axes.
fn stress(table: &Table, areas: &[f64], forces: &[f64]) -> f64 {
    let of = |(k, area): (usize, &f64)| {
        let [u, v] = [0, 1].map(|i| if table.free[2 * k + i] { forces[2 * k + i].abs() } else { 0.0 });
        let force = if table.axes[k] == [1.0, 0.0] { u.max(v) } else { u + v };
        force / area
    };
    areas.iter().enumerate().map(of).fold(0.0, f64::max)
}

/// The greatest product of an absolute value and a weight; not NaN where one of them is.
fn greatest(values: &[f64], weights: &[f64]) -> f64 {
    let mut most = [0.0f64; 4];
    let (values, weights) = (values.chunks_exact(4), weights.chunks_exact(4));
    let rest = values.remainder().iter().zip(weights.remainder());
    let last = rest.fold(0.0, |most: f64, (value, weight)| most.max(value.abs() * weight));
    for (value, weight) in values.zip(weights) {
        for k in 0..4 {
            let size = value[k].abs() * weight[k];
            most[k] = if size > most[k] { size } else { most[k] };
        }
    }
    most.into_iter().fold(last, f64::max)
}

/// The greatest share of what is left of the room.
fn most(by: &[f64], rest: &[f64]) -> f64 {
    by.iter().zip(rest).map(|(by, rest)| by * rest).fold(0.0, f64::max)
}

impl Quiet {
    /// Nothing has been examined yet. `None` where a joint takes no resultant.
    pub fn new(tree: &Tree, problem: &PathProblem) -> Option<Self> {
        let mut spans = Vec::with_capacity(tree.joints.len());
        for joint in &tree.joints {
            let to_centre = tree.sections.all[joint.section].to_centre;
            let areas: Vec<f64> = joint.contacts.iter().map(|c| problem.contacts[*c].area).collect();
            spans.push(Span {
                basis: joint.by_twist.clone().qr().q(),
                by_area: areas.iter().flat_map(|area| [1.0 / area; 2]).collect(),
                areas,
                to_origin: to_centre.try_inverse()?,
                to_centre,
            });
        }
        let count = tree.joints.len();
        let own = Own { always: true, ..Own::default() };
        let below = Below { always: true, ..Below::default() };
        Some(Quiet {
            spans,
            events: 0,
            norms: vec![Norms::default(); count],
            own: vec![own; count],
            below: vec![below; count],
            used: vec![f64::INFINITY; count],
            change: Vec::new(),
        })
    }

    /// Which share of all room below a node is used up at most by its present rates from outside; any share above `enough`
    /// where it is more.
    pub fn use_up(&mut self, tree: &Tree, m: usize, enough: f64) -> f64 {
        let mut change = std::mem::take(&mut self.change);
        self.used[m] = match self.below[m].always || tree.dirty[m] {
            true => f64::INFINITY,
            false => self.find_used(tree, m, &mut change, enough),
        };
        self.change = change;
        self.used[m]
    }

    fn find_used(&self, tree: &Tree, m: usize, change: &mut Vec<f64>, enough: f64) -> f64 {
        let below = &self.below[m];
        change.clear();
        change.extend(tree.moved[m].rates.iter().zip(&below.reference).map(|(now, then)| now - then));
        let [a, b] = tree.outer(m);
        let n = tree.redundants();
        let (forces, others) = change.split_at_mut(a + b);
        let twists = others[n + 1..].iter().zip(&below.by_twist);
        let mut used = twists.map(|(change, by)| change.abs() * by).sum::<f64>();
        for k in 0..n / 3 {
            let own = &others[3 * k..3 * k + 3];
            let change = self.spans[m].to_centre * Vector3::new(own[0], own[1], own[2]);
            used += (0..3).map(|i| below.by_resultant[3 * k + i] * change[i].abs()).sum::<f64>();
        }
        for (side, own) in [(0, 0..a), (1, a..a + b)] {
            let Some(e) = tree.places[m].outer[side].filter(|_| used <= enough) else { continue };
            let own = &mut forces[own];
            let shape = self.norms[m].shapes[side].as_slice().chunks_exact(own.len());
            for (shape, redundant) in shape.zip(&others[..n]) {
                own.iter_mut().zip(shape).for_each(|(own, shape)| *own -= shape * redundant);
            }
            used += below.by_force[side] * greatest(own, &self.spans[e].by_area);
        }
        used
    }

    /// Norms of a node's equations, which have changed.
    fn find_norms(&self, tree: &Tree, m: usize) -> Norms {
        let (table, n) = (&tree.tables[m], tree.redundants());
        let (height, [a, b]) = (table.free.len(), tree.outer(m));
        let mut by_redundants = table.by_outer.columns(a + b, n).clone_owned();
        let none = |side: usize| DMatrix::zeros([a, b][side], n);
        let shape = |side: usize| tree.places[m].outer[side].map_or(Some(none(side)), |e| self.shape(tree, e));
        let (known, shapes) = match (shape(0), shape(1)) {
            (Some(first), Some(second)) => (true, [first, second]),
            _ => (false, [none(0), none(1)]),
        };
        let by_force = [(0, 0, a), (1, a, b)].map(|(side, first, count)| {
            let mut sums = vec![0.0; height];
            let Some(e) = tree.places[m].outer[side] else { return sums };
            let Span { basis, areas, .. } = &self.spans[e];
            let columns = &table.by_outer.as_slice()[height * first..height * (first + count)];
            let sums_of = by_redundants.as_mut_slice().chunks_exact_mut(height);
            let shape = shapes[side].as_slice().chunks_exact(count);
            sums_of.zip(shape).for_each(|(sum, shape)| add_block(sum, columns, shape));
            add_without_resultant(&mut sums, columns, basis, areas);
            sums
        });
        let mut by_resultant = Vec::with_capacity(n);
        for k in 0..n / 3 {
            let own = by_redundants.columns(3 * k, 3) * self.spans[m].to_origin;
            for column in own.column_iter() {
                let column: Vec<f64> = column.iter().copied().collect();
                by_resultant.push(column.iter().map(|v| v.abs()).collect());
            }
        }
        let first = a + b + n + 1;
        let twists: Vec<&[f64]> = table.by_outer.as_slice()[height * first..].chunks_exact(height).collect();
        let own = |rows: &[f64]| stress(table, &self.spans[m].areas, rows);
        Norms {
            version: table.version,
            across: [0, 1].map(|side| own(&by_force[side])),
            across_by_twist: twists.iter().map(|column| own(column)).collect(),
            by_twist: twists.iter().map(|column| column.iter().map(|v| v.abs()).collect()).collect(),
            by_force,
            by_resultant,
            forces: DMatrix::from_iterator(
                height - 3,
                n,
                by_redundants.column_iter().flat_map(|column| {
                    let column: Vec<f64> = column.iter().copied().collect();
                    let mut forces = Vec::with_capacity(height);
                    table.forces(&column, &mut forces);
                    forces
                }),
            ),
            shapes,
            known,
            apart: Default::default(),
        }
    }

    /// Bounds a node anew at its present rates, those below being bounded.
    pub fn bound(&mut self, tree: &mut Tree, m: usize, out: &[f64]) {
        let own = &self.own[m];
        let mut below = Below { deadline: own.deadline, always: own.always, sizes: own.sizes, ..Below::default() };
        let last = &mut self.below[m];
        below.reference = std::mem::take(&mut last.reference);
        (below.rests, below.patience) = match last.rests {
            0 if self.events > last.event + 1 => (0, 1),
            0 => (last.patience, (2 * last.patience).clamp(1, MOST_RESTS)),
            rests => (rests - 1, last.patience),
        };
        below.event = self.events;
        below.always |= below.rests > 0;
        let children = tree.places[m].children;
        for child in children.into_iter().flatten().map(|child| &self.below[child]) {
            below.deadline = below.deadline.min(child.deadline);
            below.always |= child.always;
            below.sizes = [0, 1].map(|i| below.sizes[i].max(child.sizes[i]));
        }
        if !below.always {
            below.reference.clone_from(&tree.moved[m].rates);
            self.bound_shares(tree, m, out, &mut below);
        }
        tree.dirty[m] = false;
        self.used[m] = 0.0;
        self.below[m] = below;
    }

    fn bound_shares(&mut self, tree: &Tree, m: usize, out: &[f64], below: &mut Below) {
        let table = &tree.tables[m];
        if self.norms[m].version != table.version {
            self.norms[m] = self.find_norms(tree, m);
        }
        for (side, child) in tree.places[m].children.into_iter().enumerate() {
            if let Some(child) = child.filter(|child| self.norms[m].apart[side].0 != self.norms[*child].version) {
                self.norms[m].apart[side] = (self.norms[child].version, self.find_apart((m, side), child));
            }
        }
        let (own, norms) = (&self.own[m], &self.norms[m]);
        let rooms = own.room.iter().zip(out.iter().zip(&own.reference));
        let rest: Vec<f64> = rooms.map(|(room, (now, then))| 1.0 / (room - (now - then).abs())).collect();
        below.always = !norms.known || rest.iter().any(|r| r.is_nan() || *r <= 0.0);
        below.by_force = [0, 1].map(|side| most(&norms.by_force[side], &rest));
        below.by_resultant = norms.by_resultant.iter().map(|by| most(by, &rest)).collect();
        below.by_twist = norms.by_twist.iter().map(|by| most(by, &rest)).collect();
        for (side, child) in tree.places[m].children.into_iter().enumerate() {
            let Some(child) = child else { continue };
            let used = self.used[child];
            below.always |= used.is_nan() || used >= 1.0;
            let rest = 1.0 / (1.0 - used);
            let by = &self.below[child];
            let (outside, inside) = (by.by_force[side] * rest, by.by_force[1 - side] * rest);
            let more = |most: &mut f64, value: f64| *most = most.max(value);
            more(&mut below.by_force[side], outside + inside * norms.across[side]);
            more(&mut below.by_force[1 - side], inside * norms.across[1 - side]);
            let moved = self.spans[child].to_centre * self.spans[m].to_origin;
            for (j, apart) in norms.apart[side].1.iter().enumerate() {
                let own = |i: usize| by.by_resultant[3 * (j / 3) + i] * moved[(i, j % 3)].abs();
                let own = (0..3).map(own).sum::<f64>() * rest;
                more(&mut below.by_resultant[j], own + inside * apart);
            }
            let start = if side == 0 { 0 } else { 3 * tree.places[m].below[0] };
            for (j, across) in norms.across_by_twist.iter().enumerate() {
                let own = j.checked_sub(start).and_then(|j| by.by_twist.get(j)).map_or(0.0, |by| by * rest);
                more(&mut below.by_twist[j], own + inside * across);
            }
        }
    }

    /// The greatest stress in the joint of a node beside those of the shape that the node below takes for them, for each
    /// component of the redundants about its centre.
    fn find_apart(&self, (m, side): (usize, usize), child: usize) -> Vec<f64> {
        let apart = &self.norms[m].forces - &self.norms[child].shapes[1 - side];
        let of = |j: usize| {
            let own = apart.columns(3 * (j / 3), 3) * self.spans[m].to_origin.column(j % 3);
            greatest(own.as_slice(), &self.spans[m].by_area)
        };
        (0..apart.ncols()).map(of).collect()
    }

    /// Forces of a joint from redundants with stresses that vary linearly over the points that are not open. `None`
    /// where those take no resultant.
    fn shape(&self, tree: &Tree, e: usize) -> Option<DMatrix<f64>> {
        let (joint, areas, n) = (&tree.joints[e], &self.spans[e].areas, tree.redundants());
        let shape = |closed: &dyn Fn(usize) -> bool| {
            let weight = |i: usize| if closed(joint.contacts[i / 2]) { areas[i / 2] } else { 0.0 };
            let stress = DMatrix::from_fn(joint.by_twist.nrows(), 3, |i, j| weight(i) * joint.by_twist[(i, j)]);
            Some(&stress * joint.by_twist.tr_mul(&stress).try_inverse()?)
        };
        let open = |c: usize| matches!(tree.modes[c], ContactMode::Open | ContactMode::Corner(..));
        let closed = joint.contacts.iter().filter(|c| !open(**c)).count();
        let shape = if closed > 1 { shape(&|c| !open(c)) } else { shape(&|_| true) };
        Some(shape? * tree.statics[e].columns(0, n))
    }
}
