//! The polygon of tractions that the facets of a law admit: corners and recession cone.

use super::facet::Facet;

/// The polygon of admissible tractions of a law: its vertices and the directions in which it is
/// unbounded.
#[derive(Debug, Clone, PartialEq)]
pub struct YieldPolygon {
    /// Corners \[Pa\].
    pub vertices: Vec<[f64; 2]>,
    /// Extreme rays of the recession cone, unit vectors.
    pub rays: Vec<[f64; 2]>,
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl YieldPolygon {
    /// The set {t : a·t ≤ b for all facets}, by intersection of all pairs of facets.
    pub fn of(facets: &[Facet]) -> Self {
        let scale = facets.iter().map(|f| f.bound.abs()).fold(0.0, f64::max).max(1.0);
        let length = |a: [f64; 2]| a[0].hypot(a[1]);
        let mut vertices: Vec<[f64; 2]> = Vec::new();
        let mut rays: Vec<[f64; 2]> = Vec::new();
        for (i, f) in facets.iter().enumerate() {
            for sense in [1.0, -1.0] {
                let l = length(f.normal);
                let ray = [-sense * f.normal[1] / l, sense * f.normal[0] / l];
                let admissible = facets.iter().all(|g| dot(g.normal, ray) <= 1e-12 * length(g.normal));
                if admissible && !rays.iter().any(|r| (dot(*r, ray) - 1.0).abs() < 1e-12) {
                    rays.push(ray);
                }
            }
            for g in &facets[i + 1..] {
                let determinant = f.normal[0] * g.normal[1] - f.normal[1] * g.normal[0];
                if determinant.abs() <= 1e-12 * length(f.normal) * length(g.normal) {
                    continue;
                }
                let vertex = [
                    (f.bound * g.normal[1] - g.bound * f.normal[1]) / determinant,
                    (g.bound * f.normal[0] - f.bound * g.normal[0]) / determinant,
                ];
                let tolerance = 1e-12 * scale.max(length(vertex));
                let inside = facets.iter().all(|h| dot(h.normal, vertex) <= h.bound + tolerance * length(h.normal));
                if inside && !vertices.iter().any(|v| length([v[0] - vertex[0], v[1] - vertex[1]]) <= tolerance) {
                    vertices.push(vertex);
                }
            }
        }
        if rays.iter().any(|a| rays.iter().any(|b| dot(*a, *b) < -1.0 + 1e-12)) {
            // A half plane: the rays along its edge do not show that it is open inwards.
            for f in facets {
                let l = length(f.normal);
                let inwards = [-f.normal[0] / l, -f.normal[1] / l];
                if facets.iter().all(|g| dot(g.normal, inwards) <= 1e-12 * length(g.normal)) {
                    rays.push(inwards);
                }
            }
        }
        if vertices.is_empty() {
            // A half plane or strip has no corner: any point of its boundary stands for it.
            vertices.extend(facets.iter().take(1).map(|f| {
                let l2 = dot(f.normal, f.normal);
                [f.normal[0] * f.bound / l2, f.normal[1] * f.bound / l2]
            }));
        }
        YieldPolygon { vertices, rays }
    }

    /// The least t_n \[Pa\], −∞ where unbounded.
    pub fn least_normal(&self) -> f64 {
        if self.rays.iter().any(|ray| ray[0] < -1e-12) {
            return f64::NEG_INFINITY;
        }
        self.vertices.iter().map(|v| v[0]).fold(f64::INFINITY, f64::min)
    }

    /// The greatest t_n \[Pa\], ∞ where unbounded.
    pub fn greatest_normal(&self) -> f64 {
        if self.rays.iter().any(|ray| ray[0] > 1e-12) {
            return f64::INFINITY;
        }
        self.vertices.iter().map(|v| v[0]).fold(f64::NEG_INFINITY, f64::max)
    }
}
