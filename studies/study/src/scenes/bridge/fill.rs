//! The fill of a bridge: its weight on the blocks by vertical columns, and its resistance at the chords of the extrados.

use crate::scenes::abutments::backing as resistance_up_to;
use crate::scenes::dispersion::Dispersion;
use crate::scenes::lookup::out_of_range;
use std::sync::Arc;
use voussoir_core::law::{FillResistance, FillState};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Bridge, Chord, FillMass, FillPart, FillReaction, carried};
use voussoir_core::plugin::{Diagnostic, Keys};

/// Number of parts of the fill on a deformable block; each part has two points.
const PARTS: usize = 16;

/// Extent of the fill on both sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Extent {
    /// Over the whole extrados.
    Extrados,
    /// Up to the verticals through the outermost intrados springings.
    Springings,
}

/// A layer of the fill.
#[derive(Debug, Keys)]
pub struct Layer {
    /// its upper level, above y = 0
    #[key(unit = "m")]
    pub to_level: f64,
    /// of the fill
    #[key(unit = "kg/m3", range = ">= 0")]
    pub density: f64,
    /// angle of internal friction
    #[key(unit = "deg", range = ">= 0, < 90", optional = "that of the fill")]
    pub friction_angle: Option<f64>,
    /// cohesion
    #[key(unit = "Pa", range = ">= 0", optional = "that of the fill")]
    pub cohesion: Option<f64>,
    /// of the spread of loads in it, from the vertical
    #[key(unit = "deg", range = ">= 0, < 90", optional = "that of the dispersion")]
    pub angle: Option<f64>,
}

/// Solid backing.
#[derive(Debug, Clone, Copy, Keys)]
pub struct Haunching {
    /// its upper level, above y = 0
    #[key(unit = "m")]
    pub level: f64,
    /// of the backing
    #[key(unit = "kg/m3", range = ">= 0", optional = "that of the voussoirs")]
    pub density: Option<f64>,
    /// horizontal pressure up to which it resists
    #[key(unit = "Pa", range = ">= 0", default = 0.0)]
    pub strength: f64,
}

/// `[scene.fill]`.
#[derive(Debug, Keys)]
pub struct Fill {
    /// depth of a level road above the highest crown's extrados
    #[key(unit = "m", range = ">= 0", optional = "road is given")]
    pub cover: Option<f64>,
    /// points of the road from left to right, level beyond them
    #[key(names = ["x", "y"], unit = "m", len = ">= 1", optional = "level, by cover")]
    pub road: Option<Vec<[f64; 2]>>,
    /// Density \[kg/m³\].
    #[key(like = Layer)]
    pub density: f64,
    /// Angle of internal friction \[deg\].
    #[key(like = Layer, optional = "no resistance is asked for")]
    pub friction_angle: Option<f64>,
    /// Cohesion \[Pa\].
    #[key(like = Layer, default = 0.0)]
    pub cohesion: f64,
    /// extrados: fill covers the whole extrados; springings: it ends above the outermost intrados springings
    #[key(default = "extrados")]
    pub extent: Extent,
    /// how live loads spread: { law = "uniform", angle = 30.0 }
    #[key(optional = "loads do not spread")]
    pub dispersion: Option<Box<dyn Dispersion>>,
    /// how the fill resists the rings: { law = "fill_pressure", passive_factor = 0.33 }
    #[key(optional = "the fill does not resist")]
    pub resistance: Option<Box<dyn FillResistance>>,
    /// solid backing in the haunches up to a level
    #[key(optional = "none")]
    pub haunching: Option<Haunching>,
    /// layers from bottom to top; the fill itself is above the last one
    #[key(default = [])]
    pub layers: Vec<Layer>,
}

/// Ground of one material up to a level.
#[derive(Debug, Clone)]
struct Stratum {
    top: f64,
    density: f64,
    friction_angle: f64,
    cohesion: f64,
    law: Option<Arc<dyn FillResistance>>,
    angle: Option<f64>,
}

impl Fill {
    /// Returns the mistakes in its numbers, with paths from its table.
    pub fn mistakes(&self) -> Vec<Diagnostic> {
        let mut diagnostics = Vec::new();
        match (self.cover, &self.road) {
            (None, None) => {
                diagnostics.push(Diagnostic::new("cover", "is missing: the depth of the road above the crown"))
            }
            (Some(_), Some(_)) => {
                diagnostics.push(Diagnostic::new("cover", "is given besides road").help("keep one of the two"));
            }
            (Some(cover), None) => diagnostics.extend(out_of_range::<Self>("cover", cover)),
            (None, Some(road)) => diagnostics.extend(road_mistakes(road)),
        }
        if self.resistance.is_some() && self.friction_angle.is_none() {
            let message = "is missing: the resistance of the fill needs its angle of friction";
            diagnostics.push(Diagnostic::new("friction_angle", message));
        }
        let mut below = f64::NEG_INFINITY;
        for (i, layer) in self.layers.iter().enumerate() {
            if !layer.to_level.is_finite() || layer.to_level <= below {
                let message = format!("{} does not lie above the layer below, which ends at {below}", layer.to_level);
                diagnostics.push(Diagnostic::new(format!("layers.{i}.to_level"), message));
            }
            below = layer.to_level;
        }
        diagnostics
    }

    /// Returns its strata from bottom to top; `masonry` is the density of the voussoirs \[kg/m³\].
    fn strata(&self, masonry: f64) -> Vec<Stratum> {
        let law = self.resistance.as_ref().and_then(|law| shared(law.as_ref()));
        let angle = self.friction_angle.unwrap_or(0.0);
        let stratum = |top: f64, density: f64, degrees: f64, cohesion: f64, angle: Option<f64>| Stratum {
            top,
            density,
            friction_angle: degrees.to_radians(),
            cohesion,
            law: law.clone(),
            angle: angle.map(f64::to_radians),
        };
        let floor = self.haunching.map_or(f64::NEG_INFINITY, |backing| backing.level);
        let mut strata = Vec::new();
        if let Some(backing) = self.haunching {
            let law = resistance_up_to(backing.strength);
            strata.push(Stratum { law, ..stratum(floor, backing.density.unwrap_or(masonry), 0.0, 0.0, None) });
        }
        for layer in self.layers.iter().filter(|layer| layer.to_level > floor) {
            let (degrees, cohesion) = (layer.friction_angle.unwrap_or(angle), layer.cohesion.unwrap_or(self.cohesion));
            strata.push(stratum(layer.to_level, layer.density, degrees, cohesion, layer.angle));
        }
        strata.push(stratum(f64::INFINITY, self.density, angle, self.cohesion, None));
        strata
    }

    /// Adds road, weight and resistance to a bridge with a known extrados. `crown` is the highest level of the extrados,
    /// `springings` the x of the outermost intrados springings \[m\]. Diagnostics have paths from the fill's table.
    pub fn add_to(
        &self,
        assembly: &Assembly,
        bridge: &mut Bridge,
        crown: f64,
        springings: [f64; 2],
    ) -> Result<(), Vec<Diagnostic>> {
        let extrados = bridge.extrados.clone();
        let left = extrados.iter().map(Chord::left).fold(f64::INFINITY, f64::min);
        let right = extrados.iter().map(Chord::right).fold(f64::NEG_INFINITY, f64::max);
        bridge.road = match &self.road {
            Some(road) => road.iter().map(|&point| Vec2::from(point)).collect(),
            None => [left, right].map(|x| Vec2::new(x, crown + self.cover.unwrap_or(0.0))).to_vec(),
        };
        let body = extrados.first().map_or(0, |chord| chord.body);
        let strata = self.strata(assembly.material(body).density());
        bridge.layers = strata.iter().map(|stratum| (stratum.top, stratum.angle)).collect();
        let [from, to] = match self.extent {
            Extent::Extrados => [left, right],
            Extent::Springings => springings,
        };
        let ground = Ground { bridge, strata: &strata, width: assembly.width, rounding: 1e-12 * assembly.size() };
        if let Some((x, depth)) = ground.protruding(&extrados) {
            let key = if self.road.is_some() { "road" } else { "cover" };
            let message = format!("at x = {x} m the extrados stands {depth:.3e} m above the road");
            return Err(vec![Diagnostic::new(key, message)]);
        }
        let (mut masses, mut reactions) = (Vec::new(), Vec::new());
        for (chord, low, high) in carried(&extrados, [from, to], ground.rounding) {
            masses.extend(ground.masses(&chord, [low, high], assembly.is_rigid(chord.body)));
        }
        for chord in extrados.iter().filter(|chord| chord.from_middle != Chord::NO_RING) {
            reactions.extend(ground.reaction(chord, [from, to]));
        }
        bridge.masses = masses;
        bridge.reactions = reactions;
        Ok(())
    }
}

/// Returns a law in a form that many chords share.
fn shared(law: &dyn FillResistance) -> Option<Arc<dyn FillResistance>> {
    let value = serde_json::to_value(law).ok()?;
    serde_json::from_value::<Box<dyn FillResistance>>(value).ok().map(Arc::from)
}

fn road_mistakes(road: &[[f64; 2]]) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    if road.is_empty() {
        diagnostics.push(Diagnostic::new("road", "has no point"));
    }
    for (i, point) in road.iter().enumerate() {
        if !point.iter().all(|x| x.is_finite()) {
            diagnostics.push(Diagnostic::new(format!("road.{i}"), "must be finite"));
        } else if i > 0 && point[0] <= road[i - 1][0] {
            let message = format!("x = {} does not lie to the right of the point before, {}", point[0], road[i - 1][0]);
            diagnostics.push(Diagnostic::new(format!("road.{i}.0"), message));
        }
    }
    diagnostics
}

/// Strata under a road.
struct Ground<'a> {
    bridge: &'a Bridge,
    strata: &'a [Stratum],
    width: f64,
    rounding: f64,
}

impl Ground<'_> {
    fn road(&self, x: f64) -> f64 {
        self.bridge.road_at(x).unwrap_or(f64::NEG_INFINITY)
    }

    /// Returns the mass above a point, per area \[kg/m²\].
    fn overburden(&self, point: Vec2) -> f64 {
        let road = self.road(point.x);
        let mut bottom = f64::NEG_INFINITY;
        let mut sum = 0.0;
        for stratum in self.strata {
            sum += stratum.density * (road.min(stratum.top) - point.y.max(bottom)).max(0.0);
            bottom = stratum.top;
        }
        sum
    }

    /// Returns the x at which a face is above the road, and its height above the road.
    fn protruding(&self, extrados: &[Chord]) -> Option<(f64, f64)> {
        let corners = self.bridge.road.iter().map(|point| point.x);
        let ends = extrados.iter().flat_map(|chord| chord.ends.map(|end| (end.x, end.y)));
        let at_corners = corners.flat_map(|x| {
            let over = extrados.iter().filter(move |chord| chord.left() <= x && x <= chord.right());
            over.map(move |chord| (x, chord.at(x).y)).collect::<Vec<_>>()
        });
        ends.chain(at_corners)
            .map(|(x, y)| (x, y - self.road(x)))
            .filter(|(_, above)| *above > self.rounding)
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns the shares of a segment, from 0 to 1, between which the mass above it is linear. It is cut at corners of the
    /// road, where it crosses the level of a stratum, and where the road above it crosses one.
    fn cuts(&self, a: Vec2, b: Vec2) -> Vec<f64> {
        let mut cuts = vec![0.0, 1.0];
        let mut cross = |from: f64, to: f64, value: f64| {
            if (from - value) * (to - value) < 0.0 {
                cuts.push((value - from) / (to - from));
            }
        };
        for corner in &self.bridge.road {
            cross(a.x, b.x, corner.x);
        }
        let levels: Vec<f64> = self.strata.iter().map(|stratum| stratum.top).filter(|top| top.is_finite()).collect();
        levels.iter().for_each(|level| cross(a.y, b.y, *level));
        cuts.sort_by(f64::total_cmp);
        // The road is straight between these shares.
        let mut road = Vec::new();
        for pair in cuts.windows(2) {
            let at = |share: f64| self.road(a.x + (b.x - a.x) * share);
            let (from, to) = (at(pair[0]), at(pair[1]));
            for level in levels.iter().filter(|level| (from - **level) * (to - **level) < 0.0) {
                road.push(pair[0] + (pair[1] - pair[0]) * (level - from) / (to - from));
            }
        }
        cuts.extend(road);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    }

    /// Returns the fill above a chord between two x: its resultant on a rigid block, or the points of a Gauss rule on a
    /// deformable one, which is exact for a linear load.
    fn masses(&self, chord: &Chord, [low, high]: [f64; 2], rigid: bool) -> Vec<FillMass> {
        let (a, b) = (chord.at(low), chord.at(high));
        let at = |share: f64| a + (b - a) * share;
        let line = |share: f64| self.overburden(at(share)) * self.width * (high - low);
        let mut masses = Vec::new();
        let (mut total, mut moment) = (0.0, 0.0);
        for pair in self.cuts(a, b).windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let (first, last, length) = (line(from), line(to), to - from);
            if rigid {
                total += length * (first + last) / 2.0;
                moment += length * (first * (2.0 * from + to) + last * (from + 2.0 * to)) / 6.0;
                continue;
            }
            let offset = 0.5 / 3f64.sqrt();
            for part in 0..PARTS {
                for side in [-1.0, 1.0] {
                    let within = (part as f64 + 0.5 + side * offset) / PARTS as f64;
                    let mass = (first + (last - first) * within) * length / (2 * PARTS) as f64;
                    masses.push(FillMass { body: chord.body, point: at(from + length * within), mass });
                }
            }
        }
        if rigid && total > 0.0 {
            masses.push(FillMass { body: chord.body, point: at(moment / total), mass: total });
        }
        masses.retain(|fill| fill.mass > 0.0);
        masses
    }

    /// Returns the horizontal reaction at a chord between two x; `None` if the chord is level, or if no fill resists there.
    fn reaction(&self, chord: &Chord, [low, high]: [f64; 2]) -> Option<FillReaction> {
        let [a, b] = clipped(chord.ends, [low, high])?;
        if (b.y - a.y).abs() <= self.rounding {
            return None;
        }
        let at = |share: f64| a + (b - a) * share;
        let mut parts: Vec<(usize, f64, f64)> = Vec::new();
        let (mut force, mut moment) = (0.0, 0.0);
        for pair in self.cuts(a, b).windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let (first, last, length) = (self.overburden(at(from)), self.overburden(at(to)), to - from);
            force += length * (first + last) / 2.0;
            moment += length * (first * (2.0 * from + to) + last * (from + 2.0 * to)) / 6.0;
            let middle = at((from + to) / 2.0).y;
            let stratum = self.strata.iter().position(|stratum| middle <= stratum.top)?;
            match parts.iter_mut().find(|part| part.0 == stratum) {
                Some((_, share, sum)) => (*share, *sum) = (*share + length, *sum + length * (first + last) / 2.0),
                None => parts.push((stratum, length, length * (first + last) / 2.0)),
            }
        }
        let parts: Vec<FillPart> = parts.into_iter().filter_map(|part| self.part(part, (b.y - a.y).abs())).collect();
        let centroid = if force > 0.0 { moment / force } else { 0.5 };
        // The ring is to the right of the extrados in the direction from left to right.
        let direction = Vec2::new((b.y - a.y).signum(), 0.0);
        (!parts.is_empty()).then(|| FillReaction { body: chord.body, point: at(centroid), direction, parts })
    }

    /// Returns the share `share` of a height that is in one stratum, with ∫ overburden over that share.
    fn part(&self, (stratum, share, sum): (usize, f64, f64), height: f64) -> Option<FillPart> {
        let Stratum { friction_angle, cohesion, law, .. } = &self.strata[stratum];
        let law = law.clone()?;
        let (friction_angle, cohesion) = (*friction_angle, *cohesion);
        let part =
            FillPart { area: share * height * self.width, overburden: sum / share, friction_angle, cohesion, law };
        // If the resistance is zero without gravity and under full weight, it is always zero.
        let reaction = |gravity: f64| {
            let state = FillState { vertical_stress: part.overburden * gravity, friction_angle, cohesion };
            part.law.pressures(&state)[1]
        };
        (reaction(0.0) > 0.0 || reaction(1.0) > 0.0).then_some(part)
    }
}

/// Returns the part of a segment between two x.
fn clipped([a, b]: [Vec2; 2], [low, high]: [f64; 2]) -> Option<[Vec2; 2]> {
    let at = |x: f64| a + (b - a) * ((x - a.x) / (b.x - a.x));
    let end = |p: Vec2| {
        if p.x < low {
            at(low)
        } else if p.x > high {
            at(high)
        } else {
            p
        }
    };
    let outside = a.x.max(b.x) <= low || a.x.min(b.x) >= high;
    // A vertical chord is inside or outside as a whole, by its x.
    if a.x == b.x { (low <= a.x && a.x <= high).then_some([a, b]) } else { (!outside).then(|| [end(a), end(b)]) }
}
