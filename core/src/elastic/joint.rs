//! Contact points of two bodies along a joint, and their weights.

use super::mesh::edge_breaks;
use super::quadrature::lobatto;
use crate::model::MeshDensity;
use crate::model::geometry::{Vec2, edges};

/// Distance below which two breaks are the same, as a share of the joint.
const SAME: f64 = 1e-9;
/// Greatest distance of a joint's end from its edge, as a share of the edge: joints are found with a tolerance relative
/// to the size of the scene.
const ON_EDGE: f64 = 1e-5;

/// Returns the contact points along a joint, as fractions from its end 0 to its end 1, and their shares of its area
/// (their sum is 1). Each segment between two breaks has the Gauss–Lobatto rule of order + 1 points, which is exact for
/// polynomials of degree 2 order − 1. A share times height and width of the joint is the tributary area \[m²\].
///
/// `breaks` are the element boundaries of both sides, sorted, from 0 to 1 ([`union_breaks`]). Forces p × share × area
/// at these points are on each side the consistent nodal forces of the uniform pressure p, because p times a shape
/// function has degree `order` on a segment.
pub fn joint_points(breaks: &[f64], order: usize) -> (Vec<f64>, Vec<f64>) {
    let (nodes, rule) = lobatto(order + 1);
    let (mut places, mut weights) = (Vec::new(), Vec::new());
    for pair in breaks.windows(2) {
        let (middle, half) = ((pair[0] + pair[1]) / 2.0, (pair[1] - pair[0]) / 2.0);
        match weights.last_mut() {
            Some(last) => *last += rule[0] * half,
            None => {
                places.push(pair[0]);
                weights.push(rule[0] * half);
            }
        }
        for (x, w) in nodes.iter().zip(&rule).take(order).skip(1) {
            places.push(middle + half * x);
            weights.push(w * half);
        }
        places.push(pair[1]);
        weights.push(rule[order] * half);
    }
    (places, weights)
}

/// Returns the breaks of both sides, sorted, from exactly 0 to exactly 1. Breaks outside are left out; breaks within
/// 1e-9 of each other are merged.
pub fn union_breaks(one: &[f64], other: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> = one.iter().chain(other).copied().filter(|&t| t > SAME && t < 1.0 - SAME).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| *a - *b <= SAME);
    std::iter::once(0.0).chain(all).chain([1.0]).collect()
}

/// Returns the element boundaries of a body along a joint on one of its edges, as fractions from end 0 to end 1 of the
/// joint. The joint may cover only a part of the edge; its ends are breaks.
///
/// # Errors
/// If no edge contains the joint.
pub fn breaks_on_joint(vertices: &[Vec2], density: &MeshDensity, ends: [Vec2; 2]) -> Result<Vec<f64>, String> {
    let (along, found) = (ends[1] - ends[0], edges(vertices).enumerate());
    let distance = |a: Vec2, b: Vec2| {
        let edge = b - a;
        let off = |p: Vec2| {
            let t = (p - a).dot(&edge) / edge.norm_squared();
            ((p - a - edge * t).norm() / edge.norm()).max(-t).max(t - 1.0)
        };
        off(ends[0]).max(off(ends[1]))
    };
    let best = found.map(|(i, (a, b))| (i, a, b, distance(a, b))).min_by(|a, b| a.3.total_cmp(&b.3));
    let Some((edge, a, b, _)) = best.filter(|best| best.3 <= ON_EDGE) else {
        return Err(format!("no edge of the body holds the joint from {:?} to {:?}", ends[0], ends[1]));
    };
    let place = |t: &f64| ((a * (1.0 - t) + b * *t) - ends[0]).dot(&along) / along.norm_squared();
    let breaks: Vec<f64> = edge_breaks(vertices, density, edge).iter().map(place).collect();
    Ok(union_breaks(&breaks, &[]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elastic::edge_points;

    fn brick(x: f64, y: f64) -> Vec<Vec2> {
        [[0.0, 0.0], [0.4, 0.0], [0.4, 0.175], [0.0, 0.175]].map(|[a, b]| Vec2::new(a + x, b + y)).to_vec()
    }

    /// On matching meshes contact points are the nodes and weights are the consistent forces.
    #[test]
    fn matching_meshes_touch_at_their_nodes() {
        let density = MeshDensity { elements: [4, 6], order: 2, grading: [3.0; 2] };
        let (lower, upper) = (brick(0.0, 0.0), brick(0.0, 0.175));
        let ends = [lower[2], lower[3]];
        let one = breaks_on_joint(&lower, &density, ends).unwrap();
        let other = breaks_on_joint(&upper, &density, ends).unwrap();
        let (places, weights) = joint_points(&union_breaks(&one, &other), 2);
        let nodes = edge_points(&lower, &density, 2);
        assert_eq!(places.len(), nodes.len());
        assert!(places.iter().zip(&nodes).all(|(a, b)| (a - b).abs() < 1e-15));
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!((weights[1] / weights[0] - 4.0).abs() < 1e-12);
    }

    /// In running bond a joint covers half of an edge, and both its ends are contact points.
    #[test]
    fn a_joint_on_half_an_edge() {
        let density = MeshDensity { elements: [3, 2], order: 2, grading: [1.0; 2] };
        let (lower, upper) = (brick(0.0, 0.0), brick(0.2, 0.175));
        let ends = [lower[2], upper[0]];
        let one = breaks_on_joint(&lower, &density, ends).unwrap();
        let other = breaks_on_joint(&upper, &density, ends).unwrap();
        let both = union_breaks(&one, &other);
        let expected = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
        assert!(one.len() == 3 && other.len() == 3 && both.len() == 4);
        assert!(both.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12));
        assert!(breaks_on_joint(&lower, &density, [upper[2], upper[3]]).is_err());
    }
}
