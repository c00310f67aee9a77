//! Small structures: a block on two points of the ground, and a point that a spring wedges.

use crate::law::Facet;
use crate::limit::Counters;
use crate::model::geometry::{Vec2, turned};
use crate::path::{
    Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathBody, PathProblem, PathState, Period, PointLaw, Sliding,
};

/// Coefficient of friction of all structures here.
pub const FRICTION: f64 = 0.8;

/// A contact point between the ground and body 1.
pub fn point(position: Vec2, normal: Vec2, law: PointLaw, compliance: [f64; 2]) -> Contact {
    Contact {
        joint: 0,
        position,
        normal,
        tangent: turned(normal),
        minus: Attachment { body: 0, slot: None },
        plus: Attachment { body: 1, slot: None },
        area: 1.0,
        gap: 0.0,
        law,
        compliance,
        sliding: Sliding::middle(0.0),
    }
}

/// Dry friction with a tangent of the dilatancy angle.
pub fn dry(dilatancy: f64) -> PointLaw {
    let [left, right] = Facet::friction(FRICTION, 0.0, dilatancy);
    PointLaw::Facets(vec![Facet::opening(0.0), left, right].into())
}

/// The ground and one free body with a dead load of 10 N downwards and a force λ `live` at its pole.
pub fn structure(pole: Vec2, contacts: Vec<Contact>, live: Vec2) -> PathProblem {
    let ground = PathBody { held: true, ..PathBody::default() };
    let load_step = |stage, loading, end| LoadStep {
        stage,
        gravity: stage == 0,
        loading,
        start: 0.0,
        end,
        period: Period::default(),
    };
    let dead = Loading { acceleration: Vec2::new(0.0, -10.0), ..Loading::default() };
    let forces = vec![(1, None, pole, live)];
    PathProblem {
        bodies: vec![ground, PathBody { members: vec![0], pole, mass: 1.0, ..PathBody::default() }],
        body_of: vec![1],
        contacts,
        load_steps: vec![
            load_step(0, dead, LoadStepEnd::Factor(1.0)),
            load_step(1, Loading { forces, ..Loading::default() }, LoadStepEnd::Collapse(f64::INFINITY)),
        ],
        length: 2.0,
        span: 2.0,
        counters: Counters::new(),
        width: 1.0,
    }
}

/// A block on two points of the ground, 2 m apart, with its pole between them: it slides at λ = 8.
pub fn sliding_block(dilatancy: f64) -> PathProblem {
    let at = |x: f64| point(Vec2::new(x, 0.0), Vec2::new(0.0, 1.0), dry(dilatancy), [1e-6, 2e-6]);
    structure(Vec2::zeros(), vec![at(-1.0), at(1.0)], Vec2::new(1.0, 0.0))
}

/// The state of the sliding block at λ, before it slides.
pub fn stuck(factor: f64) -> PathState {
    let force = vec![[5.0, 0.5 * factor]; 2];
    let gap = [0.0, 0.0];
    PathState {
        load_step: 1,
        factor,
        gap: vec![gap; 2],
        motion: vec![[0.0; 3], [2e-6 * 0.5 * factor, -5e-6, 0.0]],
        force,
        ..PathState::default()
    }
}

/// A point that slides on the ground, held by an inclined spring. The stiffness K of the spring is such that slip
/// increases the pressure on the ground faster than friction allows: with non-associated friction no rate raises a
/// force along +x.
pub fn wedged(live: Vec2) -> PathProblem {
    let spring = Vec2::new(0.5, -(0.75f64.sqrt()));
    let up = Vec2::new(0.0, 1.0);
    let contacts = vec![
        point(Vec2::zeros(), up, dry(0.0), [0.0; 2]),
        point(Vec2::zeros(), spring, PointLaw::Bonded, [1e-6, 1e-4]),
    ];
    structure(Vec2::zeros(), contacts, live)
}

/// Stiffness K of the spring, [K_xx, K_xy].
pub fn stiffness() -> [f64; 2] {
    let (c, s) = (0.5, -(0.75f64.sqrt()));
    [1e6 * c * c + 1e4 * s * s, (1e6 - 1e4) * c * s]
}
