//! Limit points with finite displacements must not depend on how a scene is written down.

use crate::path::two_blocks::{assert_close, block, followed, pushed_at, v};
use nalgebra::Rotation2;
use voussoir_core::path::{PathProblem, Sliding};

fn tipping() -> PathProblem {
    block(0.9, pushed_at(0.8))
}

fn limit_point(problem: &PathProblem) -> f64 {
    let answer = followed(problem, None);
    answer.factor.unwrap_or_else(|| panic!("{:?}", answer.notes))
}

/// A scene that is moved and turned as a whole, loads with it, has the same limit point.
#[test]
fn a_turned_scene_has_the_same_limit_point() {
    let mut turned = tipping();
    let turn = Rotation2::new(2.5);
    let about = |p| turn * p + v(-4.0, 1.0);
    turned.bodies.iter_mut().for_each(|b| b.pole = about(b.pole));
    for c in &mut turned.contacts {
        (c.position, c.normal, c.tangent) = (about(c.position), turn * c.normal, turn * c.tangent);
    }
    for f in turned.load_steps.iter_mut().flat_map(|step| &mut step.loading.forces) {
        (f.2, f.3) = (about(f.2), turn * f.3);
    }
    assert_close(limit_point(&turned), limit_point(&tipping()), 1e-10);
}

/// Lengths in millimetres and forces in kilonewtons change nothing.
#[test]
fn units_have_no_influence() {
    let mut scaled = tipping();
    scaled.bodies.iter_mut().for_each(|b| b.pole *= 1e3);
    for c in &mut scaled.contacts {
        c.position *= 1e3;
        c.compliance = c.compliance.map(|c| 1e6 * c);
    }
    for f in scaled.load_steps.iter_mut().flat_map(|step| &mut step.loading.forces) {
        (f.2, f.3) = (f.2 * 1e3, f.3 * 1e-3);
    }
    (scaled.length, scaled.span) = (1e3, 1e3);
    assert_close(limit_point(&scaled), limit_point(&tipping()), 1e-10);
}

/// If minus and plus change places, normals, tangents and β with them, the limit point is the same.
#[test]
fn exchanged_sides_have_the_same_limit_point() {
    let mut exchanged = tipping();
    for c in &mut exchanged.contacts {
        std::mem::swap(&mut c.minus, &mut c.plus);
        (c.normal, c.tangent, c.sliding) = (-c.normal, -c.tangent, Sliding::fixed(1.0));
    }
    assert_close(limit_point(&exchanged), limit_point(&tipping()), 1e-11);
}

/// The order of the bodies has no influence.
#[test]
fn renumbered_bodies_have_the_same_limit_point() {
    let mut renumbered = tipping();
    renumbered.bodies.reverse();
    for c in &mut renumbered.contacts {
        (c.minus.body, c.plus.body) = (1 - c.minus.body, 1 - c.plus.body);
    }
    renumbered.load_steps.iter_mut().flat_map(|step| &mut step.loading.forces).for_each(|f| f.0 = 1 - f.0);
    assert_close(limit_point(&renumbered), limit_point(&tipping()), 1e-11);
}

/// The pole of the block is a name for a place only: with another one the limit point is the same.
#[test]
fn the_pole_has_no_influence() {
    let mut moved = tipping();
    moved.bodies[1].pole = v(0.1, 0.9);
    assert_close(limit_point(&moved), limit_point(&tipping()), 1e-11);
}

/// A load that is given half as great needs twice the factor.
#[test]
fn half_the_load_needs_twice_the_factor() {
    let mut halved = tipping();
    halved.load_steps[1].loading.forces.iter_mut().for_each(|f| f.3 *= 0.5);
    assert_close(limit_point(&halved), 2.0 * limit_point(&tipping()), 1e-10);
}
