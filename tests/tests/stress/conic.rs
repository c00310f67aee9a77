//! Linear and conic programs of limit analysis, written for Clarabel and shared by the independent programs of several
//! families.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, SecondOrderConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};

/// The greatest or least value of a variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extreme {
    Value(f64),
    /// No point satisfies the rows.
    Infeasible,
    /// The variable is unbounded; a point that satisfies the rows may or may not exist.
    Unbounded,
    /// The program was not decided.
    Unknown,
}

/// A x + s = right: equations first, then rows s ≥ 0, then cones s_0 ≥ |(s_1, s_2)|.
pub struct Rows {
    variables: usize,
    entries: Vec<(usize, usize, f64)>,
    pub right: Vec<f64>,
    pub linear_from: usize,
    pub cones_from: usize,
    cones: usize,
}

impl Rows {
    pub fn new(variables: usize) -> Rows {
        Rows { variables, entries: Vec::new(), right: Vec::new(), linear_from: 0, cones_from: 0, cones: 0 }
    }

    pub fn variables(&self) -> usize {
        self.variables
    }

    pub fn entry(&mut self, row: usize, variable: usize, value: f64) {
        self.entries.push((row, variable, value));
    }

    pub fn row(&mut self, entries: &[(usize, f64)], right: f64) {
        let row = self.right.len();
        entries.iter().for_each(|&(variable, value)| self.entry(row, variable, value));
        self.right.push(right);
    }

    /// The greatest dead load of a block.
    pub fn typical(&self) -> f64 {
        self.right[..self.linear_from].iter().fold(0.0, |most, value| value.abs().max(most))
    }

    /// Adds N'² ≤ F (N' − 2 |M|/h) with N' = N + F_t, for the variables N and M of a joint and \[F, F_t\], as two cones
    /// (F + y, F − y, 2 N'), in units that scale F to the `typical` force.
    pub fn stress_block(&mut self, [n, m]: [usize; 2], h: f64, [force, tension]: [f64; 2], typical: f64) {
        let scale = (typical / force).sqrt().min(1.0);
        for sign in [-1.0, 1.0] {
            let y = [(n, -1.0 / scale), (m, -sign * 2.0 / h / scale)];
            self.row(&y, force * scale + tension / scale);
            self.row(&y.map(|(v, c)| (v, -c)), force * scale - tension / scale);
            self.row(&[(n, -2.0)], 2.0 * tension);
            self.cones += 1;
        }
    }

    /// Returns the greatest (`sense` 1) or least (−1) value of a variable. With `sense` 0 it returns the value at any
    /// point that satisfies the rows. Forces are in units of the typical load, so that tolerances are meaningful.
    pub fn extreme(&self, variable: usize, sense: f64) -> Extreme {
        let unit = if self.typical() > 0.0 { self.typical() } else { 1.0 };
        match self.extreme_in(unit, variable, sense) {
            // Forces far above the typical force get more digits in their own unit.
            Extreme::Value(value) if value.abs() > 30.0 * unit => self.extreme_in(value.abs(), variable, sense),
            Extreme::Unknown => [0.1 * unit, 10.0 * unit]
                .into_iter()
                .map(|unit| self.extreme_in(unit, variable, sense))
                .find(|extreme| *extreme != Extreme::Unknown)
                .unwrap_or(Extreme::Unknown),
            extreme => extreme,
        }
    }

    fn extreme_in(&self, unit: f64, variable: usize, sense: f64) -> Extreme {
        let (mut i, mut j, mut v) = (Vec::new(), Vec::new(), Vec::new());
        let of_loads = |entry: &&(usize, usize, f64)| entry.1 == variable && entry.0 < self.linear_from;
        let most = self.entries.iter().filter(of_loads).fold(0.0, |most: f64, entry| most.max(entry.2.abs()));
        let most = if most > 0.0 { most } else { 1.0 };
        for entry in &self.entries {
            i.push(entry.0);
            j.push(entry.1);
            v.push(if of_loads(&entry) { entry.2 / most } else { entry.2 });
        }
        let b: Vec<f64> = self.right.iter().map(|value| value / unit).collect();
        let a = CscMatrix::new_from_triplets(b.len(), self.variables, i, j, v);
        let linear_to = if self.cones > 0 { self.cones_from } else { b.len() };
        let mut cones = vec![ZeroConeT(self.linear_from), NonnegativeConeT(linear_to - self.linear_from)];
        cones.extend((0..self.cones).map(|_| SecondOrderConeT(3)));
        let mut q = vec![0.0; self.variables];
        q[variable] = -sense;
        // Degenerate programs are sometimes decided with another scaling of rows and columns.
        [true, false].into_iter().find_map(|scaled| decided(&a, &b, &cones, &q, scaled)).map_or(
            Extreme::Unknown,
            |found| match found {
                Ok(x) => Extreme::Value(x[variable] * unit / most),
                Err(extreme) => extreme,
            },
        )
    }
}

/// Returns the solution, or the reason why there is none; `None` if Clarabel does not decide.
fn decided(
    a: &CscMatrix,
    b: &[f64],
    cones: &[clarabel::solver::SupportedConeT<f64>],
    q: &[f64],
    scaled: bool,
) -> Option<Result<Vec<f64>, Extreme>> {
    let settings = DefaultSettings::<f64> {
        verbose: false,
        max_iter: 300,
        tol_gap_abs: 1e-10,
        tol_gap_rel: 1e-10,
        tol_feas: 1e-10,
        equilibrate_enable: scaled,
        ..DefaultSettings::default()
    };
    let p = CscMatrix::<f64>::zeros((q.len(), q.len()));
    let mut solver = DefaultSolver::new(&p, q, a, b, cones, settings).expect("a program");
    solver.solve();
    let solution = &solver.solution;
    let gap = (solution.obj_val - solution.obj_val_dual).abs();
    let close = gap <= 1e-7 * solution.obj_val.abs().max(1e-3) && solution.r_prim <= 1e-8 && solution.r_dual <= 1e-8;
    match solution.status {
        SolverStatus::Solved => Some(Ok(solution.x.clone())),
        SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress if close => Some(Ok(solution.x.clone())),
        SolverStatus::PrimalInfeasible => Some(Err(Extreme::Infeasible)),
        SolverStatus::DualInfeasible => Some(Err(Extreme::Unbounded)),
        _ => None,
    }
}
