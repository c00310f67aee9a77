//! Directions whose forces are in equilibrium, whatever the factorisation has lost.
//!
//! Near the optimum flexibilities differ by 1e26. Parts of a wall that move as one hang together by stiff joints and on the rest by soft ones, and
//! rounding of the stiff entries drowns the soft: what the factors make of some motions is off by more than all of it, and
//! solving again for what is left gains nothing. So corrections are conjugate: the factorisation is the
//! preconditioner, and products with the matrix itself go by joints, as exact as their forces. A few motions that
//! are badly off then cost a few corrections.
//!
//! θ carries what the motions under its load would: corrections (c, τ) keep p·c + k τ = 0 with k the stiffness of the cap, and
//! on these the preconditioner is a projection. Source: Gould, Hribar and Nocedal (2001), *SIAM J. Sci. Comput.* 23, 1376–1395.

use super::directions::{Directions, cap_stiffness};
use super::residuals::{Residuals, greatest};
use super::state::{State, Step};
use super::wanted::Wanted;
use crate::limit::settings::SETTINGS;
use crate::linear::inner;

/// Corrections of a direction at the most, and the share of the gap that its equilibrium may miss.
const MOST: usize = 12;
/// Corrections in a row that do not halve what is missed, after which no other is tried.
const IDLE: usize = 2;

/// A change of velocities and of θ, with r·c of the residual it was made for.
struct Correction {
    motion: Vec<f64>,
    theta: f64,
    product: f64,
}

impl Directions<'_> {
    /// A direction whose forces are in equilibrium.
    ///
    /// Changes of forces follow those of velocities by flexibilities of up to 1e16: corrections add to them, so
    /// that only the last one's rounding is magnified.
    pub fn refined(&mut self, state: &State, residuals: &Residuals, wanted: &Wanted, moves: bool, step: &mut Step) {
        let program = self.program;
        let aim = (SETTINGS.missed * state.gap()).max(SETTINGS.exhausted);
        let stiff = cap_stiffness(program, state);
        let mut before: Option<Correction> = None;
        let (mut least, mut idle) = (f64::INFINITY, 0);
        for _ in 0..MOST {
            let mut left: Vec<f64> =
                residuals.equilibrium.iter().zip(&program.varying).map(|(r, p)| r + step.theta * p).collect();
            program.members.iter().zip(&step.x).for_each(|(member, x)| program.press(member, x, &mut left));
            let error = greatest(&left);
            idle = if error < 0.5 * least { 0 } else { idle + 1 };
            least = least.min(error);
            if error < aim || idle == IDLE {
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

    /// The correction for what is `left` out of equilibrium, conjugate to the one before.
    fn conjugate(&mut self, left: &[f64], stiff: f64, moves: bool, before: Option<&Correction>) -> Correction {
        let varying = &self.program.varying;
        let (mut motion, mut theta, mut product) = (left.to_vec(), 0.0, 0.0);
        self.stiffness.solve(&mut motion);
        if moves {
            theta = -inner(varying, &motion) / (inner(varying, &self.v) + stiff);
            motion.iter_mut().zip(&self.v).for_each(|(c, v)| *c += theta * v);
            // Of what is left the share along p is none of the motion's: without it the product loses fewer digits.
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

    /// How far a correction goes. `None` where rounding leaves it no stiffness.
    fn length(&self, correction: &Correction, stiff: f64) -> Option<f64> {
        let resisted = self.resisted(&correction.motion);
        let length = correction.product / (resisted + stiff * correction.theta * correction.theta);
        (length.is_finite() && length > 0.0).then_some(length)
    }
}
