//! Plane vectors and single facets: slack, multipliers of pairs, dilatancy.

use voussoir_core::law::{Facet, FacetMode};

/// Returns the scalar product.
pub fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the length.
pub fn norm(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

/// Returns the unit vector normal to a flow d.
pub fn across(flow: [f64; 2]) -> [f64; 2] {
    let l = norm(flow);
    [-flow[1] / l, flow[0] / l]
}

/// Returns the slack b A − a·r.
pub fn slack(facet: &Facet, force: [f64; 2], area: f64) -> f64 {
    facet.bound * area - dot(facet.normal, force)
}

/// Returns the multipliers (γ_i, γ_j) of two flows: g = −γ_i d_i − γ_j d_j.
pub fn multipliers(a: [f64; 2], b: [f64; 2], gap: [f64; 2]) -> [f64; 2] {
    let determinant = a[0] * b[1] - a[1] * b[0];
    [-(gap[0] * b[1] - gap[1] * b[0]) / determinant, -(a[0] * gap[1] - a[1] * gap[0]) / determinant]
}

/// Returns tan ψ of a law: opening per unit of slip.
pub fn dilatancy(facets: &[Facet]) -> f64 {
    facets
        .iter()
        .filter(|f| f.mode == FacetMode::Sliding && f.flow[1] != 0.0)
        .map(|f| -f.flow[0] / f.flow[1].abs())
        .fold(0.0, f64::max)
}
