//! G and its transpose: gaps of motions, and resultants of forces.

use super::{system, uneven};
use crate::path::two_blocks::assert_close;
use nalgebra::Rotation2;
use voussoir_core::model::geometry::{Vec2, cross};
use voussoir_core::path::PathProblem;

/// Motions of both blocks in units, from physical ones.
fn scaled(problem: &PathProblem, motions: [[f64; 3]; 2]) -> Vec<f64> {
    let system = system(problem);
    let mut x = vec![0.0; system.size()];
    for (body, motion) in motions.iter().enumerate() {
        for (k, value) in motion.iter().enumerate() {
            let (at, unit) = system.column(2 * system.contacts + 3 * (body + 1) + k).expect("a free body");
            x[at] = value / unit;
        }
    }
    x
}

/// G q is the derivative of the jump between the displaced places of both sides, by exact rotations of ε.
#[test]
fn gaps_of_motions_are_derivatives_of_places() {
    let problem = uneven();
    let system = system(&problem);
    let motions = [[0.3, -0.2, 0.5], [-0.4, 0.1, -0.7]];
    let gaps = system.gaps(&scaled(&problem, motions));
    let place = |body: usize, point: Vec2, step: f64| {
        let pole = problem.bodies[body].pole;
        let [x, y, theta] = if body == 0 { [0.0; 3] } else { motions[body - 1].map(|q| step * q) };
        pole + Vec2::new(x, y) + Rotation2::new(theta) * (point - pole)
    };
    for (contact, gap) in problem.contacts.iter().zip(gaps) {
        let jump =
            |step| place(contact.plus.body, contact.position, step) - place(contact.minus.body, contact.position, step);
        let rate = (jump(1e-6) - jump(-1e-6)) / 2e-6;
        for (k, e) in [contact.normal, contact.tangent].iter().enumerate() {
            assert_close(gap[k] * system.units.displacement, rate.dot(e), 1e-9);
        }
    }
}

/// Two blocks that turn together about one place open no gap between them, and a gap to the ground.
#[test]
fn a_common_motion_opens_nothing_between_the_blocks() {
    let problem = uneven();
    let rotation = 0.6;
    // About the origin: each pole p moves by θ × p.
    let about_origin = |body: usize| {
        let pole = problem.bodies[body].pole;
        [-rotation * pole.y, rotation * pole.x, rotation]
    };
    let gaps = system(&problem).gaps(&scaled(&problem, [about_origin(1), about_origin(2)]));
    gaps[2..].iter().flatten().for_each(|gap| assert_close(*gap, 0.0, 1e-9 / 1e-4));
    assert!(gaps[0][1].abs() + gaps[1][0].abs() > 1e-3);
}

/// Gᵀ r are the forces and moments of contact forces about the poles: +r on plus, −r on minus.
#[test]
fn resultants_are_forces_and_moments() {
    let problem = uneven();
    let system = system(&problem);
    let forces = [[1.0, 0.2], [2.0, -0.3], [0.5, 0.4], [0.7, 0.1]];
    let mut x = vec![0.0; system.size()];
    for (c, r) in forces.iter().enumerate() {
        (0..2).for_each(|k| x[2 * c + k] = r[k] / system.units.force);
    }
    let found = system.resultants(&x);
    for body in [1, 2] {
        let (mut sum, mut moment) = (Vec2::zeros(), 0.0);
        for (contact, r) in problem.contacts.iter().zip(forces) {
            let push = contact.normal * r[0] + contact.tangent * r[1];
            for (side, sign) in [(contact.plus.body, 1.0), (contact.minus.body, -1.0)] {
                if side == body {
                    sum += push * sign;
                    moment += sign * cross(contact.position - problem.bodies[body].pole, push);
                }
            }
        }
        let unit = system.units.force;
        for (k, right) in [sum.x, sum.y, moment / problem.length].into_iter().enumerate() {
            assert_close(found[3 * (body - 1) + k] * unit, right, 1e-12);
        }
    }
}

/// r·(G q) = (Gᵀ r)·q for any forces and motions.
#[test]
fn forces_do_as_much_work_on_gaps_as_on_motions() {
    let problem = uneven();
    let system = system(&problem);
    let forces = 2 * system.contacts;
    let x: Vec<f64> = (0..system.size()).map(|i| ((3 * i + 1) as f64).sin()).collect();
    let mut motions = x.clone();
    motions[..forces].fill(0.0);
    let on_gaps: f64 = system.gaps(&motions).iter().flatten().zip(&x).map(|(g, r)| g * r).sum();
    let on_motions: f64 = system.resultants(&x).iter().zip(&x[forces..]).map(|(w, q)| w * q).sum();
    assert_close(on_gaps, on_motions, 1e-12);
}

/// Motions converted to units and back are the same, and held bodies rest.
#[test]
fn motions_come_back_from_their_units() {
    let problem = uneven();
    let system = system(&problem);
    let motions = [[0.3, -0.2, 0.5], [-0.4, 0.1, -0.7]];
    let found = system.motions(&scaled(&problem, motions)[2 * system.contacts..]);
    assert_eq!(found[0], [0.0; 3]);
    for (found, right) in found[1..].iter().flatten().zip(motions.iter().flatten()) {
        assert_close(*found, *right, 1e-14);
    }
    assert!(system.column(2 * system.contacts).is_none());
}
