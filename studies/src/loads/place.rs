//! Loads of a stage: from what a study says to forces on blocks.
//!
//! On arches `span_fraction` f counts along the intrados span from the left springing, and a load
//! acts on the straight extrados chord above (or below) that x; where a vertical meets two chords,
//! on the upper one. A force on the boundary of two voussoirs goes to the one nearer to midspan,
//! and exactly at midspan half to each, so that mirrored loads load mirrored blocks.

use crate::scenes::{POINT, unknown};
use serde::{Deserialize, Serialize};
use voussoir_core::model::geometry::{Vec2, contains, turned};
use voussoir_core::model::{ArchLayout, Assembly, CONTACT_TOLERANCE, PointForce};
use voussoir_core::plugin::{Diagnostic, Need, Parameter, Quantity, Range, Shape, Variant};

/// Parts of an evenly spread load on a deformable block.
const PARTS: usize = 16;
/// Share of the scene's size within which a load is at a vertex.
const ROUNDING: f64 = 1e-12;

/// A block by name; a whole number is the name of a voussoir.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum BlockName {
    /// By number.
    Number(u64),
    /// By name.
    Name(String),
}

impl BlockName {
    fn text(&self) -> String {
        match self {
            BlockName::Number(number) => number.to_string(),
            BlockName::Name(name) => name.clone(),
        }
    }
}

/// One entry of `loads`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Load {
    /// A force at a point.
    Point {
        /// Place on the extrados of an arch.
        span_fraction: Option<f64>,
        /// Or the block …
        block: Option<BlockName>,
        /// … and a point in or on it \[m\].
        point: Option<[f64; 2]>,
        /// \[N\].
        force: [f64; 2],
    },
    /// Vertical pressure on the extrados of an arch, over the full width.
    Strip {
        /// Span fraction of its left end.
        from: f64,
        /// Span fraction of its right end.
        to: f64,
        /// On the plan area, downwards \[Pa\].
        pressure: f64,
    },
    /// Wheels or axles on the extrados of an arch.
    Axles {
        /// Span fraction of the origin of the positions.
        at: f64,
        /// Horizontal distances from there \[m\].
        positions: Vec<f64>,
        /// Downwards \[N\], one for each position.
        forces: Vec<f64>,
    },
    /// Pressure on an edge of a block.
    Pressure {
        /// The block.
        block: BlockName,
        /// Index of the edge's first vertex, anticlockwise.
        edge: usize,
        /// Pushes inwards \[Pa\].
        value: f64,
    },
    /// Acceleration of every block (times its mass).
    Body {
        /// \[m/s²\].
        acceleration: [f64; 2],
    },
}

/// Forces on blocks, and accelerations of all of them \[m/s²\].
pub type Placed = (Vec<PointForce>, Vec<Vec2>);

/// The forces and accelerations of a load. `path` is the key of the load in the study.
pub fn place(load: &Load, assembly: &Assembly, path: &str) -> Result<Placed, Vec<Diagnostic>> {
    let place = Place { assembly, path, held: assembly.rigid_groups().0 };
    match load {
        Load::Point { span_fraction, block, point, force } => {
            place.finite(&[("force", force)])?;
            let force = Vec2::from(*force);
            let forces = match (span_fraction, block, point) {
                (Some(fraction), None, None) => {
                    let x = place.x_at(*fraction, "span_fraction")?;
                    place.on_extrados(x, force, "span_fraction")?
                }
                (None, Some(block), Some(point)) => {
                    place.finite(&[("point", point)])?;
                    vec![place.on_block(block, Vec2::from(*point), force)?]
                }
                (Some(_), _, _) => {
                    let key = if block.is_some() { "block" } else { "point" };
                    return place.fail(key, "given besides span_fraction; give span_fraction, or block and point");
                }
                (None, Some(_), None) => {
                    return place.fail("point", "is missing: where on the block the force acts");
                }
                (None, None, Some(_)) => {
                    return place.fail("block", "is missing: the block on which the force acts");
                }
                (None, None, None) => {
                    return place.fail("", "needs span_fraction, or block and point");
                }
            };
            Ok((forces, Vec::new()))
        }
        Load::Strip { from, to, pressure } => Ok((place.strip(*from, *to, *pressure)?, Vec::new())),
        Load::Axles { at, positions, forces } => {
            place.finite(&[("positions", positions), ("forces", forces)])?;
            if positions.len() != forces.len() {
                let message = format!("{} forces for {} positions", forces.len(), positions.len());
                return place.fail("forces", message);
            }
            if positions.is_empty() {
                return place.fail("positions", "there is no axle");
            }
            let start = place.x_at(*at, "at")?;
            let (mut placed, mut diagnostics) = (Vec::new(), Vec::new());
            for (i, (position, force)) in positions.iter().zip(forces).enumerate() {
                match place.on_extrados(start + position, Vec2::new(0.0, -force), &format!("positions.{i}")) {
                    Ok(mut forces) => placed.append(&mut forces),
                    Err(mut wrong) => diagnostics.append(&mut wrong),
                }
            }
            if diagnostics.is_empty() { Ok((placed, Vec::new())) } else { Err(diagnostics) }
        }
        Load::Pressure { block, edge, value } => {
            place.finite(&[("value", &[*value])])?;
            Ok((place.on_edge(block, *edge, *value)?, Vec::new()))
        }
        Load::Body { acceleration } => {
            place.finite(&[("acceleration", acceleration)])?;
            Ok((Vec::new(), vec![Vec2::from(*acceleration)]))
        }
    }
}

/// Where a load is being placed.
struct Place<'a> {
    assembly: &'a Assembly,
    path: &'a str,
    /// Free group of each body; `None` where bonds hold it to the ground.
    held: Vec<Option<usize>>,
}

/// The straight extrados of a voussoir.
#[derive(Clone, Copy)]
struct Chord {
    body: usize,
    ends: [Vec2; 2],
}

impl Chord {
    fn left(&self) -> f64 {
        self.ends[0].x.min(self.ends[1].x)
    }

    fn right(&self) -> f64 {
        self.ends[0].x.max(self.ends[1].x)
    }

    /// Its point at x, or the nearest one; of an upright chord the upper end.
    fn at(&self, x: f64) -> Vec2 {
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

impl Place<'_> {
    fn key(&self, key: &str) -> String {
        if key.is_empty() { self.path.to_string() } else { format!("{}.{key}", self.path) }
    }

    fn fail<T>(&self, key: &str, message: impl Into<String>) -> Result<T, Vec<Diagnostic>> {
        Err(vec![Diagnostic::new(self.key(key), message)])
    }

    fn finite(&self, values: &[(&str, &[f64])]) -> Result<(), Vec<Diagnostic>> {
        let wrong: Vec<_> = values
            .iter()
            .filter(|(_, numbers)| numbers.iter().any(|x| !x.is_finite()))
            .map(|(key, _)| Diagnostic::new(self.key(key), "must be finite"))
            .collect();
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    fn arch(&self, key: &str) -> Result<&ArchLayout, Vec<Diagnostic>> {
        self.assembly.arch.as_ref().ok_or_else(|| {
            let message = "counts along the span of an arch, but this scene is not one";
            vec![Diagnostic::new(self.key(key), message).help("give block and point, or block and edge")]
        })
    }

    /// x of a span fraction, between the intrados ends of the first and last joint.
    fn x_at(&self, fraction: f64, key: &str) -> Result<f64, Vec<Diagnostic>> {
        let arch = self.arch(key)?;
        self.finite(&[(key, &[fraction])])?;
        let left = self.assembly.joints[0].ends[0].x;
        Ok(left + fraction * arch.span)
    }

    fn chords(&self, arch: &ArchLayout) -> Vec<Chord> {
        let chord = |k: usize| Chord {
            body: arch.first + k,
            ends: [self.assembly.joints[k].ends[1], self.assembly.joints[k + 1].ends[1]],
        };
        (0..arch.voussoirs).map(chord).collect()
    }

    /// Index of a block that a load can move.
    fn movable(&self, body: usize, key: &str) -> Result<usize, Vec<Diagnostic>> {
        let name = &self.assembly.bodies[body].name;
        if self.assembly.bodies[body].fixed {
            return self.fail(key, format!("block \"{name}\" is fixed: a load on it does nothing"));
        }
        if self.held[body].is_none() && self.assembly.is_rigid(body) {
            let message = format!("block \"{name}\" is rigid and bonded to the ground: a load on it does nothing");
            return self.fail(key, message);
        }
        Ok(body)
    }

    fn block(&self, block: &BlockName) -> Result<usize, Vec<Diagnostic>> {
        let name = block.text();
        let body = self.assembly.body(&name).ok_or_else(|| {
            let names = self.assembly.bodies.iter().filter(|body| !body.fixed).map(|body| body.name.as_str());
            vec![unknown(&self.key("block"), "block", &name, names)]
        })?;
        self.movable(body, "block")
    }

    fn on_block(&self, block: &BlockName, point: Vec2, force: Vec2) -> Result<PointForce, Vec<Diagnostic>> {
        let body = self.block(block)?;
        let tolerance = CONTACT_TOLERANCE * self.assembly.size();
        if !contains(&self.assembly.bodies[body].vertices, point, tolerance) {
            let message = format!("({}, {}) lies outside block \"{}\"", point.x, point.y, block.text());
            return self.fail("point", message);
        }
        Ok(PointForce { body, point, force })
    }

    fn on_edge(&self, block: &BlockName, edge: usize, value: f64) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
        let body = self.block(block)?;
        let vertices = &self.assembly.bodies[body].vertices;
        if edge >= vertices.len() {
            let message = format!("block \"{}\" has edges 0 to {}, not {edge}", block.text(), vertices.len() - 1);
            return self.fail("edge", message);
        }
        let (a, b) = (vertices[edge], vertices[(edge + 1) % vertices.len()]);
        // Of an anticlockwise polygon the inside lies to the left of every edge.
        let force = turned(b - a) * (value * self.assembly.width);
        Ok(self.spread(body, [a, b], force))
    }

    fn on_extrados(&self, x: f64, force: Vec2, key: &str) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
        let arch = self.arch(key)?;
        let tolerance = ROUNDING * self.assembly.size();
        let chords = self.chords(arch);
        let here: Vec<_> = chords
            .iter()
            .enumerate()
            .filter(|(_, chord)| chord.left() - tolerance <= x && x <= chord.right() + tolerance)
            .map(|(k, chord)| (k, chord.body, chord.at(x)))
            .collect();
        let Some(top) = here.iter().map(|(_, _, point)| point.y).max_by(f64::total_cmp) else {
            let (left, right) = extent(&chords);
            let message = format!("x = {x} m hits no block: the extrados reaches from {left} to {right} m");
            return self.fail(key, message);
        };
        let from_middle = |k: usize| (2 * k + 1).abs_diff(arch.voussoirs);
        // Chords that meet at x have their common vertex there, to within the tolerance and its slope.
        let near = |point: &Vec2| here.iter().any(|(_, _, p)| p.y == top && (point - p).norm() <= 4.0 * tolerance);
        let upper: Vec<_> = here.iter().filter(|(_, _, point)| point.y == top || near(point)).collect();
        let nearest = upper.iter().map(|&&(k, _, _)| from_middle(k)).min().unwrap_or(0);
        let chosen: Vec<_> = upper.into_iter().filter(|&&(k, _, _)| from_middle(k) == nearest).collect();
        let share = force / chosen.len() as f64;
        chosen
            .into_iter()
            .map(|&(_, body, point)| Ok(PointForce { body: self.movable(body, key)?, point, force: share }))
            .collect()
    }

    /// A force spread evenly between two points: as its resultant on a rigid block, as the points of
    /// a Gauss rule on equal parts on a deformable one.
    fn spread(&self, body: usize, [from, to]: [Vec2; 2], force: Vec2) -> Vec<PointForce> {
        if self.assembly.is_rigid(body) || self.assembly.bodies[body].fixed {
            return vec![PointForce { body, point: (from + to) / 2.0, force }];
        }
        let offset = 0.5 / 3f64.sqrt();
        let at = |part: usize, side: f64| (part as f64 + 0.5 + side * offset) / PARTS as f64;
        let places = (0..PARTS).flat_map(|part| [at(part, -1.0), at(part, 1.0)]);
        let share = force / (2 * PARTS) as f64;
        places.map(|t| PointForce { body, point: from + (to - from) * t, force: share }).collect()
    }

    fn strip(&self, from: f64, to: f64, pressure: f64) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
        self.finite(&[("pressure", &[pressure])])?;
        let (start, end) = (self.x_at(from, "from")?, self.x_at(to, "to")?);
        if from >= to {
            return self.fail("to", format!("{to} must be more than from, {from}"));
        }
        let chords = self.chords(self.arch("from")?);
        let tolerance = CONTACT_TOLERANCE * self.assembly.size();
        let (left, right) = extent(&chords);
        for (key, x) in [("from", start), ("to", end)] {
            if x < left - tolerance || x > right + tolerance {
                let message = format!("x = {x} m lies beyond the extrados, which reaches from {left} to {right} m");
                return self.fail(key, message);
            }
        }
        let mut cuts: Vec<f64> = chords.iter().flat_map(|chord| chord.ends.map(|p| p.x)).collect();
        // An end that is a vertex but for rounding is that vertex: no sliver on the next voussoir.
        let rounding = ROUNDING * self.assembly.size();
        let vertex = |x: f64| cuts.iter().copied().find(|cut| (cut - x).abs() <= rounding).unwrap_or(x);
        let (start, end) = (vertex(start), vertex(end));
        cuts.extend([start, end]);
        cuts.retain(|&x| start <= x && x <= end);
        cuts.sort_by(f64::total_cmp);
        // Between two cuts one chord is the upper one all along. Its parts are joined again, so that
        // each voussoir gets one force at the middle of what it carries.
        let mut parts: Vec<(Chord, f64, f64)> = Vec::new();
        for pair in cuts.windows(2).filter(|pair| pair[0] < pair[1]) {
            let middle = (pair[0] + pair[1]) / 2.0;
            let above = chords.iter().filter(|chord| chord.left() <= middle && middle <= chord.right());
            let Some(&top) = above.max_by(|a, b| a.at(middle).y.total_cmp(&b.at(middle).y)) else {
                continue;
            };
            match parts.last_mut() {
                Some((chord, _, high)) if chord.body == top.body && *high == pair[0] => *high = pair[1],
                _ => parts.push((top, pair[0], pair[1])),
            }
        }
        let width = self.assembly.width;
        let mut forces = Vec::with_capacity(parts.len());
        for (chord, low, high) in parts {
            let body = self.movable(chord.body, "")?;
            let force = Vec2::new(0.0, -pressure * width * (high - low));
            forces.extend(self.spread(body, [chord.at(low), chord.at(high)], force));
        }
        Ok(forces)
    }
}

/// Least and greatest x of the extrados.
fn extent(chords: &[Chord]) -> (f64, f64) {
    let left = chords.iter().fold(f64::INFINITY, |x, chord| x.min(chord.left()));
    (left, chords.iter().fold(f64::NEG_INFINITY, |x, chord| x.max(chord.right())))
}

const FRACTION: Range = Range::ANY;
const VECTOR_N: Shape = Shape::List { of: &Shape::Number(Quantity::Force, Range::ANY), min: 2, max: 2 };
const NUMBER: Shape = Shape::Integer { min: 0, max: i64::MAX };
const BLOCK: Parameter = Parameter {
    name: "block",
    doc: "name of the block, on arches the number of the voussoir from the left",
    shape: Shape::Either(&[Shape::Text, NUMBER]),
    need: Need::Required,
};

const fn many(name: &'static str, of: &'static Shape, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape: Shape::List { of, min: 1, max: usize::MAX }, need: Need::Required }
}

/// What a load may hold.
pub const LOAD: Shape = Shape::Tagged {
    key: "kind",
    variants: &[
        Variant {
            tag: "point",
            doc: "a force at a point",
            parameters: &[
                Parameter::number(
                    "span_fraction",
                    Quantity::Ratio,
                    FRACTION,
                    "place on the extrados of an arch, along the span from the left",
                )
                .optional("block and point are given"),
                BLOCK.optional("span_fraction is given"),
                Parameter {
                    name: "point",
                    doc: "in or on the block",
                    shape: POINT,
                    need: Need::Optional("span_fraction is given"),
                },
                Parameter { name: "force", doc: "x to the right, y upwards", shape: VECTOR_N, need: Need::Required },
            ],
        },
        Variant {
            tag: "strip",
            doc: "vertical pressure on the extrados of an arch, over the full width",
            parameters: &[
                Parameter::number("from", Quantity::Ratio, FRACTION, "span fraction of the left end"),
                Parameter::number("to", Quantity::Ratio, FRACTION, "span fraction of the right end"),
                Parameter::number("pressure", Quantity::Stress, Range::ANY, "on the plan area, downwards"),
            ],
        },
        Variant {
            tag: "axles",
            doc: "wheels or axles on the extrados of an arch",
            parameters: &[
                Parameter::number("at", Quantity::Ratio, FRACTION, "span fraction of the origin of the positions"),
                many("positions", &Shape::Number(Quantity::Length, Range::ANY), "horizontal distances from there"),
                many("forces", &Shape::Number(Quantity::Force, Range::ANY), "downwards, one for each position"),
            ],
        },
        Variant {
            tag: "pressure",
            doc: "pressure on an edge of a block",
            parameters: &[
                BLOCK,
                Parameter {
                    name: "edge",
                    doc: "index of its first vertex, anticlockwise; on voussoirs 0 intrados, 1 right, 2 extrados, 3 left",
                    shape: NUMBER,
                    need: Need::Required,
                },
                Parameter::number("value", Quantity::Stress, Range::ANY, "pushes inwards"),
            ],
        },
        Variant {
            tag: "body",
            doc: "acceleration of every block, times its mass",
            parameters: &[Parameter {
                name: "acceleration",
                doc: "x to the right, y upwards",
                shape: Shape::List { of: &Shape::Number(Quantity::Acceleration, Range::ANY), min: 2, max: 2 },
                need: Need::Required,
            }],
        },
    ],
};

#[cfg(test)]
mod tests;
