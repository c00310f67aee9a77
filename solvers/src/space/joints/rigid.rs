//! Sequences of rigid programs: first guesses of collapse states.
//!
//! With known normal forces n̄ a program with |t| ≤ μ n̄ and n ≥ 0 has a mechanism with slip that does not open the joints. The next
//! program uses the new normal forces (Gilbert, Casapulla and Ahmed 2006). Often many mechanisms have the same factor, and an interior
//! point method returns a mean of them in which all joints slip. A small cohesion and tensile strength of all points makes such a mean
//! dearer than a mechanism with few joints.

use crate::space::by_clarabel::guess;
use crate::space::program::{Program, Side};
use crate::space::settings::JOINTS;
use voussoir_core::law::FrictionCone;
use voussoir_core::space::{PointSet, SpaceContact, SpaceField, SpaceProblem, SpaceVelocity};

/// Approximate forces and mechanism.
pub struct Guess {
    /// Load factor.
    pub factor: f64,
    /// Forces \[N\].
    pub field: SpaceField,
    /// Mechanism with any power.
    pub motion: Vec<SpaceVelocity>,
}

/// Returns the problem with the fictitious cohesion of known normal forces. Each point is a contact.
fn fictitious(problem: &SpaceProblem, normals: &[Vec<f64>], few: f64) -> SpaceProblem {
    let of = |contact: &SpaceContact, point: usize, normal: f64| {
        let set = PointSet { points: vec![contact.inner.points[point]], areas: vec![1.0] };
        let friction = contact.law.friction;
        let cohesion = if friction > 0.0 { friction * normal + few } else { 0.0 };
        let law = FrictionCone { cohesion, tensile_strength: few, ..FrictionCone::dry(0.0, 0.0) };
        SpaceContact { inner: set.clone(), outer: set, law, ..contact.clone() }
    };
    let points = problem.contacts.iter().zip(normals);
    let contacts = points
        .flat_map(|(contact, normals)| normals.iter().enumerate().map(move |(point, n)| of(contact, point, *n)))
        .collect();
    SpaceProblem { contacts, ..problem.clone() }
}

/// Returns the guesses of a sequence for loads that start at a factor. It begins with normal forces that are not negative.
pub fn sequence(problem: &SpaceProblem, start: f64, mut normals: Vec<Vec<f64>>) -> Vec<Guess> {
    let few = JOINTS.few * mean(&normals);
    let mut guesses = Vec::new();
    while guesses.len() < JOINTS.programs {
        let program = Program::new(&fictitious(problem, &normals, few), start, Side::Inner);
        let Some((y, lambda, q)) = guess(&program) else { break };
        let mut forces = program.forces(&y).into_iter().flatten();
        let field: SpaceField = normals.iter().map(|own| forces.by_ref().take(own.len()).collect()).collect();
        let share = if guesses.is_empty() { 1.0 } else { JOINTS.relaxed };
        let points = normals.iter_mut().flatten().zip(field.iter().flatten());
        points.for_each(|(normal, force)| *normal += share * (force[0].max(0.0) - *normal));
        guesses.push(Guess { factor: start + lambda * program.unit, field, motion: program.motion(&q) });
    }
    guesses
}

/// Returns the mean normal force.
pub fn mean(normals: &[Vec<f64>]) -> f64 {
    normals.iter().flatten().sum::<f64>() / normals.iter().flatten().count().max(1) as f64
}
