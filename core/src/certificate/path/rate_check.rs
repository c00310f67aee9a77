//! Checks of a rate at a state, and of a mechanism at constant load.

use super::claims::length;
use super::none_rises::RateProblem;
use super::point_modes::{ModeCone, dilatancy, dot};
use crate::law::Facet;
use crate::path::{Contact, PathProblem, PathRate, PathState, PointMode};

/// Greatest residual of equations and laws, relative to the sizes of rates.
pub const RATE: f64 = 1e-8;
/// Least scale of a row, as a share of the greatest row.
const SMALL_ROW: f64 = 1e-3;

/// Returns the greatest length of the pairs.
fn greatest(pairs: &[[f64; 2]]) -> f64 {
    pairs.iter().map(|pair| length(*pair)).fold(0.0, f64::max)
}

/// Returns the residual of a row relative to its terms.
fn relative([value, terms]: [f64; 2], largest: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.abs() / (terms + SMALL_ROW * largest) }
}

impl RateProblem<'_> {
    /// Checks that rates solve the rate problem and returns the greatest residual.
    ///
    /// # Errors
    /// Names the first part that is wrong.
    pub fn check_rate(&self, rate: &PathRate) -> Result<f64, String> {
        let (contacts, bodies) = (self.modes.len(), self.equations.held.len());
        if rate.force.len() != contacts || rate.gap.len() != contacts || rate.motion.len() != bodies {
            return Err("a malformed rate".into());
        }
        for (body, motion) in rate.motion.iter().enumerate().filter(|(body, _)| self.equations.held[*body]) {
            let settled = self.equations.settlements[body].map(|u| u * rate.factor);
            if (0..3).any(|i| (motion[i] - settled[i]).abs() > RATE * settled[i].abs()) {
                return Err(format!("support {body} does not move as its load step says"));
            }
        }
        let rows = self.equations.products(rate);
        let (equilibrium, gaps) = rows.split_at(3 * bodies);
        let scale = |row: usize| if row % 3 == 2 { self.equations.length } else { 1.0 };
        let scaled = |(row, own): (usize, &[f64; 2])| own.map(|v| v / scale(row));
        let equilibrium: Vec<[f64; 2]> = equilibrium.iter().enumerate().map(scaled).collect();
        let largest = |rows: &[[f64; 2]]| rows.iter().map(|row| row[1]).fold(0.0, f64::max);
        let (most, moved) = (largest(&equilibrium), largest(gaps).max(greatest(&rate.gap)));
        let mut worst = equilibrium.iter().map(|row| relative(*row, most)).fold(0.0, f64::max);
        for (own, row) in rate.gap.as_flattened().iter().zip(gaps) {
            worst = worst.max((own - row[0]).abs() / moved.max(1e-300));
        }
        let sizes = [greatest(&rate.force), greatest(&rate.gap)];
        for (contact, modes) in self.modes.iter().enumerate() {
            let outside = |cone: &ModeCone| {
                let distances = cone.distances(rate.force[contact], rate.gap[contact]);
                (0..2).map(|i| distances[i] / sizes[i].max(1e-300)).fold(0.0, f64::max)
            };
            let least = modes.iter().map(outside).fold(f64::INFINITY, f64::min);
            if least.is_nan() || least > RATE {
                return Err(format!("the rate at contact point {contact} has no mode: it is {least:.1e} outside"));
            }
            worst = worst.max(least);
        }
        if worst <= RATE { Ok(worst) } else { Err(format!("the rate leaves {worst:.1e} of its equations")) }
    }

    /// Returns the rates of gaps from rates of forces and motions.
    pub(super) fn gaps_of(&self, rate: &PathRate) -> Vec<[f64; 2]> {
        let rows = self.equations.products(rate);
        rows[3 * self.equations.held.len()..].chunks_exact(2).map(|pair| [pair[0][0], pair[1][0]]).collect()
    }

    /// Checks a mechanism at constant load with small displacements: contact forces and supports do not change, p·q̇ =
    /// 1, gaps flow by the laws, the dissipation is the power of all loads, and no open point closes.
    ///
    /// # Errors
    /// Names the first part that is wrong.
    pub fn check_plateau(&self, problem: &PathProblem, state: &PathState, motion: &[[f64; 3]]) -> Result<(), String> {
        let still = vec![[0.0; 2]; self.modes.len()];
        let mut rate = PathRate { factor: 0.0, gap: still.clone(), force: still, motion: motion.to_vec() };
        if motion.len() != self.equations.held.len() {
            return Err("a malformed mechanism".into());
        }
        rate.gap = self.gaps_of(&rate);
        self.check_rate(&rate)?;
        let power: f64 = self.equations.load.equilibrium.iter().map(|(row, p)| p * motion.as_flattened()[*row]).sum();
        if power.is_nan() || (power - 1.0).abs() > RATE {
            return Err(format!("the power of the load on the mechanism is {power}, not 1"));
        }
        let (mut dissipated, mut size) = (0.0, 0.0);
        for (force, gap) in state.force.iter().zip(&rate.gap) {
            dissipated -= dot(*force, *gap);
            size += length(*force) * length(*gap);
        }
        let mut done = 0.0;
        for (step, applied) in problem.load_steps.iter().zip(problem.applied(state.load_step, state.factor)) {
            for (load, velocity) in problem.wrenches(&step.loading).iter().zip(motion) {
                let power: f64 = (0..3).map(|i| load[i] * velocity[i]).sum();
                done += applied * power;
                size += (applied * power).abs();
            }
        }
        if (dissipated - done).abs() > RATE * size || dissipated < -RATE * size {
            return Err(format!("the mechanism dissipates {dissipated:.3e}, and the loads do {done:.3e}"));
        }
        self.check_closing(problem, &rate)
    }

    /// Checks that rates remain admissible at any distance: contact forces grow within their facets, and no open point
    /// closes.
    ///
    /// # Errors
    /// Names the first part that is wrong.
    pub fn check_ray(&self, problem: &PathProblem, rate: &PathRate) -> Result<(), String> {
        self.check_rate(rate)?;
        if rate.factor * self.equations.sense <= 0.0 {
            return Err("the load does not grow along the ray".into());
        }
        let most = RATE * greatest(&rate.force);
        for (index, (contact, force)) in problem.contacts.iter().zip(&rate.force).enumerate() {
            let facets = contact.law.facets().unwrap_or_default();
            if facets.iter().any(|facet| dot(facet.normal, *force) > most * length(facet.normal)) {
                return Err(format!("the force of contact point {index} leaves its facets along the ray"));
            }
        }
        self.check_closing(problem, rate)
    }

    /// Checks that rates close no open point. A point whose gap changes by rounding only does not close.
    fn check_closing(&self, problem: &PathProblem, rate: &PathRate) -> Result<(), String> {
        let least = RATE * greatest(&rate.gap);
        let moving = self.modes.iter().enumerate().filter(|(contact, _)| length(rate.gap[*contact]) > least);
        for (contact, modes) in moving {
            let closing = closing_rate(&problem.contacts[contact], modes, rate.gap[contact]);
            if closing > least {
                return Err(format!("contact point {contact} is open and closes"));
            }
        }
        Ok(())
    }
}

/// Returns the rate at which an open point closes; 0 for closed points.
fn closing_rate(contact: &Contact, modes: &[ModeCone], gap: [f64; 2]) -> f64 {
    let Some(facets) = contact.law.facets() else { return 0.0 };
    match modes[0].mode {
        PointMode::Open => dilatancy(facets) * gap[1].abs() - gap[0],
        PointMode::Facet(f) => -opening_of(facets, &(0..facets.len()).collect::<Vec<_>>(), f, gap),
        _ => 0.0,
    }
}

/// Returns the multiplier of an opening facet in a gap that flows along it and at most one other active facet: the
/// least if there are several, −∞ if no facet fits.
pub(super) fn opening_of(facets: &[Facet], active: &[usize], opening: usize, gap: [f64; 2]) -> f64 {
    let d = facets[opening].flow;
    let alone = -dot(gap, d) / dot(d, d);
    if length([gap[0] + alone * d[0], gap[1] + alone * d[1]]) <= RATE * length(gap) {
        return alone;
    }
    let with = |other: &usize| {
        let e = facets[*other].flow;
        let determinant = d[0] * e[1] - d[1] * e[0];
        let own = -(gap[0] * e[1] - gap[1] * e[0]) / determinant;
        let theirs = -(d[0] * gap[1] - d[1] * gap[0]) / determinant;
        (determinant != 0.0 && theirs >= 0.0).then_some(own)
    };
    let others = active.iter().filter(|f| **f != opening);
    others.filter_map(with).reduce(f64::min).unwrap_or(f64::NEG_INFINITY)
}
