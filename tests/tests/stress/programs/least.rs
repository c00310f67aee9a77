//! The least load at which rigid blocks can collapse, by enumeration of the modes of all joints.
//!
//! If all modes are given, the field and the motion are two separate linear programs: the least λ in equilibrium, and a
//! motion with p·q̇ = 1. If only some modes are given, the other joints keep their cones, and two lower bounds of λ
//! remain: the least λ in equilibrium, and the least −w·q̇, because friction dissipates. Branches above the best load
//! are cut.

use super::rigid::{Rigid, sum};
use crate::conic::{Extreme, Rows};

/// Mode of one end of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// There is no force; the end may open.
    Open,
    /// There is no motion.
    Closed,
    /// The end slips with this sign of ġ_t.
    Slides(bool),
}

/// Modes of both ends of a joint; ġ_t is the same at both ends.
const MODES: [[End; 2]; 10] = {
    use End::{Closed, Open, Slides};
    [
        [Closed, Closed],
        [Closed, Open],
        [Open, Closed],
        [Slides(true), Slides(true)],
        [Slides(false), Slides(false)],
        [Slides(true), Open],
        [Slides(false), Open],
        [Open, Slides(true)],
        [Open, Slides(false)],
        [Open, Open],
    ]
};

/// Relative difference of loads below which a branch is not followed.
const SAME_LOAD: f64 = 1e-8;

/// The outcome of an enumeration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Least {
    /// The least load, with the number of programs.
    Load(f64, usize),
    /// No collapse with a load λ ≥ 0.
    Never,
    /// Too many programs, or a program that was not decided.
    Undecided,
}

/// A search for the least load.
struct Search<'a> {
    rigid: &'a Rigid,
    best: f64,
    programs: usize,
    most: usize,
    undecided: bool,
}

/// Returns the least load, using at most `most` programs.
pub fn least_load(rigid: &Rigid, most: usize) -> Least {
    let mut search = Search { rigid, best: f64::INFINITY, programs: 0, most, undecided: false };
    search.branch(&mut Vec::new());
    match search {
        Search { undecided: true, .. } => Least::Undecided,
        Search { best, programs, .. } if best.is_finite() => Least::Load(best, programs),
        _ => Least::Never,
    }
}

impl Search<'_> {
    /// Follows all modes of the next joint, the lowest bound first.
    fn branch(&mut self, modes: &mut Vec<[End; 2]>) {
        let mut children = Vec::new();
        for mode in MODES {
            let slips = mode.iter().any(|end| matches!(end, End::Slides(_)));
            if self.undecided || (slips && self.rigid.friction.is_none()) {
                continue;
            }
            modes.push(mode);
            if let Some(bound) = self.bound(modes) {
                children.push((bound, mode));
            }
            modes.pop();
        }
        children.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (bound, mode) in children {
            if bound >= self.best - SAME_LOAD * self.best.abs().max(1e-3) || self.undecided {
                return;
            }
            modes.push(mode);
            if 2 * modes.len() == self.rigid.touches.len() {
                self.best = self.best.min(bound);
            } else {
                self.branch(modes);
            }
            modes.pop();
        }
    }

    /// Returns a lower bound of λ with these modes of the first joints: the load itself if all joints have one. `None`
    /// without a field or a motion.
    fn bound(&mut self, modes: &[[End; 2]]) -> Option<f64> {
        let ends: Vec<End> = modes.iter().flatten().copied().collect();
        let power = self.least(self.motions(&ends))?;
        let field = self.least(self.field(&ends))?;
        Some(if ends.len() == self.rigid.touches.len() { field } else { field.max(power) })
    }

    /// Returns the least value of the last unknown; −∞ without a bound, `None` if nothing is feasible.
    fn least(&mut self, (rows, variable): (Rows, usize)) -> Option<f64> {
        self.programs += 1;
        self.undecided |= self.programs > self.most;
        match rows.extreme(variable, -1.0) {
            Extreme::Value(value) => Some(value),
            Extreme::Unbounded => Some(f64::NEG_INFINITY),
            Extreme::Infeasible => None,
            Extreme::Unknown => {
                self.undecided = true;
                None
            }
        }
    }

    /// Returns the program of fields with λ ≥ 0.
    fn field(&self, ends: &[End]) -> (Rows, usize) {
        let factor = 2 * self.rigid.touches.len();
        let mut rows = self.rigid.equilibrium();
        let equal = |rows: &mut Rows, entries: &[(usize, f64)]| {
            for sign in [1.0, -1.0] {
                rows.row(&entries.iter().map(|&(k, v)| (k, sign * v)).collect::<Vec<_>>(), 0.0);
            }
        };
        for index in 0..self.rigid.touches.len() {
            let (n, t) = (2 * index, 2 * index + 1);
            match ends.get(index) {
                Some(End::Open) => [n, t].iter().for_each(|k| equal(&mut rows, &[(*k, 1.0)])),
                Some(End::Slides(forward)) => {
                    let sign = if *forward { 1.0 } else { -1.0 };
                    rows.row(&[(n, -1.0)], 0.0);
                    equal(&mut rows, &[(t, 1.0), (n, sign * self.rigid.friction.unwrap_or(0.0))]);
                }
                _ => self.rigid.cone(&mut rows, index),
            }
        }
        rows.row(&[(factor, -1.0)], 0.0);
        (rows, factor)
    }

    /// Returns the program of motions with p·q̇ = 1.
    fn motions(&self, ends: &[End]) -> (Rows, usize) {
        let mut rows = self.rigid.motions();
        let power = rows.variables() - 1;
        for index in 0..self.rigid.touches.len() {
            let [n, t] = [0, 1].map(|axis| self.rigid.rate(index, axis));
            let scaled = |entries: &[(usize, f64)], by: f64| -> Vec<(usize, f64)> {
                entries.iter().map(|&(k, v)| (k, by * v)).collect()
            };
            match ends.get(index) {
                Some(End::Closed) => {
                    for axis in [&n, &t] {
                        [1.0, -1.0].iter().for_each(|sign| rows.row(&sum(scaled(axis, *sign).into_iter()), 0.0));
                    }
                }
                Some(End::Slides(forward)) => {
                    let sign = if *forward { 1.0 } else { -1.0 };
                    let opening = scaled(&t, -sign * self.rigid.dilatancy);
                    let flow = sum(n.iter().copied().chain(opening));
                    [1.0, -1.0].iter().for_each(|sign| rows.row(&scaled(&flow, *sign), 0.0));
                    rows.row(&sum(scaled(&t, -sign).into_iter()), 0.0);
                }
                _ => self.rigid.flow(&mut rows, index),
            }
        }
        (rows, power)
    }
}
