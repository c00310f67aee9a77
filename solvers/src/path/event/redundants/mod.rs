//! The force method: a path through many events where statics leaves little open.
//!
//! Blocks that are rigid on joints with a compliance of their own, and few cycles of them (an arch between
//! its abutments is one): given the three redundants X of each cycle and the load, statics gives the
//! resultant R of every section, and a section's points see nothing else. A rate problem is then three
//! equations a cycle instead of three a block, an event changes the flexibility of one section, and a
//! section none of whose points has changed its piece is a function of (X, s), s the arc of the load:
//!
//! ```text
//! R_e = E (Σ_k s_ek X_k + L_e s)       ξ_e = ξ_e⁰ − K⁻¹ ΔR_e
//! ```
//!
//! It is looked at only where something may happen in it: when its rate ξ̇ has left the neighbourhood in which
//! no point can leave its piece, or when the earliest event that is possible there is near. What dissipates
//! on the way, −∫ r·dg_p with both linear in z = (X, s), is had from ∫ z dzᵀ, one matrix for all sections.
//!
//! Where this does not decide (a mechanism, many points that choose at once, no end), it gives the present
//! state back, and the rate problem is put to the whole system.
//!
//! Source: the force method for arches, Müller-Breslau (1887), Die graphische Statik der Baukonstruktionen II.

mod equations;
mod joint;
mod section;

pub use section::Sections;

use super::rate::{Piece, dilatancy};
use super::system::{Load, dot};
use super::trace::Tracer;
use equations::{Equations, Solution};
use joint::Joint;
use nalgebra::{DMatrix, DVector, Vector3};

/// Points at the verge of a change from which flow that is not associated is not examined for other rates.
const UNEXAMINED: usize = 7;
/// Share of a section's rate by which it may change before its points are looked at again.
const NEIGHBOURHOOD: f64 = 0.3;
/// Relative violation up to which a rate keeps to its pieces.
const INEQUALITY: f64 = 1e-10;
/// Changes of a section's rate below this share of the greatest rate of a gap are rounding.
const ROUNDING: f64 = 1e-13;
/// Slacks and gaps below this (in scaled units) are events of the same moment: a redundant is rounded by all
/// sections of its cycle, which must not tell the two halves of a symmetric arch apart.
const MOMENT: f64 = 1e-11;
/// Rounds of correction, and those in which all points are corrected at once.
const ROUNDS: [usize; 2] = [40, 12];
/// Events that are all recorded; of more, so many each time their number grows e-fold.
const RECORDED: u64 = 64;

/// z = (X, s), and ∫ z dzᵀ on the way.
pub struct Clock {
    /// (X, s).
    pub place: DVector<f64>,
    /// ∫ z dzᵀ.
    pub area: DMatrix<f64>,
}

impl Clock {
    fn step(&mut self, rate: &DVector<f64>, step: f64) {
        let moved = rate * step;
        self.area += (&self.place + 0.5 * &moved) * moved.transpose();
        self.place += moved;
    }

    fn arc(&self) -> f64 {
        self.place[self.place.len() - 1]
    }
}

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Followed {
    /// At the target.
    Reached,
    /// Where the whole system must be asked.
    Left,
    /// By its observer.
    Stopped,
}

/// What is nearest: arc until then, rate with which it comes, contact point, facet or `usize::MAX`.
type Hit = (f64, f64, usize, usize);

/// One load step, or a part of it.
struct Run<'s> {
    sections: &'s Sections,
    joints: Vec<Joint>,
    equations: Equations,
    clock: Clock,
    /// Greatest rate of force seen, and of a gap now.
    sizes: [f64; 2],
    /// Motions at the beginning.
    motions: Vec<f64>,
    /// Sections looked at since the last event, with what is near in them.
    looked: Vec<(usize, Vec<Hit>)>,
    /// Sections whose tangents are new since the last event.
    fresh: Vec<usize>,
    /// Pieces before the present event.
    before: Vec<(usize, Piece)>,
    /// Work by the trapezoidal rule, displacement at the load and factor since the last record.
    since: [f64; 3],
}

impl Tracer<'_> {
    /// Follows the path from event to event as far as it goes. `steps` counts.
    pub(super) fn by_redundants(
        &mut self,
        load: &Load,
        sense: f64,
        target: f64,
        steps: &mut usize,
        most: usize,
    ) -> Followed {
        // From nothing every point stands at the verge of a change.
        if self.x.iter().all(|v| *v == 0.0) {
            return Followed::Left;
        }
        let Some(sections) = self.sections.take() else { return Followed::Left };
        let followed = Run::new(self, &sections, load).and_then(|mut run| run.follow(self, sense, target, steps, most));
        self.sections = Some(sections);
        followed.unwrap_or(Followed::Left)
    }
}

impl<'s> Run<'s> {
    fn new(tracer: &Tracer, sections: &'s Sections, load: &Load) -> Option<Self> {
        // A support's reaction works on the way: its own load has no displacement by which to count that.
        if load.opens {
            return None;
        }
        let resultants = sections.resultants(load);
        let joints: Vec<Joint> =
            sections.all.iter().zip(&resultants).map(|(section, l)| Joint::new(section, l)).collect();
        let n = 3 * sections.cycles + 1;
        Some(Run {
            sections,
            joints,
            equations: Equations::new(sections),
            clock: Clock { place: DVector::zeros(n), area: DMatrix::zeros(n, n) },
            sizes: [0.0; 2],
            motions: tracer.x[2 * tracer.system.contacts..].to_vec(),
            looked: Vec::new(),
            fresh: Vec::new(),
            before: Vec::new(),
            since: [0.0, 0.0, tracer.factor],
        })
    }

    fn follow(
        &mut self,
        tracer: &mut Tracer,
        sense: f64,
        target: f64,
        steps: &mut usize,
        most: usize,
    ) -> Option<Followed> {
        let mut unrecorded = 0;
        let mut events: u64 = 0;
        loop {
            self.before.clear();
            let bound = (target - tracer.factor) * sense;
            let next = if *steps < most { self.next(tracer, bound) } else { None };
            let Some((solution, step, hits)) = next.filter(|next| next.1.is_finite()) else {
                for (c, piece) in self.before.drain(..).rev() {
                    tracer.points[c].piece = piece;
                }
                return match unrecorded == 0 || self.record(tracer) {
                    true => (events > 0).then_some(Followed::Left),
                    false => Some(Followed::Stopped),
                };
            };
            let whole = step >= bound;
            self.advance(tracer, &solution, step, sense, if whole { &[] } else { &hits });
            if whole {
                tracer.factor = target;
            }
            *steps += 1;
            events += 1;
            unrecorded += 1;
            tracer.counts.rate_problems += 1;
            tracer.counts.by_redundants += 1;
            if whole || unrecorded * RECORDED >= tracer.counts.rate_problems {
                unrecorded = 0;
                if !self.record(tracer) {
                    return Some(Followed::Stopped);
                }
            }
            if whole {
                return Some(Followed::Reached);
            }
        }
    }

    /// The rates from the present state, how far they hold, and what ends them. `None` where that is not
    /// decided here.
    fn next(&mut self, tracer: &mut Tracer, bound: f64) -> Option<(Solution, f64, Vec<Hit>)> {
        for round in 0..ROUNDS[0] {
            tracer.counts.trials += 1;
            for e in 0..self.joints.len() {
                if self.joints[e].dirty {
                    for place in &self.sections.all[e].places {
                        let point = &mut tracer.points[place.contact];
                        point.piece = point.settled().unwrap_or(point.piece);
                    }
                    self.fresh.push(e);
                    self.joints[e].refresh(&self.sections.all[e], &tracer.system.facets, &tracer.points)?;
                    self.joints[e].deadline = f64::NEG_INFINITY;
                    self.equations.changed(e);
                }
            }
            let verges: usize = self.joints.iter().map(|j| j.verges).sum();
            if !tracer.associated && verges < UNEXAMINED {
                return None;
            }
            let weak: Vec<usize> = (0..self.joints.len()).filter(|e| self.joints[*e].flexibility.is_none()).collect();
            let solution = self.equations.solve(self.sections, &self.joints, &weak)?;
            self.looked.clear();
            let mut changes: Vec<(f64, usize, Piece)> = Vec::new();
            let mut waiting: Vec<(f64, usize)> = Vec::new();
            let mut best = bound;
            let mut own = solution.weak.iter();
            let mut twists = Vec::with_capacity(self.joints.len());
            for joint in &self.joints {
                twists.push(match joint.twist_rate(&solution.redundants) {
                    Some(twist) => twist,
                    None => own.next()?.1,
                });
            }
            // |h| at the points of a section, at most.
            let size =
                |e: usize, v: &Vector3<f64>| v[0].abs() + v[1].abs() + 1.5 * self.sections.all[e].lever * v[2].abs();
            self.sizes[1] = twists.iter().enumerate().map(|(e, twist)| size(e, twist)).fold(0.0, f64::max);
            for (e, twist) in twists.iter().enumerate() {
                let (joint, section) = (&self.joints[e], &self.sections.all[e]);
                let turned = |slip: &Vector3<f64>| joint.slips.is_some_and(|sense| sense * slip.dot(twist) < 0.0);
                let weak = joint.flexibility.is_none();
                let left = size(e, &(twist - joint.seen)) > joint.allowed || section.slip.as_ref().is_some_and(turned);
                if left || weak || joint.restless || joint.deadline == f64::NEG_INFINITY {
                    best = best.min(self.look(tracer, e, *twist, &mut changes));
                } else {
                    waiting.push((joint.deadline - self.clock.arc(), e));
                }
            }
            if changes.is_empty() {
                waiting.retain(|w| w.0 < best);
                waiting.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
                for (earliest, e) in waiting {
                    if earliest >= best {
                        break;
                    }
                    best = best.min(self.look(tracer, e, twists[e], &mut changes));
                }
            }
            if changes.is_empty() {
                let all = self.looked.iter().flat_map(|(_, hits)| hits);
                let hits = all.filter(|hit| (hit.0 - best) * hit.1 <= MOMENT).copied().collect();
                return Some((solution, best, hits));
            }
            if round >= ROUNDS[1] {
                changes.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
                changes.truncate(1);
            }
            for (_, c, to) in changes {
                self.before.push((c, tracer.points[c].piece));
                tracer.points[c].piece = to;
                self.joints[self.sections.of[c]].dirty = true;
            }
        }
        None
    }

    /// Looks at a section: its points at the present state, whether ξ̇ moves one out of its piece, what is
    /// near and until when nothing else is. Returns the arc to the next event in it.
    fn look(
        &mut self,
        tracer: &mut Tracer,
        e: usize,
        twist: Vector3<f64>,
        changes: &mut Vec<(f64, usize, Piece)>,
    ) -> f64 {
        tracer.counts.sections += 1;
        self.bring(tracer, e, None);
        let section = &self.sections.all[e];
        let joint = &mut self.joints[e];
        let h = |k: usize| (section.places[k].rows * twist).amax();
        let size = (0..section.places.len()).map(h).fold(0.0, f64::max);
        joint.slips = None;
        let mut allowed = NEIGHBOURHOOD * size;
        let rates: Vec<_> = section
            .places
            .iter()
            .enumerate()
            .map(|(k, place)| joint.rates_of(k, place, tracer.points[place.contact].piece, &twist))
            .collect();
        self.sizes[0] = rates.iter().map(|[force, _]| force.amax()).fold(self.sizes[0], f64::max);
        // Rounding of rates is no change of them.
        let rounding = ROUNDING * self.sizes[1];
        let mut hits: Vec<Hit> = Vec::new();
        // Events that may come: distance, rate, and how the rate depends on h.
        let mut ahead: Vec<(f64, f64, f64)> = Vec::new();
        for (k, place) in section.places.iter().enumerate() {
            let c = place.contact;
            let Some(facets) = &tracer.system.facets[c] else { continue };
            let [force, gap] = rates[k].map(|v| [v[0], v[1]]);
            joint.rates[k] = force;
            let point = &tracer.points[c];
            let [by_force, by_gap] = joint.sensitivity(k, place, point.piece);
            if point.settled().is_none() {
                let verge = point.verge(facets);
                let unknowns = verge.unknowns(point.piece, gap);
                if let Some((size, to)) = verge.violation(point.piece, &unknowns, force, self.sizes)
                    && size > INEQUALITY
                {
                    changes.push((size, c, to));
                }
                // Flow keeps its sense as long as γ > 0.
                match point.piece {
                    Piece::Facet(f) => {
                        let flow = facets[f].flow[0].hypot(facets[f].flow[1]);
                        allowed = allowed.min((0.8 * unknowns[0] * flow / by_gap.max(f64::MIN_POSITIVE)).max(0.0));
                    }
                    _ => allowed = 0.0,
                }
            }
            let mut met = |distance: f64, rate: f64, sensitivity: f64, least: f64, what: usize| {
                if rate > least {
                    hits.push((distance.max(0.0) / rate, rate, c, what));
                }
                ahead.push((distance, rate, sensitivity));
            };
            if point.piece == Piece::Free {
                joint.turn(k, gap[1]);
                if dilatancy(facets) > 0.0 && section.slip.is_some() {
                    joint.slips = Some(if gap[1] < 0.0 { -1.0 } else { 1.0 });
                } else if dilatancy(facets) > 0.0 {
                    allowed = allowed.min(0.5 * gap[1].abs());
                }
            }
            if point.open() {
                let rate = tracer.opening_rate(c, gap);
                let opens = joint.opening_sensitivity(k, facets, point.piece);
                met(point.opening, -rate, opens * by_gap, 1e-13 * self.sizes[1], usize::MAX);
                if point.apex {
                    continue;
                }
            }
            let here = tracer.force(c);
            for (f, facet) in facets.iter().enumerate().filter(|(f, _)| !point.active.contains(f)) {
                let falls = dot(facet.normal, force);
                let norm = facet.normal[0].hypot(facet.normal[1]);
                met(facet.slack(here), falls, norm * by_force, 1e-13 * self.sizes[0], f);
            }
        }
        allowed = allowed.max(rounding);
        // Nothing happens while ξ̇ stays within `allowed`, before the earliest that this permits.
        let earliest = |(distance, rate, sensitivity): (f64, f64, f64)| {
            let most = rate + sensitivity * allowed;
            if most > 0.0 { distance.max(0.0) / most } else { f64::INFINITY }
        };
        joint.deadline = self.clock.arc() + ahead.into_iter().map(earliest).fold(f64::INFINITY, f64::min);
        (joint.seen, joint.allowed) = (twist, allowed);
        let next = hits.iter().map(|hit| hit.0).fold(f64::INFINITY, f64::min);
        self.looked.push((e, hits));
        next
    }

    /// Brings the points of a section up to date, with a `step` of a twist rate that is an unknown of its own.
    /// Returns by how much each opens, which is left to the caller; nothing where nothing has moved.
    fn touch(&mut self, tracer: &mut Tracer, e: usize, step: Option<(Vector3<f64>, f64)>) -> Vec<f64> {
        let unit = tracer.system.force_unit * tracer.system.displacement_unit;
        let state = (tracer.system.facets.as_slice(), tracer.points.as_slice());
        let section = &self.sections.all[e];
        let gained = self.joints[e].touch(section, state, &self.clock, step, &tracer.x);
        for (place, change) in section.places.iter().zip(&gained) {
            tracer.dissipated += change.dissipated * unit;
            (0..2).for_each(|i| tracer.x[2 * place.contact + i] += change.force[i]);
        }
        gained.into_iter().map(|change| change.opening).collect()
    }

    /// The same; openings grow.
    fn bring(&mut self, tracer: &mut Tracer, e: usize, step: Option<(Vector3<f64>, f64)>) {
        let openings = self.touch(tracer, e, step);
        for (place, opening) in self.sections.all[e].places.iter().zip(openings) {
            let point = &mut tracer.points[place.contact];
            if point.open() {
                point.opening = (point.opening + opening).max(0.0);
            }
        }
    }

    /// Goes a step and notes the events at its end.
    fn advance(&mut self, tracer: &mut Tracer, solution: &Solution, step: f64, sense: f64, hits: &[Hit]) {
        let last = self.clock.place.len() - 1;
        let rate = DVector::from_fn(last + 1, |i, _| if i < last { solution.redundants[i] } else { 1.0 });
        self.clock.step(&rate, step);
        let before = tracer.factor;
        tracer.factor += sense * step;
        let moved = sense * solution.displacement * step;
        self.since[0] += 0.5 * (before + tracer.factor) * moved;
        self.since[1] += moved;
        let looked = std::mem::take(&mut self.looked);
        let restless = looked.iter().map(|l| l.0).filter(|e| self.joints[*e].restless);
        let mut stepped: Vec<usize> = std::mem::take(&mut self.fresh).into_iter().chain(restless).collect();
        stepped.sort_unstable();
        stepped.dedup();
        for &(e, twist) in solution.weak.iter().filter(|w| stepped.binary_search(&w.0).is_err()) {
            self.bring(tracer, e, Some((twist, step)));
        }
        for e in stepped {
            let weak = solution.weak.iter().find(|w| w.0 == e).map(|w| (w.1, step));
            let openings = self.touch(tracer, e, weak);
            for (k, place) in self.sections.all[e].places.iter().enumerate() {
                let opening = openings.get(k).copied().unwrap_or(0.0);
                tracer.stepped(place.contact, self.joints[e].rates[k], opening, before, self.sizes[0]);
            }
            let joint = &mut self.joints[e];
            joint.count(&self.sections.all[e], &tracer.points);
            joint.deadline = f64::NEG_INFINITY;
        }
        for hit in hits {
            let e = self.sections.of[hit.2];
            self.bring(tracer, e, None);
            self.joints[e].dirty = true;
        }
        let hits: Vec<(usize, usize)> = hits.iter().map(|hit| (hit.2, hit.3)).collect();
        tracer.arrive(&hits);
    }

    /// Writes the present state to the tracer and records it.
    fn record(&mut self, tracer: &mut Tracer) -> bool {
        for e in 0..self.joints.len() {
            self.bring(tracer, e, None);
        }
        let twists: Vec<Vector3<f64>> = self.joints.iter().map(|j| j.twist).collect();
        let start = 2 * tracer.system.contacts;
        for (b, motion) in self.sections.motions(&twists).into_iter().enumerate() {
            (0..3).for_each(|i| tracer.x[start + 3 * b + i] = self.motions[3 * b + i] + motion[i]);
        }
        let [work, moved, factor] = self.since;
        let trapezoid = 0.5 * (factor + tracer.factor) * moved;
        tracer.work += (work - trapezoid) * tracer.system.force_unit * tracer.system.displacement_unit;
        self.since = [0.0, 0.0, tracer.factor];
        tracer.record()
    }
}
