//! The second route: the same programs by Clarabel, with the same repair.
//!
//! Clarabel solves A x + s = b with s in the cones. Its unknowns are the forces of all points and λ. A state with the
//! greatest margin from the cones and an opening mechanism come from two more programs; fields and motions are mixed with
//! them. Clarabel's own gap is not used: with default settings its solution violates equilibrium and the dual cones by
//! more than the gap.

use super::cone::{Cone, UNIT};
use super::evidence::Evidence;
use super::program::Program;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use voussoir_core::limit::Counters;

/// Tolerances of the solver and regularisations of its linear systems, in the order of attempts. With its default
/// regularisation, the last one, results are wrong by 1e-5; with a smaller one its factorisation may fail.
const ATTEMPTS: [(f64, f64); 3] = [(1e-12, 1e-13), (1e-11, 1e-11), (1e-9, 1e-8)];
/// Greatest margin of a strictly interior state, in units of force. It bounds the program.
const GREATEST_MARGIN: f64 = 1.0;

/// Entries of a matrix by columns.
#[derive(Default)]
struct Columns {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl Columns {
    fn push(&mut self, entries: impl Iterator<Item = (usize, f64)>) {
        self.starts.push(self.rows.len());
        for (row, value) in entries.filter(|(_, value)| *value != 0.0) {
            self.rows.push(row);
            self.values.push(value);
        }
    }

    fn matrix(mut self, height: usize) -> CscMatrix<f64> {
        self.starts.push(self.rows.len());
        CscMatrix::new(height, self.starts.len() - 1, self.starts, self.rows, self.values)
    }
}

/// A solution of Clarabel.
struct Solution {
    x: Vec<f64>,
    z: Vec<f64>,
    iterations: u64,
    status: SolverStatus,
}

/// Solves min c·x, A x + s = b.
fn clarabel(c: &[f64], a: &CscMatrix<f64>, b: &[f64], cones: &[SupportedConeT<f64>]) -> Option<Solution> {
    solved(c, a, b, cones, false)
}

/// Solves min c·x, A x + s = b. `exactly`: makes all attempts until one reaches its tolerance, and returns the one with the
/// least residual.
fn solved(c: &[f64], a: &CscMatrix<f64>, b: &[f64], cones: &[SupportedConeT<f64>], exactly: bool) -> Option<Solution> {
    let p = CscMatrix::<f64>::zeros((c.len(), c.len()));
    let mut iterations = 0;
    let mut best: Option<(f64, Solution)> = None;
    for (tolerance, regularisation) in ATTEMPTS {
        let settings = DefaultSettings::<f64> {
            verbose: false,
            tol_gap_abs: tolerance,
            tol_gap_rel: tolerance,
            tol_feas: tolerance,
            static_regularization_constant: regularisation,
            iterative_refinement_abstol: 1e-15,
            iterative_refinement_reltol: 1e-15,
            max_threads: 1,
            ..DefaultSettings::default()
        };
        let mut solver = DefaultSolver::new(&p, c, a, b, cones, settings).ok()?;
        solver.solve();
        let own = &solver.solution;
        iterations += u64::from(own.iterations);
        let found = Solution { x: own.x.clone(), z: own.z.clone(), iterations, status: own.status };
        let failed = matches!(own.status, SolverStatus::NumericalError | SolverStatus::InsufficientProgress);
        let residual = if failed { f64::INFINITY } else { own.r_prim.max(own.r_dual) };
        let almost = exactly && own.status == SolverStatus::AlmostSolved;
        if best.as_ref().is_none_or(|(least, _)| residual < *least || least.is_infinite()) {
            best = Some((residual, found));
        }
        if !failed && !almost {
            break;
        }
    }
    best.map(|(_, solution)| Solution { iterations, ..solution })
}

/// Returns the columns of A: the wrenches of unit forces of all points.
fn wrenches(program: &Program) -> Vec<[Vec<(usize, f64)>; 3]> {
    let mut all = Vec::with_capacity(program.points.len());
    for member in &program.members {
        for point in member.points.clone() {
            all.push(std::array::from_fn(|k| member.wrench(&program.points[point], k)));
        }
    }
    all
}

/// The programs of one problem.
struct Route<'a> {
    program: &'a Program,
    wrenches: Vec<[Vec<(usize, f64)>; 3]>,
    iterations: u64,
}

impl Route<'_> {
    /// Returns the bounds of y₀ as rows: point, coefficient of y₀, right-hand side.
    fn limits(&self) -> Vec<(usize, f64, f64)> {
        let of = |(point, [least, most]): (usize, &[f64; 2])| {
            let least = (*least > 0.0).then_some((point, -1.0, -least));
            least.into_iter().chain(most.is_finite().then_some((point, 1.0, *most)))
        };
        self.program.limits.iter().enumerate().flat_map(of).collect()
    }

    /// Solves for the forces inside cones without other limits that do the least work on given rates.
    fn least_work(&mut self, rates: &[Cone]) -> Option<Solution> {
        let (rows, points) = (self.program.base.len(), self.program.points.len());
        let mut columns = Columns::default();
        for (point, wrenches) in self.wrenches.iter().enumerate() {
            for (k, wrench) in wrenches.iter().enumerate() {
                columns.push(wrench.iter().copied().chain([(rows + 3 * point + k, -1.0)]));
            }
        }
        let mut b: Vec<f64> = self.program.base.iter().map(|w| -w).collect();
        b.resize(rows + 3 * points, 0.0);
        let mut cones = vec![SupportedConeT::ZeroConeT(rows)];
        cones.extend((0..points).map(|_| SupportedConeT::SecondOrderConeT(3)));
        let solution = solved(rates.as_flattened(), &columns.matrix(rows + 3 * points), &b, &cones, true)?;
        self.iterations += solution.iterations;
        Some(solution)
    }

    /// Solves for the greatest value of a last unknown that adds `load` to equilibrium and takes `shift` times the unit from
    /// the distance of each point to its strength; `cap` bounds it.
    fn greatest(&mut self, load: &[f64], shift: f64, cap: Option<f64>) -> Option<Solution> {
        let (rows, points) = (self.program.base.len(), self.program.points.len());
        let mut columns = Columns::default();
        let (limits, conic) = (self.limits(), rows + 3 * points);
        let mut limited = limits.iter().enumerate().peekable();
        for (point, wrenches) in self.wrenches.iter().enumerate() {
            for (k, wrench) in wrenches.iter().enumerate() {
                let mut column = wrench.clone();
                column.push((rows + 3 * point + k, -1.0));
                while k == 0 && limited.peek().is_some_and(|(_, limit)| limit.0 == point) {
                    column.extend(limited.next().map(|(row, limit)| (conic + row, limit.1)));
                }
                columns.push(column.into_iter());
            }
        }
        let last = load.iter().copied().enumerate();
        let shifted = (0..points).map(|point| (rows + 3 * point, shift));
        let shifted = shifted.chain((0..limits.len()).map(|row| (conic + row, shift)));
        let bounds = limits.len() + usize::from(cap.is_some());
        columns.push(last.chain(shifted).chain(cap.map(|_| (conic + limits.len(), 1.0))));
        let mut b: Vec<f64> = self.program.base.iter().map(|w| -w).collect();
        b.resize(conic, 0.0);
        b.extend(limits.iter().map(|limit| limit.2).chain(cap));
        let mut cones = vec![SupportedConeT::ZeroConeT(rows)];
        cones.extend((0..points).map(|_| SupportedConeT::SecondOrderConeT(3)));
        cones.extend((bounds > 0).then_some(SupportedConeT::NonnegativeConeT(bounds)));
        let height = conic + bounds;
        let mut c = vec![0.0; 3 * points];
        c.push(-1.0);
        let solution = clarabel(&c, &columns.matrix(height), &b, &cones)?;
        self.iterations += solution.iterations;
        Some(solution)
    }

    /// Returns a motion with all rates at least the unit of the cones where joints cannot crush, of least sum of openings.
    fn opening(&mut self) -> Option<Vec<f64>> {
        let count = self.program.base.len();
        let mut entries: Vec<Vec<(usize, f64)>> = vec![Vec::new(); count];
        let mut c = vec![0.0; count];
        let opens = self.wrenches.iter().zip(&self.program.limits).filter(|(_, limits)| limits[1].is_infinite());
        let points = opens.clone().count();
        for (point, (wrenches, _)) in opens.enumerate() {
            for (k, wrench) in wrenches.iter().enumerate() {
                for (row, value) in wrench {
                    entries[*row].push((3 * point + k, -value));
                    c[*row] += if k == 0 { *value } else { 0.0 };
                }
            }
        }
        if points == 0 {
            return None;
        }
        let mut columns = Columns::default();
        entries.into_iter().for_each(|column| columns.push(column.into_iter()));
        let b: Vec<f64> = (0..points).flat_map(|_| UNIT.map(|x| -x)).collect();
        let cones: Vec<_> = (0..points).map(|_| SupportedConeT::SecondOrderConeT(3)).collect();
        let solution = clarabel(&c, &columns.matrix(3 * points), &b, &cones)?;
        self.iterations += solution.iterations;
        solution.x.iter().all(|x| x.is_finite()).then_some(solution.x)
    }
}

/// Returns forces by points.
fn by_points(x: &[f64], points: usize) -> Vec<Cone> {
    x.chunks_exact(3).take(points).map(|y| [y[0], y[1], y[2]]).collect()
}

/// The forces of least work on given rates.
pub enum LeastWork {
    /// Forces in equilibrium, and the motion that belongs to them.
    Field(Vec<Cone>, Vec<f64>),
    /// The work has no bound: forces in balance without loads do negative work.
    Ray(Vec<Cone>),
    /// No forces carry the loads.
    Nothing,
}

/// Returns the forces of least work on given rates of all points, repaired to equilibrium and into the cones. `None` if that
/// fails.
pub fn least_work(program: &Program, rates: &[Cone]) -> Option<LeastWork> {
    let mut route = Route { program, wrenches: wrenches(program), iterations: 0 };
    let (mut evidence, points) = (Evidence::default(), program.points.len());
    let solution = route.least_work(rates)?;
    if matches!(solution.status, SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible) {
        evidence.self_stress_near(program, &by_points(&solution.x, points));
        return evidence.ray.map(LeastWork::Ray);
    }
    if matches!(solution.status, SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible) {
        return Some(LeastWork::Nothing);
    }
    let still = vec![0.0; program.base.len()];
    let margin = route.greatest(&still, 1.0, Some(GREATEST_MARGIN))?;
    evidence.interior(program, by_points(&margin.x, points));
    evidence.repair(program, by_points(&solution.x, points), 0.0)?;
    let motion = solution.z[..program.base.len()].to_vec();
    evidence.lower.map(|field| LeastWork::Field(field.y, motion))
}

/// Returns forces, factor and motion of a program without repair: a first guess, which proves nothing.
pub fn guess(program: &Program) -> Option<(Vec<Cone>, f64, Vec<f64>)> {
    let mut route = Route { program, wrenches: wrenches(program), iterations: 0 };
    let Solution { x, z, status, .. } = route.greatest(&program.varying, 0.0, None)?;
    let solved = matches!(status, SolverStatus::Solved | SolverStatus::AlmostSolved);
    solved.then_some((by_points(&x, program.points.len()), *x.last()?, z[..program.base.len()].to_vec()))
}

/// Solves a program by Clarabel. `None` if it refuses the data.
pub fn run(program: &Program, held: bool, counters: &mut Counters) -> Option<Evidence> {
    let mut route = Route { program, wrenches: wrenches(program), iterations: 0 };
    let mut evidence = Evidence::default();
    let points = program.points.len();
    if let Some(opening) = route.opening() {
        evidence.motion(program, &opening, f64::INFINITY, held);
    }
    let still = vec![0.0; program.base.len()];
    let margin = route.greatest(&still, 1.0, Some(GREATEST_MARGIN))?;
    evidence.interior(program, by_points(&margin.x, points));
    evidence.motion(program, &margin.z[..program.base.len()], 0.0, held);
    if !held {
        let solution = route.greatest(&program.varying, 0.0, None)?;
        let unbounded = matches!(solution.status, SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible);
        let lambda = solution.x.last().copied().unwrap_or(0.0);
        if unbounded {
            evidence.ray_near(program, by_points(&solution.x, points).iter().map(|y| y.map(|x| x / lambda)).collect());
        } else {
            let _ = evidence.repair(program, by_points(&solution.x, points), lambda);
            evidence.motion(program, &solution.z[..program.base.len()], 0.0, false);
        }
    }
    *counters.entry("conic_iterations".into()).or_default() += route.iterations;
    Some(evidence)
}
