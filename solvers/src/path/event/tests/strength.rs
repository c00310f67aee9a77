//! Joints with a tensile or compressive strength: a block of weight W = 1 N on two points at a distance b = 1 m.

use crate::path::two_blocks::{assert_close, block_on, coulomb, force, live, pushed_at, traced, v};
use voussoir_core::law::Facet;
use voussoir_core::limit::Status;
use voussoir_core::path::{ContactEvent, PointLaw};

/// Coulomb friction with a compressive strength and no tensile strength.
fn crushing(strength: f64) -> PointLaw {
    let [left, right] = Facet::friction(10.0, 0.0, 0.0);
    PointLaw::Facets(vec![Facet::opening(0.0), left, right, Facet::crushing(strength)].into())
}

/// Friction μ with a tensile strength at the apex of its cone.
fn tension(strength: f64) -> PointLaw {
    let [left, right] = Facet::friction(2.0, 2.0 * strength, 0.0);
    PointLaw::Facets(vec![Facet::opening(strength), left, right].into())
}

/// A tensile strength f on the area A of a point raises the load at which a block tips: λ h = W b/2 + f A b.
#[test]
fn a_tensile_strength_delays_tipping() {
    for strength in [0.0, 0.1, 0.25] {
        let answer = traced(&block_on(&[0.0, 1.0], &tension(strength), live(pushed_at(1.0))));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), 0.5 + strength, 1e-12);
    }
}

/// A block is lifted at λ = W + 2 f A by a force at its centre.
#[test]
fn a_tensile_strength_holds_a_lifted_block() {
    let strength = 0.2;
    let answer = traced(&block_on(&[0.0, 1.0], &tension(strength), live(force(v(0.5, 0.5), v(0.0, 1.0)))));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 1.0 + 2.0 * strength, 1e-12);
}

/// Without tensile strength a block is lifted at λ = W.
#[test]
fn a_dry_block_is_lifted_at_its_weight() {
    let answer = traced(&block_on(&[0.0, 1.0], &coulomb(0.5, 0.0, 0.0), live(force(v(0.5, 0.5), v(0.0, 1.0)))));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 1.0, 1e-12);
}

/// The right corner crushes at W/2 + λ h/b = f A, before the block tips.
#[test]
fn a_corner_crushes_before_the_block_tips() {
    let (strength, height) = (0.9, 0.8);
    let answer = traced(&block_on(&[0.0, 1.0], &crushing(strength), live(pushed_at(height))));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), (strength - 0.5) / height, 1e-12);
}

/// On three points with N = W/3 ± M/b the right one begins to crush at λ h = (f A − W/3) b, and the others carry more.
#[test]
fn the_right_point_crushes_first() {
    let (strength, height) = (0.5, 0.8);
    let answer = traced(&block_on(&[0.0, 0.5, 1.0], &crushing(strength), live(pushed_at(height))));
    let crushes = answer.events.iter().find(|event| event.what == ContactEvent::Crushes).expect("a point crushes");
    assert_eq!(crushes.contact, 2);
    assert_close(crushes.factor, (strength - 1.0 / 3.0) / height, 1e-12);
    assert!(answer.factor.expect("a factor") > 1.1 * crushes.factor, "{:?}", answer.factor);
}

/// When the right corner crushes, the block turns about the left one: θ̇ = −1/h, and the centre moves by (b, −b)/(2 h).
#[test]
fn the_mechanism_of_crushing_turns_about_the_other_corner() {
    let height = 0.8;
    let motion = traced(&block_on(&[0.0, 1.0], &crushing(0.9), live(pushed_at(height)))).motion.expect("a mechanism");
    let right = [0.5 / height, -0.5 / height, -1.0 / height];
    right.iter().zip(motion[1]).for_each(|(right, found)| assert_close(found, *right, 1e-9));
}

/// A strength above W does not matter: the corner carries W at most, and the block tips at λ = W b/(2 h).
#[test]
fn a_high_compressive_strength_does_not_matter() {
    let answer = traced(&block_on(&[0.0, 1.0], &crushing(1.1), live(pushed_at(0.8))));
    assert_close(answer.factor.expect("a factor"), 0.5 / 0.8, 1e-12);
    assert!(answer.events.iter().all(|event| event.what != ContactEvent::Crushes), "{:?}", answer.events);
}

/// Pressed at its centre, a block on three points of strength f carries W + λ = 3 f A, and all of them crush together.
#[test]
fn points_crush_together_under_a_central_load() {
    let strength = 1.5;
    let pressed = live(force(v(0.5, 1.0), v(0.0, -1.0)));
    let answer = traced(&block_on(&[0.0, 0.5, 1.0], &crushing(strength), pressed));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 3.0 * strength - 1.0, 1e-12);
    assert_close(answer.motion.expect("a mechanism")[1][1], -1.0, 1e-9);
}

/// Pressed off centre by e, three points carry P = 2 f A b/(b/2 + e) with W = 0: the left point is idle at collapse.
#[test]
fn an_eccentric_load_crushes_the_points_beside_it() {
    // The resultant of two crushed points at x = b/2 and b lies at x = 3 b/4.
    let strength = 1.5;
    let pressed = live(force(v(0.75, 1.0), v(0.0, -1.0)));
    let mut problem = block_on(&[0.0, 0.5, 1.0], &crushing(strength), pressed);
    problem.load_steps.remove(0);
    problem.load_steps[0].stage = 0;
    let answer = traced(&problem);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 2.0 * strength, 1e-12);
}
