//! Simplex method on a dense dictionary of non-negative variables: feasibility, minima and reasons of infeasibility,
//! for thousands of linear programs that differ in which variables are fixed at zero.
//!
//! x_B = β + M x_N with x ≥ 0; some variables are temporarily *fixed* at zero. The dual simplex method restores x ≥ 0
//! after a change; the primal simplex method minimises a linear form. A row with a negative right-hand side that no
//! free column can raise refutes the system; the fixed variables that could raise it are the reason. Equations and free
//! variables are eliminated in advance, so that a pivot is one sweep over a dense matrix.

use crate::settings::SETTINGS;

/// Number of pivots after which the dictionary is compared with its original.
const PIVOTS_BETWEEN_AUDITS: u64 = 64;

/// The place of a variable.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    Row(usize),
    Column(usize),
    /// The variable is in no equation: it is zero.
    Absent,
}

/// A system with questions of feasibility and minimisation.
#[derive(Debug, Clone)]
pub struct Dictionary {
    rows: usize,
    columns: usize,
    matrix: Vec<f64>,
    beta: Vec<f64>,
    basic: Vec<usize>,
    nonbasic: Vec<usize>,
    place: Vec<Place>,
    fixed: Vec<bool>,
    /// Reduced costs of the columns.
    cost: Vec<f64>,
    original: Original,
    since_audit: u64,
    /// Row and sense of the last refutation.
    refuted: Option<(usize, f64)>,
    /// Number of pivots.
    pub pivots: u64,
}

#[derive(Debug, Clone)]
struct Original {
    matrix: Vec<f64>,
    beta: Vec<f64>,
    basic: Vec<usize>,
    nonbasic: Vec<usize>,
}

/// The answer to a question of feasibility.
#[derive(Debug, Clone, PartialEq)]
pub enum Feasibility {
    /// The present point is feasible.
    Point,
    /// The system is infeasible while all of these variables are fixed.
    Reason(Vec<usize>),
    /// Rounding or the limit of pivots prevented an answer.
    Undecided,
}

/// Equations over free variables and variables ≥ 0: `rows` × (free + variables), stored row by row.
pub struct Equations {
    /// Number of free variables; they are the first columns.
    pub free: usize,
    /// Number of variables ≥ 0.
    pub variables: usize,
    /// Dense rows.
    pub rows: Vec<Vec<f64>>,
    /// Right-hand sides.
    pub right: Vec<f64>,
}

impl Equations {
    /// Solves the equations for as many variables as there are independent equations, free variables first, largest
    /// pivot first. `None` if the equations contradict each other.
    pub fn dictionary(mut self) -> Option<Dictionary> {
        let width = self.free + self.variables;
        let size = self.rows.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs())).max(1.0);
        let mut solved: Vec<Option<usize>> = vec![None; self.rows.len()];
        let mut basic_of = vec![None; width];
        for (first, last) in [(0, self.free), (self.free, width)] {
            // Rows by their largest entry in these columns, the largest of all first.
            let largest = |row: &[f64]| {
                (first..last).map(|j| (row[j].abs(), j)).fold((0.0, first), |m, x| if x.0 > m.0 { x } else { m })
            };
            let mut best: Vec<(f64, usize)> = self.rows.iter().map(|row| largest(row)).collect();
            loop {
                let open = (0..self.rows.len()).filter(|&i| solved[i].is_none());
                let Some(pivot) = open.max_by(|&a, &b| best[a].0.total_cmp(&best[b].0).then(b.cmp(&a))) else {
                    break;
                };
                let (value, column) = best[pivot];
                if value <= 1e-11 * size {
                    break;
                }
                let scale = self.rows[pivot][column];
                self.rows[pivot].iter_mut().for_each(|v| *v /= scale);
                self.right[pivot] /= scale;
                self.rows[pivot][column] = 1.0;
                let (source, right) = (self.rows[pivot].clone(), self.right[pivot]);
                let entries: Vec<(usize, f64)> =
                    source.iter().copied().enumerate().filter(|(_, v)| *v != 0.0).collect();
                for i in 0..self.rows.len() {
                    let factor = self.rows[i][column];
                    if i == pivot || factor == 0.0 {
                        continue;
                    }
                    for &(j, v) in &entries {
                        let x = self.rows[i][j] - factor * v;
                        // A difference within rounding is zero.
                        self.rows[i][j] = if x.abs() < 1e-14 * size { 0.0 } else { x };
                    }
                    self.rows[i][column] = 0.0;
                    self.right[i] -= factor * right;
                    if solved[i].is_none() {
                        best[i] = largest(&self.rows[i]);
                    }
                }
                solved[pivot] = Some(column);
                basic_of[column] = Some(pivot);
            }
        }
        let scale = self.right.iter().fold(1.0f64, |m, b| m.max(b.abs()));
        if (0..self.rows.len()).any(|i| solved[i].is_none() && self.right[i].abs() > 1e-9 * scale) {
            return None;
        }
        let occurs = |j: usize| {
            let column = self.free + j;
            (0..self.rows.len()).any(|i| self.rows[i][column] != 0.0)
        };
        let nonbasic: Vec<usize> =
            (0..self.variables).filter(|&j| basic_of[self.free + j].is_none() && occurs(j)).collect();
        let (mut basic, mut beta, mut matrix) = (Vec::new(), Vec::new(), Vec::new());
        for (variable, row) in (0..self.variables).filter_map(|j| Some((j, basic_of[self.free + j]?))) {
            basic.push(variable);
            beta.push(self.right[row]);
            matrix.extend(nonbasic.iter().map(|j| -self.rows[row][self.free + j]));
        }
        Some(Dictionary::new(self.variables, basic, nonbasic, beta, matrix))
    }
}

/// Returns a number in [0, 1) that depends irregularly on `index`.
fn irregular(index: usize) -> f64 {
    ((index as f64 + 1.0) * 0.618_033_988_749_894_9).fract()
}

/// Computes β after the bound of a variable has moved: x_B = x'_B + by, or x_N = x'_N − by in every row that contains
/// it.
fn move_bound(beta: &mut [f64], matrix: &[f64], columns: usize, place: Place, by: f64) {
    match place {
        Place::Row(i) => beta[i] += by,
        Place::Column(j) => beta.iter_mut().enumerate().for_each(|(i, beta)| *beta -= by * matrix[i * columns + j]),
        Place::Absent => {}
    }
}

impl Dictionary {
    /// Creates x_B = β + M x_N, M row by row; variables in neither list are zero.
    pub fn new(variables: usize, basic: Vec<usize>, nonbasic: Vec<usize>, beta: Vec<f64>, matrix: Vec<f64>) -> Self {
        let mut place = vec![Place::Absent; variables];
        basic.iter().enumerate().for_each(|(i, &x)| place[x] = Place::Row(i));
        nonbasic.iter().enumerate().for_each(|(j, &x)| place[x] = Place::Column(j));
        let cost = nonbasic.iter().map(|&x| 1.0 + irregular(x)).collect();
        let original =
            Original { matrix: matrix.clone(), beta: beta.clone(), basic: basic.clone(), nonbasic: nonbasic.clone() };
        Dictionary {
            rows: basic.len(),
            columns: nonbasic.len(),
            matrix,
            beta,
            basic,
            nonbasic,
            place,
            fixed: vec![false; variables],
            cost,
            original,
            since_audit: 0,
            refuted: None,
            pivots: 0,
        }
    }

    /// Returns the number of matrix entries swept: pivots × entries.
    pub fn work(&self) -> u64 {
        self.pivots * (self.rows * self.columns) as u64
    }

    /// Returns the value of a variable at the present point.
    pub fn value(&self, variable: usize) -> f64 {
        match self.place[variable] {
            Place::Row(i) => self.beta[i],
            Place::Column(_) | Place::Absent => 0.0,
        }
    }

    /// Returns the cost of one unit of a variable at the vertex that [`Self::minimise`] reached.
    pub fn reduced_cost(&self, variable: usize) -> f64 {
        match self.place[variable] {
            Place::Column(c) => self.cost[c],
            Place::Row(_) | Place::Absent => 0.0,
        }
    }

    /// Returns true if a variable is zero because it is not in the basis.
    pub fn at_zero(&self, variable: usize) -> bool {
        matches!(self.place[variable], Place::Column(_))
    }

    /// Returns true if a variable is fixed at zero.
    pub fn is_fixed(&self, variable: usize) -> bool {
        self.fixed[variable]
    }

    /// Fixes a variable at zero, or releases it.
    pub fn fix(&mut self, variable: usize, fixed: bool) {
        self.fixed[variable] = fixed;
    }

    /// Adds `by` to a variable as a function of the others: its bound moves. The basis is computed again.
    pub fn shift(&mut self, variable: usize, by: f64) {
        let original = &mut self.original;
        let at = |list: &[usize], in_list: fn(usize) -> Place| list.iter().position(|&x| x == variable).map(in_list);
        let place = at(&original.basic, Place::Row).or(at(&original.nonbasic, Place::Column)).unwrap_or(Place::Absent);
        move_bound(&mut original.beta, &original.matrix, self.columns, place, by);
        self.restore();
    }

    /// Moves the bounds of several variables in the present basis and in the original dictionary. A few pivots of the
    /// dual simplex method then restore feasibility.
    pub fn relax(&mut self, shifts: &[(usize, f64)]) {
        let mut places = vec![Place::Absent; self.place.len()];
        self.original.basic.iter().enumerate().for_each(|(i, &x)| places[x] = Place::Row(i));
        self.original.nonbasic.iter().enumerate().for_each(|(j, &x)| places[x] = Place::Column(j));
        let original = &mut self.original;
        for &(variable, by) in shifts {
            move_bound(&mut original.beta, &original.matrix, self.columns, places[variable], by);
            move_bound(&mut self.beta, &self.matrix, self.columns, self.place[variable], by);
        }
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.matrix[i * self.columns..(i + 1) * self.columns]
    }

    /// Exchanges the basic variable of row `r` for that of column `c`.
    fn pivot(&mut self, r: usize, c: usize) {
        let n = self.columns;
        let scale = -1.0 / self.matrix[r * n + c];
        let mut source: Vec<f64> = self.row(r).iter().map(|v| v * scale).collect();
        source[c] = -scale;
        let beta = self.beta[r] * scale;
        let (rows, costs) = (self.matrix.chunks_exact_mut(n).zip(&mut self.beta), (&mut self.cost[..], &mut 0.0));
        for (target, right) in rows.chain([costs]) {
            let factor = std::mem::take(&mut target[c]);
            if factor != 0.0 {
                target.iter_mut().zip(&source).for_each(|(t, s)| *t += factor * s);
                *right += factor * beta;
            }
        }
        self.matrix[r * n..(r + 1) * n].copy_from_slice(&source);
        self.beta[r] = beta;
        let (leaving, entering) = (self.basic[r], self.nonbasic[c]);
        self.basic[r] = entering;
        self.nonbasic[c] = leaving;
        self.place[entering] = Place::Row(r);
        self.place[leaving] = Place::Column(c);
        self.pivots += 1;
        self.since_audit += 1;
    }

    /// Returns the greatest difference between the present point and the original dictionary.
    fn drift(&self) -> f64 {
        let point: Vec<f64> = self.original.nonbasic.iter().map(|&x| self.value(x)).collect();
        let mut worst = 0.0f64;
        for (i, row) in self.original.matrix.chunks_exact(self.columns.max(1)).enumerate() {
            let sum: f64 = row.iter().zip(&point).map(|(m, x)| m * x).sum();
            let size: f64 = 1.0 + self.original.beta[i].abs();
            worst = worst.max((self.original.beta[i] + sum - self.value(self.original.basic[i])).abs() / size);
        }
        if worst.is_finite() { worst } else { f64::INFINITY }
    }

    fn audit(&mut self) {
        if self.since_audit >= PIVOTS_BETWEEN_AUDITS {
            self.since_audit = 0;
            if self.drift() > SETTINGS.shift() {
                self.restore();
            }
        }
    }

    /// Computes the present basis again from the original dictionary.
    pub fn restore(&mut self) {
        let wanted: Vec<bool> = self.place.iter().map(|p| matches!(p, Place::Row(_))).collect();
        let costs: Vec<(usize, f64)> = self.nonbasic.iter().copied().zip(self.cost.iter().copied()).collect();
        self.matrix.clone_from(&self.original.matrix);
        self.beta.clone_from(&self.original.beta);
        self.basic.clone_from(&self.original.basic);
        self.nonbasic.clone_from(&self.original.nonbasic);
        for (i, &x) in self.basic.iter().enumerate() {
            self.place[x] = Place::Row(i);
        }
        for (j, &x) in self.nonbasic.iter().enumerate() {
            self.place[x] = Place::Column(j);
        }
        let mut entering: Vec<usize> = self.nonbasic.iter().copied().filter(|&x| wanted[x]).collect();
        while !entering.is_empty() {
            // The largest pivot in the next possible column.
            let mut best: (f64, usize, usize) = (0.0, 0, 0);
            for (k, &x) in entering.iter().enumerate() {
                let Place::Column(c) = self.place[x] else { continue };
                for r in 0..self.rows {
                    let v = self.matrix[r * self.columns + c].abs();
                    if !wanted[self.basic[r]] && v > best.0 {
                        best = (v, r, k);
                    }
                }
                if best.0 > 0.1 {
                    break;
                }
            }
            if best.0 < SETTINGS.admissible {
                break;
            }
            let x = entering.swap_remove(best.2);
            let Place::Column(c) = self.place[x] else { break };
            self.pivot(best.1, c);
        }
        for (x, cost) in costs {
            if let Place::Column(c) = self.place[x] {
                self.cost[c] = cost;
            }
        }
        self.since_audit = 0;
    }

    /// Changes the costs so that the present basis is optimal: every free column has a cost.
    fn shift_costs(&mut self) {
        for (cost, &x) in self.cost.iter_mut().zip(&self.nonbasic) {
            if !self.fixed[x] && *cost < 0.0 {
                *cost = 1e-3 * (1.0 + irregular(x));
            }
        }
    }

    /// Searches for a point with x ≥ 0 and the fixed variables at zero, by the dual simplex method.
    pub fn feasible(&mut self) -> Feasibility {
        self.shift_costs();
        self.refuted = None;
        let limit = 20 * (self.rows + self.columns) as u64 + 200;
        let mut restored = false;
        for step in 0..limit {
            self.audit();
            // The most violated row; after many pivots an order that cannot cycle.
            let mut leaving: Option<(usize, f64, f64)> = None;
            for i in 0..self.rows {
                let (beta, fixed) = (self.beta[i], self.fixed[self.basic[i]]);
                let violation = if fixed { beta.abs() } else { -beta };
                if violation > SETTINGS.inequality() && leaving.is_none_or(|l| violation > l.1) {
                    leaving = Some((i, violation, if beta < 0.0 { 1.0 } else { -1.0 }));
                }
            }
            let Some((r, violation, sense)) = leaving else {
                return Feasibility::Point;
            };
            match self.entering(r, sense) {
                Some(c) => self.pivot(r, c),
                None if self.since_audit > 0 && !restored && self.drift() > SETTINGS.shift() => {
                    restored = true;
                    self.restore();
                }
                None => {
                    let repairable =
                        self.row(r).iter().zip(&self.nonbasic).any(|(m, &x)| !self.fixed[x] && m * sense > 1e-12);
                    if repairable && violation < SETTINGS.same_rate() {
                        return Feasibility::Undecided;
                    }
                    self.refuted = Some((r, sense));
                    return Feasibility::Reason(self.reason(r, sense));
                }
            }
            if step + 1 == limit / 2 {
                self.restore();
                for (cost, &x) in self.cost.iter_mut().zip(&self.nonbasic) {
                    *cost = 1.0 + irregular(x + 7);
                }
            }
        }
        Feasibility::Undecided
    }

    /// Returns the column that enters for row `r`: least ratio; among nearly equal ratios the largest pivot.
    fn entering(&self, r: usize, sense: f64) -> Option<usize> {
        let row = self.row(r);
        let mut bound = f64::INFINITY;
        for (c, m) in row.iter().enumerate() {
            let m = m * sense;
            if m > SETTINGS.admissible && !self.fixed[self.nonbasic[c]] {
                bound = bound.min((self.cost[c].max(0.0) + 1e-9) / m);
            }
        }
        let mut best: Option<(usize, f64)> = None;
        for (c, m) in row.iter().enumerate() {
            let m = m * sense;
            if m > SETTINGS.admissible
                && !self.fixed[self.nonbasic[c]]
                && self.cost[c].max(0.0) / m <= bound
                && best.is_none_or(|b| m > b.1)
            {
                best = Some((c, m));
            }
        }
        best.map(|b| b.0)
    }

    /// Returns the proof of the last [`Feasibility::Reason`]: Σ c x = β for all points of the affine space, as (x, c),
    /// and the sense (1 or −1) by which to multiply it so that β < 0.
    pub fn refutation(&self) -> Option<(Vec<(usize, f64)>, f64)> {
        let (r, sense) = self.refuted?;
        let mut row = vec![(self.basic[r], 1.0)];
        row.extend(self.nonbasic.iter().copied().zip(self.row(r).iter().map(|m| -m)));
        Some((row, sense))
    }

    /// Returns the fixed variables that could raise row `r` if they were free.
    fn reason(&self, r: usize, sense: f64) -> Vec<usize> {
        let mut reason: Vec<usize> = self
            .row(r)
            .iter()
            .zip(&self.nonbasic)
            .filter(|(m, x)| self.fixed[**x] && *m * sense > 1e-12)
            .map(|(_, &x)| x)
            .collect();
        if sense < 0.0 {
            reason.push(self.basic[r]);
        }
        reason.sort_unstable();
        reason
    }

    /// Minimises Σ weight × variable from a feasible point by the primal simplex method with at most `most` pivots.
    /// Returns the value, and true if it is the minimum; `None` if it has no bound.
    pub fn minimise(&mut self, weights: &[(usize, f64)], most: u64) -> Option<(f64, bool)> {
        let n = self.columns;
        self.cost.iter_mut().for_each(|c| *c = 0.0);
        for &(x, weight) in weights {
            match self.place[x] {
                Place::Column(c) => self.cost[c] += weight,
                Place::Row(i) => {
                    for (cost, m) in self.cost.iter_mut().zip(&self.matrix[i * n..(i + 1) * n]) {
                        *cost += weight * m;
                    }
                }
                Place::Absent => {}
            }
        }
        let scale = weights.iter().fold(0.0f64, |m, w| m.max(w.1.abs())).max(f64::MIN_POSITIVE);
        let mut degenerate = 0;
        let mut finished = false;
        for _ in 0..most {
            self.audit();
            let mut entering: Option<(usize, f64)> = None;
            for c in 0..n {
                let d = self.cost[c];
                if d < -1e-10 * scale && !self.fixed[self.nonbasic[c]] {
                    // Bland's rule if the point does not move.
                    let better = match entering {
                        None => true,
                        Some((b, _)) if degenerate > 40 => self.nonbasic[c] < self.nonbasic[b],
                        Some((_, best)) => d < best,
                    };
                    if better {
                        entering = Some((c, d));
                    }
                }
            }
            let Some((c, _)) = entering else {
                finished = true;
                break;
            };
            let mut bound = f64::INFINITY;
            for i in 0..self.rows {
                let m = self.matrix[i * n + c];
                let blocks = m < -SETTINGS.admissible || (self.fixed[self.basic[i]] && m.abs() > SETTINGS.admissible);
                if blocks {
                    bound = bound.min((self.beta[i].max(0.0) + SETTINGS.inequality()) / m.abs());
                }
            }
            if bound.is_infinite() {
                return None;
            }
            let mut leaving: Option<(usize, f64)> = None;
            for i in 0..self.rows {
                let m = self.matrix[i * n + c];
                let blocks = m < -SETTINGS.admissible || (self.fixed[self.basic[i]] && m.abs() > SETTINGS.admissible);
                if blocks && self.beta[i].max(0.0) / m.abs() <= bound {
                    let better = match leaving {
                        None => true,
                        Some((b, _)) if degenerate > 40 => self.basic[i] < self.basic[b],
                        Some((_, best)) => m.abs() > best,
                    };
                    if better {
                        leaving = Some((i, m.abs()));
                    }
                }
            }
            let (r, m) = leaving?;
            degenerate = if self.beta[r].max(0.0) / m > 1e-12 { 0 } else { degenerate + 1 };
            self.pivot(r, c);
        }
        Some((weights.iter().map(|&(x, w)| w * self.value(x)).sum(), finished))
    }
}
