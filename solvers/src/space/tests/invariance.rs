//! Answers do not depend on units, place, rotation, mirror image and numbering.

use super::closed_forms::wall;
use super::own_flow::{found, without_dilatancy};
use super::scenes::{Scene, collapse};
use voussoir_core::nalgebra::Rotation3;
use voussoir_core::space::{SpaceContact, SpaceProblem, Vec3};

/// Accepted relative change of a factor.
const INVARIANT: f64 = 1e-10;

/// Returns a pier of a wall with one block that stands apart, so that nothing is symmetric.
pub fn scene(bricks: usize, courses: usize) -> Scene {
    let mut scene = wall(bricks, courses, 0.45);
    scene.bodies[2].0 *= 1.7;
    scene.bodies[4].1.x += 0.3;
    scene
}

pub fn direction() -> Vec3 {
    Vec3::new(0.3, 0.9, 0.1)
}

/// Maps the points and directions of a problem; moments of loads follow.
pub fn mapped(
    problem: &SpaceProblem,
    point: impl Fn(&Vec3) -> Vec3,
    vector: impl Fn(&Vec3) -> Vec3,
    mirror: bool,
) -> SpaceProblem {
    let mut image = problem.clone();
    for contact in &mut image.contacts {
        [&mut contact.inner, &mut contact.outer]
            .into_iter()
            .flat_map(|set| &mut set.points)
            .for_each(|x| *x = point(x));
        contact.frame = contact.frame.map(|x| vector(&x));
        if mirror {
            contact.frame.swap(1, 2);
        }
    }
    let origin = point(&Vec3::zeros());
    for wrench in image.fixed.iter_mut().chain(&mut image.varying) {
        let force = vector(&Vec3::new(wrench[0], wrench[1], wrench[2]));
        let sign = if mirror { -1.0 } else { 1.0 };
        let moment = vector(&Vec3::new(wrench[3], wrench[4], wrench[5])) * sign + origin.cross(&force);
        *wrench = [force.x, force.y, force.z, moment.x, moment.y, moment.z];
    }
    image
}

fn same(problem: &SpaceProblem, image: &SpaceProblem, case: &str) {
    let (own, other) = (collapse(problem), collapse(image));
    assert!((own - other).abs() <= INVARIANT * own, "{case}: {own} and {other}");
}

/// Rotations, shifts and mirror images keep the factor.
#[test]
fn rotated_shifted_and_mirrored_scenes_have_the_same_factor() {
    let problem = scene(3, 4).problem(&direction());
    let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    same(&problem, &mapped(&problem, |x| turn * x, |x| turn * x, false), "rotation");
    let shift = Vec3::new(3.0, -7.0, 5.0);
    same(&problem, &mapped(&problem, |x| x + shift, |x| *x, false), "shift");
    let mirror = |x: &Vec3| Vec3::new(x.x, -x.y, x.z);
    same(&problem, &mapped(&problem, mirror, mirror, true), "mirror");
}

/// Returns the problem in other units of length and force.
pub fn in_units(problem: &SpaceProblem, [length, force]: [f64; 2]) -> SpaceProblem {
    let mut image = problem.clone();
    for contact in &mut image.contacts {
        for set in [&mut contact.inner, &mut contact.outer] {
            set.points.iter_mut().for_each(|x| *x *= length);
            set.areas.iter_mut().for_each(|area| *area *= length * length);
        }
    }
    image.length *= length;
    for wrench in image.fixed.iter_mut().chain(&mut image.varying) {
        wrench.iter_mut().for_each(|x| *x *= force);
        wrench[3..].iter_mut().for_each(|x| *x *= length);
    }
    image
}

/// Returns the problem with another order of bodies, contacts and points; some contacts have another side as plus.
pub fn renumbered(problem: &SpaceProblem) -> SpaceProblem {
    let mut image = problem.clone();
    let count = image.bodies;
    let renamed = |body: Option<usize>| body.map(|body| count - 1 - body);
    image.fixed.reverse();
    image.varying.reverse();
    image.contacts.reverse();
    for (k, contact) in image.contacts.iter_mut().enumerate() {
        let SpaceContact { minus, plus, inner, outer, frame, .. } = contact;
        (*minus, *plus) = (renamed(*minus), renamed(*plus));
        for set in [inner, outer] {
            set.points.rotate_left(k % 3);
            set.areas.rotate_left(k % 3);
        }
        if k % 2 == 0 {
            (*minus, *plus) = (*plus, *minus);
            *frame = [-frame[0], frame[2], frame[1]];
        }
    }
    image
}

/// Units of length and force keep the factor.
#[test]
fn units_do_not_change_the_factor() {
    let problem = scene(3, 4).problem(&direction());
    for units in [[1e3, 1.0], [1.0, 1e6], [1e-3, 1e-4]] {
        same(&problem, &in_units(&problem, units), "units");
    }
}

/// The order of bodies, contacts and points, and the side that is called plus, keep the factor.
#[test]
fn numbering_does_not_change_the_factor() {
    let problem = scene(3, 4).problem(&direction());
    same(&problem, &renumbered(&problem), "numbering");
}

/// Images of a wall have the same state with slip that does not open the joints: the courses run in one position.
#[test]
fn images_have_the_same_state() {
    let problem = without_dilatancy(&scene(2, 3), &direction());
    let own = found(&problem).0;
    let turn = Rotation3::from_euler_angles(0.0, 0.0, 2.3);
    let turned = mapped(&problem, |x| turn * x, |x| turn * x, false);
    let mirror = |x: &Vec3| Vec3::new(-x.x, x.y, x.z);
    let mirrored = mapped(&problem, mirror, mirror, true);
    for image in [renumbered(&turned), in_units(&mirrored, [0.01, 1e3])] {
        let other = found(&image).0;
        assert!((own - other).abs() <= INVARIANT * own, "{own} and {other}");
    }
}
