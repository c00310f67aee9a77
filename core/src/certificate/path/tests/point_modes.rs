//! Modes of contact points next to corners of their laws.

use super::super::point_modes::point_modes;
use super::scenes::{dry, point};
use crate::law::{Facet, FacetMode};
use crate::path::{PointLaw, PointMode};
use nalgebra::Vector2;

/// Next to the apex the facets of friction can have less slack than allowed, and the facet of opening more: the point may open.
#[test]
fn a_point_next_to_the_apex_may_open() {
    let contact = point(Vector2::zeros(), Vector2::y(), dry(0.0), [0.0; 2]);
    let modes = point_modes(&contact, [1.5e-9, 0.0], false, 1e-9);
    let vertex = modes.iter().find(|cone| cone.mode == PointMode::Vertex).expect("a vertex");
    assert!(vertex.gap.iter().any(|gap| gap[0] > 0.0 && gap[1] == 0.0), "{:?}", vertex.gap);
}

/// A facet without a bound passes through no corner: it gives the point no mode.
#[test]
fn a_facet_without_a_bound_is_never_active() {
    let PointLaw::Facets(facets) = dry(0.5) else { panic!("facets") };
    let unbounded = Facet::associated(FacetMode::Crushing, [1.0, 0.0], f64::INFINITY);
    let law = PointLaw::Facets(facets.iter().copied().chain([unbounded]).collect());
    let contact = point(Vector2::zeros(), Vector2::y(), law, [0.0; 2]);
    let modes = point_modes(&contact, [0.0; 2], false, 1e-9);
    assert!(modes.len() > 2 && modes.iter().all(|cone| cone.mode != PointMode::Facet(facets.len())), "{modes:?}");
    assert!(modes.iter().flat_map(|cone| &cone.gap).all(|gap| gap[0] >= 0.0), "no closing");
}
