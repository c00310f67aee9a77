//! Tests of the scaled problem against statics and kinematics in physical units.

mod chains;
mod flexibility;
mod loads;
mod motions;
mod unit_system;

use super::System;
use crate::path::two_blocks::{forces, stack, v};
use voussoir_core::path::PathProblem;

/// A stack of two blocks in which no number is 1: poles, areas, compliances and the size of the scene.
fn uneven() -> PathProblem {
    let mut problem = stack([0.3, 0.5], forces(&[(1, v(0.2, 0.1), v(3.0, -1.0)), (2, v(0.7, 1.9), v(-0.5, 0.4))]));
    (problem.length, problem.bodies[1].pole, problem.bodies[2].pole) = (4.0, v(0.3, 0.4), v(0.8, 1.7));
    for (k, contact) in problem.contacts.iter_mut().enumerate() {
        contact.compliance = [1e-4 * (1.0 + k as f64), 2e-4 * (2.0 + k as f64)];
        contact.gap = 1e-5 * k as f64;
    }
    problem
}

/// The system of a problem whose laws are facets.
fn system(problem: &PathProblem) -> System {
    System::new(problem, |_| [0.0; 2])
}
