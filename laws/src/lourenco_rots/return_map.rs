//! Return of a trial stress to the three surfaces, backward Euler, with the consistent tangent.
//!
//! For a given bond and a given multiplier of the cap, the return to the tension cut-off and to Coulomb's line has a closed
//! form. The multiplier of the cap is then the root of one equation, and the loss of bond is the root of an outer equation.
//! Both roots are bracketed, so the return does not depend on a start value and no step is too long.

use super::surface::Surface;
use voussoir_core::law::UpdateFailure;

/// The result of the return. Stresses are positive in tension, σ along the normal, τ ≥ 0 along the joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct Returned {
    /// (σ, τ) \[Pa\].
    pub stress: [f64; 2],
    /// λ_1 of tension \[m\], λ_2 of shear \[m\], λ_3 of the cap \[m/Pa\].
    pub multipliers: [f64; 3],
    /// Growth of κ.
    pub loss: f64,
    /// Growth of κ_3 \[m\].
    pub crushing: f64,
    /// ∂(σ, τ) by the trial stress.
    pub by_trial: [[f64; 2]; 2],
}

/// Iterations of a bracketed root; bisection alone needs about sixty.
const ITERATIONS: usize = 200;

/// Returns a root of f between `low` and `high`, with f(low) > 0 ≥ f(high), within rounding. Uses inverse quadratic
/// interpolation if it is safe and bisection otherwise (Chandrupatla 1997).
fn root(mut f: impl FnMut(f64) -> f64, low: [f64; 2], high: [f64; 2]) -> Option<f64> {
    let ([mut b, mut f_b], [mut a, mut f_a], mut share) = (low, high, 0.5);
    for _ in 0..ITERATIONS {
        let x = a + share * (b - a);
        let f_x = f(x);
        let (c, f_c) = if (f_x > 0.0) == (f_a > 0.0) {
            (a, f_a)
        } else {
            let far = (b, f_b);
            (b, f_b) = (a, f_a);
            far
        };
        (a, f_a) = (x, f_x);
        let best = if f_a.abs() < f_b.abs() { a } else { b };
        let least = 2.0 * f64::EPSILON * best.abs() / (b - a).abs();
        if f_x == 0.0 || least > 0.5 || a == b {
            return Some(best);
        }
        let (xi, phi) = ((a - b) / (c - b), (f_a - f_b) / (f_c - f_b));
        share = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            f_a / (f_b - f_a) * f_c / (f_b - f_c) + (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b)
        } else {
            0.5
        };
        share = if share.is_finite() { share.clamp(least, 1.0 - least) } else { 0.5 };
    }
    None
}

/// Doubles a step from `start` until `f` is not positive. Returns that point and the last point at which `f` was positive.
fn bracket(mut f: impl FnMut(f64) -> f64, low: [f64; 2], start: f64) -> Option<[[f64; 2]; 2]> {
    let (mut low, mut high) = (low, start);
    while high.is_finite() && high > low[0] {
        let value = f(high);
        if value <= 0.0 {
            return Some([low, [high, value]]);
        }
        (low, high) = ([high, value], 2.0 * high);
    }
    None
}

/// A trial stress with the internal variables at the start of the step.
pub(super) struct Return<'a> {
    pub surface: &'a Surface,
    /// (σ, τ ≥ 0) \[Pa\].
    pub trial: [f64; 2],
    /// Remaining share of the bond, e^−κ.
    pub bond: f64,
    /// κ_3 \[m\].
    pub crushing: f64,
}

/// A point of the return: stress and multipliers.
#[derive(Clone, Copy)]
struct Place {
    stress: [f64; 2],
    multipliers: [f64; 3],
}

impl Return<'_> {
    /// Computes the return to the surfaces; `None` if the trial stress is inside all surfaces within `rounding` \[Pa\].
    pub fn solve(&self, rounding: f64) -> Result<Option<Returned>, UpdateFailure> {
        let Surface { tension, cohesion, cap, .. } = *self.surface;
        let [sigma, tau] = self.trial;
        let friction = self.surface.friction_at(self.bond);
        let outside = sigma > tension * self.bond + rounding
            || tau + sigma * friction > cohesion * self.bond + rounding * (1.0 + friction)
            || self.norm(self.trial) > cap.at(self.crushing)[0] + rounding * (1.0 + self.surface.cap_shear.sqrt());
        if !outside {
            return Ok(None);
        }
        let fresh = self.crushed(0.0)?;
        let first = self.loss(&fresh.multipliers);
        let mut loss = 0.0;
        if first > 0.0 {
            // Remaining loss of bond; a return that fails gives NaN, which ends the search.
            let rest = |loss: f64| self.crushed(loss).map_or(f64::NAN, |place| self.loss(&place.multipliers) - loss);
            let [low, high] = bracket(rest, [0.0, first], first).ok_or(UpdateFailure::NoConvergence)?;
            loss = root(rest, low, high).ok_or(UpdateFailure::NoConvergence)?;
        }
        let place = if loss > 0.0 { self.crushed(loss)? } else { fresh };
        Ok(Some(self.returned(&place, loss)))
    }

    /// Returns the growth of κ due to multipliers.
    fn loss(&self, multipliers: &[f64; 3]) -> f64 {
        (self.surface.loss[0] * multipliers[0]).hypot(self.surface.loss[1] * multipliers[1])
    }

    /// Returns √(σ² + C τ²).
    fn norm(&self, [sigma, tau]: [f64; 2]) -> f64 {
        sigma.hypot(self.surface.cap_shear.sqrt() * tau)
    }

    /// Returns the growth of κ_3: 2 λ_3 √(σ² + C² τ²).
    fn crushing(&self, place: &Place) -> f64 {
        2.0 * place.multipliers[2] * place.stress[0].hypot(self.surface.cap_shear * place.stress[1])
    }

    /// Returns the point for a given growth of κ.
    fn crushed(&self, loss: f64) -> Result<Place, UpdateFailure> {
        let bond = self.bond * (-loss).exp();
        let excess = |multiplier: f64| {
            let place = self.sheared(bond, multiplier);
            self.norm(place.stress) - self.surface.cap.at(self.crushing + self.crushing(&place))[0]
        };
        let none = self.sheared(bond, 0.0);
        let above = self.norm(none.stress) - self.surface.cap.at(self.crushing)[0];
        if above <= 0.0 {
            return Ok(none);
        }
        // Estimate: the multiplier of the elastic cap alone.
        let [k_n, k_t] = self.surface.stiffness;
        let start = above / (self.norm(none.stress) * 2.0 * k_n.max(self.surface.cap_shear * k_t));
        let [low, high] = bracket(excess, [0.0, above], start).ok_or(UpdateFailure::NoConvergence)?;
        let multiplier = root(excess, low, high).ok_or(UpdateFailure::NoConvergence)?;
        Ok(self.sheared(bond, multiplier))
    }

    /// Returns the point on tension cut-off and Coulomb's line for a given bond and a given multiplier of the cap.
    fn sheared(&self, bond: f64, crushed: f64) -> Place {
        let Surface { stiffness, tension, cohesion, dilatancy, cap_shear, .. } = *self.surface;
        let soft = [1.0 + 2.0 * stiffness[0] * crushed, 1.0 + 2.0 * cap_shear * stiffness[1] * crushed];
        let [sigma, tau] = [self.trial[0] / soft[0], self.trial[1] / soft[1]];
        let [k_n, k_t] = [stiffness[0] / soft[0], stiffness[1] / soft[1]];
        let (tension, cohesion, friction) = (tension * bond, cohesion * bond, self.surface.friction_at(bond));
        let place = |stress, opened, slipped| Place { stress, multipliers: [opened, slipped, crushed] };
        let over = tau + sigma * friction - cohesion;
        if over <= 0.0 {
            return if sigma <= tension {
                place([sigma, tau], 0.0, 0.0)
            } else {
                place([tension, tau], (sigma - tension) / k_n, 0.0)
            };
        }
        let slipped = over / (k_t + k_n * dilatancy * friction);
        let pressed = sigma - k_n * dilatancy * slipped;
        if pressed <= tension {
            return place([pressed, cohesion - pressed * friction], 0.0, slipped);
        }
        let corner = cohesion - tension * friction;
        let slipped = (tau - corner) / k_t;
        if slipped <= 0.0 {
            return place([tension, tau], (sigma - tension) / k_n, 0.0);
        }
        place([tension, corner], (sigma - tension) / k_n - dilatancy * slipped, slipped)
    }

    fn returned(&self, place: &Place, loss: f64) -> Returned {
        let Place { stress, multipliers } = *place;
        let by_trial = self.tangent(place, loss);
        Returned { stress, multipliers, loss, crushing: self.crushing(place), by_trial }
    }

    /// Solves the differentiated equations of the active surfaces. Unknowns dσ, dτ, k_n dλ_1, k_t dλ_2, k_n σ̄ dλ_3; a multiplier
    /// that is 0 stays 0.
    fn tangent(&self, place: &Place, loss: f64) -> [[f64; 2]; 2] {
        let Surface { stiffness: [k_n, k_t], tension, cohesion, dilatancy, cap_shear, .. } = *self.surface;
        let ([sigma, tau], [opened, slipped, crushed]) = (place.stress, place.multipliers);
        let bond = self.bond * (-loss).exp();
        let [cap, hardening] = self.surface.cap.at(self.crushing + self.crushing(place));
        // dκ by k_n dλ_1 and k_t dλ_2.
        let grows =
            |rate: f64, multiplier: f64, k: f64| if loss > 0.0 { rate * rate * multiplier / (loss * k) } else { 0.0 };
        let by = [grows(self.surface.loss[0], opened, k_n), grows(self.surface.loss[1], slipped, k_t)];
        let mut rows = [[0.0; 7]; 5];
        rows[0] = [1.0 + 2.0 * k_n * crushed, 0.0, 1.0, dilatancy * k_n / k_t, 2.0 * sigma / cap, 1.0, 0.0];
        rows[1] =
            [0.0, 1.0 + 2.0 * cap_shear * k_t * crushed, 0.0, 1.0, 2.0 * cap_shear * tau * k_t / (k_n * cap), 0.0, 1.0];
        rows[2][2] = 1.0;
        rows[3][3] = 1.0;
        rows[4][4] = 1.0;
        if opened > 0.0 {
            let fall = tension * bond;
            rows[2] = [1.0, 0.0, fall * by[0], fall * by[1], 0.0, 0.0, 0.0];
        }
        if slipped > 0.0 {
            let [fresh, residual] = self.surface.friction;
            let fall = (cohesion - sigma * (fresh - residual)) * bond;
            rows[3] = [self.surface.friction_at(bond), 1.0, fall * by[0], fall * by[1], 0.0, 0.0, 0.0];
        }
        if crushed > 0.0 {
            let length = sigma.hypot(cap_shear * tau);
            let turned = 2.0 * crushed * hardening / length;
            rows[4] = [
                sigma / cap - turned * sigma,
                cap_shear * tau / cap - turned * cap_shear * cap_shear * tau,
                0.0,
                0.0,
                -2.0 * hardening * length / (k_n * cap),
                0.0,
                0.0,
            ];
        }
        eliminate(&mut rows);
        [[rows[0][5], rows[0][6]], [rows[1][5], rows[1][6]]]
    }
}

/// Gauss–Jordan elimination with row pivots; the last two columns become the solutions.
fn eliminate(rows: &mut [[f64; 7]; 5]) {
    for k in 0..5 {
        let pivot = (k..5).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs())).unwrap_or(k);
        rows.swap(k, pivot);
        let own = rows[k].map(|x| x / rows[k][k]);
        rows[k] = own;
        for (i, row) in rows.iter_mut().enumerate() {
            if i != k {
                let factor = row[k];
                row.iter_mut().zip(own).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
}
