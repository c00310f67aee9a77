//! The rate problem by Newton's method with a line search: for many points at the verge of a change at once.
//!
//! With ṙ = S ġ + s λ̇ the conditions of all points are one piecewise linear system in ġ,
//!
//! ```text
//! F(ġ) = ṙ − P(ṙ − ρ ġ) = 0,   P the return to the cone of a point's facets without slack along ρ d,
//! ```
//!
//! ρ the point's own stiffness (the natural map; Alart & Curnier 1991). The pieces of ṙ − ρ ġ give Newton's step,
//! which is halved until ‖F‖ falls below the greatest of the last iterations (De Luca, Facchinei & Kanzow 1996, Math.
//! Programming 75, 407-439; Grippo, Lampariello & Lucidi 1986, SIAM J. Numer. Anal. 23, 707-716). Guess and correction without
//! it goes to and fro between pieces. What it ends in is solved and checked exactly.

use super::homotopy::Law;
use super::rate::{Piece, Rate, RateProblem};
use nalgebra::DVector;

/// Shift of the points' stiffness, relative to it, for the steps.
const SHIFT: f64 = 1e-9;
/// Steps below this share of the rates end in nothing else.
const STILL: f64 = 1e-12;
/// Iterations from a guess.
const ITERATIONS: usize = 60;
/// Most halvings of a step.
const HALVINGS: i32 = 8;
/// Least decrease of ‖F‖ per whole step, relative to it.
const DECREASE: f64 = 1e-2;
/// Iterations of which the greatest ‖F‖ counts.
const MEMORY: usize = 3;

impl RateProblem<'_> {
    /// A rate with λ̇ = 1 from the pieces of a guess. `None` where none is found, or where points are open with a
    /// strength, whose multipliers have any sign.
    pub(super) fn line_searched(&self, guess: &[Piece], counters: &mut u64) -> Option<Rate> {
        if self.points.iter().any(|p| p.open.is_some()) {
            return None;
        }
        let laws: Vec<Law> = self.points.iter().map(Law::new).collect();
        // F in the unit of each point, and the pieces there.
        let natural = |gaps: &DVector<f64>| -> (f64, Vec<Piece>) {
            let forces = &self.s * gaps + &self.load_rate;
            let (mut sum, mut pieces) = (0.0, Vec::with_capacity(laws.len()));
            for (k, law) in laws.iter().enumerate() {
                let stiffness = self.points[k].stiffness;
                let z = [0, 1].map(|i| forces[2 * k + i] - stiffness * gaps[2 * k + i]);
                let (piece, back) = law.returned(z);
                sum += (0..2).map(|i| (forces[2 * k + i] - back[i]).powi(2) / stiffness).sum::<f64>();
                pieces.push(piece);
            }
            (sum.sqrt(), pieces)
        };
        // Next to singular combinations of pieces the step is that of a slightly softer structure.
        let mut s = self.s.clone();
        for (k, point) in self.points.iter().enumerate() {
            (0..2).for_each(|i| s[(2 * k + i, 2 * k + i)] -= SHIFT * point.stiffness);
        }
        let softer =
            RateProblem { points: self.points.clone(), s, load_rate: self.load_rate.clone(), from_nothing: false };
        let mut gaps = match softer.attempt(guess, 1.0) {
            Some(attempt) if !attempt.singular => attempt.gaps,
            _ => DVector::zeros(2 * self.points.len()),
        };
        let (merit, mut pieces) = natural(&gaps);
        let mut merits = vec![merit];
        for _ in 0..ITERATIONS {
            *counters += 1;
            if let Some(rate) = self.exactly(pieces.clone(), 1.0) {
                return Some(rate);
            }
            let attempt = softer.attempt(&pieces, 1.0).filter(|attempt| !attempt.singular)?;
            let step = attempt.gaps - &gaps;
            if step.amax() <= STILL * gaps.amax() {
                return None;
            }
            let reference = merits.iter().rev().take(MEMORY).fold(0.0, |a: f64, m| a.max(*m));
            let mut best: Option<(f64, Vec<Piece>, DVector<f64>)> = None;
            for halvings in 0..=HALVINGS {
                let share = 0.5f64.powi(halvings);
                let there = &gaps + &step * share;
                let (merit, pieces) = natural(&there);
                if best.as_ref().is_none_or(|best| merit < best.0) {
                    best = Some((merit, pieces, there));
                }
                if merit <= (1.0 - DECREASE * share) * reference {
                    break;
                }
            }
            let merit;
            (merit, pieces, gaps) = best?;
            merits.push(merit);
        }
        None
    }
}
