//! Data of a bridge besides blocks and joints: the faces that carry fill and loads, the road, and the fill, as masses
//! on blocks and as horizontal reactions at the chords of the extrados.

use super::geometry::Vec2;
use crate::law::{FillResistance, FillState};
use std::sync::Arc;

/// A straight upper face of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chord {
    /// Index of the body.
    pub body: usize,
    /// Ends of the face \[m\].
    pub ends: [Vec2; 2],
    /// Distance of the voussoir from the middle of its ring: |2k + 1 − n| for voussoir k of n; [`Chord::NO_RING`] if
    /// the face is not part of a ring.
    pub from_middle: usize,
}

impl Chord {
    /// `from_middle` of faces that are not part of a ring.
    pub const NO_RING: usize = usize::MAX;

    /// Returns the least x \[m\].
    pub fn left(&self) -> f64 {
        self.ends[0].x.min(self.ends[1].x)
    }

    /// Returns the greatest x \[m\].
    pub fn right(&self) -> f64 {
        self.ends[0].x.max(self.ends[1].x)
    }

    /// Returns the point of the chord at x, or the nearest one; the upper end if the chord is vertical.
    pub fn at(&self, x: f64) -> Vec2 {
        let [a, b] = self.ends;
        // An end is returned unchanged, so that a load at a vertex acts at that vertex.
        if a.x == b.x {
            return if a.y > b.y { a } else { b };
        }
        let share = (x - a.x) / (b.x - a.x);
        if share <= 0.0 {
            a
        } else if share >= 1.0 {
            b
        } else {
            Vec2::new(x, a.y + share * (b.y - a.y))
        }
    }
}

/// Returns the upper chords between two x, each with its part of the interval. An end within `rounding` of a vertex is
/// moved to that vertex.
pub fn carried(chords: &[Chord], [start, end]: [f64; 2], rounding: f64) -> Vec<(Chord, f64, f64)> {
    let mut cuts: Vec<f64> = chords.iter().flat_map(|chord| chord.ends.map(|p| p.x)).collect();
    // Move an end to a vertex within rounding: this avoids a sliver on the next voussoir.
    let vertex = |x: f64| cuts.iter().copied().find(|cut| (cut - x).abs() <= rounding).unwrap_or(x);
    let (start, end) = (vertex(start), vertex(end));
    cuts.extend([start, end]);
    cuts.retain(|&x| start <= x && x <= end);
    cuts.sort_by(f64::total_cmp);
    // Between two neighbouring cuts the same chord is uppermost. Its parts are joined again, so that each chord gets one
    // force at the middle of its loaded length.
    let mut parts: Vec<(Chord, f64, f64)> = Vec::new();
    for pair in cuts.windows(2).filter(|pair| pair[0] < pair[1]) {
        let middle = (pair[0] + pair[1]) / 2.0;
        let above = chords.iter().filter(|chord| chord.left() <= middle && middle <= chord.right());
        let Some(&top) = above.max_by(|a, b| a.at(middle).y.total_cmp(&b.at(middle).y)) else {
            continue;
        };
        match parts.last_mut() {
            Some((chord, _, high)) if *chord == top && *high == pair[0] => *high = pair[1],
            _ => parts.push((top, pair[0], pair[1])),
        }
    }
    parts
}

/// Fill above a block. Gravity acts on it; accelerations of blocks do not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FillMass {
    /// Index of the body.
    pub body: usize,
    /// Point of action on the upper face, under the centroid of the fill \[m\].
    pub point: Vec2,
    /// Mass \[kg\].
    pub mass: f64,
}

/// Fill of one material beside a chord.
#[derive(Debug, Clone)]
pub struct FillPart {
    /// Height of the part × width \[m²\].
    pub area: f64,
    /// Mean mass of the fill above a point of the part \[kg/m²\].
    pub overburden: f64,
    /// Angle of internal friction \[rad\].
    pub friction_angle: f64,
    /// Cohesion \[Pa\].
    pub cohesion: f64,
    /// Law of its resistance.
    pub law: Arc<dyn FillResistance>,
}

/// The horizontal force H of the fill on a chord of the extrados.
#[derive(Debug, Clone)]
pub struct FillReaction {
    /// Index of the body.
    pub body: usize,
    /// Point of action: at the height of the centroid of the vertical stress along the chord \[m\].
    pub point: Vec2,
    /// Unit vector towards the ring.
    pub direction: Vec2,
    /// The fill beside the chord.
    pub parts: Vec<FillPart>,
}

impl FillReaction {
    /// Returns the least and greatest H \[N\] under a gravity \[m/s²\].
    pub fn bounds(&self, gravity: f64) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for part in &self.parts {
            let pressures = part.law.pressures(&FillState {
                vertical_stress: part.overburden * gravity,
                friction_angle: part.friction_angle,
                cohesion: part.cohesion,
            });
            (0..2).for_each(|i| sum[i] += pressures[i] * part.area);
        }
        sum
    }

    /// Returns the area on which the fill acts \[m²\].
    pub fn area(&self) -> f64 {
        self.parts.iter().map(|part| part.area).sum()
    }

    /// Returns H per displacement into the fill before it yields \[N/m\]. `None` if a part is rigid.
    pub fn stiffness(&self) -> Option<f64> {
        self.parts.iter().map(|part| Some(part.law.stiffness()? * part.area)).sum()
    }
}

/// Data of a bridge besides bodies and joints.
#[derive(Debug, Clone, Default)]
pub struct Bridge {
    /// Upper faces from left to right: chords of the outermost rings, and tops of piers and abutments.
    pub extrados: Vec<Chord>,
    /// x of the outermost intrados springings \[m\].
    pub springings: [f64; 2],
    /// The longest clear span at the intrados springings \[m\].
    pub longest_span: f64,
    /// Number of joints across rings: joints `0..radial`, with end 0 towards the intrados.
    pub radial: usize,
    /// The road from left to right \[m\], level beyond its ends. Empty if there is no fill: loads then act on the
    /// extrados.
    pub road: Vec<Vec2>,
    /// Layers of the fill that spread loads, from bottom to top: upper level \[m\], and the angle of spread \[rad\] if
    /// the layer defines one.
    pub layers: Vec<(f64, Option<f64>)>,
    /// Masses of the fill.
    pub masses: Vec<FillMass>,
    /// Reactions of the fill.
    pub reactions: Vec<FillReaction>,
}

impl Bridge {
    /// Returns the level of the road at x \[m\]. `None` if there is no road.
    pub fn road_at(&self, x: f64) -> Option<f64> {
        let first = self.road.first()?;
        let after = self.road.partition_point(|point| point.x <= x);
        Some(match (after.checked_sub(1).map(|i| self.road[i]), self.road.get(after)) {
            (Some(a), Some(b)) => a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x),
            (Some(a), None) => a.y,
            (None, _) => first.y,
        })
    }
}
