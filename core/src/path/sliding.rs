//! On which body's face a contact point slides with finite displacements, and how far.
//!
//! A contact point is a material point x⁺ of one body and x⁻ of the other, together at first. Its axes
//! turn by θ⁻ + β (θ⁺ − θ⁻), its gaps are x⁺ − x⁻ in them, and the force whose virtual work is r·δg then
//! acts on both bodies at (1 − β) x⁺ + β x⁻:
//!
//! ```text
//! r·δg = P·(δx⁺ − δx⁻) + (δθ⁻ + β (δθ⁺ − δθ⁻)) P × (x⁻ − x⁺)     P = r_n n + r_t t
//! ```
//!
//! - β = 0: the gap of x⁺ from the *line* of minus's face, the force at x⁺. Exact for any slip and any
//!   rotation while x⁺ is a corner of plus that minus's flat face reaches, and for a whole face of plus
//!   that lies within minus's. β = 1: the same the other way round.
//! - β = ½: the mean of the two, and all that can be said where the corners of both bodies coincide: as
//!   soon as they slip by s, one of the two lies beyond the other's face, and both hinges of the joint are
//!   wrong by s/2. So s is bounded by a twentieth of the joint.
//!
//! Areas, and so the compliances of single points, are those of the undeformed joint: where it loses
//! or gains overlap a share s/h of the joint's compliance is wrong, its equilibrium is not. Elastic bodies
//! deform under forces at their own points, so their points keep β = ½.
//! Source: the gap function of node-to-segment contact (Wriggers 2006, Computational Contact Mechanics,
//! ch. 4), of which β = 0 and 1 are the two passes.

use crate::model::geometry::Vec2;
use crate::model::{Assembly, Joint};

/// Slip up to which a point is paired with β = ½, as a share of its joint.
const LARGEST_SLIP: f64 = 0.05;

/// How a contact point slides with finite displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// β: its axes turn by θ⁻ + β (θ⁺ − θ⁻), its force acts at (1 − β) x⁺ + β x⁻.
    pub share: f64,
    /// Least and greatest tangential gap that this holds for \[m\].
    pub slip: [f64; 2],
}

impl Sliding {
    /// Of the point at a share `position` of a joint; corners of bodies that its ends hit to within `tolerance`
    /// \[m\] are ends of the joint.
    pub fn of(assembly: &Assembly, joint: &Joint, position: f64, tolerance: f64) -> Self {
        let sides = [joint.minus, joint.plus];
        let rigid = sides.iter().all(|side| !assembly.is_deformable(*side));
        let faces = rigid.then(|| sides.map(|side| face(&assembly.bodies[side].vertices, joint.ends, tolerance)));
        sliding(faces, joint.height(), position)
    }

    /// Midway between the bodies, in a joint of this height \[m\]; without bounds where it has none.
    pub fn middle(height: f64) -> Self {
        let most = if height > 0.0 { LARGEST_SLIP * height } else { f64::INFINITY };
        Sliding { share: 0.5, slip: [-most, most] }
    }

    /// Whether a tangential gap \[m\] is within its bounds.
    pub fn holds(&self, slip: f64) -> bool {
        (self.slip[0]..=self.slip[1]).contains(&slip)
    }
}

/// Where the edge of a polygon on which a joint lies begins and ends, along the joint from its first
/// end \[m\], with corners that the joint's ends hit to within `tolerance` set to them. `None` where no
/// edge does.
fn face(vertices: &[Vec2], ends: [Vec2; 2], tolerance: f64) -> Option<[f64; 2]> {
    let height = (ends[1] - ends[0]).norm();
    let along = (ends[1] - ends[0]) / height;
    let place = |p: Vec2| {
        let from = p - ends[0];
        (from.dot(&along), (from - along * from.dot(&along)).norm())
    };
    (0..vertices.len()).find_map(|i| {
        let [(a, off), (b, other)] = [vertices[i], vertices[(i + 1) % vertices.len()]].map(place);
        let [low, high] = [a.min(b), a.max(b)];
        let holds = off.max(other) <= tolerance && low <= tolerance && high >= height - tolerance;
        let snapped = |x: f64, end: f64| if (x - end).abs() <= tolerance { end } else { x };
        holds.then(|| [snapped(low, 0.0), snapped(high, height)])
    })
}

/// How a point at a share `position` of a joint slides; `faces` of (minus, plus), `None` where a body is
/// elastic. An end belongs to the body whose corner it is, a point between to the nearer end.
fn sliding(faces: Option<[Option<[f64; 2]>; 2]>, height: f64, position: f64) -> Sliding {
    let Some([Some(minus), Some(plus)]) = faces else { return Sliding::middle(height) };
    let end = usize::from(position > 0.5);
    let own = [0.0, height][end];
    let at = position * height;
    match (minus[end] == own, plus[end] == own) {
        (false, true) => Sliding { share: 0.0, slip: [minus[0] - at, minus[1] - at] },
        (true, false) => Sliding { share: 1.0, slip: [at - plus[1], at - plus[0]] },
        _ => Sliding::middle(height),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, width: f64) -> Vec<Vec2> {
        [[0.0, 0.0], [width, 0.0], [width, 1.0], [0.0, 1.0]].map(|[a, b]| Vec2::new(x + a, y + b)).to_vec()
    }

    /// A point belongs to the body whose corner is nearer, and may slide as far as the other's face goes.
    #[test]
    fn a_point_belongs_to_the_body_whose_corner_it_is() {
        // A block on a wider one, the joint read from right to left.
        let (below, above) = (square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0));
        let ends = [Vec2::new(3.0, 1.0), Vec2::new(1.0, 1.0)];
        let faces = [&below, &above].map(|v| face(v, ends, 1e-9));
        assert_eq!(faces, [Some([-1.0, 3.0]), Some([0.0, 2.0])]);
        assert_eq!(sliding(Some(faces), 2.0, 0.0), Sliding { share: 0.0, slip: [-1.0, 3.0] });
        assert_eq!(sliding(Some(faces), 2.0, 0.75), Sliding { share: 0.0, slip: [-2.5, 1.5] });
        // The other way up: the point belongs to minus, which slides by −g_t on plus.
        let swapped = Some([faces[1], faces[0]]);
        assert_eq!(sliding(swapped, 2.0, 0.75), Sliding { share: 1.0, slip: [-1.5, 2.5] });
        // Half over: each end has its own corner.
        let half = Some([Some([0.0, 3.0]), Some([-1.0, 2.0])]);
        assert_eq!([0.25, 0.75].map(|p| sliding(half, 2.0, p).share), [1.0, 0.0]);
        // Corners that coincide, and elastic bodies, stay midway.
        let same = Some([Some([0.0, 2.0]); 2]);
        assert_eq!(sliding(same, 2.0, 0.0), Sliding { share: 0.5, slip: [-0.1, 0.1] });
        assert_eq!(sliding(None, 2.0, 0.0), Sliding::middle(2.0));
        assert_eq!(face(&below, [Vec2::new(3.0, 0.5), Vec2::new(1.0, 0.5)], 1e-9), None);
    }
}
