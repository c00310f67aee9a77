//! Directions with forces in equilibrium in spite of rounding errors of the factorisation.
//!
//! Near the optimum flexibilities differ by 1e26. Parts of a wall that move together are connected by stiff joints, and
//! rest on soft ones; rounding errors of the stiff entries exceed the soft entries. For some motions the factors are
//! then completely wrong, and ordinary iterative refinement fails. Corrections are therefore conjugate gradients with
//! the factorisation as preconditioner. Products with the matrix are computed joint by joint, as exactly as the forces.
//! A few wrong motions then need a few corrections.
//!
//! Corrections (c, τ) satisfy p·c + k τ = 0 with k the stiffness of the cap; on this space the preconditioner is a
//! projection. Source: Gould, Hribar and Nocedal (2001), *SIAM J. Sci. Comput.* 23, 1376–1395.

use super::directions::{Directions, cap_stiffness};
use super::residuals::{Residuals, greatest};
use super::state::{State, Step};
use super::wanted::Wanted;
use crate::limit::settings::SETTINGS;
use crate::linear::inner;

/// Greatest number of corrections of a direction, and its accepted error of equilibrium relative to the gap.
const MAX_CORRECTIONS: usize = 12;
/// Number of successive corrections that do not halve the error, after which the refinement stops.
const MAX_IDLE_CORRECTIONS: usize = 2;

/// A change of velocities and of θ, with r·c of its residual r.
struct Correction {
    motion: Vec<f64>,
    theta: f64,
    product: f64,
}

impl Directions<'_> {
    /// Computes a direction with forces in equilibrium.
    ///
    /// Changes of forces follow from changes of velocities by flexibilities of up to 1e16. Corrections are added to the
    /// forces, so that only the rounding error of the last correction is magnified.
    pub fn refined(&mut self, state: &State, residuals: &Residuals, wanted: &Wanted, moves: bool, step: &mut Step) {
        let program = self.program;
        let aim = (SETTINGS.missed * state.gap()).max(SETTINGS.exhausted);
        let stiff = cap_stiffness(program, state);
        let mut before: Option<Correction> = None;
        let (mut least, mut idle) = (f64::INFINITY, 0);
        for _ in 0..MAX_CORRECTIONS {
            let mut left: Vec<f64> =
                residuals.equilibrium.iter().zip(&program.varying).map(|(r, p)| r + step.theta * p).collect();
            program.members.iter().zip(&step.x).for_each(|(member, x)| program.press(member, x, &mut left));
            let error = greatest(&left);
            idle = if error < 0.5 * least { 0 } else { idle + 1 };
            least = least.min(error);
            if error < aim || idle == MAX_IDLE_CORRECTIONS {
                break;
            }
            let correction = self.conjugate(&left, stiff, moves, before.as_ref());
            let Some(length) = self.length(&correction, stiff) else { break };
            step.theta += length * correction.theta;
            let change: Vec<f64> = correction.motion.iter().map(|c| length * c).collect();
            step.q.iter_mut().zip(&change).for_each(|(q, c)| *q += c);
            self.follow(&change, step);
            before = Some(correction);
        }
        if before.is_some() {
            self.complete(state, residuals, wanted, step);
        }
    }

    /// Returns the correction for the equilibrium error `left`, conjugate to the previous correction.
    fn conjugate(&mut self, left: &[f64], stiff: f64, moves: bool, before: Option<&Correction>) -> Correction {
        let varying = &self.program.varying;
        let (mut motion, mut theta, mut product) = (left.to_vec(), 0.0, 0.0);
        self.stiffness.solve(&mut motion);
        if moves {
            theta = -inner(varying, &motion) / (inner(varying, &self.v) + stiff);
            motion.iter_mut().zip(&self.v).for_each(|(c, v)| *c += theta * v);
            // The part of `left` along p does no work on the motion; without it the product loses fewer digits.
            product = theta * (inner(varying, &motion) + stiff * theta);
        }
        product += inner(left, &motion);
        if let Some(before) = before {
            let share = product / before.product;
            motion.iter_mut().zip(&before.motion).for_each(|(c, d)| *c += share * d);
            theta += share * before.theta;
        }
        Correction { motion, theta, product }
    }

    /// Returns the length of a correction. `None` if its stiffness is lost in rounding.
    fn length(&self, correction: &Correction, stiff: f64) -> Option<f64> {
        let resisted = self.resisted(&correction.motion);
        let length = correction.product / (resisted + stiff * correction.theta * correction.theta);
        (length.is_finite() && length > 0.0).then_some(length)
    }
}
