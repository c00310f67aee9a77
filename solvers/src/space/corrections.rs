//! Corrections of equilibrium: conjugate gradients with the factorised stiffness as preconditioner.
//!
//! Near the optimum flexibilities of points differ by 1e24. Bodies that move together are joined by stiff points and
//! rest on soft ones, and rounding of the stiff entries exceeds the soft entries. The factors are then wrong for a few
//! motions. Products with the matrix are computed point by point, so that a few corrections remove these errors.

use super::cone::{Cone, inner};
use super::interior_point::{InteriorPoint, dot};
use super::program::Bodies;

/// The directions of a sequence of corrections.
#[derive(Default)]
pub struct Corrections {
    before: Option<(Bodies, f64)>,
}

impl Corrections {
    /// Returns the motion that removes an error of equilibrium, and the decrease of the forces that goes with it. `None`
    /// if it is lost in rounding.
    pub fn next(&mut self, method: &mut InteriorPoint, left: &[f64]) -> Option<(Bodies, Vec<Cone>)> {
        let mut motion = left.to_vec();
        method.stiffness.solve(&mut motion);
        let product = dot(left, &motion);
        if let Some((before, earlier)) = &self.before {
            let share = product / earlier;
            motion.iter_mut().zip(before).for_each(|(c, d)| *c += share * d);
        }
        let rates = method.program.rates(&motion);
        let mut change: Vec<Cone> = rates.iter().zip(&method.scalings).map(|(z, scaling)| scaling.square(z)).collect();
        let resisted: f64 = rates.iter().zip(&change).map(|(z, y)| inner(z, y)).sum();
        let length = product / resisted;
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        self.before = Some((motion.clone(), product));
        motion.iter_mut().chain(change.iter_mut().flatten()).for_each(|x| *x *= length);
        Some((motion, change))
    }
}
