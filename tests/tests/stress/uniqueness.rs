//! Uniqueness of a mechanism by linear programs: the least and the greatest value of a random functional over all
//! motions that prove the factor. The programs share only the data of the problem with the solver.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::cell::Cell;
use voussoir::core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, Status};
use voussoir::core::model::stage_loads;
use voussoir::solvers::limit::conic::LimitConic;
use voussoir_tests::{Wall, first_case, friction};

/// Greatest relative excess of the load on an optimal motion over the factor.
const OPTIMAL: f64 = 1e-9;
/// Spread of the functional, relative to the greatest velocity: below the first value the motion is unique, above the
/// second it is not.
const SPREAD: [f64; 2] = [1e-4, 3e-3];

/// Returns the greatest value of `functional` over velocities [v_x, v_y, ω × length] of all groups that prove the
/// factor, each velocity within ± `box_size`. `None` if the program is not solved.
fn greatest(problem: &LimitProblem, factor: f64, length: f64, box_size: f64, functional: &[f64]) -> Option<f64> {
    let velocities = 3 * problem.groups;
    let force = problem.magnitude(&problem.varying).max(problem.magnitude(&problem.fixed));
    let (mut rows, mut columns, mut values, mut right) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let multipliers: usize = problem.joints.iter().map(|joint| joint.strength.rows.len()).sum();
    let mut push = |i: usize, j: usize, v: f64| {
        if v != 0.0 {
            rows.push(i);
            columns.push(j);
            values.push(v);
        }
    };
    // The jump of each joint is the jump of its yielding rows.
    let mut z = velocities;
    let mut dissipated = Vec::new();
    for joint in &problem.joints {
        let wrenches = joint.wrenches(problem.pole);
        for (k, wrench) in wrenches.iter().enumerate().take(joint.components()) {
            for (group, sign) in [(joint.plus, 1.0), (joint.minus, -1.0)] {
                let Some(group) = group else { continue };
                (0..2).for_each(|i| push(right.len(), 3 * group + i, sign * wrench[i]));
                push(right.len(), 3 * group + 2, sign * wrench[2] / length);
            }
            joint.strength.rows.iter().enumerate().for_each(|(i, row)| push(right.len(), z + i, row.normal[k]));
            right.push(0.0);
        }
        dissipated.extend(joint.strength.rows.iter().map(|row| row.bound / force));
        z += joint.strength.rows.len();
    }
    let power = |wrench: &[f64; 3]| [wrench[0] / force, wrench[1] / force, wrench[2] / force / length];
    for (group, wrench) in problem.varying.iter().enumerate() {
        (0..3).for_each(|i| push(right.len(), 3 * group + i, power(wrench)[i]));
    }
    right.push(1.0);
    let equations = right.len();
    // The dissipation minus the work of the fixed load is the factor.
    for (group, wrench) in problem.fixed.iter().enumerate() {
        (0..3).for_each(|i| push(equations, 3 * group + i, -power(wrench)[i]));
    }
    dissipated.iter().enumerate().for_each(|(i, d)| push(equations, velocities + i, *d));
    right.push(factor + OPTIMAL * factor.abs().max(1e-3));
    for i in 0..multipliers {
        push(right.len(), velocities + i, -1.0);
        right.push(0.0);
    }
    for i in 0..velocities {
        for sign in [1.0, -1.0] {
            push(right.len(), i, sign);
            right.push(box_size);
        }
    }
    let a = CscMatrix::new_from_triplets(right.len(), velocities + multipliers, rows, columns, values);
    let size = velocities + multipliers;
    let mut objective = vec![0.0; size];
    functional.iter().enumerate().for_each(|(i, g)| objective[i] = -g);
    let settings = DefaultSettings::<f64> {
        verbose: false,
        tol_gap_abs: 1e-9,
        tol_gap_rel: 1e-9,
        tol_feas: 1e-10,
        max_threads: 1,
        ..DefaultSettings::default()
    };
    let sets = [ZeroConeT(equations), NonnegativeConeT(right.len() - equations)];
    let p = CscMatrix::<f64>::zeros((size, size));
    let mut solver = DefaultSolver::new(&p, &objective, &a, &right, &sets, settings).ok()?;
    solver.solve();
    let solved = matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
    solved.then(|| -solver.solution.obj_val)
}

/// Returns true if the motion is the only one by two programs; `None` if the spread is between the two limits.
fn only_one(problem: &LimitProblem, answer: &LimitAnswer) -> Option<bool> {
    let (factor, motion, length) = (answer.factor?, answer.motion.as_ref()?, 0.4);
    // With varying·q̇ = 1 in units of the force.
    let force = problem.magnitude(&problem.varying).max(problem.magnitude(&problem.fixed));
    let sizes = motion.iter().flat_map(|v| [v[0], v[1], v[2] * length]).map(|v| (v * force).abs());
    let largest = sizes.fold(0.0, f64::max);
    let functional: Vec<f64> =
        (0..3 * problem.groups).map(|i| (i as f64 * 0.754_877_666_2 + 0.3).fract() - 0.5).collect();
    let opposite: Vec<f64> = functional.iter().map(|g| -g).collect();
    let of = |functional: &[f64]| greatest(problem, factor, length, 3.0 * largest, functional);
    let spread = (of(&functional)? + of(&opposite)?) / largest;
    match spread {
        spread if spread < SPREAD[0] => Some(true),
        spread if spread > SPREAD[1] => Some(false),
        _ => None,
    }
}

/// Checks random walls, some of them pushed along an axis: the solver's statement on uniqueness of the mechanism agrees
/// with the linear programs.
fn check(cases: u32) {
    let scenes = (1usize..6, 1usize..5, 0.1f64..1.2, -180.0f64..180.0, prop::option::of(0usize..8));
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let [unique, several, unclear] = [(); 3].map(|()| Cell::new(0));
    runner
        .run(&scenes, |(courses, bricks, mu, direction, eighth)| {
            let degrees = eighth.map_or(direction, |eighth| 45.0 * eighth as f64);
            let (sin, cos) = degrees.to_radians().sin_cos();
            let wall = Wall { joint: friction(mu), push: [9.81 * cos, 9.81 * sin], ..Wall::in_bond(courses, bricks) };
            let case = first_case(&wall.study());
            let loads = stage_loads(&case.assembly, &case.stages);
            let problem = LimitProblem::new(&case.assembly, &loads[1]).expect("a wall");
            let answer = LimitConic {}.solve(&problem, LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY });
            if answer.status != Status::Collapse {
                return Ok(());
            }
            match only_one(&problem, &answer) {
                Some(one) => {
                    assert_eq!(answer.unique, Some(one), "{mu} {degrees} {courses} × {bricks}");
                    let count = if one { &unique } else { &several };
                    count.set(count.get() + 1);
                }
                None => unclear.set(unclear.get() + 1),
            }
            Ok(())
        })
        .unwrap();
    let [unique, several, unclear] = [unique, several, unclear].map(|count| count.get());
    println!("{unique} alone, {several} one of several, {unclear} unclear");
    assert!(unique > cases / 8 && several > cases / 50 && unclear * 20 < cases, "{unique} {several} {unclear}");
}

/// The solver's statement that a mechanism is the only one agrees with linear programs. `VOUSSOIR_UNIQUE=2000` tries
/// more walls.
#[test]
fn mechanisms_are_the_only_ones_where_the_solver_says_so() {
    check(std::env::var("VOUSSOIR_UNIQUE").ok().and_then(|n| n.parse().ok()).unwrap_or(60));
}
