//! A span of a bridge: one or several rings of voussoirs on one intrados.
//!
//! Rings have equal shares of the thickness. The faces between them are cut at every joint of the ring below and of the ring
//! above, so that both rings touch along whole edges, also if their joints are offset.

use crate::scenes::arch::Ends;
use crate::scenes::lookup::{out_of_range, take};
use crate::scenes::profile::{Profile, Ring, Springing};
use crate::scenes::thickness::Thickness;
use std::cmp::Ordering;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::{Diagnostic, Keys};

/// Greatest number of voussoirs in a ring.
pub(super) const MAX_VOUSSOIRS: usize = 10_000;
/// Greatest number of rings.
pub(super) const MAX_RINGS: usize = 50;
/// Number of voussoirs of the polygon that approximates the length of a ring.
const FINE: usize = 2000;

/// Position of the radial joints of neighbouring rings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum RadialJoints {
    /// The joints meet.
    Aligned,
    /// Every other ring starts with half a voussoir.
    Offset,
}

/// One number for all rings, or one for each from the innermost outwards.
#[derive(Debug, Clone, PartialEq, Eq, Keys)]
#[keys(untagged)]
pub enum Counts {
    /// The same number in every ring.
    #[key(range = ">= 1, <= MAX_VOUSSOIRS")]
    Each(usize),
    /// A number for each ring.
    #[key(range = ">= 1, <= MAX_VOUSSOIRS", len = ">= 1, <= MAX_RINGS")]
    Rings(Vec<usize>),
}

/// A span.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Span {
    /// shape of the intrados
    pub profile: Profile,
    /// thickness of all rings together, along the joints; { crown, springing } grows with the arc length
    /// between them
    #[key(optional = "the profile is a list of points")]
    pub thickness: Option<Thickness>,
    /// number of voussoirs in a ring, or a list of numbers from the innermost ring outwards
    #[key(optional = "voussoir_length is given, or the profile is a list of points")]
    pub voussoirs: Option<Counts>,
    /// least length of a voussoir along the lower face of its ring
    #[key(unit = "m", range = "> 0", optional = "voussoirs is given")]
    pub voussoir_length: Option<f64>,
    /// number of rings, equally thick
    #[key(range = ">= 1, <= MAX_RINGS", default = 1)]
    pub rings: usize,
    /// aligned: radial joints of neighbouring rings meet; offset: every other ring begins with half a
    /// voussoir
    #[key(default = "aligned")]
    pub radial_joints: RadialJoints,
    /// bonded: the springing faces move with the supports; jointed: they follow the interface law
    #[key(default = "jointed")]
    pub ends: Ends,
    /// inclination of the support plane above the horizontal, rising outwards; one number or \[left, right\]
    #[key(optional = "the end joints are normal to the intrados")]
    pub springing: Option<Springing>,
    /// level of its springings
    #[key(unit = "m", default = 0.0)]
    pub level: f64,
    /// material of its blocks
    #[key(reference = "materials", optional = "that of the scene")]
    pub material: Option<String>,
}

/// A position along a ring: the share `part/of` of its length.
#[derive(Debug, Clone, Copy)]
struct Station {
    part: usize,
    of: usize,
    intrados: Vec2,
    extrados: Vec2,
}

impl Station {
    fn order(&self, other: &Station) -> Ordering {
        (self.part * other.of).cmp(&(other.part * self.of))
    }
}

/// The blocks of a ring and their joints.
#[derive(Debug, Clone)]
pub struct RingBlocks {
    /// Outlines, anticlockwise.
    pub voussoirs: Vec<Vec<Vec2>>,
    /// Ends of the joints across the ring, intrados first, one more than voussoirs.
    pub joints: Vec<[Vec2; 2]>,
}

/// Rings of a span at their positions.
#[derive(Debug, Clone)]
pub struct SpanBlocks {
    /// Rings from the innermost outwards.
    pub rings: Vec<RingBlocks>,
    /// Contacts between ring r and r + 1: (voussoir below, voussoir above, ends with the ring above to the left).
    pub interfaces: Vec<Vec<(usize, usize, [Vec2; 2])>>,
    /// Highest level of the extrados curve \[m\].
    pub crown: f64,
}

impl SpanBlocks {
    /// Returns the ends of the springing face on one side (0 left, 1 right): at the intrados and at the extrados.
    pub fn springing(&self, side: usize) -> [Vec2; 2] {
        let end = |ring: &RingBlocks| if side == 0 { ring.joints[0] } else { ring.joints[ring.joints.len() - 1] };
        [end(&self.rings[0])[0], end(&self.rings[self.rings.len() - 1])[1]]
    }
}

impl Span {
    /// Returns the rings with the left intrados springing at `x` \[m\]; diagnostics have paths from the span's table.
    pub fn blocks(&self, x: f64) -> Result<SpanBlocks, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        if !(1..=MAX_RINGS).contains(&self.rings) {
            diagnostics.push(Diagnostic::new("rings", format!("{} must be from 1 to {MAX_RINGS}", self.rings)));
        }
        diagnostics.extend(out_of_range::<Self>("level", self.level));
        let counts = take(self.counts(), &mut diagnostics);
        let Some(counts) = counts.filter(|_| diagnostics.is_empty()) else { return Err(diagnostics) };
        let mut stations = Vec::new();
        let mut crown = f64::NEG_INFINITY;
        for (index, &count) in counts.iter().enumerate() {
            let ring = self.ring(Some(count))?;
            crown = crown.max(self.crown(&ring));
            let halves = match self.radial_joints {
                RadialJoints::Offset if index % 2 == 1 => Some(self.ring(Some(2 * count))?),
                _ => None,
            };
            stations.push(ring_stations(&ring, halves.as_ref()));
        }
        // Move the left intrados springing to (x, level).
        let shift = Vec2::new(x, self.level) - stations[0][0].intrados;
        for station in stations.iter_mut().flatten() {
            station.intrados += shift;
            station.extrados += shift;
        }
        Ok(SpanBlocks { crown: crown + shift.y, ..assemble(&stations) })
    }

    /// Returns a single ring with the thickness of all rings.
    fn ring(&self, count: Option<usize>) -> Result<Ring, Vec<Diagnostic>> {
        let count = if matches!(self.profile, Profile::Points { .. }) { self.given() } else { count };
        self.profile.ring(self.thickness, count, self.springing)
    }

    /// Returns the number that the study gives for all rings.
    fn given(&self) -> Option<usize> {
        match self.voussoirs {
            Some(Counts::Each(count)) => Some(count),
            _ => None,
        }
    }

    /// Returns the highest point of the extrados curve, also if no vertex is there.
    fn crown(&self, ring: &Ring) -> f64 {
        let highest = ring.extrados.iter().fold(f64::NEG_INFINITY, |top, point| top.max(point.y));
        match (&self.profile, self.thickness) {
            (Profile::Surveyed { extrados, .. }, _) => extrados.iter().fold(highest, |top, point| top.max(point[1])),
            (Profile::Points { .. }, _) | (_, None) => highest,
            (_, Some(thickness)) => highest.max(ring.rise + thickness.at(0.0)),
        }
    }

    /// Returns the number of voussoirs in each ring.
    fn counts(&self) -> Result<Vec<usize>, Diagnostic> {
        if let Profile::Points { intrados, .. } = &self.profile {
            let by_points = match (&self.voussoirs, self.voussoir_length, self.radial_joints) {
                (Some(Counts::Rings(_)), ..) => Some("voussoirs"),
                (_, Some(_), _) => Some("voussoir_length"),
                (.., RadialJoints::Offset) => Some("radial_joints"),
                _ => None,
            };
            return match by_points {
                Some(key) => Err(Diagnostic::new(key, "the points of the profile already fix the joints")),
                None => Ok(vec![intrados.len().saturating_sub(1).max(1); self.rings]),
            };
        }
        let counts = match (&self.voussoirs, self.voussoir_length) {
            (Some(_), Some(_)) => {
                return Err(
                    Diagnostic::new("voussoir_length", "is given besides voussoirs").help("keep one of the two")
                );
            }
            (Some(Counts::Each(count)), None) => vec![*count; self.rings],
            (Some(Counts::Rings(counts)), None) if counts.len() == self.rings => counts.clone(),
            (Some(Counts::Rings(counts)), None) => {
                let message = format!("{} numbers for {} rings", counts.len(), self.rings);
                return Err(Diagnostic::new("voussoirs", message));
            }
            (None, Some(length)) => self.by_length(length)?,
            (None, None) => return Err(Diagnostic::new("voussoirs", "is missing: the number of voussoirs in a ring")),
        };
        match counts.iter().find(|count| !(1..=MAX_VOUSSOIRS).contains(*count)) {
            Some(count) => Err(Diagnostic::new("voussoirs", format!("{count} must be from 1 to {MAX_VOUSSOIRS}"))),
            None => Ok(counts),
        }
    }

    /// Returns the greatest number of voussoirs in each ring that are no shorter than `length` along its lower face.
    fn by_length(&self, length: f64) -> Result<Vec<usize>, Diagnostic> {
        if let Some(wrong) = out_of_range::<Self>("voussoir_length", length) {
            return Err(wrong);
        }
        // Mistakes in the ring itself are reported when it is built.
        let Ok(ring) = self.profile.ring(self.thickness, Some(FINE), self.springing) else {
            return Ok(vec![1; self.rings]);
        };
        let count = |index: usize| {
            let share = index as f64 / self.rings as f64;
            let at = |k: usize| ring.intrados[k] + (ring.extrados[k] - ring.intrados[k]) * share;
            let total: f64 = (0..FINE).map(|k| (at(k + 1) - at(k)).norm()).sum();
            (total / length).floor().max(1.0) as usize
        };
        Ok((0..self.rings).map(count).collect())
    }
}

/// Returns the positions of the joints of a ring; `halves` is the ring with twice as many parts. An offset ring uses every
/// other joint of it.
fn ring_stations(ring: &Ring, halves: Option<&Ring>) -> Vec<Station> {
    let station = |ring: &Ring, part: usize| Station {
        part,
        of: ring.voussoirs(),
        intrados: ring.intrados[part],
        extrados: ring.extrados[part],
    };
    let count = ring.voussoirs();
    match halves {
        None => (0..=count).map(|k| station(ring, k)).collect(),
        Some(halves) => {
            let between = (0..count).map(|k| station(halves, 2 * k + 1));
            [station(halves, 0)].into_iter().chain(between).chain([station(halves, 2 * count)]).collect()
        }
    }
}

/// Returns the positions of two rings together, each once.
fn union(below: &[Station], above: &[Station]) -> Vec<Station> {
    let mut all: Vec<Station> = below.to_vec();
    all.extend(above.iter().filter(|a| below.iter().all(|b| b.order(a) != Ordering::Equal)));
    all.sort_by(Station::order);
    all
}

/// Builds the blocks from the positions of each ring.
fn assemble(stations: &[Vec<Station>]) -> SpanBlocks {
    let count = stations.len();
    // Faces from the intrados to the extrados, each with its points from left to right.
    let face = |index: usize| -> Vec<(Station, Vec2)> {
        let all = match index {
            0 => stations[0].clone(),
            index if index == count => stations[count - 1].clone(),
            index => union(&stations[index - 1], &stations[index]),
        };
        let at = |station: Station| match index {
            0 => station.intrados,
            index if index == count => station.extrados,
            index => station.intrados + (station.extrados - station.intrados) * (index as f64 / count as f64),
        };
        all.into_iter().map(|station| (station, at(station))).collect()
    };
    let faces: Vec<_> = (0..=count).map(face).collect();
    let point = |index: usize, station: &Station| {
        let found = faces[index].iter().find(|(other, _)| other.order(station) == Ordering::Equal);
        found.map_or(station.intrados, |(_, point)| *point)
    };
    let rings = stations.iter().enumerate().map(|(r, own)| {
        let joints: Vec<_> = own.iter().map(|station| [point(r, station), point(r + 1, station)]).collect();
        let voussoirs = own.windows(2).map(|pair| {
            let within = |(station, _): &&(Station, Vec2)| {
                station.order(&pair[0]) != Ordering::Less && station.order(&pair[1]) != Ordering::Greater
            };
            let lower = faces[r].iter().filter(within).map(|(_, point)| *point);
            let upper = faces[r + 1].iter().filter(within).map(|(_, point)| *point);
            lower.chain(upper.collect::<Vec<_>>().into_iter().rev()).collect()
        });
        RingBlocks { voussoirs: voussoirs.collect(), joints }
    });
    let rings: Vec<RingBlocks> = rings.collect();
    let interfaces = (1..count).map(|index| {
        let of = |ring: usize, station: &Station| {
            stations[ring].partition_point(|own| own.order(station) != Ordering::Greater) - 1
        };
        faces[index]
            .windows(2)
            .map(|pair| (of(index - 1, &pair[0].0), of(index, &pair[0].0), [pair[1].1, pair[0].1]))
            .collect()
    });
    let interfaces = interfaces.collect();
    SpanBlocks { rings, interfaces, crown: 0.0 }
}
