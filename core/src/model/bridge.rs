//! What a bridge has besides blocks and joints: the faces on which fill and loads stand, its road, and its fill as
//! masses on blocks and as horizontal reactions at the chords of the extrados.

use super::geometry::Vec2;
use crate::law::{FillResistance, FillState};
use std::sync::Arc;

/// A straight upper face of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chord {
    /// Index of the body.
    pub body: usize,
    /// Its ends \[m\].
    pub ends: [Vec2; 2],
    /// How far the voussoir stands from the middle of its ring: |2k + 1 − n| for voussoir k of n; of what is no
    /// voussoir [`Chord::NO_RING`].
    pub from_middle: usize,
}

impl Chord {
    /// `from_middle` of faces that belong to no ring.
    pub const NO_RING: usize = usize::MAX;

    /// Least x \[m\].
    pub fn left(&self) -> f64 {
        self.ends[0].x.min(self.ends[1].x)
    }

    /// Greatest x \[m\].
    pub fn right(&self) -> f64 {
        self.ends[0].x.max(self.ends[1].x)
    }

    /// Its point at x, or the nearest one; of an upright chord the upper end.
    pub fn at(&self, x: f64) -> Vec2 {
        let [a, b] = self.ends;
        // An end is returned as it is, so that a load at a vertex acts at that vertex.
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

/// The upper chords between two x, each with the part of it that lies there; an end within `rounding` of a vertex is
/// that vertex.
pub fn carried(chords: &[Chord], [start, end]: [f64; 2], rounding: f64) -> Vec<(Chord, f64, f64)> {
    let mut cuts: Vec<f64> = chords.iter().flat_map(|chord| chord.ends.map(|p| p.x)).collect();
    // An end that is a vertex but for rounding is that vertex: no sliver on the next voussoir.
    let vertex = |x: f64| cuts.iter().copied().find(|cut| (cut - x).abs() <= rounding).unwrap_or(x);
    let (start, end) = (vertex(start), vertex(end));
    cuts.extend([start, end]);
    cuts.retain(|&x| start <= x && x <= end);
    cuts.sort_by(f64::total_cmp);
    // Between two cuts one chord is the upper one all along. Its parts are joined again, so that
    // each chord gets one force at the middle of what it carries.
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

/// Fill that stands on a block: gravity acts on it, accelerations of blocks do not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FillMass {
    /// Index of the body.
    pub body: usize,
    /// On its upper face, under the centroid of the fill \[m\].
    pub point: Vec2,
    /// \[kg\].
    pub mass: f64,
}

/// Fill of one kind beside a chord.
#[derive(Debug, Clone)]
pub struct FillPart {
    /// Height of the part × width \[m²\].
    pub area: f64,
    /// Mean of the fill's mass above a point of the part \[kg/m²\].
    pub overburden: f64,
    /// Angle of internal friction \[rad\].
    pub friction_angle: f64,
    /// Cohesion \[Pa\].
    pub cohesion: f64,
    /// How it resists.
    pub law: Arc<dyn FillResistance>,
}

/// The horizontal force H of the fill on a chord of the extrados.
#[derive(Debug, Clone)]
pub struct FillReaction {
    /// Index of the body.
    pub body: usize,
    /// Where it acts: at the height of the centroid of the vertical stress along the chord \[m\].
    pub point: Vec2,
    /// Unit vector towards the ring.
    pub direction: Vec2,
    /// The fill beside the chord.
    pub parts: Vec<FillPart>,
}

impl FillReaction {
    /// Least and greatest H \[N\] under a gravity \[m/s²\].
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

    /// Area on which it acts \[m²\].
    pub fn area(&self) -> f64 {
        self.parts.iter().map(|part| part.area).sum()
    }

    /// H by displacement into the fill before it yields \[N/m\]; `None` where some part is rigid.
    pub fn stiffness(&self) -> Option<f64> {
        self.parts.iter().map(|part| Some(part.law.stiffness()? * part.area)).sum()
    }
}

/// What a bridge knows of itself beyond bodies and joints.
#[derive(Debug, Clone, Default)]
pub struct Bridge {
    /// Upper faces from left to right: chords of the outermost rings, and tops of piers between them.
    pub extrados: Vec<Chord>,
    /// x of the outermost intrados springings \[m\].
    pub springings: [f64; 2],
    /// The longest clear span at the intrados springings \[m\].
    pub longest_span: f64,
    /// Joints `0..radial` lie across rings, with end 0 towards the intrados.
    pub radial: usize,
    /// The road from left to right \[m\], level beyond its ends; empty where there is no fill: loads stand on the
    /// extrados.
    pub road: Vec<Vec2>,
    /// Layers of the fill that spread loads, from the lowest: upper level \[m\] and the angle of spread \[rad\] where
    /// the layer has one of its own.
    pub layers: Vec<(f64, Option<f64>)>,
    /// The fill's masses.
    pub masses: Vec<FillMass>,
    /// The fill's reactions.
    pub reactions: Vec<FillReaction>,
}

impl Bridge {
    /// Level of the road at x \[m\]; `None` where there is no road.
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
