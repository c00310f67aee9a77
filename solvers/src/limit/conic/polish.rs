//! Improves a solution from 1e-8 to rounding: Newton's method on the optimality system of the active rows.
//!
//! Stationarity −e_θ + Eᵀ q + Σ y_i ∇c_i(x) = 0, equilibrium E x = b, c_i(x) = 0 for active i. Degenerate optima make
//! the system singular but consistent. It is therefore regularised by ±δ and iterated, which converges to the solution
//! nearest to the start.
//!
//! Rows enter and leave by the signs of slacks and multipliers.

use super::interior_point::Pair;
use super::system::System;
use crate::limit::nearest;
use crate::limit::settings::SETTINGS;
use voussoir_core::limit::SparseRow;
use voussoir_core::linear::{Entries, SparseLdlt};

/// Least factor, in its unit, to which a gap is related.
const LEAST_FACTOR: f64 = 1e-3;
/// Number of steps without gain after which the iteration stops.
const MAX_STEPS_WITHOUT_GAIN: usize = 4;

/// A polished pair.
pub struct Polished {
    /// The pair.
    pub pair: Pair,
    /// Greatest residual of the optimality system, violation and negative multiplier.
    pub error: f64,
    /// True if the mechanism is the only one.
    pub unique: bool,
    /// Factorisations done.
    pub factorisations: u64,
    /// Newton iterations done.
    pub iterations: u64,
}

#[derive(Clone, Copy, PartialEq)]
enum Item {
    SparseRow(usize),
    Block(usize),
}

fn dot(row: &SparseRow, x: &[f64]) -> f64 {
    row.iter().map(|&(j, v)| v * x[j]).sum()
}

fn value(system: &System, item: Item, x: &[f64]) -> f64 {
    match item {
        Item::SparseRow(i) => dot(&system.rows[i], x) - system.bounds[i],
        Item::Block(k) => system.blocks[k].value(x),
    }
}

fn multiplier(pair: &Pair, item: Item) -> f64 {
    match item {
        Item::SparseRow(i) => pair.rows[i],
        Item::Block(k) => pair.blocks[k],
    }
}

/// Polishes a pair. `None` if every factorisation fails.
pub fn polish(system: &System, approximate: &Pair) -> Option<Polished> {
    // The greater shift is tried if the smaller one leaves no pivot.
    [SETTINGS.shift, SETTINGS.great_shift].iter().find_map(|&delta| polish_with(system, approximate, delta))
}

/// Returns the interior point moved the shortest way to equilibrium, for use if the polish does not converge. Its
/// slacks are its own and its motion is that of the conic solver; the certificate checks it.
pub fn balanced(system: &System, approximate: &Pair) -> Option<Pair> {
    let (x, _) = nearest::nearest(&system.equations, &system.right, approximate.x.clone())?;
    Some(Pair { x, ..approximate.clone() })
}

fn polish_with(system: &System, approximate: &Pair, delta: f64) -> Option<Polished> {
    let items: Vec<Item> =
        (0..system.rows.len()).map(Item::SparseRow).chain((0..system.blocks.len()).map(Item::Block)).collect();
    let mut active: Vec<bool> =
        items.iter().map(|&item| multiplier(approximate, item) > -value(system, item, &approximate.x)).collect();
    let mut best: Option<Polished> = None;
    let (mut factorisations, mut iterations) = (0, 0);
    for _ in 0..6 {
        let chosen: Vec<Item> = items.iter().zip(&active).filter(|(_, a)| **a).map(|(item, _)| *item).collect();
        let mut newton = Newton { system, active: &chosen, pair: clipped(approximate, &items, &active), delta };
        let Some(work) = newton.run() else { break };
        factorisations += work.0;
        iterations += work.1;
        let pair = newton.pair;
        let scale = greatest_multiplier(&pair);
        let mut error = work.2;
        let mut changed = false;
        for (item, active) in items.iter().zip(&mut active) {
            let (y, c) = (multiplier(&pair, *item), value(system, *item, &pair.x));
            if *active && y < -SETTINGS.rounding * scale {
                error = error.max(-y / scale);
                *active = false;
                changed = true;
            } else if !*active && c > SETTINGS.rounding {
                error = error.max(c);
                *active = true;
                changed = true;
            }
        }
        if best.as_ref().is_none_or(|b| error < b.error) {
            let unique = !has_kernel(system, &chosen, &pair, scale, delta).unwrap_or(true);
            best = Some(Polished { pair, error, unique, factorisations, iterations });
        }
        if !changed || best.as_ref().is_some_and(|b| b.error < SETTINGS.rounding) {
            break;
        }
    }
    let best = best?;
    let error = best.error.max(gap(system, &best.pair) / best.pair.x[system.theta].abs().max(LEAST_FACTOR));
    Some(Polished { factorisations, iterations, error, ..best })
}

/// Returns the possible change of θ from violations of equilibrium and of the carrying rows: each times its multiplier.
fn gap(system: &System, pair: &Pair) -> f64 {
    let equations = system.equations.iter().zip(&system.right).zip(&pair.equations);
    let left = equations.map(|((row, right), q)| (q * (dot(row, &pair.x) - right)).abs());
    let rows = (0..system.rows.len()).map(|row| (pair.rows[row] * value(system, Item::SparseRow(row), &pair.x)).abs());
    let blocks = (0..system.blocks.len()).map(|k| (pair.blocks[k] * system.blocks[k].value(&pair.x)).abs());
    left.chain(rows).chain(blocks).sum()
}

fn greatest_multiplier(pair: &Pair) -> f64 {
    pair.rows.iter().chain(&pair.blocks).fold(1.0f64, |m, y| m.max(y.abs()))
}

/// Returns the pair with zero multipliers of inactive rows.
fn clipped(pair: &Pair, items: &[Item], active: &[bool]) -> Pair {
    let mut pair = pair.clone();
    for (item, active) in items.iter().zip(active) {
        match item {
            Item::SparseRow(i) if !active => pair.rows[*i] = 0.0,
            Item::Block(k) if !active => pair.blocks[*k] = 0.0,
            _ => {}
        }
    }
    pair
}

struct Newton<'a> {
    system: &'a System,
    active: &'a [Item],
    pair: Pair,
    delta: f64,
}

impl Newton<'_> {
    fn gradients(&self) -> Vec<SparseRow> {
        gradients(self.system, self.active, &self.pair.x)
    }

    /// Returns the residual of the optimality system: stationarity, then equations, then active rows.
    fn residual(&self, gradients: &[SparseRow]) -> Vec<f64> {
        let system = self.system;
        let (n, e) = (system.variables, system.equations.len());
        let mut residual = vec![0.0; n + e + self.active.len()];
        residual[system.theta] = -1.0;
        for (i, row) in system.equations.iter().enumerate() {
            row.iter().for_each(|&(j, v)| residual[j] += v * self.pair.equations[i]);
            residual[n + i] = dot(row, &self.pair.x) - system.right[i];
        }
        for (k, (item, row)) in self.active.iter().zip(gradients).enumerate() {
            let y = multiplier(&self.pair, *item);
            row.iter().for_each(|&(j, v)| residual[j] += v * y);
            residual[n + e + k] = value(system, *item, &self.pair.x);
        }
        residual
    }

    /// Iterates. Returns the numbers of factorisations and iterations, and the last residual.
    fn run(&mut self) -> Option<(u64, u64, f64)> {
        let system = self.system;
        let (n, e) = (system.variables, system.equations.len());
        let curved = self.active.iter().any(|item| matches!(item, Item::Block(_)));
        let mut factorised: Option<SparseLdlt> = None;
        let (mut factorisations, mut iterations) = (0, 0);
        let mut best = (f64::INFINITY, self.pair.clone());
        let mut without_gain = 0;
        loop {
            let gradients = self.gradients();
            let residual = self.residual(&gradients);
            let error = residual.iter().fold(0.0f64, |m, r| m.max(r.abs()));
            if error < 0.5 * best.0 {
                without_gain = 0;
            } else {
                without_gain += 1;
            }
            if error < best.0 {
                best = (error, self.pair.clone());
            }
            if error <= 1e-16 || iterations >= 40 || without_gain >= MAX_STEPS_WITHOUT_GAIN {
                break;
            }
            if factorised.is_none() || (curved && iterations < 12) {
                factorised = Some(SparseLdlt::new(residual.len(), n, &self.matrix(&gradients))?);
                factorisations += 1;
            }
            let step = factorised.as_ref()?.solve(&residual)?;
            iterations += 1;
            (0..n).for_each(|j| self.pair.x[j] -= step[j]);
            (0..e).for_each(|i| self.pair.equations[i] -= step[n + i]);
            for (k, item) in self.active.iter().enumerate() {
                match item {
                    Item::SparseRow(i) => self.pair.rows[*i] -= step[n + e + k],
                    Item::Block(b) => self.pair.blocks[*b] -= step[n + e + k],
                }
            }
        }
        self.pair = best.1;
        Some((factorisations, iterations, best.0))
    }

    fn matrix(&self, gradients: &[SparseRow]) -> Entries {
        let mut entries = saddle(self.system, gradients, self.delta);
        for item in self.active {
            if let Item::Block(k) = item {
                let block = &self.system.blocks[*k];
                let curvature = 2.0 * self.pair.blocks[*k].max(0.0) / block.strength.total;
                for &i in &block.normal {
                    block.normal.iter().for_each(|&j| entries.push((i, j, curvature)));
                }
            }
        }
        entries
    }
}

fn gradients(system: &System, active: &[Item], x: &[f64]) -> Vec<SparseRow> {
    let gradient = |item: &Item| match item {
        Item::SparseRow(i) => system.rows[*i].clone(),
        Item::Block(k) => system.blocks[*k].gradient(x),
    };
    active.iter().map(gradient).collect()
}

/// Returns \[δ I, Jᵀ; J, −δ I\] with J the equations and the gradients.
fn saddle(system: &System, gradients: &[SparseRow], delta: f64) -> Entries {
    nearest::saddle(system.variables, system.equations.iter().chain(gradients), [delta, delta])
}

/// Returns true if other multipliers (q, y) satisfy Eᵀ q + Σ y_i ∇c_i = e_θ with the same support. Inverse iteration
/// finds the least singular value of J, whose columns are the rows with positive multipliers.
fn has_kernel(system: &System, active: &[Item], pair: &Pair, scale: f64, delta: f64) -> Option<bool> {
    let support: Vec<Item> = active.iter().copied().filter(|item| multiplier(pair, *item) > 1e-10 * scale).collect();
    let rows = gradients(system, &support, &pair.x);
    let (n, m) = (system.variables, system.equations.len() + rows.len());
    let factorised = SparseLdlt::new(n + m, n, &saddle(system, &rows, delta))?;
    // A fixed, irregular start: no symmetry of the scene is orthogonal to it.
    let mut v: Vec<f64> = (0..m).map(|i| 1.0 + 0.37 * ((i as f64 * 0.754_877_666 + 0.1).fract() - 0.5)).collect();
    let mut least = f64::INFINITY;
    for _ in 0..8 {
        let norm = v.iter().map(|a| a * a).sum::<f64>().sqrt();
        v.iter_mut().for_each(|a| *a /= norm);
        let mut right = vec![0.0; n];
        right.extend(&v);
        v = factorised.solve(&right)?[n..].to_vec();
        // Now v = −δ (δ² + J Jᵀ)⁻¹ times the old unit vector.
        let gain = v.iter().map(|a| a * a).sum::<f64>().sqrt();
        least = delta / gain;
    }
    // least = δ² + σ²: it is δ² if a kernel exists.
    Some(least < 1e3 * delta * delta)
}
