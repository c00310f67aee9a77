//! Weight of fill on vaults: vertical columns from the extrados up to a level.

use voussoir_core::plugin::Keys;
use voussoir_core::space::Vec3;

/// Fill up to a level.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct VaultFill {
    /// level of its top above the springings
    #[key(unit = "m", range = "> 0")]
    pub height: f64,
    /// density of the fill; it has weight only
    #[key(unit = "kg/m3", range = ">= 0")]
    pub density: f64,
}

/// Volume \[m³\] and moment of volume about the origin \[m⁴\] of columns of fill.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Columns {
    pub volume: f64,
    moment: Vec3,
}

impl Columns {
    /// Returns the columns between facets, anticlockwise from above, and a level. Each facet is a fan of triangles about
    /// the mean of its corners, as for volumes. Facets that face downwards have no columns.
    pub fn above(facets: impl IntoIterator<Item = Vec<Vec3>>, level: f64) -> Self {
        let mut all = Columns::default();
        for facet in facets {
            let mean = facet.iter().sum::<Vec3>() / facet.len() as f64;
            for (k, corner) in facet.iter().enumerate() {
                let below = below(&[mean, *corner, facet[(k + 1) % facet.len()]], level);
                (1..below.len().max(1) - 1).for_each(|k| all.add([below[0], below[k], below[k + 1]], level));
            }
        }
        all
    }

    /// Returns the centroid; `None` without any column \[m\].
    pub fn centroid(&self) -> Option<Vec3> {
        (self.volume > 0.0).then(|| self.moment / self.volume)
    }

    /// Adds the column above a triangle. With the depth h = level − z, ∫ h dA = A Σhᵢ / 3,
    /// ∫ x h dA = A (Σxᵢ Σhᵢ + Σxᵢhᵢ) / 12, and the middle of the column is at level − h / 2.
    fn add(&mut self, corners: [Vec3; 3], level: f64) {
        let [a, b, c] = corners;
        let area = (b - a).cross(&(c - a)).z / 2.0;
        if area <= 0.0 {
            return;
        }
        let depths = corners.map(|corner| level - corner.z);
        let total: f64 = depths.iter().sum();
        let times_depth = |value: [f64; 3]| {
            let products: f64 = value.iter().zip(&depths).map(|(value, depth)| value * depth).sum();
            area * (value.iter().sum::<f64>() * total + products) / 12.0
        };
        let volume = area * total / 3.0;
        self.volume += volume;
        self.moment.x += times_depth(corners.map(|corner| corner.x));
        self.moment.y += times_depth(corners.map(|corner| corner.y));
        self.moment.z += level * volume - times_depth(depths) / 2.0;
    }
}

/// Returns the part of a polygon below a level.
fn below(polygon: &[Vec3], level: f64) -> Vec<Vec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, here) in polygon.iter().enumerate() {
        let next = polygon[(k + 1) % polygon.len()];
        if here.z <= level {
            kept.push(*here);
        }
        if (here.z < level && next.z > level) || (here.z > level && next.z < level) {
            kept.push(here + (next - here) * ((level - here.z) / (next.z - here.z)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Above a slope z = x over the unit square the columns up to z = 1 are half a cube with its centroid at (1/3, 1/2, 2/3).
    /// Up to z = 1/2 they are similar in section.
    #[test]
    fn columns_above_a_slope_are_a_wedge() {
        let slope = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, x)).to_vec();
        for (level, volume) in [(1.0, 0.5), (0.5, 0.125)] {
            let wedge = Columns::above([slope.clone()], level);
            let centroid = Vec3::new(level / 3.0, 0.5, 2.0 * level / 3.0);
            assert!((wedge.volume - volume).abs() < 1e-15, "{wedge:?}");
            assert!((wedge.centroid().unwrap() - centroid).norm() < 1e-15, "{wedge:?}");
        }
        let mut soffit = slope;
        soffit.reverse();
        assert_eq!(Columns::above([soffit], 1.0).centroid(), None);
    }
}
