//! Uniqueness of a mechanism from the stiffness at the last state.
//!
//! Close to the optimum, springs of flexibility V² resist every motion with about the ratio of forces to rates. A
//! mechanism meets a stiffness of the size of the gap, any other motion a much greater one. The softest motion that is
//! orthogonal to the mechanism, in the metric of the stiffness, is found by inverse iterations. The motion is the only
//! one if it is far stiffer than the mechanism.

use super::cone::inner;
use super::interior_point::{InteriorPoint, add, dot};
use super::settings::SETTINGS;

/// Returns true if the motion of a factorised state is the only mechanism, false if another one is as soft. `None` if
/// rounding hides the difference.
pub fn unique(method: &mut InteriorPoint) -> Option<bool> {
    let program = method.program;
    let mut mechanism = program.varying.clone();
    method.stiffness.solve(&mut mechanism);
    let power = dot(&program.varying, &mechanism);
    // A fixed sequence without a pattern starts the iteration.
    let mut motion: Vec<f64> = (0..mechanism.len()).map(|k| ((k * k + 1) as f64).sin()).collect();
    for _ in 0..SETTINGS.iterations {
        method.stiffness.solve(&mut motion);
        let share = dot(&program.varying, &motion) / power;
        add(&mut motion, -share, &mechanism);
        let size = dot(&motion, &motion).sqrt();
        motion.iter_mut().for_each(|v| *v /= size);
    }
    let [own, other] = [stiffness(method, &mechanism), stiffness(method, &motion)];
    let ratio = other / own;
    if ratio > SETTINGS.stiffer { Some(true) } else { (ratio < SETTINGS.as_soft).then_some(false) }
}

/// Returns the stiffness of a motion per square of its rates.
fn stiffness(method: &InteriorPoint, motion: &[f64]) -> f64 {
    let rates = method.program.rates(motion);
    let resisted: f64 = rates.iter().zip(&method.scalings).map(|(z, scaling)| inner(z, &scaling.square(z))).sum();
    resisted / rates.iter().map(|z| inner(z, z)).sum::<f64>()
}
