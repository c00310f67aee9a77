//! Errors of fields of joint forces.

use voussoir_core::law::StressBlock;
use voussoir_core::limit::{JointForce, LimitProblem};
use voussoir_core::model::Wrenches;

/// Returns the greatest error of a field relative to the loads: unbalanced force or violated strength.
pub fn field_error(problem: &LimitProblem, loads: &Wrenches, forces: &[JointForce]) -> f64 {
    field_violation(problem, loads, forces) / problem.magnitude(loads).max(f64::MIN_POSITIVE)
}

/// Returns the greatest error of a field \[N\].
pub fn field_violation(problem: &LimitProblem, loads: &Wrenches, forces: &[JointForce]) -> f64 {
    let (mut left, mut worst) = (loads.clone(), 0.0f64);
    for (joint, force) in problem.joints.iter().zip(forces) {
        let components = [force.normal[0], force.normal[1], force.shear];
        for (group, sign) in [(joint.plus, 1.0), (joint.minus, -1.0)] {
            let Some(group) = group else { continue };
            for (wrench, component) in joint.wrenches(problem.pole).iter().zip(components) {
                (0..3).for_each(|i| left[group][i] += sign * wrench[i] * component);
            }
        }
        for row in &joint.strength.rows {
            let reached: f64 = row.normal.iter().zip(components).map(|(normal, component)| normal * component).sum();
            worst = worst.max(reached - row.bound);
        }
        if let Some(block) = joint.strength.block {
            worst = worst.max(excess(block, force));
        }
    }
    let unbalanced = left.iter().map(|w| w[0].abs().max(w[1].abs()).max(w[2].abs() / problem.length));
    unbalanced.fold(worst, f64::max)
}

/// Returns the violation of the stress block of a joint \[N\], at the end with less compression.
pub fn excess(block: StressBlock, force: &JointForce) -> f64 {
    let pressed = force.normal[0] + force.normal[1] + block.tension;
    pressed / block.total * pressed - (2.0 * force.normal[0].min(force.normal[1]) + block.tension)
}
