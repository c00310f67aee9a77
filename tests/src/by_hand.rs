//! Path problems written by hand: bodies, contact points and load steps without an assembly. Defaults are rigid
//! weightless bodies, points of area 1 that touch, and loads from zero.

use std::iter::once;
use voussoir::core::law::Facet;
use voussoir::core::limit::Counters;
use voussoir::core::model::geometry::Vec2;
use voussoir::core::path::{
    Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathBody, PathProblem, Period, PointLaw, Sliding,
};

/// Returns a free rigid body without mass. `index` is its place in the list of bodies.
pub fn body(index: usize, pole: Vec2) -> PathBody {
    PathBody {
        members: vec![index],
        pole,
        held: false,
        mass: 0.0,
        points: Vec::new(),
        flexibility: None,
        inelastic: None,
    }
}

/// Returns the ground, as [`body`].
pub fn ground(index: usize, pole: Vec2) -> PathBody {
    PathBody { held: true, ..body(index, pole) }
}

/// Returns a point between two rigid bodies, minus and plus, on a joint without compliance; t is n rotated by +90°.
pub fn contact(joint: usize, position: Vec2, normal: Vec2, [minus, plus]: [usize; 2], law: PointLaw) -> Contact {
    Contact {
        joint,
        position,
        normal,
        tangent: Vec2::new(-normal.y, normal.x),
        minus: Attachment { body: minus, slot: None },
        plus: Attachment { body: plus, slot: None },
        area: 1.0,
        gap: 0.0,
        law,
        compliance: [0.0; 2],
        sliding: Sliding::middle(0.0),
    }
}

/// Dry friction without dilatancy.
pub fn dry_friction(friction: f64) -> PointLaw {
    PointLaw::Facets(once(Facet::opening(0.0)).chain(Facet::friction(friction, 0.0, 0.0)).collect())
}

/// Returns the loads of a stage that grow from zero.
pub fn load_step(stage: usize, loading: Loading, end: LoadStepEnd) -> LoadStep {
    LoadStep { stage, gravity: false, loading, start: 0.0, end, period: Period::default() }
}

/// Returns forces on bodies: (body, index of the point in an elastic body, point, force).
pub fn forces(forces: Vec<(usize, Option<usize>, Vec2, Vec2)>) -> Loading {
    Loading { forces, ..Loading::default() }
}

/// Returns the problem with these parts.
pub fn problem(bodies: Vec<PathBody>, contacts: Vec<Contact>, load_steps: Vec<LoadStep>, length: f64) -> PathProblem {
    let body_of = (0..bodies.len()).collect();
    let counters = Counters::new();
    PathProblem { bodies, body_of, contacts, load_steps, length, span: length, counters, width: 1.0 }
}
