//! The polygon of tractions that the facets of a law admit: corners and recession cone.

use super::facet::Facet;

/// The polygon of admissible tractions of a law: its vertices and the directions in which it is unbounded.
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
    /// Computes the set {t : a·t ≤ b for all facets} by intersecting all pairs of facets.
    pub fn of(facets: &[Facet]) -> Self {
        let scale = facets.iter().map(|f| f.bound.abs()).fold(0.0, f64::max).max(1.0);
        let length = |a: [f64; 2]| a[0].hypot(a[1]);
        let lengths: Vec<f64> = facets.iter().map(|f| length(f.normal)).collect();
        let all = || facets.iter().zip(&lengths);
        let mut vertices: Vec<[f64; 2]> = Vec::new();
        let mut rays: Vec<[f64; 2]> = Vec::new();
        for (i, (f, l)) in all().enumerate() {
            for sense in [1.0, -1.0] {
                let ray = [-sense * f.normal[1] / l, sense * f.normal[0] / l];
                let admissible = all().all(|(g, length)| dot(g.normal, ray) <= 1e-12 * length);
                if admissible && !rays.iter().any(|r| (dot(*r, ray) - 1.0).abs() < 1e-12) {
                    rays.push(ray);
                }
            }
            for (g, other) in all().skip(i + 1) {
                let determinant = f.normal[0] * g.normal[1] - f.normal[1] * g.normal[0];
                if determinant.abs() <= 1e-12 * l * other {
                    continue;
                }
                let vertex = [
                    (f.bound * g.normal[1] - g.bound * f.normal[1]) / determinant,
                    (g.bound * f.normal[0] - f.bound * g.normal[0]) / determinant,
                ];
                let tolerance = 1e-12 * scale.max(length(vertex));
                let inside = all().all(|(h, length)| dot(h.normal, vertex) <= h.bound + tolerance * length);
                if inside && !vertices.iter().any(|v| length([v[0] - vertex[0], v[1] - vertex[1]]) <= tolerance) {
                    vertices.push(vertex);
                }
            }
        }
        if rays.iter().any(|a| rays.iter().any(|b| dot(*a, *b) < -1.0 + 1e-12)) {
            // Half plane: the two rays along its edge do not show on which side the set lies, so the inward direction
            // is added.
            for (f, l) in all() {
                let inwards = [-f.normal[0] / l, -f.normal[1] / l];
                if all().all(|(g, length)| dot(g.normal, inwards) <= 1e-12 * length) {
                    rays.push(inwards);
                }
            }
        }
        if vertices.is_empty() {
            // A half plane or strip has no corner: one point of its boundary is used as vertex.
            vertices.extend(facets.iter().take(1).map(|f| {
                let l2 = dot(f.normal, f.normal);
                [f.normal[0] * f.bound / l2, f.normal[1] * f.bound / l2]
            }));
        }
        YieldPolygon { vertices, rays }
    }

    /// Returns the distance of a jump \[opening, slip\] from the jumps of finite dissipation, which form the polar of
    /// the recession cone. By Moreau's decomposition it is the length of the projection of −jump onto that cone. The
    /// greatest product with a ray would be too small if the cone is wide: with friction 1e6 an overlap of 1e-6 would
    /// count as 1e-12.
    pub fn impossible(&self, jump: [f64; 2]) -> f64 {
        let back = jump.map(|x| -x);
        let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let inside = self.rays.iter().enumerate().any(|(i, a)| {
            self.rays[..i].iter().any(|b| {
                let turn = cross(*a, *b).signum();
                // Opposite rays are the edge of a half plane; its third ray shows on which side the set lies.
                dot(*a, *b) > -1.0 + 1e-12 && turn * cross(*a, back) > 0.0 && turn * cross(back, *b) > 0.0
            })
        });
        match inside {
            true => jump[0].hypot(jump[1]),
            false => self.rays.iter().map(|ray| dot(*ray, back)).fold(0.0, f64::max),
        }
    }

    /// Returns the least t_n \[Pa\], −∞ if unbounded.
    pub fn least_normal(&self) -> f64 {
        if self.rays.iter().any(|ray| ray[0] < -1e-12) {
            return f64::NEG_INFINITY;
        }
        self.vertices.iter().map(|v| v[0]).fold(f64::INFINITY, f64::min)
    }

    /// Returns the greatest t_n \[Pa\], ∞ if unbounded.
    pub fn greatest_normal(&self) -> f64 {
        if self.rays.iter().any(|ray| ray[0] > 1e-12) {
            return f64::INFINITY;
        }
        self.vertices.iter().map(|v| v[0]).fold(f64::NEG_INFINITY, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::FacetMode;

    /// The distance of a jump from the admissible ones is the greatest power of a unit traction in the recession cone,
    /// here searched over ten thousand directions.
    #[test]
    fn an_impossible_jump_is_as_far_off_as_its_greatest_power() {
        for friction in [0.5, 1.0, 1e3, 1e6, 1e9] {
            let sliding = [1.0, -1.0].map(|sense| Facet::associated(FacetMode::Sliding, [-friction, sense], 0.0));
            let polygon = YieldPolygon::of(&sliding);
            for angle in (0..360).map(|k| f64::from(k).to_radians()) {
                let jump = [angle.cos(), angle.sin()];
                let widest = friction.atan();
                let tried = (0..=10_000).map(|k| widest * (f64::from(k) / 5e3 - 1.0));
                let power = tried.map(|a| -(a.cos() * jump[0] + a.sin() * jump[1])).fold(0.0, f64::max);
                let found = polygon.impossible(jump);
                assert!((found - power).abs() < 1e-6, "friction {friction}, {angle}: {found}, not {power}");
            }
        }
    }
}
