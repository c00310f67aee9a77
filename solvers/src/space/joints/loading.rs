//! Loading from zero stress: the course that decides if a structure stands.
//!
//! Every step obeys the law. It counts if two steps of half its size lead to nearly the same forces, so that no fall of the load factor is
//! passed over. The course ends when the load factor reaches its end, falls, or becomes constant.

use super::course::{along, compliance, dead_load, settled};
use super::step::{Control, Joints, Step};
use crate::space::program::Bodies;
use crate::space::settings::JOINTS;

/// The end of a course. Factors are above the start.
pub enum Loaded {
    /// Forces (n, s, t) of all points in equilibrium at the end.
    Carries(Vec<[f64; 3]>),
    /// The factor falls or is constant after this one.
    Falls(f64),
    /// No step was solved beyond this factor.
    Stops(f64),
    /// The dead load was not carried.
    Fell,
}

/// Loads joints without stress up to a factor above the start, with `parts` steps in place of each one.
pub fn load(joints: &mut Joints, end: f64, parts: f64) -> Loaded {
    if dead_load(joints).is_none() {
        return Loaded::Fell;
    }
    let compliance = compliance(joints);
    let growth = JOINTS.growth.powf(parts.recip());
    let accuracy = JOINTS.accuracy / (parts * parts);
    let (mut lambda, mut power) = (0.0, JOINTS.first / parts * compliance);
    let mut rate = along(joints.program, 1.0);
    for _ in 0..JOINTS.iterations {
        if power < JOINTS.least * compliance {
            break;
        }
        let guess = rate.iter().map(|q| q * power).collect();
        let Some(halves) = halves(joints, guess, lambda, accuracy) else {
            power *= JOINTS.shorter;
            continue;
        };
        for Step { motion, lambda: reached, contacts } in halves {
            if reached >= end {
                let share = (end - lambda) / (reached - lambda);
                let guess = motion.iter().map(|u| u * share).collect();
                let step = joints.coulomb(guess, end, Control::Factor(end));
                return step.map_or(Loaded::Stops(lambda), |step| {
                    Loaded::Carries(step.contacts.iter().map(|contact| contact.force).collect())
                });
            }
            if reached < lambda - JOINTS.differ * lambda.abs() {
                return Loaded::Falls(lambda);
            }
            (joints.contacts, lambda) = (contacts, reached);
            rate = motion.iter().map(|u| u / (0.5 * power)).collect();
        }
        if settled(joints, &rate, lambda) {
            return Loaded::Falls(lambda);
        }
        power = (power * growth).min(JOINTS.greatest * compliance);
    }
    Loaded::Stops(lambda)
}

/// Returns two half steps in place of a step. `None` if a step is not solved, or if the forces differ.
fn halves(joints: &mut Joints, guess: Bodies, lambda: f64, accuracy: f64) -> Option<[Step; 2]> {
    let full = joints.coulomb(guess, lambda, Control::Power)?;
    let half = full.motion.iter().map(|u| 0.5 * u).collect();
    let first = joints.coulomb(half, lambda, Control::Power)?;
    let before = std::mem::replace(&mut joints.contacts, first.contacts.clone());
    let second = joints.coulomb(first.motion.clone(), first.lambda, Control::Power);
    joints.contacts = before;
    let second = second?;
    let (mut greatest, mut error) = (0.0f64, 0.0f64);
    for (a, b) in full.contacts.iter().zip(&second.contacts).flat_map(|(a, b)| a.force.iter().zip(&b.force)) {
        greatest = greatest.max(b.abs());
        error = error.max((a - b).abs());
    }
    (error <= accuracy * greatest).then_some([first, second])
}
