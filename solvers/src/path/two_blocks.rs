//! Scenes of two or three blocks for the tests of both path solvers. The ground is body 0.

use crate::path::continuation::arc_length::ArcLength;
use crate::path::continuation::displacement_control::DisplacementControl;
use crate::path::continuation::dissipation::Dissipation;
use crate::path::event::EventPath;
use crate::path::newton::NewtonPath;
use nalgebra::DMatrix;
use std::sync::Arc;
use voussoir_core::law::Facet;
use voussoir_core::limit::Counters;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{
    Attachment, Contact, Continuation, LoadStep, LoadStepEnd, Loading, PathAnswer, PathBody, PathObserver, PathProblem,
    PathSettings, PathSolver, PathState, Period, PointLaw, Sliding, Unobserved,
};

/// Stiffness of a point \[N/m\]; blocks have a width of 1 m and a weight of 1 N.
pub(super) const STIFFNESS: f64 = 1e4;

/// Stiffness of the two springs of [`two_degrees`] over (t, n).
pub(super) const SPRINGS: [[f64; 2]; 2] = [[1.0, -1.0], [-1.0, 2.0]];

pub(super) fn v(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

/// Fails if two numbers differ by more than `tolerance`.
#[track_caller]
pub(super) fn assert_close(found: f64, right: f64, tolerance: f64) {
    assert!((found - right).abs() <= tolerance, "{found} instead of {right}");
}

/// Settings of small displacements.
pub(super) fn settings(continuation: Option<Arc<dyn Continuation>>) -> PathSettings {
    PathSettings {
        finite: false,
        tolerance: 1e-9,
        stop_displacement: None,
        stop_factor: None,
        continuation,
        stages: Vec::new(),
    }
}

/// Settings of finite displacements.
pub(super) fn finite(strategy: Option<Arc<dyn Continuation>>) -> PathSettings {
    PathSettings { finite: true, ..settings(strategy) }
}

pub(super) fn body(pole: Vec2, points: Vec<Vec2>, flexibility: Option<DMatrix<f64>>, held: bool) -> PathBody {
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

pub(super) fn ground() -> PathBody {
    body(Vec2::zeros(), vec![], None, true)
}

pub(super) fn rigid(pole: Vec2) -> PathBody {
    body(pole, vec![], None, false)
}

/// A law of facets without tensile strength.
pub(super) fn coulomb(friction: f64, cohesion: f64, dilatancy: f64) -> PointLaw {
    let [left, right] = Facet::friction(friction, cohesion, dilatancy);
    PointLaw::Facets(vec![Facet::opening(0.0), left, right].into())
}

/// A point between the ground (body 0) and the block (body 1), by its place and the normal that points into the block.
pub(super) fn point(joint: usize, position: Vec2, normal: Vec2, friction: f64, gap: f64) -> Contact {
    Contact {
        joint,
        position,
        normal,
        tangent: Vec2::new(-normal.y, normal.x),
        minus: Attachment { body: 0, slot: None },
        plus: Attachment { body: 1, slot: None },
        area: 1.0,
        gap,
        law: coulomb(friction, 0.0, 0.0),
        compliance: [1.0 / STIFFNESS; 2],
        sliding: Sliding::fixed(0.0),
    }
}

/// The same point between two other bodies.
pub(super) fn between(minus: usize, plus: usize, mut contact: Contact) -> Contact {
    (contact.minus.body, contact.plus.body) = (minus, plus);
    contact
}

pub(super) fn stage(stage: usize, loading: Loading, end: LoadStepEnd) -> LoadStep {
    LoadStep { stage, gravity: false, loading, start: 0.0, end, period: Period::default() }
}

/// The dead load: the first stage, with a factor from 0 to 1.
pub(super) fn dead(loading: Loading) -> LoadStep {
    LoadStep { gravity: true, ..stage(0, loading, LoadStepEnd::Factor(1.0)) }
}

/// The second stage, up to collapse.
pub(super) fn live(loading: Loading) -> LoadStep {
    stage(1, loading, LoadStepEnd::Collapse(f64::INFINITY))
}

/// A force on body 1.
pub(super) fn force(at: Vec2, force: Vec2) -> Loading {
    forces(&[(1, at, force)])
}

/// Forces on bodies.
pub(super) fn forces(all: &[(usize, Vec2, Vec2)]) -> Loading {
    let forces = all.iter().map(|&(body, at, force)| (body, None, at, force)).collect();
    Loading { forces, ..Loading::default() }
}

/// A movement of a held body about its pole.
pub(super) fn settlement(body: usize, motion: [f64; 3]) -> Loading {
    Loading { settlements: vec![(body, motion)], ..Loading::default() }
}

/// A scene with a length of 1 m.
pub(super) fn scene(bodies: Vec<PathBody>, contacts: Vec<Contact>, load_steps: Vec<LoadStep>) -> PathProblem {
    PathProblem {
        body_of: (0..bodies.len()).collect(),
        bodies,
        contacts,
        load_steps,
        length: 1.0,
        span: 1.0,
        width: 1.0,
        counters: Counters::new(),
    }
}

/// A block of 1 m by 1 m on points of a floor at the given places, under its weight.
pub(super) fn block_on(places: &[f64], law: &PointLaw, pushed: LoadStep) -> PathProblem {
    let up = v(0.0, 1.0);
    let at = |x: &f64| Contact { law: law.clone(), ..point(0, v(*x, 0.0), up, 0.0, 0.0) };
    let weight = LoadStep { gravity: false, ..dead(force(v(0.5, 0.5), -up)) };
    let bodies = vec![ground(), rigid(v(0.5, 0.5))];
    scene(bodies, places.iter().map(at).collect(), vec![weight, pushed])
}

/// The block on its two corners under its weight, then `pushed` until collapse.
pub(super) fn block(friction: f64, pushed: Loading) -> PathProblem {
    block_on(&[0.0, 1.0], &coulomb(friction, 0.0, 0.0), live(pushed))
}

/// Pushed by 1 N to the right at a height of the left face.
pub(super) fn pushed_at(height: f64) -> Loading {
    force(v(0.0, height), v(1.0, 0.0))
}

/// Two blocks of 1 m by 1 m and 1 N each on top of each other; friction of the lower and of the upper joint.
pub(super) fn stack([lower, upper]: [f64; 2], pushed: Loading) -> PathProblem {
    let up = v(0.0, 1.0);
    let corners = |joint: usize, height: f64, friction: f64| {
        [0.0, 1.0].map(|x| between(joint, joint + 1, point(joint, v(x, height), up, friction, 0.0)))
    };
    let [below, above] = [v(0.5, 0.5), v(0.5, 1.5)];
    let weights = forces(&[(1, below, -up), (2, above, -up)]);
    let contacts = [corners(0, 0.0, lower), corners(1, 1.0, upper)].concat();
    let bodies = vec![ground(), rigid(below), rigid(above)];
    scene(bodies, contacts, vec![LoadStep { gravity: false, ..dead(weights) }, live(pushed)])
}

/// A block of 1 m by 1 m on two springs of stiffness `k` under its left and right end, bonded: they keep their directions.
pub(super) fn on_springs(k: f64, load_steps: Vec<LoadStep>) -> PathProblem {
    let at = |x: f64| Contact {
        law: PointLaw::Bonded,
        compliance: [1.0 / k; 2],
        ..point(0, v(x, 0.0), v(0.0, 1.0), 0.0, 0.0)
    };
    scene(vec![ground(), rigid(v(0.0, 0.0))], vec![at(-0.5), at(0.5)], load_steps)
}

/// One contact point on the ground, held by springs K over (t, n): the two-degree-of-freedom example.
pub(super) fn two_degrees(
    stiffness: [[f64; 2]; 2],
    friction: f64,
    load_steps: Vec<(Vec2, LoadStepEnd)>,
) -> PathProblem {
    let [[a, b], [_, d]] = stiffness;
    let det = a * d - b * b;
    let inverse = [[d / det, -b / det], [-b / det, a / det]];
    // x is t reversed: n = y, t = −x. Forces and displacements below are given in (t, n).
    let entry = |i: usize, j: usize| inverse[i % 2][j % 2] * if (i + j) % 2 == 1 { -1.0 } else { 1.0 };
    let points = vec![Vec2::zeros(), Vec2::zeros()];
    let block = PathBody { mass: 0.0, ..body(Vec2::zeros(), points, Some(DMatrix::from_fn(4, 4, entry)), true) };
    let contact = Contact {
        minus: Attachment { body: 1, slot: None },
        plus: Attachment { body: 0, slot: Some(0) },
        compliance: [0.0; 2],
        sliding: Sliding::middle(0.0),
        ..point(0, Vec2::zeros(), v(0.0, 1.0), friction, 0.0)
    };
    let load_step = |(f, end): (Vec2, LoadStepEnd)| {
        let forces = vec![(0, Some(1), Vec2::zeros(), Vec2::new(-f.x, f.y))];
        stage(0, Loading { forces, ..Loading::default() }, end)
    };
    let ground = PathBody { mass: 0.0, ..ground() };
    scene(vec![block, ground], vec![contact], load_steps.into_iter().map(load_step).collect())
}

/// The two-degree example on a path that turns back: stick to λ = 1.25, slip with a falling load to λ = 1, open.
pub(super) fn turning() -> PathProblem {
    let pressed = (v(0.0, -1.0), LoadStepEnd::Factor(1.0));
    two_degrees(SPRINGS, 1.25, vec![pressed, (v(1.0, 0.0), LoadStepEnd::Collapse(f64::INFINITY))])
}

/// The exact path with small displacements.
pub(super) fn traced(problem: &PathProblem) -> PathAnswer {
    EventPath {}.trace(problem, &settings(None), &mut Unobserved)
}

/// All states of the exact path with small displacements.
pub(super) fn states(problem: &PathProblem) -> Vec<PathState> {
    let mut states = Kept(Vec::new());
    EventPath {}.trace(problem, &settings(None), &mut states);
    states.0
}

/// The path with finite displacements.
pub(super) fn followed(problem: &PathProblem, strategy: Option<Arc<dyn Continuation>>) -> PathAnswer {
    NewtonPath {}.trace(problem, &finite(strategy), &mut Unobserved)
}

/// All states of the path with finite displacements.
pub(super) fn finite_states(problem: &PathProblem) -> Vec<PathState> {
    let mut states = Kept(Vec::new());
    NewtonPath {}.trace(problem, &finite(None), &mut states);
    states.0
}

/// Strategies that pass limit points, with whole and half steps.
pub(super) fn strategies() -> Vec<Option<Arc<dyn Continuation>>> {
    vec![
        None,
        Some(Arc::new(ArcLength { first_step: 0.05, ..ArcLength::default() })),
        Some(Arc::new(ArcLength { first_step: 0.01, ..ArcLength::default() })),
        Some(Arc::new(DisplacementControl::default())),
        Some(Arc::new(Dissipation::default())),
    ]
}

/// Keeps all states.
pub(super) struct Kept(pub Vec<PathState>);

impl PathObserver for Kept {
    fn state(&mut self, _problem: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}
