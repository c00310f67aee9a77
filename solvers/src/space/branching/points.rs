//! The points of a scene in a search by branching: their jumps, their modes, and the forces that a mode allows.

use crate::space::program::Program;
use crate::space::settings::BRANCHING;
use std::f64::consts::{FRAC_PI_4, PI, TAU};
use voussoir_core::space::{SpaceContact, SpaceProblem};

/// The mode of a point in a part of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mode {
    /// The part allows all modes.
    Undecided,
    /// It carries nothing.
    Open,
    /// It does not open.
    Closed,
    /// It neither opens nor slips.
    Sticks,
    /// It slips in a direction between these angles, less than a straight angle apart.
    Slips([f64; 2]),
}

impl Mode {
    /// Returns true if the mode excludes no force.
    pub fn carries_all(self) -> bool {
        matches!(self, Mode::Undecided | Mode::Closed | Mode::Sticks)
    }
}

/// A point of a contact in units of the program.
pub struct Point {
    /// Derivatives of its jumps n, s and t with respect to the velocities.
    pub jumps: [Vec<f64>; 3],
    /// Index of its contact.
    pub contact: usize,
    /// Coefficient of friction.
    pub friction: f64,
    /// Directions in which the boundary of its friction is replaced by a tangent, in increasing order.
    tangents: Vec<f64>,
}

/// All points of a scene.
pub struct Points {
    /// The points, contact by contact.
    pub points: Vec<Point>,
    /// The sets of points that each contact can keep closed while the others open: vertices, edges and all of its hull.
    pub faces: Vec<Vec<Vec<usize>>>,
    /// Loads at the start.
    pub base: Vec<f64>,
    /// Varying loads.
    pub varying: Vec<f64>,
}

/// A force (n, s, t).
pub type Force = [f64; 3];

/// Returns a force with unit normal component whose shear force has a size and a direction.
fn force(shear: f64, angle: f64) -> Force {
    let (sin, cos) = angle.sin_cos();
    [1.0, shear * cos, shear * sin]
}

impl Points {
    /// Gathers the points of a problem with dry joints.
    pub fn new(problem: &SpaceProblem, program: &Program) -> Self {
        let size = program.base.len();
        let none = || [vec![0.0; size], vec![0.0; size], vec![0.0; size]];
        let (mut points, mut faces) = (Vec::new(), Vec::new());
        for (index, contact) in problem.contacts.iter().enumerate() {
            let friction = contact.law.friction;
            let tangents: Vec<f64> = (0..8).map(|k| f64::from(k) * FRAC_PI_4).collect();
            faces.push(closed_faces(contact, points.len()));
            points.extend(contact.inner.points.iter().map(|_| Point {
                jumps: none(),
                contact: index,
                friction,
                tangents: tangents.clone(),
            }));
        }
        let mut unit = vec![0.0; size];
        for column in 0..size {
            unit[column] = 1.0;
            let rates = program.rates(&unit);
            for member in &program.members {
                for place in member.points.clone() {
                    let [n, s, t] = rates[place];
                    let jump = [n / member.strengths[0], s, t];
                    (0..3).for_each(|k| points[place].jumps[k][column] = jump[k]);
                }
            }
            unit[column] = 0.0;
        }
        Points { points, faces, base: program.base.clone(), varying: program.varying.clone() }
    }
}

/// Returns the sets of points of a contact that a motion can keep closed while it opens the others. Openings are linear over the contact, so
/// these are no point, a vertex, an edge, or all points; they have the numbers from `first`.
fn closed_faces(contact: &SpaceContact, first: usize) -> Vec<Vec<usize>> {
    let points = &contact.inner.points;
    let count = points.len();
    let is_edge = |a: usize, b: usize| {
        let along = points[b] - points[a];
        let side = |c: usize| contact.frame[0].dot(&along.cross(&(points[c] - points[a])));
        let sides = || (0..count).filter(|c| *c != a && *c != b).map(side);
        sides().all(|side| side >= 0.0) || sides().all(|side| side <= 0.0)
    };
    let edges = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b])).filter(|[a, b]| is_edge(*a, *b));
    let mut faces: Vec<Vec<usize>> = vec![Vec::new()];
    faces.extend((0..count).map(|a| vec![first + a]));
    faces.extend(edges.map(|edge| edge.map(|place| first + place).to_vec()));
    if count > 2 {
        faces.push((first..first + count).collect());
    }
    faces
}

impl Point {
    /// Returns forces whose non-negative combinations contain all forces that a mode allows.
    pub fn generators(&self, mode: Mode) -> Vec<Force> {
        let friction = self.friction;
        match mode {
            Mode::Open => Vec::new(),
            _ if friction == 0.0 => vec![[1.0, 0.0, 0.0]],
            Mode::Slips([from, to]) => {
                // The arc against the slip, between its ends and the tangents there and in the middle. Directions that differ by
                // rounding would make the program singular.
                let (middle, half) = (f64::midpoint(from, to) + PI, ((to - from) / 2.0).max(BRANCHING.narrow / 2.0));
                let at = |shear: f64, share: f64| force(shear, middle + share * half);
                let ends = [at(friction, -1.0), at(friction, 1.0)];
                let apex = friction / (half / 2.0).cos();
                let apices = [at(apex, -0.5), at(apex, 0.5)];
                let curved = half * half > BRANCHING.outward;
                ends.into_iter().chain(apices.into_iter().filter(|_| curved)).collect()
            }
            Mode::Undecided | Mode::Closed | Mode::Sticks => {
                let next = self.tangents.iter().skip(1).copied().chain([self.tangents[0] + TAU]);
                let apex = |(a, b): (&f64, f64)| force(friction / ((b - a) / 2.0).cos(), f64::midpoint(*a, b));
                self.tangents.iter().zip(next).map(apex).collect()
            }
        }
    }

    /// Adds a tangent in the direction of a force that exceeds friction by this share. Returns false if it does not, or if there are
    /// enough tangents.
    pub fn refine(&mut self, [n, s, t]: &Force, excess: f64) -> bool {
        let exceeds = s.hypot(*t) > self.friction * n * (1.0 + excess);
        if !exceeds || self.tangents.len() >= BRANCHING.tangents {
            return false;
        }
        let angle = t.atan2(*s).rem_euclid(TAU);
        let place = self.tangents.partition_point(|other| *other < angle);
        self.tangents.insert(place, angle);
        true
    }

    /// Returns a force whose shear force is reduced to friction.
    pub fn within_friction(&self, [n, s, t]: Force) -> Force {
        let shear = s.hypot(t);
        let share = if shear > self.friction * n { self.friction * n / shear } else { 1.0 };
        [n, s * share, t * share]
    }
}
