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
//! their size. A shear force beyond friction then gets the limit of friction as its size, a tensile force vanishes, and the steps go
//! on. If this does not end, a program on cones looks for admissible forces that fit the motion (`least`).

use super::descent::{Descent, Dual, Found, is_state, jumps, matrix, row, velocities};
use super::least::forces;
use super::rigid::Guess;
use crate::linear::null_space::null_space;
use crate::space::settings::{DESCENT, JOINTS};
use nalgebra::{DMatrix, DVector};
use voussoir_core::limit::Counters;
use voussoir_core::linear::least_norm;
use voussoir_core::space::{SpaceContact, SpaceField, SpaceProblem, Vec3, Wrench, power};

/// Returns a state near a guess, with its dual motion.
pub fn refined(descent: &Descent, guess: &Guess, counters: &mut Counters) -> Option<(Found, Dual)> {
    let problem = descent.problem;
    JOINTS.resting.iter().find_map(|share| {
        let mut parts = Parts::new(problem, guess, *share)?;
        parts.balance()?;
        // If the forces are unique, a program with an interior does not find them.
        let mut own = None;
        for _ in 0..JOINTS.rounds {
            if parts.unload() {
                own = Some((parts.factor, parts.field(problem)));
                break;
            }
            if parts.balance().is_none() {
                break;
            }
        }
        let mut motion = velocities(problem, &parts.motion);
        let unit = power(&problem.varying, &motion);
        motion.iter_mut().flatten().for_each(|v| *v /= unit);
        let jumps = jumps(problem, &motion);
        let known =
            own.or_else(|| Some(parts.factor).zip(forces(problem, descent.solve, parts.factor, &jumps, counters)));
        let known = known.filter(|(factor, _)| *factor > descent.start)?;
        let (found, dual) = descent.of_mechanism((motion, &jumps), known, counters);
        is_state(problem, &found).then_some((found, dual))
    })
}

/// Returns wrenches in the metric of the rows.
fn scaled(problem: &SpaceProblem, wrenches: &[Wrench]) -> DVector<f64> {
    let of = |w: &Wrench| [w[0], w[1], w[2], w[3] / problem.length, w[4] / problem.length, w[5] / problem.length];
    DVector::from_iterator(6 * problem.bodies, wrenches.iter().flat_map(of))
}

/// The motion of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Opens,
    Slips,
    Sticks,
}

/// The force of a point that does not open.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Force {
    None,
    /// At the limit of friction: against its slip, or in this direction if it sticks.
    Limit([f64; 2]),
    Inside,
}

/// A point with its rows n, s, t and its force.
struct Point {
    part: Part,
    friction: f64,
    rows: [DVector<f64>; 3],
    kind: Force,
    force: [f64; 3],
}

impl Point {
    /// Returns the size of the slip and its direction.
    fn slip(&self, motion: &DVector<f64>) -> (f64, [f64; 2]) {
        let [s, t] = [self.rows[1].dot(motion), self.rows[2].dot(motion)];
        let size = s.hypot(t);
        (size, [s / size, t / size])
    }

    /// Returns the direction of the shear force at the limit of friction.
    fn against(&self, motion: &DVector<f64>) -> Option<[f64; 2]> {
        match (self.kind, self.part) {
            (Force::Limit(_), Part::Slips) => Some(self.slip(motion).1.map(|x| -x)),
            (Force::Limit(direction), _) => Some(direction),
            _ => None,
        }
    }

    /// Returns the wrenches of a unit of each unknown of the force.
    fn columns(&self, motion: &DVector<f64>) -> Vec<DVector<f64>> {
        let [n, s, t] = &self.rows;
        match self.against(motion) {
            Some(d) => vec![n + (s * d[0] + t * d[1]) * self.friction],
            None if self.kind == Force::Inside => self.rows.to_vec(),
            None => Vec::new(),
        }
    }
}

/// The parts of all points, with forces and a motion that fit them.
struct Parts {
    /// All points, contact by contact.
    points: Vec<Point>,
    factor: f64,
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
        let points = problem.contacts.iter().zip(&guess.field);
        let points =
            points.flat_map(|(contact, own)| contact.inner.points.iter().zip(own).map(move |(x, f)| (contact, x, f)));
        let point = |((contact, point, force), v): ((&SpaceContact, &Vec3, &[f64; 3]), &[f64; 3])| {
            let rows = contact.frame.map(|axis| row(problem, contact, point, &axis));
            let (part, kind) = if v[0] > least {
                (Part::Opens, Force::None)
            } else if v[1].hypot(v[2]) > least {
                (Part::Slips, Force::Limit([0.0; 2]))
            } else {
                (Part::Sticks, Force::Inside)
            };
            Point { part, friction: contact.law.friction, rows, kind, force: [force[0].max(0.0), force[1], force[2]] }
        };
        let points: Vec<Point> = points.zip(&own).map(point).collect();
        let resting = points.iter().flat_map(|point| match point.part {
            Part::Opens => &point.rows[..0],
            Part::Slips => &point.rows[..1],
            Part::Sticks => &point.rows[..],
        });
        let kept = null_space(&matrix(resting, 6 * problem.bodies), DESCENT.null)?;
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
        Some(Parts { points, factor: guess.factor, motion: motion / unit, basis, fixed, varying })
    }

    /// Solves equilibrium by Newton steps. `None` if they fail, or if points overlap.
    fn balance(&mut self) -> Option<()> {
        let loads = self.fixed.amax() + self.varying.amax();
        let mut last = f64::INFINITY;
        let size = self.motion.norm();
        for _ in 0..JOINTS.newton {
            let mut columns: Vec<_> = self.points.iter().flat_map(|point| point.columns(&self.motion)).collect();
            columns.push(self.varying.clone());
            let mut unknowns = self.unknowns();
            let forces = columns.iter().zip(&unknowns);
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
            let both = DMatrix::from_fn(left.len(), forces.ncols() + turning.ncols(), |row, column| {
                let (own, column) =
                    if column < forces.ncols() { (&forces, column) } else { (&turning, column - forces.ncols()) };
                own[(row, column)]
            });
            let change = least_norm(&both, &left);
            let (changes, turned) = change.as_slice().split_at(forces.ncols());
            let changed = unknowns.iter_mut().zip(changes.iter().zip(&scales));
            changed.for_each(|(unknown, (change, scale))| *unknown -= change * scale);
            self.motion -= &self.basis * DVector::from_column_slice(turned) * self.motion.norm();
            self.press(&unknowns);
        }
        None
    }

    /// Returns the unknowns: the normal force at the limit of friction, all of a force inside, and the factor.
    fn unknowns(&self) -> Vec<f64> {
        let of = |point: &Point| match point.kind {
            Force::None => Vec::new(),
            Force::Limit(_) => vec![point.force[0]],
            Force::Inside => point.force.to_vec(),
        };
        self.points.iter().flat_map(of).chain([self.factor]).collect()
    }

    /// Sets the forces and the factor.
    fn press(&mut self, unknowns: &[f64]) {
        let mut unknowns = unknowns.iter().copied();
        let mut next = || unknowns.next().unwrap_or_default();
        for point in &mut self.points {
            point.force = match (point.against(&self.motion), point.kind) {
                (Some(d), _) => {
                    let n = next();
                    [n, point.friction * n * d[0], point.friction * n * d[1]]
                }
                (None, Force::Inside) => [next(), next(), next()],
                _ => [0.0; 3],
            };
        }
        self.factor = next();
    }

    /// Returns true if no force leaves its cone. Otherwise forces beyond friction get the limit of friction, and tensile ones vanish.
    fn unload(&mut self) -> bool {
        let largest = self.points.iter().map(|point| point.force[0]).fold(0.0, f64::max);
        let mut admissible = true;
        for point in &mut self.points {
            let [n, s, t] = point.force;
            let shear = s.hypot(t);
            if n < 0.0 {
                (point.kind, point.force, admissible) = (Force::None, [0.0; 3], false);
            } else if point.kind == Force::Inside && shear > point.friction * n + f64::EPSILON * largest {
                (point.kind, admissible) = (Force::Limit([s / shear, t / shear]), false);
            }
        }
        admissible
    }

    /// Returns the forces of all points, contact by contact.
    fn field(&self, problem: &SpaceProblem) -> SpaceField {
        let mut points = self.points.iter();
        let contacts = problem.contacts.iter().map(|contact| contact.inner.points.len());
        contacts.map(|count| points.by_ref().take(count).map(|point| point.force).collect()).collect()
    }

    /// Returns the sizes of the unknowns: normal forces, but no less than a share of the greatest, and the factor.
    fn scales(&self) -> Vec<f64> {
        let largest = self.points.iter().map(|point| point.force[0]).fold(0.0, f64::max);
        let of = |point: &Point| {
            let count = match point.kind {
                Force::None => 0,
                Force::Limit(_) => 1,
                Force::Inside => 3,
            };
            vec![point.force[0].max(JOINTS.softest * largest); count]
        };
        self.points.iter().flat_map(of).chain([self.factor.abs()]).collect()
    }

    /// Returns the change of the wrenches with the motion, for changes of its size.
    fn turning(&self) -> DMatrix<f64> {
        let mut turning = DMatrix::zeros(self.motion.len(), self.basis.ncols());
        for point in self.points.iter().filter(|point| point.part == Part::Slips && point.kind != Force::None) {
            let (size, [s, t]) = point.slip(&self.motion);
            let across = &point.rows[2] * s - &point.rows[1] * t;
            let moved = across.transpose() * &self.basis;
            turning -= across * moved * (point.friction * point.force[0] / size * self.motion.norm());
        }
        turning
    }

    /// Returns true if no points overlap.
    fn is_possible(&self) -> bool {
        let of = |part| self.points.iter().filter(move |point| point.part == part);
        let rates = of(Part::Opens).map(|point| point.rows[0].dot(&self.motion));
        let largest = rates.clone().chain(of(Part::Slips).map(|point| point.slip(&self.motion).0));
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
