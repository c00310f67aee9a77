//! A piecewise linear path through the cells of the contact points' normal fans.
//!
//! A parameter t runs from 0 to 1. In each combination of cells everything moves linearly with t; where a
//! point reaches a boundary it goes over into the neighbouring cell, and t goes on in the sense that leads into
//! it: it may turn back. Sources: Eaves & Scarf (1976, Math. Operations Research 1); Ralph (1994, ibid. 19).

use super::normal_fan::Boundary;

/// Values of t beyond which a path that turned back is given up.
const LOST: f64 = -30.0;

/// A point in its cell and how it moves with t.
pub struct PointInCell<'a> {
    /// Boundaries of its cell.
    pub boundaries: &'a [Boundary],
    /// r.
    pub force: [f64; 2],
    /// Δg.
    pub gap: [f64; 2],
    /// A.
    pub area: f64,
    /// dr/dt.
    pub force_rate: [f64; 2],
    /// dΔg/dt.
    pub gap_rate: [f64; 2],
}

/// What a path meets next.
enum NextBoundary {
    /// t = 1.
    End,
    /// Nothing: a ray in the present sense of t.
    Ray,
    /// A boundary of a point's cell (point, boundary).
    Boundary(usize, usize),
}

/// A piecewise linear system that can be followed: linear in each combination of cells.
pub trait PiecewiseLinear {
    /// Number of contact points.
    fn points(&self) -> usize;
    /// A point in its cell and its rates; `None` where it has no cell.
    fn point(&self, point: usize) -> Option<PointInCell<'_>>;
    /// Solves for the rates in the present combination of cells. An error says why there are none.
    fn solve_rates(&mut self) -> Result<(), String>;
    /// Moves by so much of t.
    fn advance(&mut self, by: f64);
    /// Takes a point across a boundary of its cell: by which boundary it enters the neighbour, and whether its
    /// equations are others there.
    fn cross(&mut self, point: usize, boundary: usize) -> (usize, bool);
}

/// How a path ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathEnd {
    /// At t = 1.
    Arrived,
    /// Along a ray, in this sense of t.
    Ray(f64),
}

/// Follows a path from t = 0 through at most so many combinations of equations. An error says why it has no end.
pub fn follow(system: &mut impl PiecewiseLinear, most: usize) -> Result<PathEnd, String> {
    let mut path = PiecewiseLinearPath::new();
    for _ in 0..most {
        system.solve_rates()?;
        // Across boundaries without a change of equations the rates stay.
        loop {
            let (by, next) = path.advance(system.points(), |c| system.point(c));
            if matches!(next, NextBoundary::Ray) {
                return Ok(PathEnd::Ray(path.sense));
            }
            system.advance(by);
            let NextBoundary::Boundary(point, boundary) = next else { return Ok(PathEnd::Arrived) };
            if path.is_lost() {
                return Err("the path of pivoting turned back".into());
            }
            let (entered, changed) = system.cross(point, boundary);
            path.enter(point, entered);
            if changed {
                break;
            }
        }
    }
    Err(format!("{most} pivots were not enough"))
}

/// Where a path has come to.
struct PiecewiseLinearPath {
    t: f64,
    /// 1 or −1: the sense of t.
    sense: f64,
    /// The point that has gone over into another cell, and by which of its boundaries.
    entered: Option<(usize, usize)>,
}

impl PiecewiseLinearPath {
    /// At t = 0.
    fn new() -> Self {
        PiecewiseLinearPath { t: 0.0, sense: 1.0, entered: None }
    }

    /// Goes on to what comes next: what it is, and by how much t changes until then. Points without a
    /// cell are `None`.
    fn advance<'a>(&mut self, points: usize, at: impl Fn(usize) -> Option<PointInCell<'a>>) -> (f64, NextBoundary) {
        if let Some((c, boundary)) = self.entered.take()
            && let Some(point) = at(c)
        {
            self.sense =
                if point.boundaries[boundary].slack_rate(point.force_rate, point.gap_rate) < 0.0 { -1.0 } else { 1.0 };
        }
        // When, how fast (of boundaries that are met together the fastest first), which.
        let mut next: Option<(f64, f64, usize, usize)> = None;
        for c in 0..points {
            let Some(point) = at(c) else { continue };
            for (index, boundary) in point.boundaries.iter().enumerate() {
                let speed = self.sense * boundary.slack_rate(point.force_rate, point.gap_rate);
                if speed >= 0.0 {
                    continue;
                }
                let slack = boundary.slack(point.force, point.gap, point.area).max(0.0);
                // Most boundaries are further away than the nearest so far: without a division.
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
            Some((when, _, c, index)) if when < rest => (when, NextBoundary::Boundary(c, index)),
            _ if rest.is_finite() => (rest, NextBoundary::End),
            _ => return (0.0, NextBoundary::Ray),
        };
        self.t += self.sense * step;
        (self.sense * step, met)
    }

    /// A point has gone over into another cell by this boundary of that cell.
    fn enter(&mut self, point: usize, boundary: usize) {
        self.entered = Some((point, boundary));
    }

    /// Whether it turned back too far.
    fn is_lost(&self) -> bool {
        self.t < LOST
    }
}
