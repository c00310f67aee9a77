//! The required decrease of the products of slacks and multipliers in a direction.

use super::cone::ROWS;
use super::state::{State, Step};

/// Range of the products s z after a step, relative to their mean, outside which a corrector moves them. The upper
/// value also limits the change of one product.
const PRODUCT_RANGE: [f64; 2] = [0.1, 10.0];

/// Required decrease of the products s z; 0 for rows that a joint does not have.
#[derive(Debug, Clone)]
pub struct Wanted {
    pub(super) rows: Vec<[f64; ROWS]>,
    pub(super) cap: f64,
}

impl Wanted {
    /// Creates zeros for `count` joints.
    pub fn none(count: usize) -> Self {
        Wanted { rows: vec![[0.0; ROWS]; count], cap: 0.0 }
    }

    /// Requires all of s z, for a predictor.
    pub fn all(&mut self, state: &State) {
        for (rows, (s, z)) in self.rows.iter_mut().zip(state.slacks.iter().zip(&state.multipliers)) {
            *rows = std::array::from_fn(|row| s[row] * z[row]);
        }
        self.cap = state.cap[0] * state.cap[1];
    }

    /// Reduces the required decrease by `mean`.
    pub fn but(&mut self, state: &State, mean: f64) {
        for (rows, z) in self.rows.iter_mut().zip(&state.multipliers) {
            (0..ROWS).for_each(|row| rows[row] -= if z[row] > 0.0 { mean } else { 0.0 });
        }
        self.cap -= mean;
    }

    /// Adds the products of the changes in a predictor.
    pub fn and_second_order(&mut self, predictor: &Step) {
        for (rows, (ds, dz)) in self.rows.iter_mut().zip(predictor.slacks.iter().zip(&predictor.multipliers)) {
            (0..ROWS).for_each(|row| rows[row] += ds[row] * dz[row]);
        }
        self.cap += predictor.cap[0] * predictor.cap[1];
    }

    /// Copies another object, and moves products towards `mean` that would be far from it after steps of these lengths.
    pub fn centre(&mut self, other: &Wanted, state: &State, step: &Step, lengths: [f64; 2], mean: f64) {
        let off = |s: f64, ds: f64, z: f64, dz: f64| {
            let product = (s + lengths[0] * ds) * (z + lengths[1] * dz);
            // No clamp: without rows the mean is NaN, and clamp panics.
            let near = product.max(PRODUCT_RANGE[0] * mean).min(PRODUCT_RANGE[1] * mean);
            let moved = (near - product).max(-PRODUCT_RANGE[1] * mean);
            if z > 0.0 { moved } else { 0.0 }
        };
        let states = state.slacks.iter().zip(&state.multipliers);
        let steps = step.slacks.iter().zip(&step.multipliers);
        for ((rows, other), ((s, z), (ds, dz))) in self.rows.iter_mut().zip(&other.rows).zip(states.zip(steps)) {
            *rows = std::array::from_fn(|row| other[row] - off(s[row], ds[row], z[row], dz[row]));
        }
        self.cap = other.cap - off(state.cap[0], step.cap[0], state.cap[1], step.cap[1]);
    }
}
