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
//! - β = ½: the mean of the two, and all that can be said where the corners of both bodies coincide. As soon as they
//!   slip by s, one of the two lies beyond the other's face, and the mean is wrong by s/2: the point becomes that of the
//!   corner that stays on the other's face. At one end of the joint that is plus's where s > 0 and minus's where s < 0,
//!   at the other end the other way round. β follows the slip s = t_m·(x⁺ − x⁻), t_m in the mean axes,
//!
//! ```text
//! β(s) = ½ + (β± − ½) ψ((|s| − w/10)/(w − w/10))     w = h/20, β+ for s > 0, β− for s < 0
//! ψ(ξ) = ξ³ (10 − 15 ξ + 6 ξ²)     0 for ξ < 0, 1 for ξ > 1
//! ```
//!
//! twice continuously differentiable, so that forces and stiffness are continuous: corners are rounded by w. What is
//! conjugate to r is r·δg with this β, in which g depends on s through β as well: beside P acts
//! (turned(P)·(x⁺ − x⁻)) (θ⁺ − θ⁻) β'(s) along t_m in the middle between x⁺ and x⁻.
//! - Where bodies are elastic, s and x⁺ − x⁻ in this are those of their rigid motions, and what their deformation adds to
//!   the gaps is read in the mean axes (wrong by its product with (β − ½)(θ⁺ − θ⁻)), with the forces that are conjugate to
//!   that. Without slip deformation matters and β = ½ is right for it; a point whose corner is one body's passes to that
//!   corner with either sign of s, β+ = β−.
//!
//! Areas, and so the compliances of single points, are those of the undeformed joint: where it loses
//! or gains overlap a share s/h of the joint's compliance is wrong, its equilibrium is not. A joint whose corners
//! coincide loses overlap as it slips: half of its height is the most. A point at which neither body has a corner keeps
//! β = ½, up to w.
//! Source: the gap function of node-to-segment contact (Wriggers 2006, Computational Contact Mechanics,
//! ch. 4), of which β = 0 and 1 are the two passes.

use crate::model::geometry::Vec2;
use crate::model::{Assembly, Joint};

/// Slip at which a point has passed from the middle to a corner, and up to which it holds in the middle, as a share of
/// its joint.
const PASSING_SLIP: f64 = 0.05;

/// Share of that slip at which it begins to pass.
const BEGINS: f64 = 0.1;

/// Places of points this near to half of their joint are its middle.
const MIDDLE: f64 = 1e-9;

/// Most slip of a joint whose corners coincide, as a share of it: what it has lost of its overlap.
const LARGEST_SLIP: f64 = 0.5;

/// How a contact point slides with finite displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// β without slip: its axes turn by θ⁻ + β (θ⁺ − θ⁻), its force acts at (1 − β) x⁺ + β x⁻.
    pub share: f64,
    /// β after slip of either sense, negative and positive.
    pub corners: [f64; 2],
    /// Slip at which β has passed to a corner's \[m\]; zero where it does not depend on slip.
    pub passing: f64,
    /// Least and greatest tangential gap that this holds for \[m\].
    pub slip: [f64; 2],
}

impl Sliding {
    /// Of the point at a share `position` of a joint; corners of bodies that its ends hit to within `tolerance`
    /// \[m\] are ends of the joint.
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

    /// With one β \[-\], whatever the slip.
    pub fn fixed(share: f64) -> Self {
        Sliding { share, corners: [share; 2], passing: 0.0, slip: [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// What two ends of a joint have in common: midway where each has its own corners, as long as both hold.
    fn in_common(self, other: Sliding, height: f64) -> Self {
        if self.corners == other.corners && self.share == other.share {
            return self;
        }
        let slip = [self.slip[0].max(other.slip[0]), self.slip[1].min(other.slip[1])];
        Sliding { slip, passing: PASSING_SLIP * height, ..Sliding::fixed(0.5) }
    }

    /// Midway between the bodies at first, and with its own β once it has slipped, in a joint of this height \[m\].
    fn begun_midway(self, height: f64) -> Self {
        if self.share == 0.5 { self } else { Sliding { share: 0.5, passing: PASSING_SLIP * height, ..self } }
    }

    /// Midway between the bodies, in a joint of this height \[m\]; without bounds where it has none.
    pub fn middle(height: f64) -> Self {
        let most = if height > 0.0 { PASSING_SLIP * height } else { f64::INFINITY };
        Sliding { slip: [-most, most], ..Sliding::fixed(0.5) }
    }

    /// Returns true if the blocks come apart at the bounds: a point away from all corners is only paired for less.
    pub fn parts_at_bound(&self) -> bool {
        self.corners != [0.5; 2] || self.passing > 0.0
    }

    /// β and its first and second derivatives at a slip \[-, 1/m, 1/m²\].
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

/// How a point of rigid bodies at a share `position` of a joint slides; `faces` of (minus, plus). An end belongs to the
/// body whose corner it is, a point between to the nearer end, the very middle to what both ends have in common.
fn sliding(faces: [Option<[f64; 2]>; 2], height: f64, position: f64) -> Sliding {
    let of = |end: usize| at_end(faces, height, position, end);
    match position - 0.5 {
        off if off.abs() <= MIDDLE => of(0).in_common(of(1), height),
        off => of(usize::from(off > 0.0)),
    }
}

/// The same of a point that goes with an end of its joint.
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

/// Where the corners of both bodies coincide at an end of a joint: midway, and at a corner once that has slipped.
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

    /// A point belongs to the body whose corner is nearer, and may slide as far as the other's face goes.
    #[test]
    fn a_point_belongs_to_the_body_whose_corner_it_is() {
        // A block on a wider one, the joint read from right to left.
        let (below, above) = (square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0));
        let ends = [Vec2::new(3.0, 1.0), Vec2::new(1.0, 1.0)];
        let faces = [&below, &above].map(|v| face(v, ends, 1e-9));
        assert_eq!(faces, [Some([-1.0, 3.0]), Some([0.0, 2.0])]);
        assert_eq!(sliding(faces, 2.0, 0.0), Sliding { slip: [-1.0, 3.0], ..Sliding::fixed(0.0) });
        assert_eq!(sliding(faces, 2.0, 0.75), Sliding { slip: [-2.5, 1.5], ..Sliding::fixed(0.0) });
        // The other way up: the point belongs to minus, which slides by −g_t on plus.
        let swapped = [faces[1], faces[0]];
        assert_eq!(sliding(swapped, 2.0, 0.75), Sliding { slip: [-1.5, 2.5], ..Sliding::fixed(1.0) });
        // Half over: each end has its own corner.
        let half = [Some([0.0, 3.0]), Some([-1.0, 2.0])];
        assert_eq!([0.25, 0.75].map(|p| sliding(half, 2.0, p).share), [1.0, 0.0]);
        // Corners that coincide pass from the middle to the corner that stays on a face; without faces points stay midway.
        let same = [Some([0.0, 2.0]); 2];
        let passing = |corners| Sliding { share: 0.5, corners, passing: 0.1, slip: [-1.0, 1.0] };
        assert_eq!(sliding(same, 2.0, 0.0), passing([1.0, 0.0]));
        assert_eq!(sliding(same, 2.0, 1.0), passing([0.0, 1.0]));
        // Of elastic bodies all begin in the middle.
        let own = sliding(half, 2.0, 0.25).begun_midway(2.0);
        assert_eq!([-0.2, 0.0, 0.2].map(|slip| own.share_at(slip)[0]), [1.0, 0.5, 1.0]);
        assert_eq!(sliding([None; 2], 2.0, 0.0), Sliding::middle(2.0));
        // In the middle of a joint no end goes before the other, wherever rounding puts it.
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

    /// β passes from ½ to the corner's, with the derivatives that it says.
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
