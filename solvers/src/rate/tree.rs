//! The complete search over modes: all rates with a sense of λ, or a proof that no such rate exists.
//!
//! Rates are points of the linear complementarity problem of [`proof`](super::proof). Without the products w_i z_i = 0 it
//! is a linear program. A node fixes the mode of one more point; a program without a point ends the branch with a
//! contradiction, and a contradiction that does not use the mode of a node ends that node too (conflict-directed
//! backjumping: Prosser 1993, Computational Intelligence 9).

use super::lcp::{RateLcp, gaps_of, rate_lcp};
use super::neighbours::add;
use super::problem::{Rate, RateProblem};
use super::proof::{ModeTree, NoRate};
use crate::contact::active_point::ActivePoint;
use crate::contact::facet::{across, dot, norm};
use crate::contact::mode::ContactMode;
use crate::optimise::dense_simplex::{Dictionary, Feasibility};
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, DVector};
use voussoir_core::path::PointMode;

/// Facets up to which a problem is searched: its program is dense.
const MOST: usize = 1200;
/// Linear programs for each leaf of the budget.
const PROGRAMS: u64 = 4;
/// Entries of the program that all pivots may change: each pivot changes all of them.
const MOST_CHANGED: u64 = 2_000_000_000;

/// Result of a complete search in one sense of λ.
pub struct Searched {
    /// All rates that were found.
    pub rates: Vec<Rate>,
    /// The tree, if it is complete.
    pub proof: Option<NoRate>,
    /// The reason why the search is not complete.
    pub open: Option<String>,
}

impl Searched {
    fn undecided(why: &str) -> Searched {
        Searched { rates: Vec::new(), proof: None, open: Some(why.into()) }
    }
}

/// Searches all modes for rates with λ̇ = `factor`; for λ̇ = 0 the load does work on the rate. Ends after `most` leaves.
pub fn search(problem: &RateProblem, factor: f64, most: usize, trials: &mut u64) -> Searched {
    search_some(problem, factor, (most, usize::MAX), trials)
}

/// The same, but ends after `enough` leaves if it has found a rate.
pub fn search_some(problem: &RateProblem, factor: f64, (most, enough): (usize, usize), trials: &mut u64) -> Searched {
    let Some(lcp) = rate_lcp(problem) else {
        return Searched::undecided("the points that are open with a strength are held by nothing");
    };
    if lcp.facets.len() > MOST {
        return Searched::undecided("there are too many facets for its dense program");
    }
    let rows = lcp.all_rows();
    let Some(program) = Program::new(problem, &lcp, factor) else {
        let tree = ModeTree::Contradiction([vec![0.0; rows.len()], vec![1.0]].concat());
        return Searched { rates: Vec::new(), proof: Some(NoRate { factor, rows, tree }), open: None };
    };
    let choices = choices(problem, &lcp);
    let decided = vec![None; choices.len()];
    let mut search = Search {
        problem,
        lcp: &lcp,
        dictionary: program.dictionary(),
        program,
        choices,
        decided,
        rates: Vec::new(),
        doubtful: false,
        leaves: 0,
        programs: 0,
        most,
        enough,
    };
    let found = search.node();
    *trials += search.programs;
    let Search { program, rates, doubtful, .. } = search;
    match found {
        Err(why) => Searched { rates, proof: None, open: Some(why) },
        Ok(_) if doubtful => Searched { rates, proof: None, open: Some("a combination is decided by rounding".into()) },
        Ok((tree, _)) => {
            let proof = NoRate { factor, rows, tree: program.in_own_units(tree, &lcp) };
            Searched { rates, proof: Some(proof), open: None }
        }
    }
}

/// A mode of a point and the variables that it sets to zero: i for w_i, n + i for z_i.
type Choice = (PointMode, Vec<usize>);

/// The modes of each point, those that the certificate expects.
fn choices(problem: &RateProblem, lcp: &RateLcp) -> Vec<Vec<Choice>> {
    let n = lcp.facets.len();
    let of_mode = |k: usize, mode: PointMode| {
        let own = lcp.facets.iter().enumerate().filter(|(_, at)| at.0 == k);
        let stays = |f: usize| mode == PointMode::Vertex || mode == PointMode::Facet(f);
        (mode, own.map(|(i, at)| if stays(at.1) { i } else { n + i }).collect())
    };
    let points = problem.points.iter().enumerate();
    points.map(|(k, point)| point_modes(point).into_iter().map(|mode| of_mode(k, mode)).collect()).collect()
}

/// The modes of a point. A facet on which no force rate but zero stays has no mode.
pub(super) fn point_modes(point: &ActivePoint) -> Vec<PointMode> {
    let vertex = point.active.iter().any(|f| point.active.first() != Some(f) || point.open.is_some_and(|o| o != *f));
    let vertex = vertex.then_some(PointMode::Vertex);
    if let Some(open) = point.open {
        return std::iter::once(PointMode::Facet(open)).chain(vertex).collect();
    }
    let stays = |f: &&usize| {
        let along = across(point.facets[**f].normal);
        let admissible = |sense: f64| {
            point.active.iter().all(|j| {
                sense * dot(point.facets[*j].normal, along) <= SETTINGS.residual() * norm(point.facets[*j].normal)
            })
        };
        admissible(1.0) || admissible(-1.0)
    };
    let facets = point.active.iter().filter(stays).map(|f| PointMode::Facet(*f));
    std::iter::once(PointMode::Stick).chain(facets).chain(vertex).collect()
}

/// The mode of a contact point in a cell, by its gap rate.
fn contact_mode(point: &ActivePoint, mode: PointMode, gap: [f64; 2]) -> ContactMode {
    match mode {
        PointMode::Stick => ContactMode::Stick,
        PointMode::Facet(f) => ContactMode::Facet(f as u8),
        PointMode::Open => ContactMode::Open,
        PointMode::Vertex => {
            let least = |mode: &ContactMode| {
                let signed = |(k, v): (usize, f64)| if k == 0 && point.open.is_some() { 0.0 } else { v };
                let unknowns = mode.unknowns(point.facets, gap);
                unknowns.into_iter().enumerate().map(signed).fold(f64::INFINITY, f64::min)
            };
            let corners = point.candidates().into_iter().filter(|mode| matches!(mode, ContactMode::Corner(..)));
            if point.apex { None } else { corners.max_by(|a, b| least(a).total_cmp(&least(b))) }
                .unwrap_or(ContactMode::Open)
        }
    }
}

/// The linear program: w = constant + matrix z, one row more for λ̇ = 0.
struct Program {
    matrix: DMatrix<f64>,
    constant: DVector<f64>,
    /// Size by which q, or c, was divided.
    size: f64,
    factor: f64,
}

impl Program {
    /// `None` if the load does no work at all.
    fn new(problem: &RateProblem, lcp: &RateLcp, factor: f64) -> Option<Program> {
        let n = lcp.facets.len();
        let (m, q) = (&lcp.lcp.matrix, &lcp.lcp.constant);
        if factor != 0.0 {
            let size = if n == 0 { 1.0 } else { q.amax().max(1e-300) };
            return Some(Program { matrix: m.clone(), constant: q * (factor / size), size, factor });
        }
        let unit = |j: usize| -> Vec<f64> { (0..n).map(|i| f64::from(u8::from(i == j))).collect() };
        let work: Vec<f64> = (0..n).map(|j| problem.power(&gaps_of(problem, lcp, &unit(j), 0.0))).collect();
        let size = work.iter().fold(0.0, |a: f64, c| a.max(c.abs()));
        if size == 0.0 {
            return None;
        }
        let matrix = DMatrix::from_fn(n + 1, n, |i, j| if i < n { m[(i, j)] } else { work[j] / size });
        let constant = DVector::from_fn(n + 1, |i, _| if i < n { 0.0 } else { -1.0 });
        Some(Program { matrix, constant, size, factor })
    }

    /// Variables: w, z and the surplus of the last row.
    fn variable_of_row(&self, row: usize) -> usize {
        let n = self.matrix.ncols();
        if row < n { row } else { 2 * n }
    }

    fn dictionary(&self) -> Dictionary {
        let (rows, n) = self.matrix.shape();
        let basic: Vec<usize> = (0..rows).map(|row| self.variable_of_row(row)).collect();
        let entries = (0..rows).flat_map(|i| (0..n).map(move |j| self.matrix[(i, j)])).collect();
        Dictionary::new(n + rows, basic, (n..2 * n).collect(), self.constant.iter().copied().collect(), entries)
    }

    /// Multipliers of the rows and the fixed variables that they use. `None` if they do not contradict each other
    /// beyond rounding.
    fn contradiction(&self, dictionary: &Dictionary) -> Option<(Vec<f64>, Vec<usize>)> {
        let (rows, n) = self.matrix.shape();
        let (terms, sense) = dictionary.refutation()?;
        let mut y = DVector::zeros(rows);
        for (variable, value) in terms.into_iter().filter(|(variable, _)| *variable < n || *variable >= 2 * n) {
            y[if variable < n { variable } else { n }] = sense * value;
        }
        let right = y.dot(&self.constant);
        let by = -self.matrix.tr_mul(&y);
        let own = (0..rows).map(|row| (self.variable_of_row(row), y[row]));
        let all: Vec<(usize, f64)> = own.chain((0..n).map(|j| (n + j, by[j]))).collect();
        let size = all.iter().fold(0.0, |a: f64, (_, c)| a.max(c.abs()));
        let (mut used, mut against) = (Vec::new(), 0.0);
        for (variable, c) in all.into_iter().filter(|(_, c)| *c < 0.0) {
            if !dictionary.is_fixed(variable) {
                against -= c;
            } else if c < -SETTINGS.negligible() * size {
                used.push(variable);
            }
        }
        (right < 0.0 && SETTINGS.largest_inverse() * against < -0.5 * right)
            .then(|| (y.iter().copied().collect(), used))
    }

    /// The tree with multipliers of the rows in physical units.
    fn in_own_units(&self, tree: ModeTree, lcp: &RateLcp) -> ModeTree {
        match tree {
            ModeTree::Contradiction(y) => {
                let mut own: Vec<f64> = y.iter().zip(&lcp.unit).map(|(y, unit)| y / unit).collect();
                own.extend(lcp.eliminated_rows(&own));
                own.extend(y.get(lcp.unit.len()).map(|work| work / self.size));
                ModeTree::Contradiction(own)
            }
            ModeTree::Point { point, modes } => {
                let own = |(mode, tree)| (mode, self.in_own_units(tree, lcp));
                ModeTree::Point { point, modes: modes.into_iter().map(own).collect() }
            }
            rate => rate,
        }
    }
}

struct Search<'a> {
    problem: &'a RateProblem<'a>,
    lcp: &'a RateLcp,
    program: Program,
    dictionary: Dictionary,
    choices: Vec<Vec<Choice>>,
    /// The mode of each point on the present branch.
    decided: Vec<Option<PointMode>>,
    rates: Vec<Rate>,
    doubtful: bool,
    leaves: usize,
    programs: u64,
    most: usize,
    /// Leaves after which it ends if it has found a rate.
    enough: usize,
}

/// A tree and the points whose modes its contradictions use.
type Explained = (ModeTree, Vec<usize>);

impl Search<'_> {
    fn node(&mut self) -> Result<Explained, String> {
        self.programs += 1;
        let changed = self.dictionary.pivots.saturating_mul(self.program.matrix.len() as u64);
        let done = changed > MOST_CHANGED || self.programs > PROGRAMS * self.most as u64;
        if done || self.leaves >= self.most {
            return Err(format!("{} combinations of modes were not enough", self.leaves));
        }
        let found = self.dictionary.feasible();
        if let Feasibility::Reason(_) = found
            && let Some((y, used)) = self.program.contradiction(&self.dictionary)
        {
            self.leaves += 1;
            return Ok((ModeTree::Contradiction(y), self.points_of(&used)));
        }
        match self.next_point(found == Feasibility::Point) {
            Some(point) => self.branch(point),
            None => self.cell(found == Feasibility::Point),
        }
    }

    /// Points to which variables belong.
    fn points_of(&self, variables: &[usize]) -> Vec<usize> {
        let n = self.lcp.facets.len();
        let mut points: Vec<usize> = variables.iter().map(|x| self.lcp.facets[x % n].0).collect();
        points.sort_unstable();
        points.dedup();
        points
    }

    /// The undecided point that is farthest from complementarity.
    fn next_point(&self, feasible: bool) -> Option<usize> {
        let n = self.lcp.facets.len();
        let undecided = (0..self.choices.len()).filter(|k| self.decided[*k].is_none());
        let value = |x: usize| if feasible { self.dictionary.value(x).max(0.0) } else { 0.0 };
        let most = |first: usize| (first..first + n).map(value).fold(1e-3, f64::max);
        let (most_w, most_z) = (most(0), most(n));
        let product = |k: usize| {
            let own = (0..n).filter(|i| self.lcp.facets[*i].0 == k);
            let worst = own.map(|i| (value(i) / most_w).min(value(n + i) / most_z)).fold(0.0, f64::max);
            if worst > SETTINGS.admissible { worst } else { 0.0 }
        };
        undecided.map(|k| (product(k), k)).reduce(|a, b| if b.0 > a.0 { b } else { a }).map(|(_, k)| k)
    }

    /// The modes of a point, first those that the present point of the program nearly satisfies.
    fn nearest_first(&self, point: usize) -> Vec<Choice> {
        let n = self.lcp.facets.len();
        let value = |x: usize| self.dictionary.value(x).max(0.0);
        let most = |first: usize| (first..first + n).map(value).fold(1e-3, f64::max);
        let sizes = [most(0), most(n)];
        let distance = |choice: &Choice| choice.1.iter().map(|x| value(*x) / sizes[x / n]).fold(0.0, f64::max);
        let mut choices = self.choices[point].clone();
        choices.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        choices
    }

    fn branch(&mut self, point: usize) -> Result<Explained, String> {
        let (mut modes, mut reasons) = (Vec::new(), Vec::new());
        for (mode, fixed) in self.nearest_first(point) {
            self.decided[point] = Some(mode);
            fixed.iter().for_each(|x| self.dictionary.fix(*x, true));
            let found = self.node();
            fixed.iter().for_each(|x| self.dictionary.fix(*x, false));
            self.decided[point] = None;
            let (tree, reason) = found?;
            if !reason.contains(&point) {
                return Ok((tree, reason));
            }
            modes.push((mode, tree));
            reasons.extend(reason.into_iter().filter(|k| *k != point));
        }
        reasons.sort_unstable();
        reasons.dedup();
        let place = |mode: &PointMode| self.choices[point].iter().position(|choice| choice.0 == *mode);
        modes.sort_by_key(|(mode, _)| place(mode));
        Ok((ModeTree::Point { point, modes }, reasons))
    }

    /// All points have their modes and the program has a point, or was not decided.
    fn cell(&mut self, feasible: bool) -> Result<Explained, String> {
        self.leaves += 1;
        let modes: Vec<PointMode> = self.decided.iter().map(|mode| mode.unwrap_or(PointMode::Stick)).collect();
        let found = if feasible { self.rate_of_cell(&modes) } else { None };
        match found {
            Some(rate) => add(&mut self.rates, rate),
            None => self.doubtful = true,
        }
        if self.leaves >= self.enough && !self.rates.is_empty() {
            return Err("the search ended with a rate".into());
        }
        Ok((ModeTree::Rate(modes), (0..self.choices.len()).collect()))
    }

    fn rate_of_cell(&self, modes: &[PointMode]) -> Option<Rate> {
        let n = self.lcp.facets.len();
        let (factor, problem) = (self.program.factor, self.problem);
        let size = if factor == 0.0 { 1.0 } else { self.program.size };
        let z: Vec<f64> = (n..2 * n).map(|x| self.dictionary.value(x).max(0.0) * size).collect();
        let gaps = gaps_of(problem, self.lcp, &z, factor);
        let points = problem.points.iter().zip(modes).zip(&gaps);
        let modes = points.map(|((point, mode), gap)| contact_mode(point, *mode, *gap)).collect();
        let rate = Rate { factor, modes, gaps };
        let leads_on = factor != 0.0 || problem.leads_on(&rate);
        (leads_on && problem.admits(&rate)).then_some(rate)
    }
}
