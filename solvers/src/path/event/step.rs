//! A step along a direction: how far it is to the next events, and what they change.

use super::direction::{Direction, MECHANISM};
use super::point::{Point, opening};
use super::rate::Piece;
use super::system::dot;
use super::trace::Tracer;
use voussoir_core::law::FacetMode;
use voussoir_core::path::{ContactEvent, PathEvent};

/// Slacks and gaps below this (in scaled units) are events of the same moment.
const SAME: f64 = 1e-12;

impl Tracer<'_> {
    /// How far it is to the next events along a direction, and which facets (or `usize::MAX` for a
    /// closing) of which points they are.
    pub fn next_event(&self, direction: &Direction) -> (f64, Vec<(usize, usize)>) {
        // A rate that is rounding brings no event.
        let size = direction.x[..2 * self.system.contacts].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let gap_size = direction.gaps.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        let (of_forces, share) = if direction.factor == 0.0 { (size.max(gap_size), MECHANISM) } else { (size, 1e-13) };
        let (least_force, least_gap) = (share * of_forces, share * gap_size);
        let mut step = f64::INFINITY;
        let mut hits: Vec<(f64, f64, usize, usize)> = Vec::new();
        let mut meet = |when: f64, speed: f64, c: usize, what: usize| {
            if (when - step) * speed <= SAME {
                hits.push((when, speed, c, what));
            }
            step = step.min(when);
        };
        for (c, point) in self.points.iter().enumerate() {
            let Some(facets) = &self.system.facets[c] else { continue };
            if point.open() {
                let rate = self.opening_rate(c, direction.gaps[c]);
                if -rate > least_gap {
                    meet(point.opening / -rate, -rate, c, usize::MAX);
                }
                if point.apex {
                    continue;
                }
            }
            let force = self.force(c);
            let rate = [direction.x[2 * c], direction.x[2 * c + 1]];
            for (f, facet) in facets.iter().enumerate() {
                let falls = dot(facet.normal, rate);
                if falls > least_force && !point.active.contains(&f) {
                    meet(facet.slack(force).max(0.0) / falls, falls, c, f);
                }
            }
        }
        let same = |e: &&(f64, f64, usize, usize)| (e.0 - step) * e.1 <= SAME;
        (step, hits.iter().filter(same).map(|e| (e.2, e.3)).collect())
    }

    /// Rate of the opening above the dilated surface.
    pub(super) fn opening_rate(&self, c: usize, gap: [f64; 2]) -> f64 {
        let Some(facets) = &self.system.facets[c] else { return 0.0 };
        dot(opening(self.points[c].piece, facets, if gap[1] < 0.0 { -1.0 } else { 1.0 }), gap)
    }

    /// Rate of the gap without its `opening` rate, which is reversible: a tensile strength that opens stores
    /// the work of its force and gives it back.
    fn irreversible(&self, c: usize, gap: [f64; 2], opening: f64) -> [f64; 2] {
        match (&self.system.facets[c], self.points[c].opening_facet) {
            (Some(facets), Some(open)) if self.points[c].piece != Piece::Free => {
                [0, 1].map(|i| gap[i] + opening * facets[open].flow[i])
            }
            _ => gap,
        }
    }

    /// Energy that the tensile strength of open points has stored \[J\].
    pub fn stored_by_opening(&self) -> f64 {
        let held = |(c, point): (usize, &Point)| match (&self.system.facets[c], point.opening_facet) {
            (Some(facets), Some(open)) if point.open() && !point.apex => {
                dot(facets[open].flow, self.force(c)) * point.opening
            }
            _ => 0.0,
        };
        let sum: f64 = self.points.iter().enumerate().map(held).sum();
        sum * self.system.force_unit * self.system.displacement_unit
    }

    /// Goes a step along a direction and notes the events at its end.
    pub fn advance(&mut self, direction: &Direction, step: f64, sense: f64, hits: &[(usize, usize)]) {
        let unit = self.system.force_unit * self.system.displacement_unit;
        let openings: Vec<f64> = (0..self.points.len()).map(|c| self.opening_rate(c, direction.gaps[c])).collect();
        for (c, point) in self.points.iter().enumerate() {
            if matches!(point.piece, Piece::Stick | Piece::Free) {
                continue;
            }
            let mean = [0, 1].map(|i| self.x[2 * c + i] + 0.5 * step * direction.x[2 * c + i]);
            let flow = self.irreversible(c, direction.gaps[c], openings[c]);
            self.dissipated -= dot(mean, flow) * step * unit;
        }
        let before = self.factor;
        for (x, rate) in self.x.iter_mut().zip(&direction.x) {
            *x += step * rate;
        }
        self.factor += sense * step * direction.factor;
        let size = direction.x[..2 * self.system.contacts].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (c, opening_rate) in openings.into_iter().enumerate() {
            let rate = [direction.x[2 * c], direction.x[2 * c + 1]];
            self.stepped(c, rate, step * opening_rate, before, size);
        }
        self.arrive(hits);
    }

    /// What a step changes of a contact point: its opening, which facets it leaves, and what it then notes as
    /// having happened at the factor `before` it. `size`: greatest rate of force.
    pub(super) fn stepped(&mut self, c: usize, rate: [f64; 2], opening: f64, before: f64, size: f64) {
        let Some(facets) = &self.system.facets[c] else { return };
        let was_open = self.points[c].open();
        let was_hit = std::mem::take(&mut self.points[c].hit);
        let point = &mut self.points[c];
        if !was_open && point.piece == Piece::Stick && point.active.is_empty() {
            return;
        }
        point.opening = if was_open || matches!(point.piece, Piece::Free | Piece::Facet(_) | Piece::Corner(..)) {
            (point.opening + opening).max(0.0)
        } else {
            0.0
        };
        let mut happened = Vec::new();
        if !was_open && point.open() {
            happened.push(ContactEvent::Opens);
        }
        // What began to flow in this step began at its start.
        if let Piece::Facet(f) = point.piece
            && was_hit
        {
            happened.extend(match facets[f].mode {
                FacetMode::Sliding if facets[f].flow[1] > 0.0 => Some(ContactEvent::SlipsBackward),
                FacetMode::Sliding => Some(ContactEvent::SlipsForward),
                FacetMode::Crushing => Some(ContactEvent::Crushes),
                FacetMode::Opening => None,
            });
        }
        // Facets that this direction leaves are active no more.
        if !(point.open() && point.apex) {
            let force = [self.x[2 * c], self.x[2 * c + 1]];
            let had = point.active.len();
            point.active.retain(|f| {
                let facet = &facets[*f];
                dot(facet.normal, rate) > -1e-11 * size || facet.slack(force) <= SAME
            });
            if had > 0 && point.active.is_empty() && !was_hit && point.noted {
                happened.push(ContactEvent::Sticks);
            }
        }
        point.noted |= !happened.is_empty();
        let (load_step, factor, contact) = (self.load_step, before, c);
        self.events.extend(happened.into_iter().map(|what| PathEvent { load_step, factor, contact, what }));
    }

    /// Contact points that arrive at a facet, or (`usize::MAX`) close.
    pub(super) fn arrive(&mut self, hits: &[(usize, usize)]) {
        for &(c, f) in hits {
            let Some(facets) = &self.system.facets[c] else { continue };
            let point = &mut self.points[c];
            point.hit = true;
            if f == usize::MAX {
                point.opening = 0.0;
                if point.apex {
                    point.active = (0..facets.len()).filter(|f| facets[*f].bound <= 0.0).collect();
                }
                point.piece = Piece::Stick;
                point.noted = true;
                self.events.push(PathEvent {
                    load_step: self.load_step,
                    factor: self.factor,
                    contact: c,
                    what: ContactEvent::Closes,
                });
            } else {
                if !point.active.contains(&f) {
                    point.active.push(f);
                }
                let force = [self.x[2 * c], self.x[2 * c + 1]];
                // At the apex all facets meet.
                if point.apex && (facets[f].mode == FacetMode::Opening || force[0].abs() <= SAME) {
                    point.active = (0..facets.len()).filter(|f| facets[*f].bound <= 0.0).collect();
                    point.piece = Piece::Free;
                } else {
                    let other = point.active.iter().copied().find(|g| *g != f);
                    point.piece = match (point.open(), other) {
                        (true, _) => point.opening_facet.map_or(Piece::Facet(f), |open| Piece::Corner(open, f)),
                        (false, _) => Piece::Facet(f),
                    };
                }
            }
        }
    }
}
