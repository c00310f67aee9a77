//! One factorisation that is reused while few contact points change their two rows (Sherman, Morrison & Woodbury).
//!
//! ```text
//! B x_0 = f     B Y = [e_i]     x = x_0 + Y ε
//! ```
//!
//! B: the factorised rows; Y: the responses to unit right-hand sides of the two rows of a changed point; ε is
//! determined by its present rows. x_0 and Y are stored without the forces that [`condensed`](super::condensed)
//! condenses out.

use super::condensed::Condensed;
use std::collections::BTreeMap;

/// Response to a unit right-hand side of a row of a point.
pub struct Column {
    /// Kept unknowns.
    pub y: Vec<f64>,
    /// All unknowns, refined, if needed.
    pub x: Option<Vec<f64>>,
}

/// Factors with the known responses.
pub struct UpdatedFactorisation {
    /// Factors of B.
    pub factors: Condensed,
    columns: BTreeMap<usize, [Column; 2]>,
}

impl UpdatedFactorisation {
    /// Creates factors without responses.
    pub fn new(factors: Condensed) -> Self {
        UpdatedFactorisation { factors, columns: BTreeMap::new() }
    }

    /// Forgets all responses.
    pub fn forget_responses(&mut self) {
        self.columns.clear();
    }

    /// Computes the responses to the rows of a point if they are not known, with `refinements` refinements. Returns the
    /// number of right-hand sides solved; `None` if it fails.
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

    /// Returns the responses to the rows of a point, if they are known.
    pub fn columns(&self, contact: usize) -> Option<&[Column; 2]> {
        self.columns.get(&contact)
    }

    /// Returns the number of points with known responses.
    pub fn responses(&self) -> usize {
        self.columns.len()
    }

    /// Returns a row times a solution that is given by its kept unknowns and the right-hand sides of the points; `own`:
    /// the force of a point, if it is known.
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
