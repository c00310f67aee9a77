//! Newton's method with a line search for the rate problem: for an active set of many points at once.
//!
//! With ṙ = S ġ + s λ̇ the conditions of all points are one piecewise linear system in ġ,
//!
//! ```text
//! F(ġ) = ṙ − P(ṙ − ρ ġ) = 0,   P the return map to the cone of a point's facets without slack along ρ d,
//! ```
//!
//! ρ the point's own stiffness (the natural map; Alart & Curnier 1991). The modes of ṙ − ρ ġ give Newton's step,
//! which a line search on ‖F‖ damps; the active set without it may cycle. What it ends in is solved and checked
//! exactly.

use super::cone::Cone;
use super::problem::{Rate, RateProblem};
use crate::contact::mode::ContactMode;
use crate::optimise::line_search::LineSearch;
use nalgebra::DVector;

/// Regularisation of the points' stiffness, relative to it, for the steps.
const REGULARISATION: f64 = 1e-9;
/// Steps below this share of the rates end in nothing else.
const STILL: f64 = 1e-12;
/// Iterations from a guess.
const ITERATIONS: usize = 60;

/// ‖F‖ in the units of the points, and the modes there.
fn natural_map(problem: &RateProblem, cones: &[Cone], gaps: &DVector<f64>) -> (f64, Vec<ContactMode>) {
    let forces = &problem.s * gaps + &problem.load_rate;
    let (mut sum, mut modes) = (0.0, Vec::with_capacity(cones.len()));
    for (k, cone) in cones.iter().enumerate() {
        let stiffness = problem.points[k].stiffness;
        let z = [0, 1].map(|i| forces[2 * k + i] - stiffness * gaps[2 * k + i]);
        let (mode, back) = cone.return_map(z);
        sum += (0..2).map(|i| (forces[2 * k + i] - back[i]).powi(2) / stiffness).sum::<f64>();
        modes.push(mode);
    }
    (sum.sqrt(), modes)
}

/// A rate with λ̇ = 1 from the modes of a guess. `None` where none is found, or where points are open with a
/// strength, whose multipliers have any sign.
pub fn line_search(problem: &RateProblem, guess: &[ContactMode], trials: &mut u64) -> Option<Rate> {
    if problem.points.iter().any(|p| p.open.is_some()) {
        return None;
    }
    let cones: Vec<Cone> = problem.points.iter().map(Cone::new).collect();
    // Next to singular combinations of modes the step is that of a slightly softer structure.
    let mut s = problem.s.clone();
    for (k, point) in problem.points.iter().enumerate() {
        (0..2).for_each(|i| s[(2 * k + i, 2 * k + i)] -= REGULARISATION * point.stiffness);
    }
    let softer = RateProblem {
        points: problem.points.clone(),
        s,
        load_rate: problem.load_rate.clone(),
        from_nothing: false,
        load_force: problem.load_force,
        load_flexibility: problem.load_flexibility,
        metric: None,
        settles: problem.settles,
    };
    let mut gaps = match softer.attempt(guess, 1.0) {
        Some(attempt) if !attempt.singular => attempt.gaps,
        _ => DVector::zeros(2 * problem.points.len()),
    };
    let mut search = LineSearch::of_pieces();
    let (merit, mut modes) = natural_map(problem, &cones, &gaps);
    search.merits.push(merit);
    for _ in 0..ITERATIONS {
        *trials += 1;
        if let Some(rate) = problem.exactly(modes.clone(), 1.0) {
            return Some(rate);
        }
        let attempt = softer.attempt(&modes, 1.0).filter(|attempt| !attempt.singular)?;
        let step = attempt.gaps - &gaps;
        if step.amax() <= STILL * gaps.amax() {
            return None;
        }
        let at = |_, share: f64| {
            let there = &gaps + &step * share;
            let (merit, modes) = natural_map(problem, &cones, &there);
            Ok::<_, ()>((merit, (modes, there)))
        };
        ((modes, gaps), _) = search.search(1.0, at).ok()?;
    }
    None
}
