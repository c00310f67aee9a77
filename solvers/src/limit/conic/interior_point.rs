//! The first, approximate solution: Clarabel.

use super::system::System;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// A primal-dual pair.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Variables.
    pub x: Vec<f64>,
    /// Multipliers of the equations.
    pub equations: Vec<f64>,
    /// Multipliers of the linear rows, ≥ 0.
    pub rows: Vec<f64>,
    /// Multipliers of the stress blocks as φ ≤ 0, ≥ 0.
    pub blocks: Vec<f64>,
}

/// What the solver says; its word is not passed on as proof.
pub enum Word {
    /// It thinks this pair is optimal, or close to it.
    Pair(Pair, u64),
    /// It thinks that θ has no bound.
    Unbounded(u64),
    /// Anything else.
    Other(String, u64),
}

/// Solves a system.
pub fn solve(system: &System) -> Word {
    let (e, l) = (system.equations.len(), system.rows.len());
    let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut right: Vec<f64> = system.right.clone();
    let mut push = |i: usize, j: usize, v: f64| {
        rows.push(i);
        columns.push(j);
        values.push(v);
    };
    for (i, row) in system.equations.iter().enumerate() {
        row.iter().for_each(|&(j, v)| push(i, j, v));
    }
    for (i, row) in system.rows.iter().enumerate() {
        row.iter().for_each(|&(j, v)| push(e + i, j, v));
    }
    right.extend(&system.bounds);
    // u² ≤ F w as |(2u, F/κ − κ w)| ≤ F/κ + κ w, κ balancing the entries.
    let balance = |total: f64| total.max(1e-12).sqrt();
    for (k, block) in system.blocks.iter().enumerate() {
        let first = e + l + 3 * k;
        let (tension, kappa) = (block.strength.tension, balance(block.strength.total));
        let scaled = block.strength.total / kappa;
        let end = block.normal[block.end];
        push(first, end, -2.0 * kappa);
        push(first + 2, end, 2.0 * kappa);
        block.normal.iter().for_each(|&j| push(first + 1, j, -2.0));
        right.extend([scaled + kappa * tension, 2.0 * tension, scaled - kappa * tension]);
    }
    let a = CscMatrix::new_from_triplets(right.len(), system.variables, rows, columns, values);
    let p = CscMatrix::<f64>::zeros((system.variables, system.variables));
    let mut q = vec![0.0; system.variables];
    q[system.theta] = -1.0;
    let mut cones = vec![SupportedConeT::ZeroConeT(e), SupportedConeT::NonnegativeConeT(l)];
    cones.extend(system.blocks.iter().map(|_| SupportedConeT::SecondOrderConeT(3)));
    let settings = DefaultSettings::<f64> {
        verbose: false,
        max_iter: 200,
        tol_gap_abs: 1e-11,
        tol_gap_rel: 1e-11,
        tol_feas: 1e-11,
        max_threads: 1,
        ..DefaultSettings::default()
    };
    let mut solver = match DefaultSolver::new(&p, &q, &a, &right, &cones, settings) {
        Ok(solver) => solver,
        Err(error) => {
            return Word::Other(format!("the conic solver refused the problem: {error:?}"), 0);
        }
    };
    solver.solve();
    let solution = &solver.solution;
    let iterations = u64::from(solution.iterations);
    let finite = solution.x.iter().chain(&solution.z).all(|v| v.is_finite());
    match solution.status {
        SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Word::Unbounded(iterations),
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            Word::Other("the conic solver found no admissible field".into(), iterations)
        }
        // Whatever it calls its end, the polish and the certificate decide what the pair is worth.
        _ if finite => {
            let z = &solution.z;
            let blocks = system.blocks.iter().enumerate().map(|(k, block)| {
                let first = e + l + 3 * k;
                balance(block.strength.total) * (z[first] - z[first + 2])
            });
            let pair = Pair {
                x: solution.x.clone(),
                equations: z[..e].to_vec(),
                rows: z[e..e + l].to_vec(),
                blocks: blocks.collect(),
            };
            Word::Pair(pair, iterations)
        }
        status => Word::Other(format!("the conic solver ended with {status:?}"), iterations),
    }
}
