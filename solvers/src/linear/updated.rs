//! One factorisation that serves while few contact points change their two rows (Sherman, Morrison & Woodbury).
//!
//! ```text
//! B x_0 = f     B Y = [e_i]     x = x_0 + Y ε
//! ```
//!
//! B: the rows that were factorised; Y: the responses to unit right-hand sides of the two rows of a changed point; ε
//! such that its present rows hold. x_0 and Y are kept without the forces that [`condensed`](super::condensed)
//! takes out.

use super::condensed::Condensed;
use std::collections::BTreeMap;

/// Response to a unit right-hand side of a row of a point.
pub struct Column {
    /// Kept unknowns.
    pub y: Vec<f64>,
    /// All unknowns, refined.
    pub x: Option<Vec<f64>>,
}

/// Factors with the responses that are known.
pub struct UpdatedFactorisation {
    /// Of B.
    pub factors: Condensed,
    columns: BTreeMap<usize, [Column; 2]>,
}

impl UpdatedFactorisation {
    /// Without responses.
    pub fn new(factors: Condensed) -> Self {
        UpdatedFactorisation { factors, columns: BTreeMap::new() }
    }

    /// Forgets all responses.
    pub fn forget_responses(&mut self) {
        self.columns.clear();
    }

    /// Makes sure that the responses to the rows of a point are known, refined so often. Returns how many right-hand
    /// sides that took; `None` where they are not found.
    pub fn respond(&mut self, contact: usize, refinements: usize) -> Option<u64> {
        if self.columns.contains_key(&contact) {
            return Some(0);
        }
        let columns = if refinements == 0 {
            self.factors.units(contact)?.map(|y| Column { y, x: None })
        } else {
            let equations = &self.factors;
            let refined = |row: usize| {
                let mut right = equations.nothing().0;
                right[row] = 1.0;
                let x = equations.solve(&right, refinements)?;
                Some(Column { y: equations.kept_of(&x), x: Some(x) })
            };
            [refined(2 * contact)?, refined(2 * contact + 1)?]
        };
        self.columns.insert(contact, columns);
        Some(2)
    }

    /// The responses to the rows of a point, where they are known.
    pub fn columns(&self, contact: usize) -> Option<&[Column; 2]> {
        self.columns.get(&contact)
    }

    /// Number of points whose responses are known.
    pub fn responses(&self) -> usize {
        self.columns.len()
    }

    /// A row times a solution of which the kept unknowns and the right-hand sides of the points are given; `own`: the
    /// force of a point that is known.
    pub fn row_dot(
        &self,
        row: impl Iterator<Item = (usize, f64)>,
        (contact, own): (usize, [f64; 2]),
        right: &impl Fn(usize) -> [f64; 2],
        y: &[f64],
    ) -> f64 {
        let equations = &self.factors;
        let forces = 2 * equations.contacts();
        let value = |j: usize| match j {
            j if j / 2 == contact => own[j % 2],
            j if j < forces => equations.force(j / 2, right(j / 2), y)[j % 2],
            j => equations.other(j, y),
        };
        row.map(|(j, v)| v * value(j)).sum()
    }

    /// Adds the responses of a point times ε to kept unknowns.
    pub fn add(&self, contact: usize, epsilon: [f64; 2], y: &mut [f64]) {
        let Some(columns) = self.columns.get(&contact) else { return };
        for (k, column) in columns.iter().enumerate() {
            y.iter_mut().zip(&column.y).for_each(|(y, v)| *y += epsilon[k] * v);
        }
    }
}
