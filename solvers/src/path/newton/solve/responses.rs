//! The response of the structure to gap rates of the active set and to the load, with the points of the active set stuck.

use super::active_set::ActiveSet;
use crate::contact::mode::ContactMode;
use crate::path::newton::model::equations::Equations;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::response::traction_row;
use crate::settings::SETTINGS;
use voussoir_core::linear::{Entries, SparseLu};

/// Responses to unit rates, and the factors that combine them.
pub struct Responses {
    /// The rates of all unknowns except λ for a unit gap rate in each of the two directions of every point of the
    /// active set and, last, for λ̇ = 1 in the sense of the load step.
    pub unit: Vec<Vec<f64>>,
    /// Right-hand sides of the same rates.
    right: Vec<Vec<f64>>,
    factors: SparseLu,
}

impl Responses {
    /// Computes the responses. `None` if linear algebra fails. The factors of steps do not serve: their added terms are
    /// greater, so that the combinations of modes of a softening block are decided by rounding.
    pub fn new(
        system: &StepSystem,
        state: &State,
        active: &ActiveSet,
        equations: &Equations,
        direction: f64,
    ) -> Option<Self> {
        let size = system.size() - 1;
        let forces = equations.gaps.len();
        // −∂/∂λ of gaps and balance.
        let driven =
            |row: &[(usize, f64)]| -> f64 { row.iter().filter(|e| e.0 == size).map(|e| -direction * e.1).sum() };
        let (mut entries, mut shift): (Entries, Entries) = (Vec::new(), Vec::new());
        let mut load = vec![0.0; size];
        let add = |i: usize, row: &[(usize, f64)], by: f64, entries: &mut Entries| {
            entries.extend(row.iter().filter(|e| e.0 < size).map(|&(j, v)| (i, j, by * v)));
        };
        for (c, mode) in active.modes.iter().enumerate() {
            let gap: [Vec<(usize, f64)>; 2] = [0, 1].map(|k| equations.gaps.row(2 * c + k).collect());
            let law = system.law(c).map_or(&[][..], |law| &law.facets);
            let rows = if system.laws.responses.is(c) { traction_rows(system, state, c) } else { mode.rows(law)? };
            for (k, own) in rows.into_iter().enumerate() {
                let i = 2 * c + k;
                entries.extend((0..2).filter(|t| own[*t] != 0.0).map(|t| (i, 2 * c + t, own[t])));
                for t in (0..2).filter(|t| own[2 + t] != 0.0) {
                    add(i, &gap[t], own[2 + t], &mut entries);
                    load[i] += own[2 + t] * driven(&gap[t]);
                }
                if *mode == ContactMode::Stick && !system.laws.responses.is(c) {
                    shift.push((i, i, SETTINGS.shift()));
                }
            }
        }
        for row in 0..equations.bodies.len() {
            let (i, own) = (forces + row, equations.bodies.row(row));
            add(i, own, 1.0, &mut entries);
            load[i] = driven(own);
            shift.push((i, i, -SETTINGS.shift()));
        }
        let unit = |i: usize| (0..size).map(|j| f64::from(u8::from(i == j))).collect();
        let mut right: Vec<Vec<f64>> = active.contacts.iter().flat_map(|c| [2 * c, 2 * c + 1]).map(unit).collect();
        right.push(load);
        let factors = SparseLu::shifted(size, &entries, &shift)?;
        let found = Responses { unit: factors.solve(&right, 3)?, right, factors };
        let solved = |(x, right): (&Vec<f64>, &Vec<f64>)| {
            let parts = entries.iter().map(|&(_, j, v)| (v * x[j]).abs()).fold(0.0, f64::max);
            found.factors.left(right, x).iter().all(|left| left.abs() <= SETTINGS.admissible * parts)
        };
        found.unit.iter().zip(&found.right).all(solved).then_some(found)
    }

    /// Returns the unknowns without λ for gap rates of the active set and λ̇; λ̇ = 0 means a held load. Responses to unit
    /// rates may cancel in a motion that hardly deforms the structure: their sum is corrected by its residual.
    pub fn combined(&self, gaps: &[[f64; 2]], factor: f64) -> Option<Vec<f64>> {
        let mut x = sum(&self.unit, gaps, factor);
        let left = self.factors.left(&sum(&self.right, gaps, factor), &x);
        let correction = self.factors.solve(&[left], 1)?.swap_remove(0);
        x.iter_mut().zip(correction).for_each(|(x, correction)| *x += correction);
        Some(x)
    }
}

/// Returns the sum of columns multiplied by gap rates and, last, by λ̇.
fn sum(columns: &[Vec<f64>], gaps: &[[f64; 2]], factor: f64) -> Vec<f64> {
    let mut sum = vec![0.0; columns.first().map_or(0, Vec::len)];
    for (by, share) in columns.iter().zip(gaps.as_flattened().iter().chain([&factor])) {
        sum.iter_mut().zip(by).for_each(|(sum, by)| *sum += share * by);
    }
    sum
}

/// Returns the rows [by force, by gap] of a contact point with a law of tractions from gaps: dr + K dg = 0, scaled.
fn traction_rows(system: &StepSystem, state: &State, contact: usize) -> [[f64; 4]; 2] {
    let (own, stiffness) = traction_row(system, state, contact);
    [[own[0], 0.0, stiffness[0][0], stiffness[0][1]], [0.0, own[1], stiffness[1][0], stiffness[1][1]]]
}
