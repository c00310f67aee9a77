//! The tangent against finite differences, objectivity, and hand-made systems of few unknowns.

use super::NewtonPath;
use super::kinematics::{Kinematics, Loads};
use super::model::{Control, Loaded, Model};
use crate::path::continuation::arc_length::ArcLength;
use crate::path::continuation::dissipation::Dissipation;
use crate::path::continuation::exact_events::ExactEvents;
use crate::path::continuation::load_control::LoadControl;
use nalgebra::{DMatrix, Rotation2};
use std::sync::Arc;
use voussoir_core::elastic::{Condenser, IsotropicElastic, MeshDensity};
use voussoir_core::law::{
    Facet, Isotropic, PlanarUpdate, Plane, Region, StressPoint, StressUpdate, UpdateFailure, Voigt, von_mises,
};
use voussoir_core::limit::{Counters, Status};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{
    Attachment, Contact, Continuation, LoadStep, LoadStepEnd, Loading, PathBody, PathObserver, PathProblem,
    PathSettings, PathSolver, PathState, PointLaw, Sliding, Unobserved,
};

fn settings(continuation: Option<Arc<dyn Continuation>>) -> PathSettings {
    PathSettings { finite: false, tolerance: 1e-9, stop_displacement: None, stop_factor: None, continuation }
}

fn body(pole: Vec2, points: Vec<Vec2>, flexibility: Option<DMatrix<f64>>, held: bool) -> PathBody {
    PathBody {
        members: vec![0],
        pole,
        held,
        mass: 2.0,
        points,
        flexibility: flexibility.map(Arc::new),
        inelastic: None,
    }
}

/// A symmetric positive definite matrix of plausible entries.
fn flexibility(rows: usize) -> DMatrix<f64> {
    let a = DMatrix::from_fn(rows, rows, |i, j| ((7 * i + 3 * j * j + 1) as f64).sin());
    (&a * a.transpose()) * 0.02 + DMatrix::identity(rows, rows) * 0.01
}

/// A held body, two elastic ones and a rigid one in a chain, loads on two of them.
fn chain() -> PathProblem {
    let points = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.2), Vec2::new(2.0, -0.1)];
    let load = Vec2::new(0.6, 0.5);
    let bodies = vec![
        body(Vec2::new(-0.5, 0.1), vec![], None, true),
        body(Vec2::new(0.5, 0.1), vec![points[0], points[1], load], Some(flexibility(6)), false),
        body(Vec2::new(1.5, 0.0), vec![points[1], points[2]], Some(flexibility(4)), false),
        body(Vec2::new(2.5, 0.0), vec![], None, false),
    ];
    let slots = [(None, Some(0)), (Some(1), Some(0)), (Some(1), None)];
    let contacts = (0..3)
        .map(|i| {
            let normal = Rotation2::new(0.3 * i as f64 - 0.2) * Vec2::new(1.0, 0.0);
            Contact {
                joint: i,
                position: points[i],
                normal,
                tangent: Vec2::new(-normal.y, normal.x),
                minus: Attachment { body: i, slot: slots[i].0 },
                plus: Attachment { body: i + 1, slot: slots[i].1 },
                area: 1.0,
                gap: 0.01,
                law: PointLaw::Bonded,
                compliance: [0.003, 0.007],
                sliding: Sliding::middle(0.0),
            }
        })
        .collect();
    let loading = Loading {
        forces: vec![(1, Some(2), load, Vec2::new(0.3, -1.0)), (3, None, Vec2::new(2.6, 0.4), Vec2::new(-0.5, 0.2))],
        acceleration: Vec2::new(0.4, -0.9),
        settlements: vec![(0, [0.02, -0.03, 0.1])],
    };
    PathProblem {
        bodies,
        body_of: vec![0, 1, 2, 3],
        contacts,
        load_steps: vec![LoadStep { stage: 0, gravity: false, loading, start: 0.0, end: LoadStepEnd::Factor(1.0) }],
        length: 3.0,
        counters: Counters::new(),
    }
}

fn some_state() -> (Vec<[f64; 2]>, Vec<[f64; 3]>) {
    let force = (0..3).map(|i| [1.0 + i as f64, 0.5 - 0.4 * i as f64]).collect();
    let motion = (0..4).map(|i| [0.1 * i as f64, 0.05 - 0.1 * i as f64, 0.3 - 0.25 * i as f64]).collect();
    (force, motion)
}

/// The chain with rigid bodies, whose points slide on one face, on the other, and in between.
fn sliding_chain() -> PathProblem {
    let mut problem = chain();
    problem.bodies.iter_mut().for_each(|body| body.flexibility = None);
    problem.load_steps[0].loading.forces[0].1 = None;
    for (contact, share) in problem.contacts.iter_mut().zip([0.0, 1.0, 0.3]) {
        (contact.minus.slot, contact.plus.slot) = (None, None);
        contact.sliding.share = share;
    }
    problem
}

/// The matrix and the column of λ are the derivatives of gaps and balance, and symmetric.
#[test]
fn the_tangent_is_the_derivative() {
    for (problem, finite) in [(chain(), false), (chain(), true), (sliding_chain(), true)] {
        let kinematics = Kinematics::new(&problem, finite);
        let (force, mut motion) = some_state();
        let loading = &problem.load_steps[0].loading;
        let settle = |motion: &mut Vec<[f64; 3]>, factor: f64| {
            motion[0] = [0.02 * factor, -0.03 * factor, 0.1 * factor];
        };
        let factor = 0.7;
        settle(&mut motion, factor);
        let flat = |force: &[[f64; 2]], motion: &[[f64; 3]], factor: f64| {
            let s = kinematics.slopes(force, motion, &Loads { parts: vec![(factor, loading)] }, &[]);
            let mut all: Vec<f64> = s.gap.iter().flatten().copied().collect();
            all.extend(s.balance.iter().flatten());
            all
        };
        let loads = Loads { parts: vec![(factor, loading)] };
        let slopes = kinematics.slopes(&force, &motion, &loads, &[]);
        let curvature = kinematics.curvature(&force, &motion, &loads, &slopes, &[]);
        let size = 6 + 12;
        let mut dense = DMatrix::zeros(size, size);
        for &(i, j, value) in &curvature.entries {
            dense[(i, j)] += value;
        }
        assert!((&dense - dense.transpose()).amax() < 1e-13);
        let h = 1e-6;
        let mut checked = 0;
        for j in 0..=size {
            let at = |step: f64| {
                let (mut f, mut m, mut l) = (force.clone(), motion.clone(), factor);
                match j {
                    j if j < 6 => f[j / 2][j % 2] += step,
                    j if j < size => m[(j - 6) / 3][(j - 6) % 3] += step,
                    _ => {
                        l += step;
                        settle(&mut m, l);
                    }
                }
                flat(&f, &m, l)
            };
            let (above, below) = (at(h), at(-h));
            for i in 0..size {
                let difference = (above[i] - below[i]) / (2.0 * h);
                let exact = if j < size { dense[(i, j)] } else { curvature.factor[i] };
                assert!(
                    (difference - exact).abs() < 1e-8,
                    "finite {finite}, row {i}, column {j}: {difference} {exact}"
                );
                checked += 1;
            }
        }
        assert_eq!(checked, 18 * 19);
    }
}

/// Gaps and balance of a scene turned as a whole by a large rotation, loads with it: gaps the same,
/// forces turned, moments the same.
#[test]
fn gaps_are_objective() {
    let mut problem = chain();
    problem.load_steps[0].loading.settlements.clear();
    let (force, motion) = some_state();
    let loading = problem.load_steps[0].loading.clone();
    let kinematics = Kinematics::new(&problem, true);
    let before = kinematics.slopes(&force, &motion, &Loads { parts: vec![(1.0, &loading)] }, &[]);
    for angle in [1.0, 3.0, 40.0] {
        let turn = Rotation2::new(angle);
        let turned: Vec<[f64; 3]> = motion
            .iter()
            .zip(&problem.bodies)
            .map(|(q, b)| {
                let place = turn * (b.pole + Vec2::new(q[0], q[1])) - b.pole;
                [place.x, place.y, q[2] + angle]
            })
            .collect();
        let mut load = loading.clone();
        load.acceleration = turn * load.acceleration;
        load.forces.iter_mut().for_each(|f| f.3 = turn * f.3);
        let after = kinematics.slopes(&force, &turned, &Loads { parts: vec![(1.0, &load)] }, &[]);
        for (a, b) in after.gap.iter().flatten().zip(before.gap.iter().flatten()) {
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
        for (a, b) in after.balance.iter().zip(&before.balance) {
            let b_turned = turn * Vec2::new(b[0], b[1]);
            assert!((Vec2::new(a[0], a[1]) - b_turned).norm() < 1e-13 && (a[2] - b[2]).abs() < 1e-13);
        }
        assert!((after.stored - before.stored).abs() < 1e-13);
    }
}

/// One contact point on the ground, held by springs K over (t, n): the two-degree-of-freedom example.
fn two_degrees(stiffness: [[f64; 2]; 2], friction: f64, load_steps: Vec<(Vec2, LoadStepEnd)>) -> PathProblem {
    let [[a, b], [_, d]] = stiffness;
    let det = a * d - b * b;
    let inverse = [[d / det, -b / det], [-b / det, a / det]];
    // x is t reversed: n = y, t = −x. Forces and displacements below are given in (t, n).
    let entry = |i: usize, j: usize| inverse[i % 2][j % 2] * if (i + j) % 2 == 1 { -1.0 } else { 1.0 };
    let points = vec![Vec2::zeros(), Vec2::zeros()];
    let block = PathBody {
        members: vec![0],
        pole: Vec2::zeros(),
        held: true,
        mass: 0.0,
        points,
        flexibility: Some(Arc::new(DMatrix::from_fn(4, 4, entry))),
        inelastic: None,
    };
    let mut ground = block.clone();
    ground.points.clear();
    ground.flexibility = None;
    let [left, right] = Facet::friction(friction, 0.0, 0.0);
    let contact = Contact {
        joint: 0,
        position: Vec2::zeros(),
        normal: Vec2::new(0.0, 1.0),
        tangent: Vec2::new(-1.0, 0.0),
        minus: Attachment { body: 1, slot: None },
        plus: Attachment { body: 0, slot: Some(0) },
        area: 1.0,
        gap: 0.0,
        law: PointLaw::Facets(vec![Facet::opening(0.0), left, right].into()),
        compliance: [0.0; 2],
        sliding: Sliding::middle(0.0),
    };
    PathProblem {
        bodies: vec![block, ground],
        body_of: vec![0, 1],
        contacts: vec![contact],
        load_steps: load_steps
            .into_iter()
            .map(|(f, end)| LoadStep {
                stage: 0,
                gravity: false,
                loading: Loading {
                    forces: vec![(0, Some(1), Vec2::zeros(), Vec2::new(-f.x, f.y))],
                    ..Loading::default()
                },
                start: 0.0,
                end,
            })
            .collect(),
        length: 1.0,
        counters: Counters::new(),
    }
}

const K: [[f64; 2]; 2] = [[1.0, -1.0], [-1.0, 2.0]];

struct Kept(Vec<PathState>);

impl PathObserver for Kept {
    fn state(&mut self, _problem: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}

fn turning() -> PathProblem {
    two_degrees(
        K,
        1.25,
        vec![
            (Vec2::new(0.0, -1.0), LoadStepEnd::Factor(1.0)),
            (Vec2::new(1.0, 0.0), LoadStepEnd::Collapse(f64::INFINITY)),
        ],
    )
}

/// Stick to λ = 1.25, slip back to λ = 1 along λ = 1.25 − u_t/4, then open without bound.
#[test]
fn a_path_that_turns_back() {
    let mut states = Kept(Vec::new());
    let mut how = settings(Some(Arc::new(ArcLength::default())));
    how.stop_factor = Some(0.0);
    let answer = NewtonPath {}.trace(&turning(), &how, &mut states);
    assert_eq!(answer.status, Status::LimitPoint, "{:?}", answer.notes);
    assert!((answer.factor.unwrap() - 1.25).abs() < 1e-9, "{:?}", answer.factor);
    let (mut slid, mut open) = (0, 0);
    for state in states.0.iter().filter(|s| s.load_step == 1) {
        let [normal, tangent] = state.gap[0];
        if normal > 1e-9 {
            open += 1;
            assert!(
                (tangent - (2.0 * state.factor - 1.0)).abs() < 1e-9 && (normal - (state.factor - 1.0)).abs() < 1e-9
            );
        } else if tangent > 1e-9 {
            slid += 1;
            assert!((state.factor - (1.25 - 0.25 * tangent)).abs() < 1e-9);
        } else {
            assert!(state.factor < 1.25 + 1e-9);
        }
    }
    assert!(slid > 2 && open > 0, "{slid} {open} {:?}", answer.notes);
}

#[test]
fn load_control_stops_at_the_limit_point() {
    let answer = NewtonPath {}.trace(&turning(), &settings(Some(Arc::new(LoadControl::default()))), &mut Unobserved);
    assert_eq!(answer.status, Status::LimitPoint, "{:?}", answer.notes);
    assert!((answer.factor.unwrap() - 1.25).abs() < 1e-6, "{:?} {:?}", answer.factor, answer.notes);
    assert!(answer.counters["cutbacks"] > 0);
}

/// Total loads f = (1.2, −1), applied together. μ = 0.5, 0.9: separation, u = K⁻¹ f = (1.4, 0.2), the only
/// solution. μ = 1.25, 1.5, 2: sticking, where |f_t| ≤ μ |f_n|; the other solutions of the
/// benchmark (slip, separation) are not sought by a path that starts stuck.
#[test]
fn one_solution_of_the_two_degree_example() {
    for (friction, tangential, normal) in
        [(0.5, 1.4, 0.2), (0.9, 1.4, 0.2), (1.25, 0.0, 0.0), (1.5, 0.0, 0.0), (2.0, 0.0, 0.0)]
    {
        let problem = two_degrees(K, friction, vec![(Vec2::new(1.2, -1.0), LoadStepEnd::Factor(1.0))]);
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
    let problem = two_degrees(K, 1.1, vec![(Vec2::new(1.2, -1.0), LoadStepEnd::Factor(1.0))]);
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

#[test]
fn exact_events_are_refused() {
    let answer = NewtonPath {}.trace(&turning(), &settings(Some(Arc::new(ExactEvents {}))), &mut Unobserved);
    assert_eq!(answer.status, Status::Stalled);
    assert!(answer.notes[0].contains("event_path"));
}

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
        }],
        length: 2.0 * half_span,
        counters: Counters::new(),
    }
}

/// With N the force and L = √(a² + y²) the distance of crown and support, the hinge's springs lie in
/// the bar's line (the force acts at the middle of their two ends), so L = ℓ − c N and
/// F = 2 N y / L = (2/c)(ℓ/L − 1) y; the peak is at L³ = ℓ a². The path is that curve through the peak,
/// the snap and beyond.
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
    ] {
        let mut how = settings(strategy);
        how.finite = true;
        how.stop_displacement = Some(0.35);
        let mut states = Kept(Vec::new());
        let answer = NewtonPath {}.trace(&two_bars(a, h, c), &how, &mut states);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        let factor = answer.factor.expect("a peak");
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
        let end = answer.last.expect("a state behind the peak");
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

/// Von Mises with linear hardening H = E / 10, radial return (Simo & Hughes 1998, box 3.2).
#[derive(Debug)]
struct Mises {
    elastic: Isotropic,
    strength: f64,
    hardening: f64,
}

impl StressUpdate for Mises {
    fn state_size(&self) -> usize {
        7
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["xx [-]", "yy [-]", "zz [-]", "xy [-]", "yz [-]", "zx [-]", "cumulated [-]"]
    }

    fn update_point(
        &self,
        strain: &Voigt,
        _length: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        new.copy_from_slice(old);
        let left: Voigt = std::array::from_fn(|i| strain[i] - old[i]);
        let (deviator, pressure) = self.elastic.split(&left);
        let trial = von_mises(&deviator);
        let excess = trial - self.strength - self.hardening * old[6];
        let (g, h) = (self.elastic.shear, self.hardening);
        let step = (excess / (3.0 * g + h)).max(0.0);
        let share = if step > 0.0 { 3.0 * g * step / trial } else { 0.0 };
        let mut point = StressPoint { tangent: self.elastic.tangent(), ..StressPoint::ZERO };
        point.stress = std::array::from_fn(|i| deviator[i] * (1.0 - share) - if i < 3 { pressure } else { 0.0 });
        if step > 0.0 {
            point.region = Region::Shear;
            new[6] += step;
            (0..6).for_each(|i| new[i] += deviator[i] / trial * step * if i < 3 { 1.5 } else { 3.0 });
            point.dissipation = (trial - 3.0 * g * step) * step;
            point.tangent = Isotropic::stiffness(g * (1.0 - share), self.elastic.bulk);
            let turn = 9.0 * g * g * (step / trial - 1.0 / (3.0 * g + h));
            for i in 0..6 {
                (0..6).for_each(|j| point.tangent[i][j] += turn * deviator[i] * deviator[j] / (trial * trial));
            }
        }
        Ok(point)
    }
}

/// In a step in which a bent block yields, residuals fall quadratically to rounding, with small and with finite
/// displacements: the tangent is that of the whole iteration.
#[test]
fn steps_with_yielding_blocks_converge_quadratically() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
    let places = [0.0, 0.5, 1.0].map(|t| Vec2::new(t, 0.0));
    let mut points = places.to_vec();
    points.push(Vec2::new(1.0, 1.0));
    let material = IsotropicElastic { young_modulus: 1e9, poisson_ratio: 0.2, density: 0.0 };
    let law = Mises { elastic: Isotropic::new(1e9, 0.2), strength: 1e6, hardening: 1e8 };
    let update = Arc::new(PlanarUpdate::new(Arc::new(law), Plane::Strain).unwrap());
    let mesh = MeshDensity { elements: [2, 2], order: 2, grading: [1.0; 2] };
    let inelastic = Condenser::new(Plane::Strain, 1.0).inelastic(&square, material, update, &mesh, &points).unwrap();
    let mut block = body(Vec2::new(0.5, 0.5), points, None, false);
    block.flexibility = Some(inelastic.flexibility());
    block.inelastic = Some(Arc::new(inelastic));
    let ground = body(Vec2::zeros(), Vec::new(), None, true);
    let contacts = places.iter().enumerate().map(|(slot, place)| Contact {
        joint: 0,
        position: *place,
        normal: Vec2::new(0.0, 1.0),
        tangent: Vec2::new(-1.0, 0.0),
        minus: Attachment { body: 0, slot: None },
        plus: Attachment { body: 1, slot: Some(slot) },
        area: 1.0,
        gap: 0.0,
        law: PointLaw::Bonded,
        compliance: [0.0; 2],
        sliding: Sliding::middle(0.0),
    });
    let loading =
        Loading { forces: vec![(1, Some(3), Vec2::new(1.0, 1.0), Vec2::new(3e5, -4e5))], ..Loading::default() };
    let load_step =
        LoadStep { stage: 0, gravity: false, loading: loading.clone(), start: 0.0, end: LoadStepEnd::Factor(1.0) };
    let problem = PathProblem {
        bodies: vec![ground, block],
        body_of: vec![0, 1],
        contacts: contacts.collect(),
        load_steps: vec![load_step],
        length: 1.0,
        counters: Counters::new(),
    };
    for finite in [false, true] {
        let mut model = Model::new(&problem, finite).unwrap();
        model.load(Loaded { earlier: Vec::new(), growing: &loading, start: 0.0 });
        let start = model.undeformed();
        let (state, _) = model.newton(&start, start.clone(), &Control::Factor(1.0)).unwrap();
        let yielding = state.blocks.iter().flatten().map(|inner| inner.linear.yielding).sum::<usize>();
        assert!(yielding > 10 && yielding < 36, "{yielding} of 36 points yield");
        let r = &model.residuals;
        let fast: Vec<&[f64]> = r.windows(2).filter(|p| p[0] < 0.1 && p[0] > 1e-6).collect();
        assert!(fast.len() >= 2, "{r:?}");
        assert!(fast.iter().all(|p| p[1] <= 3.0 * p[0] * p[0] + 1e-12), "finite {finite}: {r:?}");
        assert!(r[r.len() - 1] < 1e-11, "{r:?}");
    }
}
