//! Cohesion, tension and crushing: one block on the ground against closed forms.

use super::invariance::mapped;
use super::scenes::{COLLAPSE, certified, frame, rectangle};
use crate::space::solve;
use voussoir_core::law::FrictionCone;
use voussoir_core::limit::Status;
use voussoir_core::nalgebra::Rotation3;
use voussoir_core::space::{SpaceContact, SpaceProblem, Vec3, Wrench};

const WIDTH: f64 = 2.0;
const DEPTH: f64 = 1.5;
const HEIGHT: f64 = 3.0;
const WEIGHT: f64 = WIDTH * DEPTH * HEIGHT;

fn law(friction: f64, cohesion: f64, tensile_strength: f64, compressive_strength: f64) -> FrictionCone {
    FrictionCone { friction, dilatancy: friction, cohesion, tensile_strength, compressive_strength }
}

/// Returns the block on the ground under its weight and a varying wrench about the middle of its base.
fn block(law: FrictionCone, parts: usize, varying: Wrench) -> SpaceProblem {
    let corners = rectangle([-WIDTH / 2.0, WIDTH / 2.0], [-DEPTH / 2.0, DEPTH / 2.0], 0.0);
    SpaceProblem {
        free: vec![Some(0)],
        bodies: 1,
        contacts: vec![SpaceContact::new(0, [None, Some(0)], &corners, frame(&Vec3::z()), (law, parts))],
        fixed: vec![[0.0, 0.0, -WEIGHT, 0.0, 0.0, 0.0]],
        varying: vec![varying],
        pole: Vec3::zeros(),
        length: 4.0,
    }
}

/// Weight times λ along x at the centroid.
const PUSH: Wrench = [WEIGHT, 0.0, 0.0, 0.0, WEIGHT * HEIGHT / 2.0, 0.0];
/// Weight times λ times a unit of length, about the vertical axis.
const TWIST: Wrench = [0.0, 0.0, 0.0, 0.0, 0.0, WEIGHT];

/// Returns the proved bounds.
fn bounds(problem: &SpaceProblem) -> [f64; 2] {
    let answer = solve(problem, COLLAPSE);
    let verdict = certified(problem, &answer, COLLAPSE);
    assert!(matches!(verdict.status, Status::Collapse | Status::Open), "{:?} {:?}", answer.notes, verdict.certificate);
    verdict.bounds.map(|bound| bound.expect("both bounds are proved"))
}

fn meet([low, high]: [f64; 2], exact: f64) {
    assert!((low - exact).abs() < 1e-8 && (high - exact).abs() < 1e-8, "[{low}, {high}] {exact}");
}

/// A cohesive joint with tension up to the tip of its cone slides at λ = μ + c A/W, with bounds that meet.
#[test]
fn cohesion_adds_its_area_to_sliding() {
    let [friction, cohesion] = [0.3, 0.4];
    let problem = block(law(friction, cohesion, f64::INFINITY, f64::INFINITY), 1, PUSH);
    assert!(problem.is_exact());
    meet(bounds(&problem), friction + cohesion * WIDTH * DEPTH / WEIGHT);
}

/// Without crushing a joint with tension opens about its edge at λ h/2 = b/2 (1 + f_t A/W), with bounds that meet.
#[test]
fn tension_delays_overturning() {
    let tension = 0.5;
    let problem = block(law(0.8, 5.0, tension, f64::INFINITY), 2, PUSH);
    meet(bounds(&problem), WIDTH / HEIGHT * (1.0 + tension * WIDTH * DEPTH / WEIGHT));
}

/// A block that crushes its edge topples at λ = (b − W/(f_c d))/h; the bounds enclose it, and finer parts bring them closer.
#[test]
fn crushing_moves_the_hinge_inwards() {
    let crushing = 40.0;
    let exact = (WIDTH - WEIGHT / (crushing * DEPTH)) / HEIGHT;
    let brackets = [3, 12].map(|parts| bounds(&block(law(2.0, 0.0, 0.0, crushing), parts, PUSH)));
    for [low, high] in brackets {
        assert!(low < exact && exact < high, "[{low}, {high}] {exact}");
    }
    let [coarse, fine] = brackets.map(|[low, high]| high - low);
    assert!(fine < 0.25 * coarse && fine < 0.03 * exact, "{coarse} {fine}");
}

/// Torsion of a rectangular base a × b with cohesion, friction and no tension: the bounds enclose μ W D/2, by forces at the
/// vertices, plus c ∫ r dA = c [2abD + a³ ln((b + D)/a) + b³ ln((a + D)/b)]/12. The block lifts by μ D/2 per turn.
#[test]
fn torsion_of_a_cohesive_base_is_enclosed() {
    let (cohesion, [a, b]) = (3.0, [WIDTH, DEPTH]);
    let friction = 0.4;
    let exact = cohesion * polar() / WEIGHT + friction * a.hypot(b) / 2.0;
    let [low, high] = bounds(&block(law(friction, cohesion, 0.0, f64::INFINITY), 8, TWIST));
    assert!(low < exact && exact < high, "[{low}, {high}] {exact}");
    assert!(high - low < 0.01 * exact, "[{low}, {high}]");
}

/// Returns ∫ r dA of the base.
fn polar() -> f64 {
    let ([a, b], d) = ([WIDTH, DEPTH], WIDTH.hypot(DEPTH));
    (2.0 * a * b * d + a.powi(3) * ((b + d) / a).ln() + b.powi(3) * ((a + d) / b).ln()) / 12.0
}

/// A cohesive joint without friction slides at λ = c A/W, also if it can be crushed or torn, and torsion reaches c ∫ r dA. With enough
/// cohesion it overturns at the load of a joint with tension.
#[test]
fn cohesion_without_friction_has_its_closed_forms() {
    let (cohesion, area) = (1.2, WIDTH * DEPTH);
    for [tension, crushing] in [[0.0, f64::INFINITY], [0.5, f64::INFINITY], [0.0, 400.0]] {
        for parts in [1, 4] {
            meet(bounds(&block(law(0.0, cohesion, tension, crushing), parts, PUSH)), cohesion * area / WEIGHT);
        }
    }
    let exact = cohesion * polar() / WEIGHT;
    let [low, high] = bounds(&block(law(0.0, cohesion, 0.0, f64::INFINITY), 8, TWIST));
    assert!(low < exact && exact < high && high - low < 0.01 * exact, "[{low}, {high}] {exact}");
    let tension = 0.5;
    let overturning = WIDTH / HEIGHT * (1.0 + tension * area / WEIGHT);
    meet(bounds(&block(law(0.0, 5.0, tension, f64::INFINITY), 3, PUSH)), overturning);
}

/// The compressive strength defines where the normal force may be: in torsion the pressure is f_c outside a circle of radius r₀ with
/// N = f_c (A − π r₀²), and the moment is μ f_c (∫ r dA − 2 π r₀³/3). For f_c = N/A the pressure is uniform.
#[test]
fn crushing_limits_torsion() {
    let (friction, area) = (0.4, WIDTH * DEPTH);
    for ratio in [1.02, 1.5, 2.2] {
        let radius = (area * (1.0 - 1.0 / ratio) / std::f64::consts::PI).sqrt();
        let lost = 2.0 * std::f64::consts::PI / 3.0 * radius.powi(3);
        let exact = friction * ratio / area * (polar() - lost);
        let [low, high] = bounds(&block(law(friction, 0.0, 0.0, ratio * WEIGHT / area), 8, TWIST));
        assert!(low < exact && exact < high && high - low < 0.02 * exact, "{ratio}: [{low}, {high}] {exact}");
    }
}

/// A tensile strength just below the tip gives nearly the bounds of the cone, although another program finds them.
#[test]
fn the_cut_at_the_tip_has_no_effect() {
    let [friction, cohesion] = [0.5, 0.3];
    let whole = bounds(&block(law(friction, cohesion, f64::INFINITY, f64::INFINITY), 1, PUSH));
    let cut = bounds(&block(law(friction, cohesion, 0.9999999 * cohesion / friction, f64::INFINITY), 3, PUSH));
    assert!(whole.iter().zip(cut).all(|(whole, cut)| (whole - cut).abs() < 1e-6), "{whole:?} {cut:?}");
}

/// Rotations and mirror images keep both bounds of a base that crushes while it turns and tilts. The lower one loses up to 1e-8
/// where the repair mixes the forces with others.
#[test]
fn rotated_and_mirrored_bounds_are_equal() {
    let both = [0, 1, 2, 3, 4, 5].map(|k| PUSH[k] + TWIST[k]);
    let problem = block(law(0.6, 1.0, 0.3, 40.0), 3, both);
    let own = bounds(&problem);
    let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    let mirror = |x: &Vec3| Vec3::new(-x.x, x.y, x.z);
    let images = [mapped(&problem, |x| turn * x, |x| turn * x, false), mapped(&problem, mirror, mirror, true)];
    for image in images {
        let other = bounds(&image);
        assert!(own.iter().zip(other).all(|(own, other)| (own - other).abs() < 1e-7 * own), "{own:?} {other:?}");
    }
}

/// A weight that the joint cannot carry is refuted, with the dissipation of crushing.
#[test]
fn a_crushed_base_has_no_equilibrium() {
    let pressure = WEIGHT / (WIDTH * DEPTH);
    let problem = block(law(0.5, 0.0, 0.0, 0.99 * pressure), 2, PUSH);
    let answer = solve(&problem, COLLAPSE);
    assert_eq!(certified(&problem, &answer, COLLAPSE).status, Status::NoEquilibrium, "{:?}", answer.notes);
}
