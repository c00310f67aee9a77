//! Sliding of a contact point with finite displacements: the body on whose face it slides, and its range.
//!
//! A contact point consists of a material point x⁺ of one body and x⁻ of the other, which coincide at first. Its axes
//! rotate by θ⁻ + β (θ⁺ − θ⁻) and its gaps are x⁺ − x⁻ in these axes. The force with the virtual work r·δg then acts on
//! both bodies at (1 − β) x⁺ + β x⁻:
//!
//! ```text
//! r·δg = P·(δx⁺ − δx⁻) + (δθ⁻ + β (δθ⁺ − δθ⁻)) P × (x⁻ − x⁺)     P = r_n n + r_t t
//! ```
//!
//! - β = 0: the gap is the distance of x⁺ from the *line* of the face of minus, and the force acts at x⁺. This is exact for
//!   any slip and rotation while x⁺ is a corner of plus on the flat face of minus, and for a whole face of plus within
//!   the face of minus. β = 1 is the same with both bodies exchanged.
//! - β = ½: the mean of the two, used if corners of both bodies coincide. When they slip by s, one of them lies beyond the
//!   face of the other, and the mean is wrong by s/2. The point therefore changes to the corner that stays on the other
//!   face. At one end of the joint this is the corner of plus for s > 0 and of minus for s < 0, at the other end the
//!   reverse. β depends on the slip s = t_m·(x⁺ − x⁻) with t_m in the mean axes:
//!
//! ```text
//! β(s) = ½ + (β± − ½) ψ((|s| − w/10)/(w − w/10))     w = h/20, β+ for s > 0, β− for s < 0
//! ψ(ξ) = ξ³ (10 − 15 ξ + 6 ξ²)     0 for ξ < 0, 1 for ξ > 1
//! ```
//!
//! It is twice continuously differentiable, so that forces and stiffness are continuous: corners are rounded by w. The
//! work of r is r·δg with this β, in which g also depends on s through β. In addition to P there is a force
//! (turned(P)·(x⁺ − x⁻)) (θ⁺ − θ⁻) β'(s) along t_m in the middle between x⁺ and x⁻.
//! - If bodies are elastic, s and x⁺ − x⁻ here are those of the rigid motions. The part of the gaps from deformation is
//!   measured in the mean axes (wrong by its product with (β − ½)(θ⁺ − θ⁻)), with the conjugate forces. Without slip
//!   deformation matters and β = ½ is right for it; a point whose corner belongs to one body changes to that corner for
//!   either sign of s, β+ = β−.
//!
//! Areas, and so the compliances of points, are those of the undeformed joint. If the joint loses or gains overlap, a
//! share s/h of its compliance is wrong, but its equilibrium is not. A joint with coinciding corners loses overlap as
//! it slips, at most half of its height. A point at which neither body has a corner keeps β = ½, up to a slip of w.
//! Source: the gap function of node-to-segment contact (Wriggers 2006, Computational Contact Mechanics, ch. 4); β = 0
//! and β = 1 are its two passes.

use crate::model::geometry::Vec2;
use crate::model::{Assembly, Joint};

/// Slip at which a point has changed from the middle to a corner, as a share of the height of its joint. It also bounds
/// the slip of points in the middle.
const PASSING_SLIP: f64 = 0.05;

/// Share of this slip at which the change begins.
const BEGINS: f64 = 0.1;

/// Distance from half of the joint within which a point is its middle, as a share of the joint.
const MIDDLE: f64 = 1e-9;

/// Greatest slip of a joint with coinciding corners, as a share of its height: the lost overlap.
const LARGEST_SLIP: f64 = 0.5;

/// The rule by which a contact point slides with finite displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// β without slip: axes rotate by θ⁻ + β (θ⁺ − θ⁻), the force acts at (1 − β) x⁺ + β x⁻.
    pub share: f64,
    /// β after negative and after positive slip.
    pub corners: [f64; 2],
    /// Slip at which β reaches the value of a corner \[m\]; zero if β does not depend on slip.
    pub passing: f64,
    /// Least and greatest tangential gap for which the rule holds \[m\].
    pub slip: [f64; 2],
}

impl Sliding {
    /// Returns the rule of the point at a share `position` of a joint. Corners of bodies within `tolerance` \[m\] of
    /// the ends of the joint count as its ends.
    pub fn of(assembly: &Assembly, joint: &Joint, position: f64, tolerance: f64) -> Self {
        let sides = [joint.minus, joint.plus];
        // An abutment without a polygon has the face of its joint.
        let faces = sides.map(|side| match &assembly.bodies[side].vertices[..] {
            [] => Some([0.0, joint.height()]),
            vertices => face(vertices, joint.ends, tolerance),
        });
        let found = sliding(faces, joint.height(), position);
        let elastic = sides.iter().any(|side| assembly.is_deformable(*side));
        if elastic { found.begun_midway(joint.height()) } else { found }
    }

    /// Returns a rule with constant β, for any slip.
    pub fn fixed(share: f64) -> Self {
        Sliding { share, corners: [share; 2], passing: 0.0, slip: [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// Combines the rules of two ends of a joint: β = ½ if they differ, within the slip that both allow.
    fn in_common(self, other: Sliding, height: f64) -> Self {
        if self.corners == other.corners && self.share == other.share {
            return self;
        }
        let slip = [self.slip[0].max(other.slip[0]), self.slip[1].min(other.slip[1])];
        Sliding { slip, passing: PASSING_SLIP * height, ..Sliding::fixed(0.5) }
    }

    /// Returns the rule that begins with β = ½ and changes to its own β with slip, in a joint of this height \[m\].
    fn begun_midway(self, height: f64) -> Self {
        if self.share == 0.5 { self } else { Sliding { share: 0.5, passing: PASSING_SLIP * height, ..self } }
    }

    /// Returns the rule with β = ½ in a joint of this height \[m\]; without bounds if the height is zero.
    pub fn middle(height: f64) -> Self {
        let most = if height > 0.0 { PASSING_SLIP * height } else { f64::INFINITY };
        Sliding { slip: [-most, most], ..Sliding::fixed(0.5) }
    }

    /// Returns true if the blocks separate at the bounds. A point away from all corners only reaches the end of its
    /// rule.
    pub fn parts_at_bound(&self) -> bool {
        self.corners != [0.5; 2] || self.passing > 0.0
    }

    /// Returns β and its first and second derivative at a slip \[-, 1/m, 1/m²\].
    pub fn share_at(&self, slip: f64) -> [f64; 3] {
        if self.passing == 0.0 {
            return [self.share, 0.0, 0.0];
        }
        let along = 1.0 - BEGINS;
        let x = ((slip.abs() / self.passing - BEGINS) / along).clamp(0.0, 1.0);
        let psi = x * x * x * (10.0 + x * (6.0 * x - 15.0));
        let first = 30.0 * (x * (1.0 - x)).powi(2);
        let second = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x);
        let (by, scale) = (self.corners[usize::from(slip > 0.0)] - self.share, along * self.passing);
        [self.share + by * psi, by * slip.signum() * first / scale, by * second / (scale * scale)]
    }
}

/// Returns the start and end of the polygon edge that contains a joint, along the joint from its first end \[m\].
/// Corners within `tolerance` of the ends of the joint are moved to them. `None` if no edge contains the joint.
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

/// Returns the rule of a point of rigid bodies at a share `position` of a joint; `faces` of (minus, plus). An end
/// belongs to the body whose corner it is, a point in between to the nearer end, and the middle combines the rules of
/// both ends.
fn sliding(faces: [Option<[f64; 2]>; 2], height: f64, position: f64) -> Sliding {
    let of = |end: usize| at_end(faces, height, position, end);
    match position - 0.5 {
        off if off.abs() <= MIDDLE => of(0).in_common(of(1), height),
        off => of(usize::from(off > 0.0)),
    }
}

/// Returns the rule of a point that belongs to one end of its joint.
fn at_end(faces: [Option<[f64; 2]>; 2], height: f64, position: f64, end: usize) -> Sliding {
    let [Some(minus), Some(plus)] = faces else { return Sliding::middle(height) };
    let own = [0.0, height][end];
    let at = position * height;
    match (minus[end] == own, plus[end] == own) {
        (false, true) => Sliding { slip: [minus[0] - at, minus[1] - at], ..Sliding::fixed(0.0) },
        (true, false) => Sliding { slip: [at - plus[1], at - plus[0]], ..Sliding::fixed(1.0) },
        (true, true) => coinciding(height, end),
        _ => Sliding::middle(height),
    }
}

/// Returns the rule at an end with coinciding corners: β = ½, and the β of a corner after slip.
fn coinciding(height: f64, end: usize) -> Sliding {
    let corners = [[1.0, 0.0], [0.0, 1.0]][end];
    let most = LARGEST_SLIP * height;
    Sliding { share: 0.5, corners, passing: PASSING_SLIP * height, slip: [-most, most] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, width: f64) -> Vec<Vec2> {
        [[0.0, 0.0], [width, 0.0], [width, 1.0], [0.0, 1.0]].map(|[a, b]| Vec2::new(x + a, y + b)).to_vec()
    }

    /// A point belongs to the body with the nearer corner and slides up to the end of the other face.
    #[test]
    fn a_point_belongs_to_the_body_whose_corner_it_is() {
        // A block on a wider one, the joint read from right to left.
        let (below, above) = (square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0));
        let ends = [Vec2::new(3.0, 1.0), Vec2::new(1.0, 1.0)];
        let faces = [&below, &above].map(|v| face(v, ends, 1e-9));
        assert_eq!(faces, [Some([-1.0, 3.0]), Some([0.0, 2.0])]);
        assert_eq!(sliding(faces, 2.0, 0.0), Sliding { slip: [-1.0, 3.0], ..Sliding::fixed(0.0) });
        assert_eq!(sliding(faces, 2.0, 0.75), Sliding { slip: [-2.5, 1.5], ..Sliding::fixed(0.0) });
        // With both bodies exchanged the point belongs to minus, which slides by −g_t on plus.
        let swapped = [faces[1], faces[0]];
        assert_eq!(sliding(swapped, 2.0, 0.75), Sliding { slip: [-1.5, 2.5], ..Sliding::fixed(1.0) });
        // A block that overlaps half of the other: each body has its corner at one end.
        let half = [Some([0.0, 3.0]), Some([-1.0, 2.0])];
        assert_eq!([0.25, 0.75].map(|p| sliding(half, 2.0, p).share), [1.0, 0.0]);
        // Coinciding corners change from the middle to the corner that stays on a face; without faces β stays ½.
        let same = [Some([0.0, 2.0]); 2];
        let passing = |corners| Sliding { share: 0.5, corners, passing: 0.1, slip: [-1.0, 1.0] };
        assert_eq!(sliding(same, 2.0, 0.0), passing([1.0, 0.0]));
        assert_eq!(sliding(same, 2.0, 1.0), passing([0.0, 1.0]));
        // On elastic bodies all points begin with β = ½.
        let own = sliding(half, 2.0, 0.25).begun_midway(2.0);
        assert_eq!([-0.2, 0.0, 0.2].map(|slip| own.share_at(slip)[0]), [1.0, 0.5, 1.0]);
        assert_eq!(sliding([None; 2], 2.0, 0.0), Sliding::middle(2.0));
        // In the middle of a joint both ends count equally, whatever the rounding.
        for (faces, slip) in [(same, [-1.0, 1.0]), (half, [-1.0, 2.0])] {
            for position in [0.5 - 1e-16, 0.5, 0.5 + 2e-16] {
                let midway = sliding(faces, 2.0, position);
                assert_eq!((midway.corners, midway.share), ([0.5; 2], 0.5));
                assert!((midway.slip[0] - slip[0]).abs() + (midway.slip[1] - slip[1]).abs() < 1e-12, "{midway:?}");
            }
        }
        assert_eq!(sliding(faces, 2.0, 0.5).corners, [0.0; 2]);
        assert_eq!(face(&below, [Vec2::new(3.0, 0.5), Vec2::new(1.0, 0.5)], 1e-9), None);
    }

    /// β changes from ½ to the value of the corner, and its derivatives are those of the function.
    #[test]
    fn a_coinciding_corner_passes_to_the_one_that_stays_on_a_face() {
        for corners in [[0.0, 1.0], [1.0, 0.0], [1.0, 1.0]] {
            let sliding = Sliding { corners, passing: 0.1, ..Sliding::middle(2.0) };
            let shares = [-1.0, -0.1, 0.0, 0.1, 1.0].map(|slip| sliding.share_at(slip)[0]);
            assert_eq!(shares, [corners[0], corners[0], 0.5, corners[1], corners[1]]);
            for slip in [-0.12, -0.07, -1e-3, 0.02, 0.09, 0.2] {
                let [_, first, second] = sliding.share_at(slip);
                let [above, below] = [1e-6, -1e-6].map(|h| sliding.share_at(slip + h));
                assert!(((above[0] - below[0]) / 2e-6 - first).abs() < 1e-7, "{slip}");
                assert!(((above[1] - below[1]) / 2e-6 - second).abs() < 1e-5, "{slip}");
            }
        }
        assert_eq!(Sliding::fixed(0.25).share_at(3.0), [0.25, 0.0, 0.0]);
    }
}
