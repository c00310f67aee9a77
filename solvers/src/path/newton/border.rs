//! The control's row beside the equations of points and bodies.
//!
//! The row of an arc length or a displacement is dense: inside the matrix it would fill the factors. The
//! equations above it, K x = f with one unknown more than rows, are factorised with one unknown x_k held
//! in its place, and the control chooses among their solutions,
//!
//! ```text
//! [K; e_kᵀ] z = (f, 0)     [K; e_kᵀ] w = (0, 1)     x = z + t w,   t = (l − c·z) / (c·w)
//! ```
//!
//! w spans the null space of K: the rate along the path. It exists at limit points too, where K without
//! the column of λ is singular, as long as x_k moves along the path: where |w_k| is small beside the
//! greatest |w|, the unknown that moves most is held instead (local parametrisation: Rheinboldt 1980,
//! SIAM J. Numer. Anal. 17, 221-237). Two solutions and a quotient amplify rounding; refinement against
//! all rows, the control's included, takes that out again (Govaerts 1991, SIAM J. Matrix Anal. Appl. 12,
//! 469-483).

use crate::lu::Entries;
use crate::path::condensed::{Condensed, pair};

/// Entries up to which the control's row is part of the matrix.
const SPARSE: usize = 4;
/// Least rate of the unknown that is held, relative to the greatest.
const MOVES: f64 = 1e-4;

/// Factorised equations with a control.
pub(super) struct Bordered {
    equations: Condensed,
    /// The control's row with its w and c·w, where it is not part of the matrix.
    border: Option<(Vec<f64>, Vec<f64>, f64)>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Index of the greatest magnitude.
fn greatest(v: &[f64]) -> usize {
    (0..v.len()).fold(0, |best, i| if v[i].abs() > v[best].abs() { i } else { best })
}

impl Bordered {
    /// Factorises the equations above the last row with the `control` as that row. `None` where they are
    /// singular.
    pub fn new(size: usize, contacts: usize, equations: Entries, shift: &Entries, control: &[f64]) -> Option<Self> {
        let mut equations = equations;
        let last = size - 1;
        let few: Entries = control.iter().enumerate().filter(|(_, v)| **v != 0.0).map(|(j, v)| (last, j, *v)).collect();
        if few.len() <= SPARSE {
            equations.extend(few);
            return Some(Bordered { equations: Condensed::new(size, contacts, &equations, shift)?, border: None });
        }
        let end: Vec<f64> = (0..size).map(|i| f64::from(u8::from(i == last))).collect();
        let mut held = 2 * contacts + greatest(&control[2 * contacts..]);
        for again in [true, false] {
            equations.push((last, held, 1.0));
            let factors = Condensed::new(size, contacts, &equations, shift)?;
            equations.pop();
            if let Some(w) = factors.apply(&end) {
                let most = 2 * contacts + greatest(&w[2 * contacts..]);
                if !again || w[held].abs() >= MOVES * w[most].abs() {
                    let along = dot(control, &w);
                    let border = Some((control.to_vec(), w, along)).filter(|_| along != 0.0)?;
                    return Some(Bordered { equations: factors, border: Some(border) });
                }
                held = most;
            } else if again {
                held = last;
            }
        }
        None
    }

    /// The equations above the control, the control's row in them or an unknown held in its place.
    pub fn equations(&self) -> &Condensed {
        &self.equations
    }

    /// What unit right-hand sides of the two rows of a contact point give, without the unknowns that
    /// are condensed out.
    pub fn units(&self, contact: usize) -> Option<[Vec<f64>; 2]> {
        let mut columns = self.equations.units(contact)?;
        if let Some((control, w, along)) = &self.border {
            let w = self.equations.kept_of(w);
            for (k, y) in columns.iter_mut().enumerate() {
                let right = |c: usize| if c == contact { pair(k, 1.0) } else { [0.0; 2] };
                let t = -self.equations.dot(control, right, y) / along;
                y.iter_mut().zip(&w).for_each(|(y, w)| *y += t * w);
            }
        }
        Some(columns)
    }

    /// Once, without refinement.
    pub fn apply(&self, right: &[f64]) -> Option<Vec<f64>> {
        let Some((control, w, along)) = &self.border else { return self.equations.apply(right) };
        let last = right.len() - 1;
        let mut above = right.to_vec();
        above[last] = 0.0;
        let mut z = self.equations.apply(&above)?;
        let t = (right[last] - dot(control, &z)) / along;
        z.iter_mut().zip(w).for_each(|(z, w)| *z += t * w);
        z.iter().all(|v| v.is_finite()).then_some(z)
    }

    /// What all rows leave of a right-hand side.
    pub fn left(&self, right: &[f64], x: &[f64]) -> Vec<f64> {
        let mut left = self.equations.left(right, x);
        if let (Some((control, ..)), Some(last)) = (&self.border, left.last_mut()) {
            *last = right[right.len() - 1] - dot(control, x);
        }
        left
    }
}
