//! Drawings (DXF): polylines become the points of a profile, closed polylines blocks, layers materials.
//!
//! The content of a drawing is separate from the reader of its file (`dxf.rs`).

use crate::config::diagnostic::suggest;
use std::collections::BTreeMap;

/// A corner of a polyline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Position in units of the drawing.
    pub point: [f64; 2],
    /// Tangent of a quarter of the angle of the arc to the next corner, positive anticlockwise; 0 for a straight side.
    pub bulge: f64,
}

/// A polyline of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyline {
    /// Name in messages: its kind and handle.
    pub entity: String,
    /// Its layer.
    pub layer: String,
    /// True if the last corner is joined to the first.
    pub closed: bool,
    /// Its corners in order.
    pub corners: Vec<Corner>,
}

/// The used content of a drawing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// One unit of the drawing \[m\]; `None` if it is not defined.
    pub unit: Option<f64>,
    /// Its polylines in the order of the file.
    pub polylines: Vec<Polyline>,
    /// Lines and arcs that belong to no polyline: their names and layers.
    pub loose: Vec<[String; 2]>,
}

/// A block of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnBlock {
    /// Its layer and its number on it, from 1.
    pub name: String,
    /// Its corners \[m\].
    pub vertices: Vec<[f64; 2]>,
    /// The material of its layer; `None` for the material of the scene.
    pub material: Option<String>,
    /// True if the block is ground.
    pub fixed: bool,
}

/// The layer whose blocks are ground.
pub const GROUND: &str = "ground";
/// The layer that every drawing has: its blocks have the material of the scene.
const UNNAMED: &str = "0";
/// Greatest angle of a chord of an arc \[°\].
const CHORD: f64 = 1.0;
/// Layers of a profile.
const CURVES: [&str; 2] = ["intrados", "extrados"];

impl Polyline {
    fn named(&self) -> String {
        format!("{} on layer \"{}\"", self.entity, self.layer)
    }

    /// Returns the points \[m\], with arcs divided into chords; consecutive points differ.
    fn points(&self, unit: f64) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        let count = self.corners.len();
        for (i, corner) in self.corners.iter().enumerate() {
            points.push(corner.point);
            if i + 1 < count || self.closed {
                points.extend(arc(corner, self.corners[(i + 1) % count].point));
            }
        }
        points.dedup();
        if self.closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points.into_iter().map(|point| point.map(|x| x * unit)).collect()
    }
}

/// Returns the points inside the arc from a corner to the next.
fn arc(from: &Corner, to: [f64; 2]) -> Vec<[f64; 2]> {
    let angle = 4.0 * from.bulge.atan();
    if angle == 0.0 {
        return Vec::new();
    }
    let [x, y] = from.point;
    let [dx, dy] = [to[0] - x, to[1] - y];
    // The distance of the centre from the middle of the chord is cot(angle/2)/2 of the length of the chord.
    let beside = 0.5 / (angle / 2.0).tan();
    let centre = [x + dx / 2.0 - dy * beside, y + dy / 2.0 + dx * beside];
    let pieces = (angle.abs().to_degrees() / CHORD).ceil().max(1.0) as usize;
    let turned = |k: usize| {
        let (sine, cosine) = (angle * k as f64 / pieces as f64).sin_cos();
        let [rx, ry] = [x - centre[0], y - centre[1]];
        [centre[0] + rx * cosine - ry * sine, centre[1] + rx * sine + ry * cosine]
    };
    (1..pieces).map(turned).collect()
}

impl Drawing {
    /// Returns the points of the intrados and the extrados \[m\], each from left to right. Each curve is the only polyline on the
    /// layer with its name. `unit` \[m\].
    pub fn profile(&self, unit: f64) -> Result<[Vec<[f64; 2]>; 2], Vec<String>> {
        let (mut curves, mut wrong) = ([Vec::new(), Vec::new()], Vec::new());
        for (name, curve) in CURVES.iter().zip(&mut curves) {
            let on = |layer: &str| layer.eq_ignore_ascii_case(name);
            let lines: Vec<&Polyline> = self.polylines.iter().filter(|line| on(&line.layer)).collect();
            let loose = self.loose.iter().filter(|[_, layer]| on(layer));
            wrong.extend(loose.map(|[entity, layer]| {
                format!("{entity} on layer \"{layer}\" is no polyline; join the lines of the {name} to one")
            }));
            match lines[..] {
                [line] if line.closed => wrong.push(format!("{} is closed; the {name} is open", line.named())),
                [line] => {
                    let mut points = line.points(unit);
                    if points.first().zip(points.last()).is_some_and(|(first, last)| first[0] > last[0]) {
                        points.reverse();
                    }
                    if points.len() < 2 {
                        wrong.push(format!("{} has no two points", line.named()));
                    }
                    *curve = points;
                }
                [] => {
                    let layers: Vec<&str> = self.polylines.iter().map(|line| line.layer.as_str()).collect();
                    let help = suggest(name, &layers, "layers with polylines");
                    wrong.push(format!("there is no polyline on layer \"{name}\"; {help}"));
                }
                [_, second, ..] => {
                    wrong.push(format!("{} is the second polyline there; join them to one", second.named()));
                }
            }
        }
        if wrong.is_empty() { Ok(curves) } else { Err(wrong) }
    }

    /// Returns closed polylines as blocks \[m\]. Their layer is the name of one of the `materials`, or `ground` for fixed blocks,
    /// or `0` for blocks with the material of the scene. `unit` \[m\].
    pub fn blocks(&self, unit: f64, materials: &[&str]) -> Result<Vec<DrawnBlock>, Vec<String>> {
        let (mut blocks, mut wrong): (Vec<DrawnBlock>, Vec<String>) = (Vec::new(), Vec::new());
        let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
        for line in &self.polylines {
            let (layer, named) = (line.layer.as_str(), line.named());
            let of_scene = layer == UNNAMED || layer.eq_ignore_ascii_case(GROUND);
            let material = materials.iter().find(|material| **material == layer);
            if material.is_none() && !of_scene {
                let known = [materials, &[GROUND, UNNAMED]].concat();
                let help = suggest(layer, &known, "layers are materials:");
                wrong.push(format!("{named}: there is no material of this name; {help}"));
                continue;
            }
            if !line.closed && line.corners.first().map(|c| c.point) != line.corners.last().map(|c| c.point) {
                wrong.push(format!("{named} is not closed; each block is a closed polyline"));
                continue;
            }
            if line.corners.iter().any(|corner| corner.bulge != 0.0) {
                wrong.push(format!("{named} has an arc; sides of blocks are straight"));
                continue;
            }
            let vertices = Polyline { closed: true, ..line.clone() }.points(unit);
            if vertices.len() < 3 {
                wrong.push(format!("{named} has no three corners"));
                continue;
            }
            let fixed = layer.eq_ignore_ascii_case(GROUND);
            let number = numbers.entry(layer).or_insert(0);
            *number += 1;
            let (name, material) = (format!("{layer} {number}"), material.map(|name| name.to_string()));
            blocks.push(DrawnBlock { name, vertices, material, fixed });
        }
        let on_material = |layer: &str| materials.contains(&layer) || layer.eq_ignore_ascii_case(GROUND);
        let loose = self.loose.iter().filter(|[_, layer]| on_material(layer));
        wrong.extend(loose.map(|[entity, layer]| {
            format!("{entity} on layer \"{layer}\" is no polyline; each block is a closed polyline")
        }));
        if wrong.is_empty() && blocks.is_empty() {
            wrong.push("there is no closed polyline".into());
        }
        if wrong.is_empty() { Ok(blocks) } else { Err(wrong) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(layer: &str, closed: bool, points: &[[f64; 2]]) -> Polyline {
        let corners = points.iter().map(|&point| Corner { point, bulge: 0.0 }).collect();
        Polyline { entity: "LWPOLYLINE 2A".into(), layer: layer.into(), closed, corners }
    }

    fn drawing(polylines: Vec<Polyline>) -> Drawing {
        Drawing { unit: Some(1e-3), polylines, loose: Vec::new() }
    }

    /// A profile drawn from right to left in millimetres; its extrados is one arc.
    #[test]
    fn a_profile_is_its_points() {
        let intrados = line("Intrados", false, &[[3000.0, 0.0], [1500.0, 750.0], [0.0, 0.0]]);
        // A quarter of a circle about (1500, 0): bulge tan(90°/4), clockwise.
        let bulge = -(std::f64::consts::PI / 8.0).tan();
        let corners = vec![
            Corner { point: [1500.0 - 2000.0, 0.0], bulge: 2.0 * bulge / (1.0 - bulge * bulge) },
            Corner { point: [1500.0 + 2000.0, 0.0], bulge: 0.0 },
        ];
        let extrados = Polyline { corners, ..line("EXTRADOS", false, &[]) };
        let [inner, outer] = drawing(vec![intrados, extrados]).profile(1e-3).expect("a profile");
        assert_eq!(inner, [[0.0, 0.0], [1.5, 0.75], [3.0, 0.0]]);
        assert_eq!(outer.len(), 181);
        for point in &outer {
            assert!(((point[0] - 1.5).hypot(point[1]) - 2.0).abs() < 1e-12 && point[1] > -1e-12, "{point:?}");
        }
        assert!(outer.windows(2).all(|pair| pair[1][0] > pair[0][0]));
    }

    #[test]
    fn closed_polylines_are_blocks_of_their_layer() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let repeated = [square.as_slice(), &square[..1]].concat();
        let blocks =
            drawing(vec![line("ground", true, &square), line("stone", false, &repeated), line("0", true, &square)]);
        let blocks = blocks.blocks(2.0, &["stone"]).expect("blocks");
        let seen: Vec<_> =
            blocks.iter().map(|b| (b.name.as_str(), b.material.as_deref(), b.fixed, b.vertices.len())).collect();
        assert_eq!(seen, [("ground 1", None, true, 4), ("stone 1", Some("stone"), false, 4), ("0 1", None, false, 4)]);
        assert_eq!(blocks[1].vertices[2], [2.0, 2.0]);
    }

    #[test]
    fn mistakes_name_entity_and_layer() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let wrong = |line: Polyline| drawing(vec![line]).blocks(1.0, &["stone"]).expect_err("a mistake").join("\n");
        assert_eq!(
            wrong(line("stone", false, &square)),
            "LWPOLYLINE 2A on layer \"stone\" is not closed; each block is a closed polyline"
        );
        assert!(wrong(line("stome", true, &square)).contains("did you mean \"stone\"?"));
        let mut round = line("stone", true, &square);
        round.corners[1].bulge = 0.5;
        assert!(wrong(round).contains("LWPOLYLINE 2A on layer \"stone\" has an arc"));
        assert!(wrong(line("stone", true, &square[..2])).contains("no three corners"));
        let loose = Drawing { loose: vec![["LINE 1F".into(), "stone".into()]], ..Drawing::default() };
        assert!(loose.blocks(1.0, &["stone"]).expect_err("a line")[0].starts_with("LINE 1F on layer \"stone\""));
        let profile = |lines: Vec<Polyline>| drawing(lines).profile(1.0).expect_err("a mistake").join("\n");
        let inner = line("intrados", false, &square[..2]);
        assert!(profile(vec![inner.clone()]).contains("there is no polyline on layer \"extrados\""));
        let outer = line("extrados", false, &square[..2]);
        assert!(profile(vec![inner.clone(), outer.clone(), outer.clone()]).contains("is the second polyline there"));
        assert!(profile(vec![Polyline { closed: true, ..inner }, outer]).contains("is closed"));
    }
}
