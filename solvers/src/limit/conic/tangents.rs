//! Stress blocks by tangents: a sequence of linear programs that converges to the solution of the conic program.
//!
//! A stress block (N + F_t)² ≤ F (2 N_i + F_t) lies within its tangent at any N̄. With a tangent for each end of each
//! crushing joint the program is linear and is solved to rounding by its blocks. Its forces define the next tangents.
//! The violation after one program is the square of the error of N̄ (Kelley 1960, *J. SIAM* 8: cutting planes, here one
//! for each block).

use crate::limit::block_program::{Loads, Program, Solved, solve};
use crate::limit::equilibrium::{excess, field_error};
use crate::limit::settings::SETTINGS;
use voussoir_core::law::{FacetMode, ForceRow, StressBlock};
use voussoir_core::limit::{JointForce, LimitProblem, combined};
use voussoir_core::model::Wrenches;

/// Greatest number of programs.
const MAX_PROGRAMS: usize = 12;

/// Returns the tangent of a stress block at one end for the normal force N̄ = `pressed`: 2 ū (N + F_t) − ū² ≤
/// F (2 N_i + F_t), ū = N̄ + F_t, over F.
fn tangent(block: StressBlock, end: usize, pressed: f64) -> ForceRow {
    let share = ((pressed + block.tension) / block.total).clamp(0.0, 1.0);
    let mut normal = [2.0 * share, 2.0 * share, 0.0];
    normal[end] -= 2.0;
    let bound = block.tension * (1.0 - 2.0 * share) + share * share * block.total;
    ForceRow::associated(FacetMode::Opening, normal, bound)
}

/// Returns the problem with tangents at these N̄ instead of its stress blocks.
fn flattened(problem: &LimitProblem, touched: &[f64]) -> LimitProblem {
    let mut flat = problem.clone();
    for (joint, pressed) in flat.joints.iter_mut().zip(touched) {
        if let Some(block) = joint.strength.block.take() {
            joint.strength.rows.extend([0, 1].map(|end| tangent(block, end, *pressed)));
        }
    }
    flat
}

/// Returns the normal force N of a joint.
fn pressed(force: &JointForce) -> f64 {
    force.normal[0] + force.normal[1]
}

/// Solves the sequence of programs and returns all of them. The solution of the last one is removed if its forces
/// exceed the strengths.
pub fn by_tangents(
    problem: &LimitProblem,
    (fixed, varying, cap): (&Wrenches, &Wrenches, f64),
    start: &[JointForce],
) -> Vec<Solved> {
    let mut touched: Vec<f64> = start.iter().map(pressed).collect();
    let (mut all, mut least) = (Vec::new(), f64::INFINITY);
    while all.len() < MAX_PROGRAMS {
        let flat = flattened(problem, &touched);
        let loads = Loads { fixed: Some(fixed), varying, cap, strengths: true };
        let Some(program) = Program::new(&flat, loads) else { break };
        let mut solved = solve(&program, false);
        let Some(solution) = solved.solution.take() else {
            all.push(solved);
            break;
        };
        let error = field_error(problem, &combined(fixed, varying, solution.factor), &solution.forces);
        // A tangent stays if its block is satisfied, so that undetermined forces do not loosen it.
        for ((joint, force), touched) in problem.joints.iter().zip(&solution.forces).zip(&mut touched) {
            if joint.strength.block.is_some_and(|block| excess(block, force) > 0.0) {
                *touched = pressed(force);
            }
        }
        solved.solution = (error <= SETTINGS.admissible).then_some(solution);
        let done = solved.solution.is_some() || error > SETTINGS.diverged * least;
        least = least.min(error);
        all.push(solved);
        if done {
            break;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tangent touches its block at N̄ and lies outside it elsewhere, at either end.
    #[test]
    fn tangents_hold_their_block() {
        for tension in [0.0, 0.3] {
            let block = StressBlock { tension, total: 10.0 + tension };
            for (drawn, end) in [(0.0, 0), (2.5, 1), (7.0, 0), (10.0, 1)] {
                let row = tangent(block, end, drawn);
                for pressed in [-tension, 0.0, 1.0, 2.5, 6.0, 7.0, 10.0] {
                    // The least force of this end that satisfies the block.
                    let least = ((pressed + tension) * (pressed + tension) / block.total - tension) / 2.0;
                    let mut forces = [pressed - least; 2];
                    forces[end] = least;
                    let slack = row.bound - row.normal[0] * forces[0] - row.normal[1] * forces[1];
                    assert!(
                        slack > -1e-14 && (pressed != drawn || slack < 1e-14),
                        "{tension} {drawn} {pressed} {slack}"
                    );
                }
            }
        }
    }
}
