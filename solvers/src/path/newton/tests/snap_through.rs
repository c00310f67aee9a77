//! The truss of von Mises with finite displacements.

use crate::path::continuation::dissipation::Dissipation;
use crate::path::newton::NewtonPath;
use crate::path::two_blocks::{Kept, body, settings};
use nalgebra::Rotation2;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{
    Attachment, Constraint, Contact, Continuation, Increment, LoadStep, LoadStepEnd, Loading, MOST_MONITORS, Monitor,
    PathProblem, PathSolver, Period, PointLaw, Sliding, Unobserved,
};

/// Two rigid bars, hinged to each other at the crown and to the ground by a hinge of compliance c in
/// both directions: the truss of von Mises.
fn two_bars(half_span: f64, rise: f64, compliance: f64) -> PathProblem {
    let supports = [Vec2::new(-half_span, 0.0), Vec2::new(half_span, 0.0)];
    let crown = Vec2::new(0.0, rise);
    let bodies = vec![
        body(Vec2::zeros(), vec![], None, true),
        body((supports[0] + crown) / 2.0, vec![], None, false),
        body((supports[1] + crown) / 2.0, vec![], None, false),
    ];
    let hinge = |joint: usize, position: Vec2, minus: usize, plus: usize, compliance: f64| Contact {
        joint,
        position,
        normal: Vec2::new(1.0, 0.0),
        tangent: Vec2::new(0.0, 1.0),
        minus: Attachment { body: minus, slot: None },
        plus: Attachment { body: plus, slot: None },
        area: 1.0,
        gap: 0.0,
        law: PointLaw::Bonded,
        compliance: [compliance; 2],
        sliding: Sliding::middle(0.0),
    };
    let contacts = vec![
        hinge(0, supports[0], 0, 1, compliance),
        hinge(1, crown, 1, 2, 0.0),
        hinge(2, supports[1], 2, 0, compliance),
    ];
    let half = Vec2::new(0.0, -0.5);
    let loading = Loading { forces: vec![(1, None, crown, half), (2, None, crown, half)], ..Loading::default() };
    PathProblem {
        bodies,
        body_of: vec![0, 1, 2],
        contacts,
        load_steps: vec![LoadStep {
            stage: 0,
            gravity: false,
            loading,
            start: 0.0,
            end: LoadStepEnd::Collapse(f64::INFINITY),
            period: Period::default(),
        }],
        length: 2.0 * half_span,
        span: 2.0 * half_span,
        counters: Counters::new(),
        width: 1.0,
    }
}

/// Control of the displacement of a point of the first bar, downwards.
#[derive(Debug, Serialize, Deserialize)]
struct DisplacementOfPoint {
    point: [f64; 2],
}

#[typetag::serde(name = "displacement_of_point")]
impl Continuation for DisplacementOfPoint {
    fn monitors(&self) -> Vec<Monitor> {
        vec![Monitor::Displacement { block: 1, point: self.point, direction: [0.0, -1.0] }]
    }

    fn constraint(&self, increment: &Increment, _previous: Option<&Increment>) -> Constraint {
        let value = increment.monitored[0];
        let mut monitored = [0.0; MOST_MONITORS];
        monitored[0] = if value < 0.0 { -1.0 } else { 1.0 };
        Constraint { value: value.abs(), derivative: Increment { monitored, ..Increment::default() } }
    }

    fn passes_limit_points(&self) -> bool {
        true
    }
}

/// With N the force and L = √(a² + y²) the distance of crown and support, the hinge's springs are in line with the bar
/// (the force acts at the middle of their two ends), so L = ℓ − c N and F = 2 N y / L = (2/c)(ℓ/L − 1) y; the peak is
/// at L³ = ℓ a². The path follows that curve through the peak and the snap.
#[test]
fn two_bars_snap_through() {
    let (a, h, c) = (1.0, 0.2, 1e-3);
    let length = f64::hypot(a, h);
    let load = |y: f64| 2.0 / c * (length / f64::hypot(a, y) - 1.0) * y;
    let at_peak = (length * a * a).powf(1.0 / 3.0);
    let peak = load((at_peak * at_peak - a * a).sqrt());
    for strategy in [
        None,
        Some(Arc::new(crate::path::continuation::displacement_control::DisplacementControl::default())
            as Arc<dyn Continuation>),
        Some(Arc::new(Dissipation::default()) as Arc<dyn Continuation>),
        Some(Arc::new(DisplacementOfPoint { point: [0.0, h] }) as Arc<dyn Continuation>),
    ] {
        let mut how = settings(strategy);
        how.finite = true;
        how.stop_displacement = Some(0.35);
        let mut states = Kept(Vec::new());
        let answer = NewtonPath {}.trace(&two_bars(a, h, c), &how, &mut states);
        // Hanging bars carry more than at the peak: the answer would depend on the end of the path.
        assert_eq!(answer.status, Status::Stalled, "{:?}", answer.notes);
        assert!(answer.notes.iter().any(|note| note.starts_with("still rising")), "{:?}", answer.notes);
        assert_eq!(answer.limit_points.len(), 1);
        let factor = answer.limit_points[0].factor;
        assert!((factor - peak).abs() < 1e-10 * peak, "{factor} {peak}");
        let motion = answer.motion.expect("a motion");
        let velocity = motion[1][1] + motion[1][2] * 0.5;
        assert!((velocity + 1.0).abs() < 0.2, "the crown moves down by about 1 per unit of power: {velocity}");
        let (mut least, mut last) = (0.0f64, 0.0);
        for state in &states.0 {
            let [x, y, theta] = state.motion[1];
            let crown = Vec2::new(-0.5, 0.1) + Vec2::new(x, y) + Rotation2::new(theta) * Vec2::new(0.5, 0.1);
            assert!(crown.x.abs() < 1e-9, "{crown}");
            assert!((state.factor - load(crown.y)).abs() < 1e-9 * peak, "{} {}", state.factor, load(crown.y));
            assert!((state.displacement - (h - crown.y)).abs() < 1e-12);
            least = least.min(state.factor);
            last = state.factor;
        }
        assert!(
            least < -0.99 * peak && last > least,
            "{least} {last}: the snap goes to −peak and the load grows again"
        );
        let end = answer.last.expect("a state after the peak");
        assert!((end.work - end.stored).abs() < 2e-3 * peak * h, "{} {}", end.work, end.stored);
    }
}

/// The same turned by a large angle, in other units, and mirrored: the same factor.
#[test]
fn the_peak_does_not_depend_on_place_or_units() {
    let mut how = settings(None);
    how.finite = true;
    let reference = NewtonPath {}.trace(&two_bars(1.0, 0.2, 1e-3), &how, &mut Unobserved).factor.expect("a peak");
    let mut turned = two_bars(1.0, 0.2, 1e-3);
    let turn = Rotation2::new(2.1);
    let about = |p: Vec2| turn * p + Vec2::new(3.0, -7.0);
    turned.bodies.iter_mut().for_each(|b| b.pole = about(b.pole));
    for c in &mut turned.contacts {
        (c.position, c.normal, c.tangent) = (about(c.position), turn * c.normal, turn * c.tangent);
    }
    for f in &mut turned.load_steps[0].loading.forces {
        (f.2, f.3) = (about(f.2), turn * f.3);
    }
    // Millimetres and meganewtons: lengths × 1000, compliances × 1e9.
    let mut units = two_bars(1000.0, 200.0, 1e-3 * 1e9);
    units.load_steps[0].loading.forces.iter_mut().for_each(|f| f.3 *= 1e-6);
    units.bodies.iter_mut().for_each(|b| b.mass *= 1e-3);
    for problem in [turned, units] {
        let factor = NewtonPath {}.trace(&problem, &how, &mut Unobserved).factor.expect("a peak");
        assert!((factor - reference).abs() < 1e-10 * reference, "{factor} {reference}");
    }
}
