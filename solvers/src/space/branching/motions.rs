//! The motions that the modes of the points allow: a cone of velocities q, described by rows that are zero or not negative.
//!
//! In a state the live load has the power p·q = 1, and λ = D − w·q with the dissipation D ≥ 0. States below a factor therefore
//! have −w·q ≤ λ p·q.

use super::points::{Force, Mode, Points};
use crate::optimise::dense_simplex::{Dictionary, Equations, Feasibility};
use crate::space::settings::BRANCHING;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_8, PI};

/// An equation between the velocities and variables ≥ 0.
struct Row {
    velocities: Vec<f64>,
    /// Variables with their factors.
    variables: Vec<(usize, f64)>,
}

/// All equations.
struct Rows {
    free: usize,
    rows: Vec<Row>,
    variables: usize,
}

impl Rows {
    /// Adds an equation: a row over the velocities plus variables is zero.
    fn add(&mut self, velocities: Vec<f64>, variables: Vec<(usize, f64)>) {
        self.rows.push(Row { velocities, variables });
    }

    fn new_variables(&mut self, count: usize) -> usize {
        self.variables += count;
        self.variables - count
    }

    /// Adds a variable ≥ 0 that equals a row.
    fn variable(&mut self, row: Vec<f64>) -> usize {
        let variable = self.new_variables(1);
        self.add(row, vec![(variable, -1.0)]);
        variable
    }

    /// Adds the positive and the negative part of a row.
    fn parts(&mut self, row: Vec<f64>) -> usize {
        let first = self.new_variables(2);
        self.add(row, vec![(first, -1.0), (first + 1, 1.0)]);
        first
    }

    /// Adds a variable that is at least the slip of a point times cos(π/8).
    fn slip(&mut self, jumps: &[Vec<f64>; 3]) -> usize {
        let slip = self.new_variables(1);
        for k in 0..8u8 {
            let beyond = self.new_variables(1);
            self.add(along(jumps, PI + f64::from(k) * FRAC_PI_4), vec![(slip, 1.0), (beyond, -1.0)]);
        }
        slip
    }

    fn dictionary(self, work: &mut u64) -> Option<Dictionary> {
        let Rows { free, rows, variables } = self;
        let width = free + variables;
        // Most entries are zero and not swept.
        *work += (rows.len() * rows.len() * width / 4) as u64;
        let dense = |row: Row| {
            let mut dense = row.velocities;
            dense.resize(width, 0.0);
            row.variables.into_iter().for_each(|(variable, factor)| dense[free + variable] = factor);
            dense
        };
        let right = vec![0.0; rows.len()];
        Equations { free, variables, rows: rows.into_iter().map(dense).collect(), right }.dictionary()
    }
}

/// Variables of a point.
#[derive(Debug, Clone, Copy)]
enum Own {
    None,
    /// Its opening.
    Opening(usize),
    /// Positive and negative parts of its slip along both tangents; they start here.
    Slip(usize),
    /// Parts of its slip across the first and the last direction of its sector, and along the middle; they start here.
    Sector(usize),
}

/// Returns a combination of rows.
fn combined(parts: &[(f64, &[f64])]) -> Vec<f64> {
    (0..parts[0].1.len()).map(|i| parts.iter().map(|(factor, row)| factor * row[i]).sum()).collect()
}

/// Returns the jump along a direction between the tangents of a point.
fn along(jumps: &[Vec<f64>; 3], angle: f64) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    combined(&[(cos, &jumps[1]), (sin, &jumps[2])])
}

/// Returns the rows of all points below a factor, and the variables of each point. The first variable is the power of the live load.
fn rows(points: &Points, modes: &[Mode], below: f64) -> (Rows, Vec<Own>) {
    let mut rows = Rows { free: points.base.len(), rows: Vec::new(), variables: 0 };
    rows.variable(points.varying.clone());
    rows.variable(combined(&[(below, &points.varying), (1.0, &points.base)]));
    let own = points.points.iter().zip(modes).map(|(point, mode)| {
        let jumps = &point.jumps;
        if matches!(mode, Mode::Undecided | Mode::Open) {
            return Own::Opening(rows.variable(jumps[0].clone()));
        }
        rows.add(jumps[0].clone(), Vec::new());
        match mode {
            Mode::Sticks => {
                jumps[1..].iter().for_each(|row| rows.add(row.clone(), Vec::new()));
                Own::None
            }
            Mode::Slips([from, to]) => {
                let first = rows.variable(along(jumps, from + FRAC_PI_2));
                rows.variable(along(jumps, to - FRAC_PI_2));
                rows.variable(along(jumps, f64::midpoint(*from, *to)));
                Own::Sector(first)
            }
            _ if point.friction > 0.0 => {
                let first = rows.parts(jumps[1].clone());
                rows.parts(jumps[2].clone());
                Own::Slip(first)
            }
            _ => Own::None,
        }
    });
    let own = own.collect();
    (rows, own)
}

/// The cone of motions of some modes.
struct Cone {
    dictionary: Dictionary,
}

impl Cone {
    /// Returns false if a variable is zero in all motions.
    fn can(&mut self, variable: usize) -> bool {
        self.dictionary.relax(&[(variable, -1.0)]);
        let possible = !matches!(self.dictionary.feasible(), Feasibility::Reason(_));
        self.dictionary.relax(&[(variable, 1.0)]);
        possible
    }

    /// Returns the least ratios of variables to another one. `None` if that is zero in all motions.
    fn ratios(&mut self, variables: [usize; 2], to: usize) -> Option<[f64; 2]> {
        self.dictionary.relax(&[(to, -1.0)]);
        let feasible = self.dictionary.feasible();
        let ratios = (feasible == Feasibility::Point).then(|| {
            variables.map(|variable| match self.dictionary.minimise(&[(variable, 1.0)], BRANCHING.pivots) {
                Some((least, true)) => (least - BRANCHING.outward).max(0.0),
                _ => 0.0,
            })
        });
        self.dictionary.relax(&[(to, 1.0)]);
        match feasible {
            Feasibility::Reason(_) => None,
            _ => Some(ratios.unwrap_or_default()),
        }
    }

    /// Returns the modes of a point that the motions allow.
    fn restricted(&mut self, mode: Mode, own: Own) -> Mode {
        match (mode, own) {
            (Mode::Undecided, Own::Opening(opening)) if !self.can(opening) => Mode::Closed,
            (Mode::Closed, Own::Slip(first)) => self.sector(first),
            (Mode::Slips([from, to]), Own::Sector(first)) => {
                let Some([low, high]) = self.ratios([first, first + 1], first + 2) else { return Mode::Sticks };
                // The part across an end, sin θ, has this ratio to the part along the middle, cos (θ − h).
                let half = (to - from) / 2.0;
                let angle = |ratio: f64| (ratio * half.cos()).atan2(1.0 - ratio * half.sin());
                let (low, high) = (from + angle(low), to - angle(high));
                if low <= high { Mode::Slips([low, high]) } else { mode }
            }
            _ => mode,
        }
    }

    /// Returns the mode of a closed point whose slip has these parts.
    fn sector(&mut self, first: usize) -> Mode {
        let slips = [0, 2, 1, 3].map(|part| {
            // In the order of the angles: along s, along t, against s, against t.
            let (own, other) = (first + part, first + (part ^ 1));
            self.dictionary.fix(other, true);
            let possible = self.can(own);
            self.dictionary.fix(other, false);
            possible
        });
        let turn = |k: usize| k as f64 * FRAC_PI_2;
        match (slips.iter().filter(|slips| **slips).count(), (0..4).find(|k| slips[*k] && !slips[(k + 3) % 4])) {
            (0, _) => Mode::Sticks,
            (1, Some(k)) => Mode::Slips([turn(k); 2]),
            (2, Some(k)) if slips[(k + 1) % 4] => Mode::Slips([turn(k), turn(k + 1)]),
            _ => Mode::Closed,
        }
    }
}

/// Restricts the modes to those that some motion below a factor allows. Returns false if no motion does.
pub fn restrict(points: &Points, modes: &mut [Mode], below: f64, work: &mut u64) -> bool {
    let (rows, own) = rows(points, modes, below);
    let Some(dictionary) = rows.dictionary(work) else { return true };
    let mut cone = Cone { dictionary };
    let possible = cone.can(0);
    if possible {
        modes.iter_mut().zip(own).for_each(|(mode, own)| *mode = cone.restricted(*mode, own));
    }
    *work += cone.dictionary.work();
    possible
}

/// Returns the jumps (n, s, t) of the loaded points in the motion below a factor that comes nearest to the flow of some forces: it has
/// the least power left. `None` if no motion exists. Without a result there are no jumps.
pub fn nearest(points: &Points, modes: &[Mode], forces: &[Force], below: f64, work: &mut u64) -> Option<Vec<[f64; 3]>> {
    let (mut rows, _) = rows(points, modes, below);
    let mut left = vec![0.0; points.base.len()];
    let mut slips = Vec::new();
    let mut loaded = Vec::new();
    for (index, ((point, mode), force)) in points.points.iter().zip(modes).zip(forces).enumerate() {
        if force[0] <= 0.0 || *mode == Mode::Sticks {
            continue;
        }
        let [n, s, t] = point.within_friction(*force);
        let [normal, first, second] = &point.jumps;
        let friction = point.friction * n;
        let mut power = combined(&[(n, normal), (s, first), (t, second)]);
        // Both values of the slip are at least the true one, so the power left is not negative.
        if let Mode::Slips([from, to]) = mode {
            let middle = along(&point.jumps, f64::midpoint(*from, *to));
            power = combined(&[(1.0, &power), (friction / ((to - from) / 2.0).cos(), &middle)]);
        } else {
            slips.push((rows.slip(&point.jumps), friction / FRAC_PI_8.cos()));
        }
        left = combined(&[(1.0, &left), (1.0, &power)]);
        loaded.push((index, point.jumps.clone().map(|row| rows.parts(row))));
    }
    let power = rows.new_variables(1);
    rows.add(left, std::iter::once((power, -1.0)).chain(slips).collect());
    let mut jumps = vec![[0.0; 3]; modes.len()];
    let Some(mut dictionary) = rows.dictionary(work) else { return Some(jumps) };
    dictionary.relax(&[(0, -1.0)]);
    let feasible = dictionary.feasible();
    if feasible == Feasibility::Point {
        dictionary.minimise(&[(power, 1.0)], BRANCHING.pivots);
        for (index, parts) in loaded {
            jumps[index] = parts.map(|first| dictionary.value(first) - dictionary.value(first + 1));
        }
    }
    *work += dictionary.work();
    (!matches!(feasible, Feasibility::Reason(_))).then_some(jumps)
}
