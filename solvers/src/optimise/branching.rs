//! Branching on a linear complementarity problem: a solution, or a proof that there is none.
//!
//! ```text
//! w = q + M z,   w ≥ 0,   z ≥ 0,   w_i z_i = 0
//! ```
//!
//! M is any square matrix, so that pivoting proves nothing: a search. Without the products it is a
//! linear program; where its point has w_i z_i > 0, one of the two is set to zero, then the other. A
//! program without a point has multipliers y with y·w − (yᵀM)·z = y·q of contradicting signs (Farkas
//! 1902); they are recomputed from M and q, and those variables that must be zero for the
//! contradiction are a reason why these cannot all be zero together. A pair that takes no part in a reason is not
//! branched on again (conflict-directed backjumping: Prosser 1993, Computational Intelligence 9), and
//! reasons are kept: a variable that one of them leaves no choice is decided at once.

use super::dense_simplex::{Dictionary, Feasibility};
use super::lcp::Lcp;
use nalgebra::DVector;

/// w and z of solutions that are excluded are below this (entries of q and of the diagonal of M are of
/// size one): multipliers that are rounding of zero are weighed with it.
const LARGEST: f64 = 1e6;
/// Product below this share of the greatest w and z is zero.
const ZERO: f64 = 1e-9;
/// Coefficients below this share of the greatest are rounding, of variables that are set to zero.
const ROUNDING: f64 = 1e-14;
/// Reasons that are kept.
const KEPT: usize = 2000;

/// What is known of the solutions.
#[derive(Debug, Clone, PartialEq)]
pub enum LcpAnswer {
    /// There is none (with entries up to a million).
    NoSolution,
    /// z of one.
    Solution(Vec<f64>),
    /// The search ended before, and why.
    Undecided(String),
}

/// What a node of the search found.
enum Node {
    /// These variables cannot all be zero.
    Reason(Vec<usize>),
    Solution(Vec<f64>),
    Lost(String),
}

/// Searches through at most so many nodes, each of which is a linear program; also how many there were. The
/// problem is scaled by the caller: M and q of size one.
pub fn solve_by_branching(problem: &Lcp, most: u64) -> (LcpAnswer, u64) {
    let n = problem.constant.len();
    let rows: Vec<f64> = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|at| problem.matrix[at]).collect();
    let right = problem.constant.iter().copied().collect();
    let mut search = Search {
        problem,
        program: Dictionary::new(2 * n, (0..n).collect(), (n..2 * n).collect(), right, rows),
        reasons: Vec::new(),
        nodes: 0,
        most,
    };
    let answer = match search.node() {
        Node::Reason(_) => LcpAnswer::NoSolution,
        Node::Solution(z) => LcpAnswer::Solution(z),
        Node::Lost(why) => LcpAnswer::Undecided(why),
    };
    (answer, search.nodes)
}

/// Variables that must be zero for the multipliers' contradiction; `None` where there is none beyond
/// rounding. `sense`: the sign of the coefficients that contradict.
fn reason(
    problem: &Lcp,
    multipliers: &[(usize, f64)],
    sense: f64,
    fixed: impl Fn(usize) -> bool,
) -> Option<Vec<usize>> {
    let mut y = DVector::zeros(problem.constant.len());
    multipliers.iter().for_each(|&(i, value)| y[i] = sense * value);
    let right = y.dot(&problem.constant);
    let by = -problem.matrix.tr_mul(&y);
    let coefficients = y.iter().chain(by.iter());
    let size = coefficients.clone().fold(0.0, |a: f64, c| a.max(c.abs()));
    // Σ c x = right < 0 with x ≥ 0: impossible where no c < 0 is left.
    let (mut reason, mut against) = (Vec::new(), 0.0);
    for (variable, &c) in coefficients.enumerate().filter(|(_, c)| **c < 0.0) {
        if !fixed(variable) {
            against -= c;
        } else if c < -ROUNDING * size {
            reason.push(variable);
        }
    }
    (right < 0.0 && LARGEST * against < -0.5 * right).then_some(reason)
}

struct Search<'a> {
    problem: &'a Lcp,
    /// Variables: w, then z.
    program: Dictionary,
    reasons: Vec<Vec<usize>>,
    nodes: u64,
    most: u64,
}

impl Search<'_> {
    fn pairs(&self) -> usize {
        self.problem.constant.len()
    }

    fn partner(&self, variable: usize) -> usize {
        let n = self.pairs();
        if variable < n { variable + n } else { variable - n }
    }

    /// A kept reason all of whose variables are zero, or the variable that one leaves no choice.
    fn known(&self) -> Result<Option<usize>, Vec<usize>> {
        let mut forced = None;
        for reason in &self.reasons {
            let mut open = reason.iter().copied().filter(|x| !self.program.is_fixed(*x));
            match (open.next(), open.next()) {
                (None, _) => return Err(reason.clone()),
                (Some(x), None) if !self.program.is_fixed(self.partner(x)) => forced = Some(x),
                _ => {}
            }
        }
        Ok(forced)
    }

    fn node(&mut self) -> Node {
        let n = self.pairs();
        let forced = match self.known() {
            Err(reason) => return Node::Reason(reason),
            Ok(forced) => forced,
        };
        if let Some(x) = forced {
            return self.branch(x);
        }
        self.nodes += 1;
        if self.nodes > self.most {
            return Node::Lost(format!("{} linear programs were not enough", self.most));
        }
        let open = |this: &Self, i: usize| !this.program.is_fixed(i) && !this.program.is_fixed(i + n);
        let mut chosen = None;
        match self.program.feasible() {
            Feasibility::Point => {
                let w: Vec<f64> = (0..n).map(|i| self.program.value(i).max(0.0)).collect();
                let z: Vec<f64> = (n..2 * n).map(|i| self.program.value(i).max(0.0)).collect();
                let [most_w, most_z] = [&w, &z].map(|v| v.iter().fold(1e-3, |a: f64, b| a.max(*b)));
                let product = |i: usize| (w[i] / most_w).min(z[i] / most_z);
                match (0..n).max_by(|i, j| product(*i).total_cmp(&product(*j))) {
                    Some(i) if product(i) > ZERO => {
                        // The smaller of the two first.
                        chosen = Some(if w[i] / most_w < z[i] / most_z { i } else { i + n });
                    }
                    _ => return Node::Solution(z),
                }
            }
            Feasibility::Reason(_) => {
                let reason = self.program.refutation().and_then(|(multipliers, sense)| {
                    let own: Vec<(usize, f64)> = multipliers.into_iter().filter(|(x, _)| *x < n).collect();
                    reason(self.problem, &own, sense, |x| self.program.is_fixed(x))
                });
                if let Some(reason) = reason {
                    return self.learnt(reason);
                }
            }
            Feasibility::Undecided => {}
        }
        match chosen.or_else(|| (0..n).find(|i| open(self, *i))) {
            Some(x) if open(self, x % n) => self.branch(x),
            _ => Node::Lost("a linear program is decided by rounding".into()),
        }
    }

    fn learnt(&mut self, reason: Vec<usize>) -> Node {
        if self.reasons.len() < KEPT {
            self.reasons.push(reason.clone());
        }
        Node::Reason(reason)
    }

    /// First this variable is zero, then its partner.
    fn branch(&mut self, first: usize) -> Node {
        let mut both = Vec::new();
        for x in [first, self.partner(first)] {
            self.program.fix(x, true);
            let found = self.node();
            self.program.fix(x, false);
            match found {
                // Without it there is none either.
                Node::Reason(reason) if !reason.contains(&x) => return Node::Reason(reason),
                Node::Reason(reason) => both.extend(reason.into_iter().filter(|y| *y != x)),
                other => return other,
            }
        }
        both.sort_unstable();
        both.dedup();
        self.learnt(both)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimise::lcg::Lcg;
    use nalgebra::DMatrix;

    /// Whether every choice of one zero per pair has no solution, by solving each.
    fn none_by_enumeration(problem: &Lcp) -> bool {
        let n = problem.constant.len();
        (0..1usize << n).all(|choice| {
            let moving: Vec<usize> = (0..n).filter(|i| choice >> i & 1 == 1).collect();
            let k = moving.len();
            let m = DMatrix::from_fn(k, k, |i, j| problem.matrix[(moving[i], moving[j])]);
            let right = DVector::from_fn(k, |i, _| -problem.constant[moving[i]]);
            let own = if k == 0 { Some(right) } else { m.lu().solve(&right) };
            let Some(own) = own else { return true };
            let mut z = DVector::zeros(n);
            (0..k).for_each(|i| z[moving[i]] = own[i]);
            let w = &problem.constant + &problem.matrix * &z;
            z.iter().any(|z| *z < -1e-9) || w.iter().enumerate().any(|(i, w)| choice >> i & 1 == 0 && *w < -1e-9)
        })
    }

    fn random(n: usize, random: &mut Lcg) -> Lcp {
        let matrix = DMatrix::from_fn(n, n, |i, j| if i == j { 1.0 } else { 1.5 * random.next() });
        Lcp { matrix, constant: DVector::from_fn(n, |_, _| random.next()) }
    }

    #[test]
    fn agrees_with_every_combination() {
        let mut random_numbers = Lcg::new(5);
        let (mut with, mut without) = (0, 0);
        for number in 0..600 {
            let mut problem = random(2 + number % 7, &mut random_numbers);
            // Rows that only help: fewer solutions.
            (0..number % 3).for_each(|i| problem.constant[i] = -1.0);
            let (answer, nodes) = solve_by_branching(&problem, 10_000);
            assert!(nodes < 500, "{nodes}");
            match answer {
                LcpAnswer::NoSolution => {
                    assert!(none_by_enumeration(&problem), "{number}");
                    without += 1;
                }
                LcpAnswer::Solution(z) => {
                    assert!(!none_by_enumeration(&problem), "{number}");
                    let z = DVector::from_vec(z);
                    let w = &problem.constant + &problem.matrix * &z;
                    let size = 1.0 + z.amax();
                    assert!(w.min() > -1e-8 * size && z.min() >= 0.0);
                    assert!((0..w.len()).all(|i| w[i].min(z[i]) < 1e-7 * size), "{w} {z}");
                    with += 1;
                }
                LcpAnswer::Undecided(why) => panic!("{number}: {why}"),
            }
        }
        assert!(with > 100 && without > 100, "{with} {without}");
    }

    /// Problems made around a solution, degenerate ones too, are never said to have none.
    #[test]
    fn a_planted_solution_is_found() {
        let mut random_numbers = Lcg::new(11);
        for number in 0..200 {
            let n = 5 + number % 20;
            let mut problem = random(n, &mut random_numbers);
            if number % 4 == 0 {
                let same = problem.matrix.row(0).clone_owned();
                problem.matrix.set_row(1, &same);
            }
            let z = DVector::from_fn(n, |_, _| random_numbers.next().max(0.0));
            let w = DVector::from_fn(n, |i, _| if z[i] > 0.0 { 0.0 } else { (random_numbers.next() + 0.5).max(0.0) });
            problem.constant = &w - &problem.matrix * &z;
            let (answer, nodes) = solve_by_branching(&problem, 100_000);
            assert!(matches!(answer, LcpAnswer::Solution(_)), "{number}: {answer:?} after {nodes}");
        }
    }
}
