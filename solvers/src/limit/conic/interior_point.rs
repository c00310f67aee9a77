//! The first, approximate solution with Clarabel.

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

/// The result that the conic solver reports. It is not used as a proof.
pub enum Word {
    /// An optimal or nearly optimal pair.
    Pair(Pair, u64),
    /// θ has no bound.
    Unbounded(u64),
    /// Anything else.
    Other(String, u64),
}

/// A system in the solver's form: A x + s = b, s in a product of cones.
struct Conic {
    a: CscMatrix<f64>,
    b: Vec<f64>,
    sets: Vec<SupportedConeT<f64>>,
    /// First row of the cones of stress blocks, three rows each.
    first_cone: usize,
}

/// Returns κ of u² ≤ F w written as |(2u, F/κ − κ w)| ≤ F/κ + κ w; it balances the entries.
fn balance(total: f64) -> f64 {
    total.max(1e-12).sqrt()
}

impl Conic {
    fn new(system: &System) -> Self {
        let e = system.equations.len();
        let first_cone = e + system.rows.len();
        let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let mut push = |i: usize, j: usize, v: f64| {
            rows.push(i);
            columns.push(j);
            values.push(v);
        };
        for (i, row) in system.equations.iter().chain(&system.rows).enumerate() {
            row.iter().for_each(|&(j, v)| push(i, j, v));
        }
        let mut b: Vec<f64> = system.right.iter().chain(&system.bounds).copied().collect();
        for (place, block) in system.blocks.iter().enumerate() {
            let first = first_cone + 3 * place;
            let (tension, kappa) = (block.strength.tension, balance(block.strength.total));
            let scaled = block.strength.total / kappa;
            let end = block.normal[block.end];
            push(first, end, -2.0 * kappa);
            push(first + 2, end, 2.0 * kappa);
            block.normal.iter().for_each(|&j| push(first + 1, j, -2.0));
            b.extend([scaled + kappa * tension, 2.0 * tension, scaled - kappa * tension]);
        }
        let a = CscMatrix::new_from_triplets(b.len(), system.variables, rows, columns, values);
        let mut sets = vec![SupportedConeT::ZeroConeT(e), SupportedConeT::NonnegativeConeT(first_cone - e)];
        sets.extend(system.blocks.iter().map(|_| SupportedConeT::SecondOrderConeT(3)));
        Conic { a, b, sets, first_cone }
    }

    /// Returns the pair of a solution.
    fn pair(&self, system: &System, x: &[f64], z: &[f64]) -> Pair {
        let (e, rows) = (system.equations.len(), system.rows.len());
        let blocks = system.blocks.iter().zip(z[self.first_cone..].chunks_exact(3));
        let blocks = blocks.map(|(block, z)| balance(block.strength.total) * (z[0] - z[2])).collect();
        Pair { x: x.to_vec(), equations: z[..e].to_vec(), rows: z[e..e + rows].to_vec(), blocks }
    }
}

/// Solves a system.
pub fn solve(system: &System) -> Word {
    let conic = Conic::new(system);
    let p = CscMatrix::<f64>::zeros((system.variables, system.variables));
    let mut q = vec![0.0; system.variables];
    q[system.theta] = -1.0;
    let settings = DefaultSettings::<f64> {
        verbose: false,
        max_iter: 200,
        tol_gap_abs: 1e-11,
        tol_gap_rel: 1e-11,
        tol_feas: 1e-11,
        max_threads: 1,
        ..DefaultSettings::default()
    };
    let mut solver = match DefaultSolver::new(&p, &q, &conic.a, &conic.b, &conic.sets, settings) {
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
        // The status of the solver does not matter: the polish and the certificate check the pair.
        _ if finite => Word::Pair(conic.pair(system, &solution.x, &solution.z), iterations),
        status => Word::Other(format!("the conic solver ended with {status:?}"), iterations),
    }
}
