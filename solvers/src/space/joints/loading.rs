//! Loading from zero stress: the course that decides if a structure stands.
//!
//! Every step obeys the law; steps with fictitious cohesion only lead to a first guess. A step counts if two steps of half its size lead to
//! nearly the same forces, so that few falls of the load factor are passed over. The course ends when the load factor reaches its end or becomes constant.

use super::course::{along, by_cohesion, compliance, dead_load, own_step, settled};
use super::step::{Control, Joints, Step};
use crate::space::program::Bodies;
use crate::space::settings::JOINTS;

/// The end of a course. Factors are above the start.
pub enum Loaded {
    /// Forces (n, s, t) of all points in equilibrium at the end. The factor never fell.
    Carries(Vec<[f64; 3]>),
    /// The factor falls from this one and reaches the end later: under a constant load the blocks move, and perhaps stop later.
    Snaps(f64),
    /// A mechanism moves at a constant factor. This is the greatest factor of the course.
    Collapses(f64),
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
    let mut peak = None;
    'course: for _ in 0..JOINTS.iterations {
        if power < JOINTS.least * compliance {
            break;
        }
        let Some(halves) = halves(joints, &rate, [lambda, power], accuracy) else {
            power *= JOINTS.shorter;
            continue;
        };
        for Step { motion, lambda: reached, contacts } in halves {
            if reached >= end {
                if let Some(peak) = peak {
                    return Loaded::Snaps(peak);
                }
                let share = (end - lambda) / (reached - lambda);
                let guess = motion.iter().map(|u| u * share).collect();
                let Some(step) = joints.coulomb(guess, end, Control::Factor(end)) else {
                    power *= JOINTS.shorter;
                    continue 'course;
                };
                return Loaded::Carries(step.contacts.iter().map(|contact| contact.force).collect());
            }
            if reached < lambda - JOINTS.differ * lambda.abs() {
                peak = Some(peak.map_or(lambda, |peak: f64| peak.max(lambda)));
            }
            (joints.contacts, lambda) = (contacts, reached);
            rate = motion.iter().map(|u| u / (0.5 * power)).collect();
        }
        if settled(joints, &rate, lambda) {
            return Loaded::Collapses(peak.map_or(lambda, |peak| peak.max(lambda)));
        }
        power = (power * growth).min(JOINTS.greatest * compliance);
    }
    Loaded::Stops(lambda)
}

/// Returns two half steps in place of a step. `None` if a step is not solved, or if the forces differ.
fn halves(joints: &mut Joints, rate: &[f64], [lambda, power]: [f64; 2], accuracy: f64) -> Option<[Step; 2]> {
    let guess: Bodies = rate.iter().map(|q| q * power).collect();
    let full = match own_step(joints, &guess, lambda, power) {
        Some(step) => step,
        None => {
            let normals = joints.contacts.iter().map(|contact| contact.force[0]).collect();
            by_cohesion(joints, guess, lambda, Control::Power, normals)?
        }
    };
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
