//! Results that must not depend on how a scene is written down: mirror image, numbering, place, units.

use crate::path::two_blocks::{assert_close, forces, stack, traced, v};
use nalgebra::Rotation2;
use voussoir_core::law::Facet;
use voussoir_core::limit::Status;
use voussoir_core::path::{Contact, PathAnswer, PathProblem, PointLaw};

/// A stack of two blocks, pushed at the upper one, with one soft corner.
fn scene() -> PathProblem {
    let mut problem = stack([0.32, 0.6], forces(&[(2, v(0.0, 1.3), v(1.0, 0.1)), (1, v(0.0, 0.4), v(0.2, 0.0))]));
    problem.contacts[1].compliance = [3e-4, 2e-4];
    problem
}

/// Loads of all events in order, and of the collapse.
fn loads(answer: &PathAnswer) -> Vec<f64> {
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    answer.events.iter().map(|event| event.factor).chain(answer.factor).collect()
}

#[track_caller]
fn same_loads(one: &PathProblem, other: &PathProblem, scale: f64) {
    let [one, other] = [one, other].map(|problem| loads(&traced(problem)));
    assert!(one.len() > 2 && one.len() == other.len(), "{one:?} {other:?}");
    one.iter().zip(&other).for_each(|(a, b)| assert_close(*b, a * scale, 1e-11 * scale));
}

/// Applies a map of places and directions to a scene.
fn mapped(
    problem: &PathProblem,
    place: impl Fn(f64, f64) -> (f64, f64),
    direction: impl Fn(f64, f64) -> (f64, f64),
) -> PathProblem {
    let mut problem = problem.clone();
    let place = |p: voussoir_core::model::geometry::Vec2| v(place(p.x, p.y).0, place(p.x, p.y).1);
    let direction = |p: voussoir_core::model::geometry::Vec2| v(direction(p.x, p.y).0, direction(p.x, p.y).1);
    problem.bodies.iter_mut().for_each(|b| b.pole = place(b.pole));
    for c in &mut problem.contacts {
        c.position = place(c.position);
        c.normal = direction(c.normal);
        c.tangent = v(-c.normal.y, c.normal.x);
    }
    for f in problem.load_steps.iter_mut().flat_map(|step| &mut step.loading.forces) {
        (f.2, f.3) = (place(f.2), direction(f.3));
    }
    problem
}

/// The mirror image has the same events at the same loads.
#[test]
fn the_mirror_image_has_the_same_events() {
    same_loads(&scene(), &mapped(&scene(), |x, y| (1.0 - x, y), |x, y| (-x, y)), 1.0);
}

/// A scene that is moved and turned as a whole has the same events.
#[test]
fn a_turned_scene_has_the_same_events() {
    let turn = Rotation2::new(0.7);
    let place = |x: f64, y: f64| {
        let p = turn * v(x, y);
        (p.x + 3.0, p.y - 2.0)
    };
    let direction = |x: f64, y: f64| {
        let p = turn * v(x, y);
        (p.x, p.y)
    };
    same_loads(&scene(), &mapped(&scene(), place, direction), 1.0);
}

/// The order of the contact points has no influence.
#[test]
fn renumbered_points_have_the_same_events() {
    let mut renumbered = scene();
    renumbered.contacts.reverse();
    same_loads(&scene(), &renumbered, 1.0);
}

/// The order of the bodies has no influence.
#[test]
fn renumbered_bodies_have_the_same_events() {
    let mut renumbered = scene();
    renumbered.bodies.reverse();
    renumbered.body_of.reverse();
    for c in &mut renumbered.contacts {
        (c.minus.body, c.plus.body) = (2 - c.minus.body, 2 - c.plus.body);
    }
    renumbered.load_steps.iter_mut().flat_map(|step| &mut step.loading.forces).for_each(|f| f.0 = 2 - f.0);
    same_loads(&scene(), &renumbered, 1.0);
}

/// If minus and plus change places, and normals with them, the events are the same.
#[test]
fn exchanged_sides_have_the_same_events() {
    let mut exchanged = scene();
    for c in &mut exchanged.contacts {
        std::mem::swap(&mut c.minus, &mut c.plus);
        (c.normal, c.tangent) = (-c.normal, -c.tangent);
    }
    same_loads(&scene(), &exchanged, 1.0);
}

/// Lengths in millimetres change nothing: places × 1000, compliances × 1000.
#[test]
fn the_unit_of_length_has_no_influence() {
    let mut scaled = mapped(&scene(), |x, y| (1e3 * x, 1e3 * y), |x, y| (x, y));
    scaled.contacts.iter_mut().for_each(|c| c.compliance = c.compliance.map(|c| 1e3 * c));
    (scaled.length, scaled.span) = (1e3, 1e3);
    same_loads(&scene(), &scaled, 1.0);
}

/// Forces in kilonewtons change nothing: forces and stiffness × 1e-3.
#[test]
fn the_unit_of_force_has_no_influence() {
    let mut scaled = scene();
    scaled.contacts.iter_mut().for_each(|c| c.compliance = c.compliance.map(|c| 1e3 * c));
    scaled.load_steps.iter_mut().flat_map(|step| &mut step.loading.forces).for_each(|f| f.3 *= 1e-3);
    same_loads(&scene(), &scaled, 1.0);
}

/// A load that is given half as great needs twice the factor.
#[test]
fn half_the_load_needs_twice_the_factor() {
    let mut halved = scene();
    halved.load_steps[1].loading.forces.iter_mut().for_each(|f| f.3 *= 0.5);
    same_loads(&scene(), &halved, 2.0);
}

/// A stronger facet that is never reached changes nothing: a compressive strength of 100 W.
#[test]
fn a_facet_that_is_never_reached_has_no_influence() {
    let mut more = scene();
    more.contacts.iter_mut().for_each(|contact: &mut Contact| {
        let facets = contact.law.facets().expect("facets").iter().copied();
        contact.law = PointLaw::Facets(facets.chain([Facet::crushing(100.0)]).collect());
    });
    same_loads(&scene(), &more, 1.0);
}
