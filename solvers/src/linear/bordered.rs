//! A dense control row outside the equations of points and bodies.
//!
//! The row of an arc length or a displacement is dense: inside the matrix it would fill the factors. The equations
//! above it, K x = f with one unknown more than rows, are factorised with one unknown x_k held. The control selects one
//! of their solutions,
//!
//! ```text
//! [K; e_kᵀ] z = (f, 0)     [K; e_kᵀ] w = (0, 1)     x = z + t w,   t = (l − c·z) / (c·w)
//! ```
//!
//! w spans the null space of K: the rate along the path. It exists also at limit points, where K without the column of
//! λ is singular, if x_k moves along the path. If |w_k| is small compared with the greatest |w|, the unknown that moves
//! most is held instead (local parametrisation: Rheinboldt 1980, SIAM J. Numer. Anal. 17, 221-237). Two solutions and a
//! quotient amplify rounding errors; refinement with all rows, the control row included, removes them (Govaerts 1991,
//! SIAM J. Matrix Anal. Appl. 12, 469-483).

use super::factorised::{Factorised, row_error};
use super::inner;
use crate::settings::SETTINGS;
use std::rc::Rc;

/// Greatest number of entries of a control row that is part of the matrix.
const SPARSE: usize = 4;

/// The last row of factorised equations.
enum Last {
    /// The control.
    Control(Vec<(usize, f64)>),
    /// An unknown that is held, with w.
    Unknown(Vec<f64>),
}

/// Factorised equations without a control: they serve every control that is a border.
pub struct BorderedFactors<E> {
    equations: E,
    last: Last,
}

/// Factorised equations with a control.
pub struct BorderedSystem<E> {
    held: Rc<BorderedFactors<E>>,
    /// The control row with c·w, if it is not part of the matrix.
    border: Option<(Vec<f64>, f64)>,
}

/// Returns the index of the greatest magnitude.
fn greatest(v: &[f64]) -> usize {
    (0..v.len()).fold(0, |best, i| if v[i].abs() > v[best].abs() { i } else { best })
}

/// Returns the entries of a control row, if it is part of the matrix.
fn few(control: &[f64]) -> Option<Vec<(usize, f64)>> {
    let entries = || control.iter().enumerate().filter(|(_, v)| **v != 0.0);
    (entries().nth(SPARSE).is_none()).then(|| entries().map(|(j, v)| (j, *v)).collect())
}

impl<E: Factorised> BorderedFactors<E> {
    /// Creates factors: `factorise` factorises the equations with a given last row, as the `control` of `contacts`
    /// points requires. `None` if they are singular.
    pub fn new(
        contacts: usize,
        control: &[f64],
        mut factorise: impl FnMut(Vec<(usize, f64)>) -> Option<E>,
    ) -> Option<Self> {
        let size = control.len();
        let last = size - 1;
        if let Some(few) = few(control) {
            let equations = factorise(few.clone())?;
            return Some(BorderedFactors { equations, last: Last::Control(few) });
        }
        let end: Vec<f64> = (0..size).map(|i| f64::from(u8::from(i == last))).collect();
        let mut held = 2 * contacts + greatest(&control[2 * contacts..]);
        for again in [true, false] {
            let equations = factorise(vec![(held, 1.0)])?;
            if let Some(w) = equations.apply(&end) {
                let most = 2 * contacts + greatest(&w[2 * contacts..]);
                if !again || w[held].abs() >= SETTINGS.fine * w[most].abs() {
                    return Some(BorderedFactors { equations, last: Last::Unknown(w) });
                }
                held = most;
            } else {
                held = last;
            }
        }
        None
    }

    /// Returns the equations; their last row replaces the control.
    pub fn equations(&self) -> &E {
        &self.equations
    }

    /// Returns true if the factors serve a control.
    pub fn serves(&self, control: &[f64]) -> bool {
        match (&self.last, few(control)) {
            (Last::Control(own), Some(few)) => *own == few,
            (Last::Unknown(_), None) => true,
            _ => false,
        }
    }

    /// Returns true if the factors serve a control of few unknowns, either directly or as a border with c·w ≠ 0.
    pub fn borders(&self, control: &[f64]) -> bool {
        let Last::Unknown(w) = &self.last else { return self.serves(control) };
        let size = control[greatest(control)].abs();
        let along = inner(control, w).abs();
        along >= SETTINGS.distinct() * size * w[greatest(w)].abs() && along != 0.0
    }
}

impl<E: Factorised> BorderedSystem<E> {
    /// Adds a control that the factorised equations serve. `None` if it is orthogonal to w.
    pub fn new(held: Rc<BorderedFactors<E>>, control: &[f64]) -> Option<Self> {
        let border = match &held.last {
            Last::Control(_) => None,
            Last::Unknown(w) => Some((control.to_vec(), Some(inner(control, w)).filter(|along| *along != 0.0)?)),
        };
        Some(BorderedSystem { held, border })
    }

    /// Returns the equations above the control, with the control row or an unknown held in its place.
    pub fn equations(&self) -> &E {
        &self.held.equations
    }

    /// Moves a solution z of the equations above the control along w until c·z has a value. z has the unknowns from
    /// `first`; the control has none before them.
    pub fn onto_control(&self, z: &mut [f64], first: usize, value: f64) {
        let (Last::Unknown(w), Some((control, along))) = (&self.held.last, &self.border) else { return };
        let t = (value - inner(&control[first..], z)) / along;
        z.iter_mut().zip(&w[first..]).for_each(|(z, w)| *z += t * w);
    }

    /// Solves once, without refinement.
    pub fn apply(&self, right: &[f64]) -> Option<Vec<f64>> {
        if self.border.is_none() {
            return self.held.equations.apply(right);
        }
        let mut above = right.to_vec();
        let value = std::mem::take(above.last_mut()?);
        let mut z = self.held.equations.apply(&above)?;
        self.onto_control(&mut z, 0, value);
        z.iter().all(|v| v.is_finite()).then_some(z)
    }

    /// Returns the residual of all rows for a right-hand side, and the greatest backward error of a row.
    pub fn left(&self, right: &[f64], x: &[f64]) -> (Vec<f64>, f64) {
        let Some((control, _)) = &self.border else { return self.held.equations.errors(right, x) };
        // The last row is the control, not the row of the held unknown.
        let last = right.len() - 1;
        let mut above = right.to_vec();
        above[last] = self.held.equations.last_row_dot(x);
        let (mut left, error) = self.held.equations.errors(&above, x);
        let (mut own, mut size) = (right[last], right[last].abs());
        for (c, x) in control.iter().zip(x) {
            own -= c * x;
            size += (c * x).abs();
        }
        left[last] = own;
        (left, error.max(row_error(own, size)))
    }
}
