//! Scales of loads and motions.

use super::problem::{LimitProblem, Velocity};
use crate::model::Wrenches;

/// Returns the force that scales wrenches to size one; 1 N if all wrenches are zero.
pub fn force_unit(problem: &LimitProblem, wrenches: &Wrenches) -> f64 {
    match problem.magnitude(wrenches) {
        0.0 => 1.0,
        magnitude => magnitude,
    }
}

/// Returns the force scale of a program: the scale of the fixed loads, if any, or of the varying ones.
pub fn force_scale(problem: &LimitProblem, fixed: &Wrenches, varying: &Wrenches) -> f64 {
    force_unit(problem, if problem.magnitude(fixed) > 0.0 { fixed } else { varying })
}

/// Scales a motion so that the wrenches, about the problem's pole, have power 1 on it.
pub fn with_unit_power(wrenches: &Wrenches, mut motion: Vec<Velocity>) -> Vec<Velocity> {
    let power: f64 = wrenches.iter().zip(&motion).map(|(w, v)| w[0] * v[0] + w[1] * v[1] + w[2] * v[2]).sum();
    motion.iter_mut().flatten().for_each(|v| *v /= power);
    motion
}

/// Returns `fixed` + `factor` × `varying`.
pub fn combined(fixed: &Wrenches, varying: &Wrenches, factor: f64) -> Wrenches {
    let add = |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|i| a[i] + factor * b[i]);
    fixed.iter().zip(varying).map(add).collect()
}
