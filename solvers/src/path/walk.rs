//! Walking along a piecewise linear path from cell to cell of the points' laws (see `cells`).
//!
//! A parameter t runs from 0 to 1. In each combination of cells everything moves linearly with t; where a
//! point reaches a wall it goes over into the cell behind, and t goes on in the sense that leads into
//! it: it may turn back.

use super::cells::Wall;
use std::borrow::Borrow;

/// Values of t behind which a path that turned back is given up.
const LOST: f64 = -30.0;

/// A point in its cell and how it moves with t.
pub(in crate::path) struct Standing<'a> {
    pub walls: &'a [Wall],
    pub force: [f64; 2],
    pub gap: [f64; 2],
    pub area: f64,
    pub force_rate: [f64; 2],
    pub gap_rate: [f64; 2],
}

/// What a path meets next.
pub(in crate::path) enum Met {
    /// t = 1.
    End,
    /// Nothing: it goes on for ever in the present sense of t.
    Ray,
    /// A wall of a point's cell (point, wall).
    Wall(usize, usize),
}

/// Where a path has come to.
pub(in crate::path) struct Walk {
    t: f64,
    /// 1 or −1: the sense of t.
    pub sense: f64,
    /// The point that has gone over into another cell, and by which of its walls.
    entered: Option<(usize, usize)>,
}

impl Walk {
    /// At t = 0.
    pub fn new() -> Self {
        Walk { t: 0.0, sense: 1.0, entered: None }
    }

    /// Goes on to what comes next: what it is, and by how much t changes until then. Points without a
    /// cell are `None`.
    pub fn on<'a, P: Borrow<Standing<'a>>>(&mut self, points: usize, at: impl Fn(usize) -> Option<P>) -> (f64, Met) {
        if let Some((c, wall)) = self.entered.take()
            && let Some(point) = at(c)
        {
            let point = point.borrow();
            self.sense = if point.walls[wall].speed(point.force_rate, point.gap_rate) < 0.0 { -1.0 } else { 1.0 };
        }
        // When, how fast (of walls that are met together the fastest first), which.
        let mut next: Option<(f64, f64, usize, usize)> = None;
        for c in 0..points {
            let Some(point) = at(c) else { continue };
            let point = point.borrow();
            for (index, wall) in point.walls.iter().enumerate() {
                let speed = self.sense * wall.speed(point.force_rate, point.gap_rate);
                if speed >= 0.0 {
                    continue;
                }
                let slack = wall.slack(point.force, point.gap, point.area).max(0.0);
                // Most walls are further away than the nearest so far: without a division.
                if next.is_some_and(|n| slack > n.0 * -speed) {
                    continue;
                }
                let when = slack / -speed;
                if next.is_none_or(|n| when < n.0 || (when == n.0 && -speed > n.1)) {
                    next = Some((when, -speed, c, index));
                }
            }
        }
        let rest = if self.sense > 0.0 { 1.0 - self.t } else { f64::INFINITY };
        let (step, met) = match next {
            Some((when, _, c, index)) if when < rest => (when, Met::Wall(c, index)),
            _ if rest.is_finite() => (rest, Met::End),
            _ => return (0.0, Met::Ray),
        };
        self.t += self.sense * step;
        (self.sense * step, met)
    }

    /// A point has gone over into another cell by this wall of that cell.
    pub fn enters(&mut self, point: usize, wall: usize) {
        self.entered = Some((point, wall));
    }

    /// Whether it turned back too far.
    pub fn is_lost(&self) -> bool {
        self.t < LOST
    }
}
