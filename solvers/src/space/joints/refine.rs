//! From a guess to a collapse state in which all points keep their parts.
//!
//! The rates of the guess decide which points open, slip and stick. Motions x that keep these parts are a linear space, up to the directions
//! of slip. Equilibrium of the forces that fit x is an equation for x, for the factor λ, for the normal forces n of slipping points, and for the forces
//! f of sticking points:
//!
//! ```text
//! Σ n (r_n − μ d·r_t) + Σ f·r + w + λ p = 0,   d = r_t·x / |r_t·x|
//! ```
//!
//! Here r are the wrenches of unit forces at a point, and r·x its rates. Newton steps of least norm solve it, with forces relative to
//! their size. The forces may leave the cones. Those that fit the motion and do not are found by a program on cones (`least`).

use super::descent::{Descent, Dual, Found, is_state, jumps, matrix, row, velocities};
use super::least::forces;
use super::rigid::Guess;
use crate::linear::null_space::null_space;
use crate::space::settings::{DESCENT, JOINTS};
use nalgebra::{DMatrix, DVector};
use voussoir_core::limit::Counters;
use voussoir_core::space::{SpaceProblem, Wrench, power};

/// Returns a state near a guess, with its dual motion.
pub fn refined(descent: &Descent, guess: &Guess, counters: &mut Counters) -> Option<(Found, Dual)> {
    let problem = descent.problem;
    JOINTS.resting.iter().find_map(|share| {
        let mut parts = Parts::new(problem, guess, *share)?;
        parts.balance()?;
        let mut motion = velocities(problem, &parts.motion);
        let unit = power(&problem.varying, &motion);
        motion.iter_mut().flatten().for_each(|v| *v /= unit);
        let jumps = jumps(problem, &motion);
        let factor = parts.unknowns.pop().filter(|factor| *factor > descent.start)?;
        let field = forces(problem, descent.solve, factor, &jumps, counters)?;
        let (found, dual) = descent.of_mechanism((motion, &jumps), (factor, field), counters);
        is_state(problem, &found).then_some((found, dual))
    })
}

/// Returns wrenches in the metric of the rows.
fn scaled(problem: &SpaceProblem, wrenches: &[Wrench]) -> DVector<f64> {
    let of = |w: &Wrench| [w[0], w[1], w[2], w[3] / problem.length, w[4] / problem.length, w[5] / problem.length];
    DVector::from_iterator(6 * problem.bodies, wrenches.iter().flat_map(of))
}

/// A slipping point: friction and rows n, s, t.
struct Slipping {
    friction: f64,
    rows: [DVector<f64>; 3],
}

impl Slipping {
    /// Returns the size of the slip and its direction.
    fn slip(&self, motion: &DVector<f64>) -> (f64, [f64; 2]) {
        let [s, t] = [self.rows[1].dot(motion), self.rows[2].dot(motion)];
        let size = s.hypot(t);
        (size, [s / size, t / size])
    }
}

/// The parts of all points, with forces and a motion that fit them.
struct Parts {
    open: Vec<DVector<f64>>,
    slipping: Vec<Slipping>,
    /// Rows n, s, t of sticking points.
    sticking: Vec<DVector<f64>>,
    /// Normal forces of slipping points, forces of sticking points, and the factor.
    unknowns: Vec<f64>,
    motion: DVector<f64>,
    /// Basis of the motions that keep the parts and have no power.
    basis: DMatrix<f64>,
    fixed: DVector<f64>,
    varying: DVector<f64>,
}

impl Parts {
    /// Reads the parts from the rates of a guess. Points with rates below a share of the greatest one rest. `None` if no such motion
    /// has power.
    fn new(problem: &SpaceProblem, guess: &Guess, share: f64) -> Option<Self> {
        let own = jumps(problem, &guess.motion);
        let least = share * own.iter().map(|v| v[0].hypot(v[1]).hypot(v[2])).fold(0.0, f64::max);
        let (mut open, mut slipping, mut sticking, mut resting) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (mut normals, mut forces) = (Vec::new(), Vec::new());
        let points = problem.contacts.iter().zip(&guess.field);
        let points =
            points.flat_map(|(contact, own)| contact.inner.points.iter().zip(own).map(move |(x, f)| (contact, x, f)));
        for ((contact, point, force), v) in points.zip(&own) {
            let rows = contact.frame.map(|axis| row(problem, contact, point, &axis));
            if v[0] > least {
                open.push(rows[0].clone());
            } else if v[1].hypot(v[2]) > least {
                resting.push(rows[0].clone());
                normals.push(force[0].max(0.0));
                slipping.push(Slipping { friction: contact.law.friction, rows });
            } else {
                resting.extend_from_slice(&rows);
                forces.extend(force);
                sticking.extend(rows);
            }
        }
        let kept = null_space(&matrix(&resting, 6 * problem.bodies), DESCENT.null)?;
        let (fixed, varying) = (scaled(problem, &problem.fixed), scaled(problem, &problem.varying));
        let power = kept.transpose() * &varying;
        let of_guess =
            guess.motion.iter().flat_map(|v| (0..6).map(|k| v[k] * if k < 3 { 1.0 } else { problem.length }));
        let of_guess = DVector::from_iterator(6 * problem.bodies, of_guess);
        let motion = &kept * (kept.transpose() * &of_guess);
        let unit = varying.dot(&motion);
        // A motion with little power would be a state at nearly every factor within rounding.
        if power.norm() <= DESCENT.null * varying.norm() || unit.is_nan() || unit < 0.5 * varying.dot(&of_guess) {
            return None;
        }
        let basis = &kept * null_space(&DMatrix::from_row_slice(1, power.len(), power.as_slice()), DESCENT.null)?;
        let unknowns = normals.into_iter().chain(forces).chain([guess.factor]).collect();
        Some(Parts { open, slipping, sticking, unknowns, motion: motion / unit, basis, fixed, varying })
    }

    /// Solves equilibrium by Newton steps. `None` if they fail, or if points overlap.
    fn balance(&mut self) -> Option<()> {
        let loads = self.fixed.amax() + self.varying.amax();
        let mut last = f64::INFINITY;
        let size = self.motion.norm();
        for _ in 0..JOINTS.newton {
            let mut columns = self.columns();
            let forces = columns.iter().zip(&self.unknowns);
            let left = forces.fold(self.fixed.clone(), |left, (column, force)| left + column * *force);
            let error = left.amax() / loads;
            if error <= JOINTS.balanced || (error <= JOINTS.nearly && error > 0.5 * last) {
                return (self.is_possible() && self.motion.norm() < 2.0 * size).then_some(());
            }
            if error.is_nan() || error > 0.5 * last {
                return None;
            }
            last = error;
            let scales = self.scales();
            columns.iter_mut().zip(&scales).for_each(|(column, scale)| *column *= *scale);
            let turning = self.turning();
            let forces = DMatrix::from_columns(&columns);
            let product = &forces * forces.transpose() + &turning * turning.transpose();
            let parts = product.symmetric_eigen();
            let few = f64::EPSILON * left.len() as f64 * parts.eigenvalues.amax();
            let mut amounts = parts.eigenvectors.transpose() * left;
            let known = amounts.iter_mut().zip(&parts.eigenvalues);
            known.for_each(|(amount, value)| *amount = if *value > few { *amount / value } else { 0.0 });
            let multipliers = parts.eigenvectors * amounts;
            let changes = forces.transpose() * &multipliers;
            let unknowns = self.unknowns.iter_mut().zip(changes.iter().zip(&scales));
            unknowns.for_each(|(unknown, (change, scale))| *unknown -= change * scale);
            self.motion -= &self.basis * (turning.transpose() * multipliers) * self.motion.norm();
        }
        None
    }

    /// Returns the wrenches of a unit of each unknown.
    fn columns(&self) -> Vec<DVector<f64>> {
        let slipping = self.slipping.iter().map(|own| {
            let (_, [s, t]) = own.slip(&self.motion);
            &own.rows[0] - (&own.rows[1] * s + &own.rows[2] * t) * own.friction
        });
        slipping.chain(self.sticking.iter().cloned()).chain([self.varying.clone()]).collect()
    }

    /// Returns the sizes of the unknowns: normal forces, but no less than a share of the greatest, and the factor.
    fn scales(&self) -> Vec<f64> {
        let (slipping, others) = self.unknowns.split_at(self.slipping.len());
        let (sticking, factor) = others.split_at(self.sticking.len());
        let normals = || slipping.iter().chain(sticking.iter().step_by(3));
        let least = JOINTS.softest * normals().copied().fold(0.0, f64::max);
        let slipping = slipping.iter().map(|n| n.max(least));
        let sticking = sticking.chunks_exact(3).flat_map(|force| [force[0].max(least); 3]);
        slipping.chain(sticking).chain(factor.iter().map(|factor| factor.abs())).collect()
    }

    /// Returns the change of the wrenches with the motion, for changes of its size.
    fn turning(&self) -> DMatrix<f64> {
        let mut turning = DMatrix::zeros(self.motion.len(), self.basis.ncols());
        for (own, normal) in self.slipping.iter().zip(&self.unknowns) {
            let (size, [s, t]) = own.slip(&self.motion);
            let across = &own.rows[2] * s - &own.rows[1] * t;
            let moved = across.transpose() * &self.basis;
            turning -= across * moved * (own.friction * normal / size * self.motion.norm());
        }
        turning
    }

    /// Returns true if no points overlap.
    fn is_possible(&self) -> bool {
        let rates = self.open.iter().map(|row| row.dot(&self.motion));
        let largest = rates.clone().chain(self.slipping.iter().map(|own| own.slip(&self.motion).0));
        let largest = largest.fold(0.0, f64::max);
        rates.fold(f64::INFINITY, f64::min) >= -DESCENT.proved * largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::joints::rigid::sequence;
    use crate::space::solve;
    use crate::space::tests::own_flow::groove;

    /// A rigid program of a block in a groove leads to the state at μ / sin α.
    #[test]
    fn a_guess_becomes_a_state() {
        let problem = groove(45.0, 0.5, 6.0);
        let descent = Descent { problem: &problem, solve, start: 0.0 };
        let normals = problem.contacts.iter().map(|contact| vec![1.0; contact.inner.points.len()]).collect();
        let guesses = sequence(&problem, 0.0, normals);
        let (found, _) = refined(&descent, guesses.last().unwrap(), &mut Counters::new()).unwrap();
        assert!((found.factor - 0.5f64.sqrt()).abs() < 1e-10, "{}", found.factor);
    }
}
