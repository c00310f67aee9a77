//! The search over several parameters: a scan, then cutting planes (Kelley 1960) in trust regions around its best points.
//!
//! Each point gives a linear bound of a concave result from its derivatives. The next point is the highest one that the bounds
//! near the best point permit inside the trust region. Bounds from both sides of a kink meet at it. The region shrinks if the result
//! is lower than the bounds predict. Points are rounded to shares of the step, so that results of other processors do not move
//! them. A point is known by its shares of the ranges.

use super::request::{Axis, Request};
use super::shape::{Level, point};
use super::trials::{Answer, Trials};
use rayon::prelude::*;
use voussoir_solvers::optimise::cutting_planes::{Cut, highest_step};
use voussoir_study::results::CaseResult;

/// Greatest number of starts.
const STARTS: usize = 3;
/// Least distance of two starts.
const APART: f64 = 0.2;
/// First radius of the trust region.
const RADIUS: f64 = 0.2;
/// Least radius: the search ends there.
const LEAST_RADIUS: f64 = 1e-7;
/// Greatest number of points of one start.
const MAX_POINTS: usize = 120;
/// Step of differences, if there are no derivatives.
const STEP: f64 = 1e-4;
/// Parts of a step to which points are rounded.
const GRID: f64 = 64.0;
/// Bases of the scan, one for each parameter (Halton 1960).
const BASES: [usize; 8] = [2, 3, 5, 7, 11, 13, 17, 19];

/// Returns the left and right derivatives of a result with respect to each parameter, if limit analysis gives them.
pub(super) type Derivatives<'a> = dyn Fn(&[f64], &CaseResult) -> Option<Vec<[f64; 2]>> + 'a;

/// A search over several parameters.
pub(super) struct Several<'a> {
    pub request: &'a Request,
    pub axes: &'a [Axis],
    pub solve: &'a (dyn Fn(usize, &[f64]) -> Answer + Sync),
    pub derivatives: &'a Derivatives<'a>,
    /// The volume that points keep.
    pub level: Option<Level<'a>>,
}

/// A point with its merit and the bounds from it.
struct Known {
    shares: Vec<f64>,
    merit: f64,
    slopes: Vec<Vec<f64>>,
}

/// Returns the greatest difference of two points.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Returns the number with the digits of `index` behind the point in reversed order (Halton 1960).
fn halton(mut index: usize, base: usize) -> f64 {
    let (mut share, mut digit) = (0.0, 1.0);
    while index > 0 {
        digit /= base as f64;
        share += digit * (index % base) as f64;
        index /= base;
    }
    share
}

/// Returns the points of the scan.
fn scanned(request: &Request, axes: &[Axis]) -> impl Iterator<Item = Vec<f64>> {
    let count = axes.len();
    (1..=request.scan).map(move |i| BASES[..count].iter().map(|base| halton(i, *base)).collect())
}

/// Returns true if a point of the scan has a neighbour with the volume.
pub(super) fn reaches(request: &Request, level: &Level) -> bool {
    scanned(request, level.axes).any(|shares| level.projected(&shares).is_some())
}

impl Several<'_> {
    /// Returns the results at all points that were tried, in order of id.
    pub fn best_point(&self) -> Vec<CaseResult> {
        let even = scanned(self.request, self.axes);
        let scan: Vec<Vec<f64>> = even.filter_map(|shares| self.on_level(shares)).collect();
        let answers: Vec<Answer> =
            scan.par_iter().enumerate().map(|(i, shares)| (self.solve)(i, &point(self.axes, shares))).collect();
        let mut trials = Trials::new(self.solve, self.request.stride());
        let mut found: Vec<(f64, Vec<f64>, usize)> = Vec::new();
        for (shares, answer) in scan.into_iter().zip(answers) {
            if let Some(Some(merit)) = trials.add(answer) {
                found.push((merit, shares, trials.results.len() - 1));
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut starts: Vec<(f64, Vec<f64>, usize)> = Vec::new();
        for own in found {
            if starts.len() < STARTS && starts.iter().all(|other| distance(&other.1, &own.1) > APART) {
                starts.push(own);
            }
        }
        for (merit, shares, place) in starts {
            let result = trials.results[place].clone();
            let start = self.known(&mut trials, shares, merit, &result);
            self.climb(&mut trials, start);
        }
        trials.results
    }

    fn on_level(&self, shares: Vec<f64>) -> Option<Vec<f64>> {
        match &self.level {
            Some(level) => level.projected(&shares),
            None => Some(shares),
        }
    }

    /// Returns a point with the derivatives of its merit.
    fn known(&self, trials: &mut Trials, shares: Vec<f64>, merit: f64, result: &CaseResult) -> Known {
        let at = point(self.axes, &shares);
        let scale = |j: usize| self.request.sense() * self.axes[j].length();
        let slopes = match (self.derivatives)(&at, result) {
            Some(sides) => {
                let side = |side: usize| sides.iter().enumerate().map(|(j, own)| own[side] * scale(j)).collect();
                let (left, right): (Vec<f64>, Vec<f64>) = (side(0), side(1));
                if left == right { vec![left] } else { vec![left, right] }
            }
            None => vec![(0..shares.len()).map(|j| self.difference(trials, &shares, merit, j)).collect()],
        };
        Known { shares, merit, slopes }
    }

    /// Returns the derivative by a difference; 0 if there is no result at any side.
    fn difference(&self, trials: &mut Trials, shares: &[f64], merit: f64, j: usize) -> f64 {
        let side = |step: f64| {
            let mut moved = shares.to_vec();
            moved[j] += step;
            let inside = (0.0..=1.0).contains(&moved[j]);
            let found = inside.then(|| trials.at(&point(self.axes, &moved))).flatten().flatten();
            found.map(|other| (other - merit) / step)
        };
        [STEP, -STEP].into_iter().find_map(side).unwrap_or(0.0)
    }

    /// Improves a point until the bounds from points near it permit no gain above the accuracy, or the trust region is too small.
    fn climb(&self, trials: &mut Trials, start: Known) {
        let (mut known, mut best, mut radius, mut failed) = (vec![start], 0, RADIUS, 0);
        for _ in 0..MAX_POINTS {
            let Some((shares, gain)) = self.next(&known, best, radius) else { return };
            if radius < LEAST_RADIUS || trials.spent() {
                return;
            }
            if gain <= self.request.accuracy * known[best].merit.abs() {
                if radius <= self.request.tolerance {
                    return;
                }
                // Bounds from distant points may be wrong: the result is concave only near a point.
                radius /= 8.0;
                continue;
            }
            let is_new = |shares: &Vec<f64>| known.iter().all(|own| distance(shares, &own.shares) > 0.0);
            let Some(shares) = self.on_level(shares).filter(is_new) else {
                radius /= 4.0;
                continue;
            };
            let step = distance(&shares, &known[best].shares);
            let Some(Some(merit)) = trials.at(&point(self.axes, &shares)) else {
                radius = 0.5 * step.min(radius);
                continue;
            };
            let Some(result) = trials.results.last().cloned() else { return };
            let won = merit - known[best].merit;
            known.push(self.known(trials, shares, merit, &result));
            failed = if won > 0.1 * gain { 0 } else { failed + 1 };
            if won > 0.0 {
                best = known.len() - 1;
            }
            if won > 0.7 * gain && step > 0.9 * radius {
                radius = (2.0 * radius).min(0.5);
            } else if failed > self.axes.len() {
                (radius, failed) = (0.5 * radius, 0);
            }
        }
    }

    /// Returns the highest point that the bounds permit near the best point, and its gain.
    fn next(&self, known: &[Known], best: usize, radius: f64) -> Option<(Vec<f64>, f64)> {
        let centre = &known[best];
        let bound = |x: &f64| [-x.min(radius), (1.0 - x).min(radius)];
        let bounds: Vec<[f64; 2]> = centre.shares.iter().map(bound).collect();
        let near = known.iter().filter(|own| distance(&own.shares, &centre.shares) <= 2.0 * radius);
        let cut = |own: &Known, slope: &Vec<f64>| {
            let to: Vec<f64> = centre.shares.iter().zip(&own.shares).map(|(a, b)| a - b).collect();
            let value = Cut { value: own.merit, slope: slope.clone() }.at(&to);
            // A bound below the best merit is not valid: the result is not concave between the two points.
            Cut { value: value.max(centre.merit), slope: slope.clone() }
        };
        let cuts: Vec<Cut> = near.flat_map(|own| own.slopes.iter().map(move |slope| cut(own, slope))).collect();
        let level = self.level.as_ref().map(|level| level.slope(&centre.shares).map(|(_, slope)| slope));
        let level = match level {
            Some(slope) => Some(slope?),
            None => None,
        };
        let (step, value) = highest_step(&cuts, &bounds, level.as_deref())?;
        let length = step.iter().map(|x| x.abs()).fold(0.0, f64::max);
        let grid = length.max(f64::MIN_POSITIVE).log2().ceil().exp2() / GRID;
        let round = |(x, step): (&f64, f64)| (x + (step / grid).round() * grid).clamp(0.0, 1.0);
        let shares = centre.shares.iter().zip(step).map(round).collect();
        Some((shares, value - centre.merit))
    }
}
