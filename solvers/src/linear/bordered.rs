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
use super::{inner, largest};
use crate::settings::SETTINGS;
use std::cell::OnceCell;
use std::rc::Rc;

/// Greatest number of entries of a control row that is part of the matrix.
const SPARSE: usize = 4;

/// Factorised equations with a row of few unknowns at the end: they serve this row as a control, and every control that is
/// a border.
pub struct BorderedFactors<E> {
    equations: E,
    /// A control of few unknowns, or the row of a held unknown.
    last: Vec<(usize, f64)>,
    /// Number of unknowns, and of contact forces, which come first.
    sizes: [usize; 2],
    /// w; `None` if the last row hardly changes along it.
    along: OnceCell<Option<Vec<f64>>>,
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
        let sizes = [control.len(), 2 * contacts];
        let mut with = |last: Vec<(usize, f64)>| {
            let equations = factorise(last.clone())?;
            Some(BorderedFactors { equations, last, sizes, along: OnceCell::new() })
        };
        if let Some(few) = few(control) {
            return with(few);
        }
        let first = with(vec![(sizes[1] + greatest(&control[sizes[1]..]), 1.0)])?;
        if first.along().is_some() {
            return Some(first);
        }
        let held = first.homogeneous().map_or(sizes[0] - 1, |w| sizes[1] + greatest(&w[sizes[1]..]));
        let again = with(vec![(held, 1.0)])?;
        let w = again.homogeneous()?;
        Some(BorderedFactors { along: OnceCell::from(Some(w)), ..again })
    }

    /// Returns the solution of the equations above the last row for zero, of which this row is 1.
    fn homogeneous(&self) -> Option<Vec<f64>> {
        let size = self.sizes[0];
        let end: Vec<f64> = (0..size).map(|i| f64::from(u8::from(i + 1 == size))).collect();
        self.equations.apply(&end)
    }

    /// Returns w, if the last row changes along it.
    fn along(&self) -> Option<&Vec<f64>> {
        let changes = |w: &Vec<f64>| {
            let own = self.last.iter().fold(0.0, |a: f64, (_, own)| a.max(own.abs()));
            1.0 >= SETTINGS.distinct() * own * largest(&w[self.sizes[1]..])
        };
        self.along.get_or_init(|| self.homogeneous().filter(changes)).as_ref()
    }

    /// Returns the equations; their last row replaces the control.
    pub fn equations(&self) -> &E {
        &self.equations
    }

    /// Returns true if the factors serve a control, either directly or as a border with c·w ≠ 0.
    pub fn serves(&self, control: &[f64]) -> bool {
        let borders = |w: &Vec<f64>| {
            let (along, size) = (inner(control, w).abs(), largest(control) * largest(w));
            along >= SETTINGS.distinct() * size && along != 0.0
        };
        self.is_last(control) || self.along().is_some_and(borders)
    }

    fn is_last(&self, control: &[f64]) -> bool {
        few(control).is_some_and(|few| self.last == few)
    }
}

impl<E: Factorised> BorderedSystem<E> {
    /// Adds a control that the factorised equations serve. `None` if it is orthogonal to w.
    pub fn new(held: Rc<BorderedFactors<E>>, control: &[f64]) -> Option<Self> {
        if held.is_last(control) {
            return Some(BorderedSystem { held, border: None });
        }
        let along = Some(inner(control, held.along()?)).filter(|along| *along != 0.0)?;
        Some(BorderedSystem { held, border: Some((control.to_vec(), along)) })
    }

    /// Returns the equations above the control, with the control row or an unknown held in its place.
    pub fn equations(&self) -> &E {
        &self.held.equations
    }

    /// Moves a solution z of the equations above the control along w until c·z has a value. z has the unknowns from
    /// `first`; the control has none before them.
    pub fn onto_control(&self, z: &mut [f64], first: usize, value: f64) {
        let (Some((control, along)), Some(w)) = (&self.border, self.held.along()) else { return };
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
