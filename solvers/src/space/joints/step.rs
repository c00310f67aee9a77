//! One step of rigid blocks on elastic joints: semismooth Newton iterations.
//!
//! A step finds the motion u with A f(Aᵀ u) + w + λ p = 0, at a given λ, or with the power p·u of the first guess and λ unknown. With
//! the law's own friction the matrix is unsymmetric, and the iteration may fail. With a fictitious cohesion (`lagged`) the step is the
//! minimum of a convex function, and a line search makes the iteration converge. Source of the iteration:
//! Alart and Curnier (1991), *Comput. Methods Appl. Mech. Eng.* 92, 353–375.

use super::point::{Contact, Limit, Matrix, Spring};
use crate::space::cone::Cone;
use crate::space::interior_point::{add, dot, greatest};
use crate::space::program::{Bodies, Member, Program};
use crate::space::settings::JOINTS;
use crate::space::stiffness::{Block, times, times_transposed};
use std::ops::Range;
use voussoir_core::linear::{Analysis, Entries, SparseLu};
use voussoir_core::space::SpaceField;

/// The quantity that is given in a step.
#[derive(Debug, Clone, Copy)]
pub enum Control {
    /// The factor of the live load.
    Factor(f64),
    /// The power p·u of the live load in the first guess.
    Power,
}

/// The end of a step.
pub struct Step {
    /// Displacements of the bodies.
    pub motion: Bodies,
    /// Factor of the live load.
    pub lambda: f64,
    /// All points.
    pub contacts: Vec<Contact>,
}

/// Rigid blocks on elastic joints.
pub struct Joints<'a> {
    /// The scaled scene.
    pub program: &'a Program,
    /// All points.
    pub springs: Vec<Spring>,
    /// The state of all points.
    pub contacts: Vec<Contact>,
    /// Power of the live load per factor in a small step from the dead load; set by the first course.
    pub compliance: Option<f64>,
    /// Power of a contact, relative to loads and motion, that counts as zero at the end of a course.
    pub settled: f64,
    /// Newton iterations done.
    pub iterations: u64,
    moves: Vec<[Block; 2]>,
    analysis: Analysis,
}

/// Responses of all points and the forces that they leave on the bodies.
struct Trial {
    contacts: Vec<Contact>,
    tangents: Vec<Matrix>,
    /// A f + w.
    left: Bodies,
}

impl<'a> Joints<'a> {
    /// Creates joints without stress; `settled` is the power that counts as zero.
    pub fn new(program: &'a Program, springs: Vec<Spring>, settled: f64) -> Self {
        let contacts = vec![Contact::default(); springs.len()];
        let moves = program.members.iter().map(Member::moves).collect();
        Joints {
            program,
            springs,
            contacts,
            compliance: None,
            settled,
            iterations: 0,
            moves,
            analysis: Analysis::default(),
        }
    }

    /// Puts forces \[N\] on all points, contact by contact, with closed gaps.
    pub fn press(&mut self, field: &SpaceField) {
        let forces = self.program.scaled(field);
        self.contacts = forces.into_iter().map(|force| Contact { force, gap: 0.0 }).collect();
    }

    /// Returns the limits of the law.
    pub fn law(&self) -> Vec<Limit> {
        self.springs.iter().map(Spring::law).collect()
    }

    /// Returns the size of the loads at a factor.
    pub fn loads(&self, lambda: f64) -> f64 {
        let sum = |loads: &[f64]| loads.iter().map(|x| x.abs()).sum::<f64>();
        sum(&self.program.base) + lambda.abs() * sum(&self.program.varying)
    }

    /// Returns the jumps (n, s, t) of all points.
    pub fn jumps(&self, motion: &[f64]) -> Vec<[f64; 3]> {
        let mut jumps = self.program.rates(motion);
        self.normals(&mut jumps);
        jumps
    }

    /// Turns y₀ or z₀ of all points to and from the normal component.
    fn normals(&self, points: &mut [Cone]) {
        for member in &self.program.members {
            points[member.points.clone()].iter_mut().for_each(|y| y[0] /= member.strengths[0]);
        }
    }

    fn trial(&self, motion: &[f64], limits: &[Limit]) -> Trial {
        let jumps = self.jumps(motion);
        let points = self.springs.iter().zip(&self.contacts).zip(jumps.iter().zip(limits));
        let (contacts, tangents): (Vec<Contact>, Vec<Matrix>) =
            points.map(|((spring, before), (jump, limit))| spring.response(before, jump, *limit)).unzip();
        let mut forces: Vec<Cone> = contacts.iter().map(|contact| contact.force).collect();
        self.normals(&mut forces);
        let mut left = self.program.base.clone();
        self.program.press(&forces, &mut left);
        Trial { contacts, tangents, left }
    }

    /// Solves the linear system of an iteration for a change of the motion and, under control of the power, for the new factor.
    fn change(&mut self, trial: &Trial, right: &[f64], control: Control, shift: f64) -> Option<Vec<f64>> {
        self.iterations += 1;
        let bodies = self.program.base.len();
        let mut entries = Entries::new();
        let mut diagonal = vec![0.0; bodies];
        for (member, moves) in self.program.members.iter().zip(&self.moves) {
            let block = self.condensed(member.points.clone(), &trial.tangents);
            for (row, moved) in moves.iter().enumerate() {
                let Some(a) = member.bodies[row] else { continue };
                let half = times(moved, &block);
                for (column, other) in moves.iter().enumerate() {
                    let Some(b) = member.bodies[column] else { continue };
                    let own = times_transposed(&half, other);
                    for (i, row) in own.iter().enumerate() {
                        entries.extend(row.iter().enumerate().map(|(j, value)| (6 * a + i, 6 * b + j, *value)));
                        diagonal[6 * a + i] += if a == b { row[i] } else { 0.0 };
                    }
                }
            }
        }
        let size = diagonal.iter().sum::<f64>() / diagonal.len().max(1) as f64;
        entries.extend((0..bodies).map(|i| (i, i, shift * size + f64::MIN_POSITIVE)));
        let mut right = right.to_vec();
        if let Control::Power = control {
            let live = self.program.varying.iter().enumerate();
            entries.extend(live.flat_map(|(i, p)| [(i, bodies, -p), (bodies, i, *p)]));
            right.push(0.0);
        }
        let factors = SparseLu::analysed(right.len(), &entries, &mut self.analysis)?;
        factors.solve(&[right], 1)?.pop()
    }

    /// Returns the 6 × 6 tangent of a contact in its frame about its centre.
    fn condensed(&self, points: Range<usize>, tangents: &[Matrix]) -> Block {
        let mut sum = [[0.0; 6]; 6];
        for (x, tangent) in self.program.points[points.clone()].iter().zip(&tangents[points]) {
            // Wrenches of unit forces n, s, t at the point.
            let wrenches =
                [[1.0, 0.0, 0.0, 0.0, x.z, -x.y], [0.0, 1.0, 0.0, -x.z, 0.0, x.x], [0.0, 0.0, 1.0, x.y, -x.x, 0.0]];
            let halves: [[f64; 6]; 3] =
                std::array::from_fn(|i| std::array::from_fn(|k| (0..3).map(|j| tangent[i][j] * wrenches[j][k]).sum()));
            for (wrench, half) in wrenches.iter().zip(&halves) {
                for (row, a) in sum.iter_mut().zip(wrench) {
                    row.iter_mut().zip(half).for_each(|(sum, b)| *sum += a * b);
                }
            }
        }
        sum
    }

    /// Returns the step with the friction of the law, from a first guess of motion and factor. `None` if the iteration fails.
    pub fn coulomb(&mut self, mut motion: Bodies, mut lambda: f64, control: Control) -> Option<Step> {
        let limits = self.law();
        let mut last = f64::INFINITY;
        for _ in 0..JOINTS.newton {
            let trial = self.trial(&motion, &limits);
            let mut left = trial.left.clone();
            add(&mut left, lambda, &self.program.varying);
            let error = greatest(&left) / self.loads(lambda);
            if error <= JOINTS.balanced || (error <= JOINTS.nearly && error > 0.5 * last) {
                return Some(Step { motion, lambda, contacts: trial.contacts });
            }
            last = error;
            let shift = if matches!(control, Control::Factor(_)) { JOINTS.shift } else { 0.0 };
            let step = self.change(&trial, &left, control, shift)?;
            add(&mut motion, 1.0, &step[..left.len()]);
            lambda += step.get(left.len()).copied().unwrap_or(0.0);
        }
        None
    }

    /// Returns the step with the fictitious cohesion of known normal forces. `None` if the convex function has no minimum within
    /// reach.
    pub fn lagged(&mut self, mut motion: Bodies, mut lambda: f64, control: Control, normals: &[f64]) -> Option<Step> {
        let limits: Vec<Limit> = self.springs.iter().zip(normals).map(|(spring, n)| spring.lagged(*n)).collect();
        let mut trial = self.trial(&motion, &limits);
        for _ in 0..JOINTS.convex {
            // Under control of the power λ follows from the step, so the live load drops out of the right-hand side.
            let mut right = trial.left.clone();
            if let Control::Factor(factor) = control {
                add(&mut right, factor, &self.program.varying);
            }
            let step = self.change(&trial, &right, control, JOINTS.regular)?;
            let direction = &step[..right.len()];
            lambda = step.get(right.len()).copied().unwrap_or(lambda);
            trial = self.searched(&mut motion, direction, &limits, control, &right);
            let mut left = trial.left.clone();
            add(&mut left, lambda, &self.program.varying);
            if greatest(&left) / self.loads(lambda) <= JOINTS.lagged {
                return Some(Step { motion, lambda, contacts: trial.contacts });
            }
        }
        None
    }

    /// Moves along a direction until the convex function has nearly no slope, and returns the trial there.
    fn searched(
        &self,
        motion: &mut Bodies,
        direction: &[f64],
        limits: &[Limit],
        control: Control,
        right: &[f64],
    ) -> Trial {
        let start = -dot(right, direction);
        let mut length = 1.0;
        for _ in 0..JOINTS.search {
            let mut moved = motion.clone();
            add(&mut moved, length, direction);
            let trial = self.trial(&moved, limits);
            let mut slope = -dot(&trial.left, direction);
            if let Control::Factor(factor) = control {
                slope -= factor * dot(&self.program.varying, direction);
            }
            if slope <= JOINTS.slope * start.abs() {
                *motion = moved;
                return trial;
            }
            let share = if start < 0.0 { start / (start - slope) } else { 0.5 };
            length *= share.clamp(0.2, 0.7);
        }
        add(motion, length, direction);
        self.trial(motion, limits)
    }
}
