//! One contact point with friction, held by two springs.

use crate::path::continuation::arc_length::ArcLength;
use crate::path::continuation::dissipation::Dissipation;
use crate::path::continuation::load_control::LoadControl;
use crate::path::newton::NewtonPath;
use crate::path::two_blocks::{Kept, SPRINGS, settings, turning, two_degrees};
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{Continuation, LoadStepEnd, PathSolver, Unobserved};

/// Stick to λ = 1.25, slip back to λ = 1 along λ = 1.25 − u_t/4, then open without bound. Strategies have no influence.
#[test]
fn a_path_that_turns_back() {
    for strategy in [Arc::new(ArcLength::default()) as Arc<dyn Continuation>, Arc::new(LoadControl::default())] {
        let mut states = Kept(Vec::new());
        let answer = NewtonPath {}.trace(&turning(), &settings(Some(strategy)), &mut states);
        assert_eq!(answer.status, Status::Unbounded, "{:?}", answer.notes);
        let [peak] = &answer.limit_points[..] else { panic!("{:?}", answer.limit_points) };
        assert!((peak.factor - 1.25).abs() < 1e-12 && (peak.lowest - 1.0).abs() < 1e-12, "{peak:?}");
        let slipped = states.0.iter().find(|state| state.gap[0][1] > 1e-9).expect("a state after slip");
        assert!((slipped.gap[0][1] - 1.0).abs() < 1e-12 && (slipped.factor - 1.0).abs() < 1e-12, "{slipped:?}");
    }
}

/// Total loads f = (1.2, −1), applied together. μ = 0.5, 0.9: separation, u = K⁻¹ f = (1.4, 0.2), the only
/// solution. μ = 1.25, 1.5, 2: sticking, where |f_t| ≤ μ |f_n|; the other solutions of the
/// benchmark (slip, separation) are not sought by a path that starts stuck.
#[test]
fn one_solution_of_the_two_degree_example() {
    for (friction, tangential, normal) in
        [(0.5, 1.4, 0.2), (0.9, 1.4, 0.2), (1.25, 0.0, 0.0), (1.5, 0.0, 0.0), (2.0, 0.0, 0.0)]
    {
        let problem = two_degrees(SPRINGS, friction, vec![(Vec2::new(1.2, -1.0), LoadStepEnd::Factor(1.0))]);
        let answer = NewtonPath {}.trace(&problem, &settings(None), &mut Unobserved);
        assert_eq!(answer.status, Status::Stands, "μ {friction}: {:?}", answer.notes);
        let [n, t] = answer.state.gap[0];
        assert!((n - normal).abs() < 1e-12 && (t - tangential).abs() < 1e-12, "μ {friction}: {n} {t}");
    }
}

/// The same with μ = 1.1, where separation is the only solution too: the step from the stuck state
/// cycles, the one from the open state does not.
#[test]
fn separation_at_a_friction_close_to_the_load() {
    let problem = two_degrees(SPRINGS, 1.1, vec![(Vec2::new(1.2, -1.0), LoadStepEnd::Factor(1.0))]);
    let answer = NewtonPath {}.trace(&problem, &settings(None), &mut Unobserved);
    assert_eq!(answer.status, Status::Stands, "{:?} {:?} {:?}", answer.factor, answer.state.gap, answer.notes);
    let [n, t] = answer.state.gap[0];
    assert!((n - 0.2).abs() < 1e-12 && (t - 1.4).abs() < 1e-12, "{n} {t}");
}

/// A block on a spring, pressed with 1 N, μ = 0.5: slips at 0.5, unloads elastically, slips back after
/// a reversal of twice the friction, and reloads: gap = slip, spring K_t = 1, contact compliant.
#[test]
fn slip_has_a_history() {
    let load_step = |t: f64| (Vec2::new(t, 0.0), LoadStepEnd::Factor(1.0));
    let problem = two_degrees(
        [[1.0, 0.0], [0.0, 2.0]],
        0.5,
        vec![
            (Vec2::new(0.0, -1.0), LoadStepEnd::Factor(1.0)),
            load_step(0.8),
            load_step(-0.6),
            load_step(-0.9),
            load_step(0.5),
            load_step(0.9),
        ],
    );
    // Force f_t = 0.8, 0.2, −0.7, −0.2, 0.7 in turn: slip f − 0.5 = 0.3; stuck while |f − 0.3| ≤ 0.5;
    // back to −0.2; stuck; forward to 0.2.
    let expected = [0.0, 0.3, 0.3, -0.2, -0.2, 0.2];
    for strategy in [
        None,
        Some(Arc::new(LoadControl::default()) as Arc<dyn Continuation>),
        Some(Arc::new(Dissipation::default()) as Arc<dyn Continuation>),
    ] {
        let mut states = Kept(Vec::new());
        let answer = NewtonPath {}.trace(&problem, &settings(strategy), &mut states);
        assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
        for (load_step, slip) in expected.iter().enumerate() {
            let last = states.0.iter().rfind(|s| s.load_step == load_step).expect("a state of every load step");
            assert!((last.gap[0][1] - slip).abs() < 1e-12, "load step {load_step}: {} {slip}", last.gap[0][1]);
        }
        let end = answer.state;
        // Dissipation: μ N × (0.3 + 0.5 + 0.4).
        assert!((end.dissipated - 0.6).abs() < 1e-12, "{}", end.dissipated);
    }
}
