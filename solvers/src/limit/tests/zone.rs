//! Tests of the zone of thrust.

use super::scenes::{Dry, STUCK, block, lintel, ring};
use crate::limit::chain::{ChainEngine, LimitChain};
use crate::limit::conic;
use crate::limit::thrust_zone::{thrust_zone, zone_by};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use voussoir_core::limit::{Engine, ForceVariables, LimitProblem, LimitQuestion, LimitSolver, combined};
use voussoir_core::model::Wrenches;

const RUBBED: Dry = Dry { friction: Some(0.6), ..STUCK };

/// A ring under its weight and a share of the live load at collapse; returns it with that load.
fn loaded(dry: Dry, voussoirs: usize, share: f64) -> (LimitProblem, Wrenches) {
    let problem = ring(voussoirs, 0.8, 1.2, dry);
    let answer = LimitChain {}.solve(&problem, LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY });
    let factor = answer.factor.expect("a collapse load");
    let loads = combined(&problem.fixed, &problem.varying, share * factor);
    (problem, loads)
}

/// Returns the least or greatest M/N of a joint by one linear program over forces divided by the normal force of that
/// joint (Charnes and Cooper 1962), over all joint forces. It does not use redundants.
fn end_by_one_program(problem: &LimitProblem, loads: &Wrenches, joint: usize, sense: f64) -> f64 {
    let variables = ForceVariables::new(problem);
    let (unit, last) = (problem.magnitude(loads), variables.count);
    let (mut entries, mut b) = (Vec::new(), Vec::new());
    for (i, row) in variables.equilibrium(problem).iter().enumerate() {
        row.iter().for_each(|&(j, v)| entries.push((b.len(), j, v)));
        let scale = if i % 3 == 2 { problem.length } else { 1.0 };
        entries.push((b.len(), last, loads[i / 3][i % 3] / scale / unit));
        b.push(0.0);
    }
    let (first, _) = variables.joints[joint];
    entries.extend([(b.len(), first, 1.0), (b.len(), first + 1, 1.0)]);
    b.push(1.0);
    let equations = b.len();
    for (joint, &(first, own)) in problem.joints.iter().zip(&variables.joints) {
        for row in &joint.strength.rows {
            (0..own).for_each(|k| entries.push((b.len(), first + k, row.normal[k])));
            entries.push((b.len(), last, -row.bound / unit));
            b.push(0.0);
        }
    }
    entries.push((b.len(), last, -1.0));
    b.push(0.0);
    let [rows, columns] = [0, 1].map(|i| entries.iter().map(|e| [e.0, e.1][i]).collect::<Vec<_>>());
    let values = entries.iter().map(|e| e.2).collect();
    let a = CscMatrix::new_from_triplets(b.len(), last + 1, rows, columns, values);
    let mut q = vec![0.0; last + 1];
    (q[first], q[first + 1]) = (sense / 2.0, -sense / 2.0);
    let cones = [SupportedConeT::ZeroConeT(equations), SupportedConeT::NonnegativeConeT(b.len() - equations)];
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: 1e-12,
        tol_gap_rel: 1e-12,
        tol_feas: 1e-12,
        ..Default::default()
    };
    let p = CscMatrix::zeros((last + 1, last + 1));
    let mut solver = DefaultSolver::new(&p, &q, &a, &b, &cones, settings).expect("a program");
    solver.solve();
    assert!(matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved));
    let height = (problem.joints[joint].ends[1] - problem.joints[joint].ends[0]).norm();
    (solver.solution.x[first + 1] - solver.solution.x[first]) / 2.0 * height
}

fn assert_near(found: f64, known: f64, tolerance: f64, what: &str) {
    assert!((found - known).abs() <= tolerance, "{what}: {found} instead of {known}");
}

/// A single block has one field: its zone is a point, b/2 λ/λ_c from the middle.
#[test]
fn a_block_has_one_eccentricity() {
    let problem = block(1.0, 2.0, STUCK);
    let loads = combined(&problem.fixed, &problem.varying, 0.2);
    let [least, greatest] = thrust_zone(&problem, &loads)[0].expect("a zone");
    assert_near(greatest.abs(), 0.2, 1e-12, "lever h λ / 2");
    assert_near(least, greatest, 1e-12, "one field");
}

/// Three methods agree: ratios over the redundants, ratios over all forces, and one program over normalised forces.
#[test]
fn three_ways_find_the_same_zone() {
    for dry in [STUCK, RUBBED] {
        let (problem, loads) = loaded(dry, 9, 0.6);
        let zone = thrust_zone(&problem, &loads);
        let conic = zone_by(&problem, &loads, vec![conic::engine(&problem)]);
        for joint in 0..problem.joints.len() {
            let (own, other) = (zone[joint].expect("a zone"), conic[joint].expect("a zone"));
            assert!(own[1] - own[0] > 1e-3, "{own:?}");
            for (end, sense) in [-1.0, 1.0].into_iter().enumerate() {
                assert_near(own[end], other[end], 1e-9, "by all forces");
                assert_near(own[end], end_by_one_program(&problem, &loads, joint, sense), 1e-6, "by one program");
            }
        }
    }
}

/// Both engines use stress blocks of crushing joints; the zone of a weak ring lies within the zone of a strong one.
#[test]
fn crushing_narrows_the_zone() {
    let (_, loads) = loaded(Dry { crushing: Some(20.0), ..RUBBED }, 7, 0.5);
    let crushed = |strength: f64| {
        let problem = ring(7, 0.8, 1.2, Dry { crushing: Some(strength), ..RUBBED });
        let zone = thrust_zone(&problem, &loads);
        let conic = zone_by(&problem, &loads, vec![conic::engine(&problem)]);
        for (own, other) in zone.iter().zip(&conic) {
            let (own, other) = (own.expect("by redundants"), other.expect("by cones"));
            (0..2).for_each(|end| assert_near(own[end], other[end], 1e-8, "by cones"));
        }
        zone
    };
    for (weak, strong) in crushed(20.0).iter().zip(&crushed(200.0)) {
        let (weak, strong) = (weak.expect("a zone"), strong.expect("a zone"));
        assert!(strong[0] < weak[0] && weak[1] < strong[1], "{weak:?} {strong:?}");
    }
}

/// Near the collapse load the zone closes at the edges of four joints, the hinges of the mechanism.
#[test]
fn the_zone_closes_at_hinges() {
    let (problem, loads) = loaded(STUCK, 24, 1.0 - 1e-9);
    let zone = thrust_zone(&problem, &loads);
    let at_hinges = problem.joints.iter().zip(&zone).filter(|(joint, zone)| {
        let [least, greatest] = zone.expect("a zone");
        let half = (joint.ends[1] - joint.ends[0]).norm() / 2.0;
        assert!(greatest - least < 1e-6, "{least} {greatest}");
        half - least.abs().min(greatest.abs()) < 1e-6
    });
    assert_eq!(at_hinges.count(), 4);
}

/// The mirror image of a ring and its loads has the mirror image of the zone.
#[test]
fn a_mirror_image_has_the_mirrored_zone() {
    let (problem, loads) = loaded(RUBBED, 12, 0.7);
    let mirrored_loads: Wrenches = loads.iter().rev().map(|[x, y, m]| [-x, *y, -m]).collect();
    let (zone, mirrored) = (thrust_zone(&problem, &loads), thrust_zone(&problem, &mirrored_loads));
    for (own, other) in zone.iter().zip(mirrored.iter().rev()) {
        let (own, other) = (own.expect("a zone"), other.expect("a zone"));
        (0..2).for_each(|end| assert_near(own[end], other[end], 1e-9, "mirrored"));
    }
}

/// The thrust of a flat arch without crushing grows without bound: the zone is the limit of very large thrusts.
#[test]
fn a_thrust_without_bound_has_a_zone() {
    let mut problem = lintel(4.0, 0.5, 1.0);
    for joint in &mut problem.joints {
        joint.strength = block(1.0, 1.0, STUCK).joints[0].strength.clone();
    }
    let loads = combined(&problem.fixed, &problem.varying, 1.0);
    let mut engines: Vec<Vec<Box<dyn Engine + '_>>> = vec![vec![conic::engine(&problem)]];
    engines.push(vec![Box::new(ChainEngine::new(&problem).expect("a chain"))]);
    for engine in engines {
        for zone in zone_by(&problem, &loads, engine) {
            let [least, greatest] = zone.expect("a zone");
            assert_near(least, -0.25, 1e-9, "lower edge");
            assert_near(greatest, 0.25, 1e-9, "upper edge");
        }
    }
}
