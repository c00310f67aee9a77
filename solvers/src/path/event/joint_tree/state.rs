//! The data of a run on the tree, and how forces, twists and openings of a joint are brought up to date.

use super::quiet::Quiet;
use super::tree::Tree;
use crate::contact::facet::dot;
use crate::contact::mode::ContactMode;
use crate::path::event::elastic_chain::ElasticChain;
use crate::path::event::event_run::Hit;
use crate::path::event::trace::Trace;
use crate::path::system::Load;
use nalgebra::Vector3;
use std::cmp::Ordering;
use voussoir_core::law::FacetMode;

/// How far a run has come.
pub struct Progress {
    /// (X, s).
    pub place: Vec<f64>,
    /// Resultants of all joints at the beginning.
    resultants: Vec<Vector3<f64>>,
    /// Relative twists of all joints since.
    pub twists: Vec<Vector3<f64>>,
    /// Motions at the beginning.
    pub motions: Vec<f64>,
    /// Work by the trapezoidal rule, displacement at the load and factor since the last record.
    pub since: [f64; 3],
    /// Mean arc between the last events.
    pub spacing: f64,
}

/// One load step, or a part of it.
pub struct Run {
    /// The joints.
    pub tree: Tree,
    /// What holds of them while nothing happens.
    pub quiet: Quiet,
    /// How far it has come.
    pub progress: Progress,
    /// Sense of the slip of open points, which dilatancy follows.
    pub senses: Vec<f64>,
    /// What each joint did when it was last looked at.
    pub out: Vec<Vec<f64>>,
    /// Greatest rate of a force and of a gap.
    pub sizes: [f64; 2],
    /// Nodes looked at since the last event, those above first.
    pub seen: Vec<usize>,
    /// What is near in the joints examined since the last event.
    pub hits: Vec<Hit>,
    /// Joints with points whose modes are others than those of the tree.
    pub stale: Vec<usize>,
    /// Joints whose modes are new since the last event, and those whose points may leave their modes at any time.
    pub fresh: Vec<usize>,
    /// Modes before the present event.
    pub before: Vec<(usize, ContactMode)>,
    /// Memory that is used again and again.
    pub memory: Memory,
}

/// What waits until a deadline: a joint, or all joints of a node.
#[derive(Clone, Copy, PartialEq)]
pub struct Waiting {
    /// The arc.
    pub deadline: f64,
    /// The node.
    pub node: usize,
    /// Whether its joint alone.
    pub own: bool,
}

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.deadline.total_cmp(&self.deadline).then(other.node.cmp(&self.node)).then(other.own.cmp(&self.own))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Of one joint, or of all.
#[derive(Default)]
pub struct Memory {
    /// Forces of its points.
    pub forces: Vec<f64>,
    /// What it did.
    gained: Vec<f64>,
    /// What waits until a deadline.
    pub waiting: Vec<Waiting>,
}

impl Run {
    /// From the present state. `None` where a support moves, where flow is not associated, or
    /// where the equations are singular.
    pub fn new(trace: &Trace, load: &Load) -> Option<Self> {
        if load.settles || !trace.associated {
            return None;
        }
        let chain: &ElasticChain = trace.factors.chain.as_ref()?;
        let tree = Tree::new(&trace.system, chain, load, &trace.state.points)?;
        let count = tree.joints.len();
        let force = |c: &usize| trace.state.force(*c);
        let resultants = tree.joints.iter().map(|joint| {
            let forces: Vec<f64> = joint.contacts.iter().flat_map(force).collect();
            Vector3::from_fn(|i, _| joint.resultant(i, &forces))
        });
        let progress = Progress {
            place: vec![0.0; tree.redundants() + 1],
            resultants: resultants.collect(),
            twists: vec![Vector3::zeros(); count],
            motions: trace.state.x[2 * trace.system.contacts..].to_vec(),
            since: [0.0, 0.0, trace.state.factor],
            spacing: 0.0,
        };
        Some(Run {
            quiet: Quiet::new(&tree, trace.problem)?,
            tree,
            progress,
            senses: vec![0.0; trace.system.contacts],
            out: vec![Vec::new(); count],
            sizes: [0.0; 2],
            seen: Vec::new(),
            hits: Vec::new(),
            stale: (0..count).collect(),
            fresh: Vec::new(),
            before: Vec::new(),
            memory: Memory::default(),
        })
    }

    /// Hands what waits above a joint down to it. Returns by how much each of its points opens, which is left to the
    /// caller.
    pub fn settle(&mut self, trace: &mut Trace, e: usize) -> Vec<f64> {
        self.settle_above(trace, e);
        self.take(trace, e)
    }

    /// The same; its points open.
    pub fn settle_joint(&mut self, trace: &mut Trace, e: usize) {
        self.settle_above(trace, e);
        self.settle_node(trace, e);
    }

    fn settle_above(&mut self, trace: &mut Trace, e: usize) {
        let path = self.tree.path(e);
        let (_, above) = path.split_last().unwrap_or((&e, &[]));
        above.iter().for_each(|m| self.settle_node(trace, *m));
    }

    /// The same of a node to which all above has been handed down; its points open.
    pub fn settle_node(&mut self, trace: &mut Trace, m: usize) {
        let openings = self.take(trace, m);
        for (c, opening) in self.tree.joints[m].contacts.iter().zip(openings) {
            let point = &mut trace.state.points[*c];
            if point.open() {
                point.opening = (point.opening + opening).max(0.0);
            }
        }
    }

    /// Brings the forces, the twist and the dissipation of a node's joint up to date.
    fn take(&mut self, trace: &mut Trace, m: usize) -> Vec<f64> {
        if !std::mem::take(&mut self.tree.moved[m].any) {
            return Vec::new();
        }
        let mut pending = std::mem::take(&mut self.tree.moved[m].pending);
        let (mut out, mut forces) = (std::mem::take(&mut self.memory.gained), std::mem::take(&mut self.memory.forces));
        self.tree.tables[m].answer(&pending, &mut out);
        self.balance(trace, m, &mut out, &mut forces);
        let (table, joint) = (&self.tree.tables[m], &self.tree.joints[m]);
        table.forces(&out, &mut forces);
        let n = out.len();
        let mut openings = vec![0.0; joint.contacts.len()];
        let mut dissipated = 0.0;
        for (k, &c) in joint.contacts.iter().enumerate() {
            (0..2).for_each(|i| trace.state.x[2 * c + i] += forces[2 * k + i]);
            let (mode, facets) = (self.tree.modes[c], trace.system.facets[c].as_deref().unwrap_or_default());
            if mode == ContactMode::Stick {
                continue;
            }
            let [_, gap] = table.point(k, &out);
            openings[k] = dot(mode.opening(facets, self.senses[c]), gap);
            let flows = match mode {
                ContactMode::Facet(f) => [Some(f), None],
                ContactMode::Corner(i, j) => [Some(i), Some(j)],
                _ => continue,
            };
            // Flow is associated: its work is its rate by the bound. Opening is reversible.
            for (f, rate) in flows.into_iter().flatten().zip(mode.unknowns(facets, gap)) {
                let facet = &facets[f as usize];
                if facet.mode != FacetMode::Opening {
                    dissipated += rate * facet.bound;
                }
            }
        }
        trace.state.energy.dissipated += dissipated * trace.system.units.energy();
        self.progress.twists[m] += Vector3::new(out[n - 3], out[n - 2], out[n - 1]);
        for (side, child) in self.tree.places[m].children.into_iter().enumerate() {
            let Some(child) = child else { continue };
            let mut below = std::mem::take(&mut self.tree.moved[child].pending);
            let parts = self.tree.hand_down((m, side), &pending, &forces);
            let mut rest = below.as_mut_slice();
            for part in parts {
                let (own, after) = rest.split_at_mut(part.len());
                own.iter_mut().zip(part).for_each(|(own, value)| *own += value);
                rest = after;
            }
            (self.tree.moved[child].pending, self.tree.moved[child].any) = (below, true);
        }
        (self.memory.gained, self.memory.forces) = (out, forces);
        pending.fill(0.0);
        self.tree.moved[m].pending = pending;
        openings
    }

    /// Takes out what increments leave of the joint's resultant.
    fn balance(&self, trace: &Trace, m: usize, out: &mut [f64], forces: &mut Vec<f64>) {
        if self.tree.places[m].weak.last() == Some(&m) {
            return;
        }
        let (table, joint, statics) = (&self.tree.tables[m], &self.tree.joints[m], &self.tree.statics[m]);
        table.forces(out, forces);
        for (own, &c) in forces.chunks_exact_mut(2).zip(&joint.contacts) {
            let force = trace.state.force(c);
            (own[0], own[1]) = (own[0] + force[0], own[1] + force[1]);
        }
        let (first, n) = (out.len() - 3, out.len());
        for i in 0..3 {
            let given: f64 = (0..statics.ncols()).map(|j| statics[(i, j)] * self.progress.place[j]).sum();
            let left = self.progress.resultants[m][i] + given - joint.resultant(i, forces);
            let by = &table.local.as_slice()[n * (first + i)..n * (first + i + 1)];
            out.iter_mut().zip(by).for_each(|(out, by)| *out += by * left);
        }
    }

    /// The greatest arc so far.
    pub fn arc(&self) -> f64 {
        self.progress.place[self.progress.place.len() - 1]
    }
}
