//! `blocks`: an assembly of polygonal blocks.
#![doc = include_str!("blocks.md")]

use super::keys::{PlaneState, SceneKeys};
use super::lookup::{from_root, law, material, out_of_range, outside, pairs_of, take, unknown};
use super::mesh::{Mesh, density, mesh_diagnostics};
use voussoir_core::model::geometry::{Vec2, area_and_centroid, bounding_box, cross};
use voussoir_core::model::{
    Assembly, Body, Bond, Catalogue, Gap, Interpenetration, Joint, Scene, crosses_itself, find_joints,
};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Range, Sample};

/// One block.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Block {
    /// unique
    pub name: String,
    /// vertices, in either sense
    #[key(names = ["x", "y"], unit = "m", len = ">= 3")]
    pub vertices: Vec<[f64; 2]>,
    /// held by the ground
    #[key(default = false)]
    pub fixed: bool,
    /// Material instead of the scene's material.
    #[key(like = SceneKeys, optional = "the scene's")]
    pub material: Option<String>,
    /// Law of its joints instead of the scene's law.
    #[key(like = SceneKeys, optional = "the scene's")]
    pub joint: Option<String>,
}

/// Law or gap of the joints between two blocks.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Pair {
    /// names of two blocks
    pub between: [String; 2],
    /// Law of their joints.
    #[key(like = SceneKeys, optional = "that of the blocks, or the scene's")]
    pub joint: Option<String>,
    /// initial opening: a number, or a table \[\[s, gap\], …\] along the joint, s from its end 0
    #[key(default = 0.0)]
    pub gap: Gap,
}

/// An assembly of blocks.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = Blocks::validate)]
pub struct Blocks {
    /// Width out of plane \[m\].
    #[key(like = SceneKeys)]
    pub width: f64,
    /// Stress state of deformable blocks.
    #[key(like = SceneKeys, default)]
    pub plane: PlaneState,
    /// Material of blocks that do not name one.
    #[key(like = SceneKeys, optional = "every block names its own")]
    pub material: Option<String>,
    /// Law of joints without another law.
    #[key(like = SceneKeys, optional = "every joint has a law from its blocks or its pair")]
    pub joint: Option<String>,
    /// the blocks
    #[key(len = ">= 1")]
    pub blocks: Vec<Block>,
    /// joints with another law or with a gap
    #[key(default = [])]
    pub pairs: Vec<Pair>,
    /// Mesh of deformable blocks.
    #[key(like = SceneKeys)]
    pub mesh: Option<Mesh>,
}

/// Returns the polygon of a list of vertices, anticlockwise, with the same first vertex.
fn polygon(vertices: &[[f64; 2]]) -> Result<Vec<Vec2>, String> {
    let mut polygon: Vec<_> = vertices.iter().map(|&[x, y]| Vec2::new(x, y)).collect();
    if polygon.len() < 3 {
        return Err(format!("{} vertices make no block: at least three", polygon.len()));
    }
    if let Some(i) = polygon.iter().position(|p| !(p.x.is_finite() && p.y.is_finite())) {
        return Err(format!("vertex {i} is not finite"));
    }
    let (low, high) = bounding_box(&polygon);
    let size = (high - low).norm();
    let n = polygon.len();
    if let Some(i) = (0..n).find(|&i| (polygon[(i + 1) % n] - polygon[i]).norm() <= 1e-12 * size) {
        return Err(format!("vertices {i} and {} coincide", (i + 1) % n));
    }
    let (area, _) = area_and_centroid(&polygon);
    let flat = area.abs() <= 1e-12 * size * size;
    // The test of crossing ignores neighbouring edges, so edges that fold back on each other are tested here.
    let folds = |i: usize| {
        let (one, other) = (polygon[(i + 1) % n] - polygon[i], polygon[(i + 2) % n] - polygon[(i + 1) % n]);
        cross(one, other).abs() <= 1e-12 * one.norm() * other.norm() && one.dot(&other) < 0.0
    };
    if crosses_itself(&polygon) {
        return Err("the outline crosses or touches itself".into());
    }
    if flat {
        return Err("the block has no area".into());
    }
    if let Some(i) = (0..n).find(|&i| folds(i)) {
        return Err(format!("the outline folds back on itself at vertex {}", (i + 1) % n));
    }
    if area < 0.0 {
        polygon[1..].reverse();
    }
    Ok(polygon)
}

/// Checks that openings are ≥ 0, and that a table covers the joint in order.
fn gap_mistakes(path: &str, gap: &Gap) -> Vec<Diagnostic> {
    let table = match gap {
        Gap::Uniform(gap) => return outside(Range::NON_NEGATIVE, path, *gap).into_iter().collect(),
        Gap::Table(table) => table,
    };
    let mut diagnostics = Vec::new();
    if table.is_empty() {
        diagnostics.push(Diagnostic::new(path, "the table has no row [s, gap]"));
    }
    for (i, [s, gap]) in table.iter().enumerate() {
        diagnostics.extend(outside(Range::ANY, &format!("{path}.{i}.0"), *s));
        diagnostics.extend(outside(Range::NON_NEGATIVE, &format!("{path}.{i}.1"), *gap));
        if i > 0 && *s <= table[i - 1][0] {
            let message = format!("{s} does not come after {}: s grows along the joint", table[i - 1][0]);
            diagnostics.push(Diagnostic::new(format!("{path}.{i}.0"), message));
        }
    }
    diagnostics
}

impl Blocks {
    /// Returns the polygons, and all mistakes that need no catalogue, with paths from the scene's table.
    fn shapes(&self) -> (Vec<Option<Vec<Vec2>>>, Vec<Diagnostic>) {
        let mut diagnostics = Vec::new();
        diagnostics.extend(out_of_range::<Self>("width", self.width));
        diagnostics.extend(mesh_diagnostics(self.mesh.as_ref()));
        if self.blocks.is_empty() {
            diagnostics.push(Diagnostic::new("blocks", "there is no block"));
        } else if self.blocks.iter().all(|block| !block.fixed) {
            diagnostics.push(
                Diagnostic::new("blocks", "nothing is fixed").help("give fixed = true to the blocks that are held"),
            );
        } else if self.blocks.iter().all(|block| block.fixed) {
            diagnostics.push(Diagnostic::new("blocks", "every block is fixed: nothing can move"));
        }
        for (i, block) in self.blocks.iter().enumerate() {
            let key = format!("blocks.{i}.name");
            if block.name.trim().is_empty() {
                diagnostics.push(Diagnostic::new(&key, "is empty"));
            }
            if let Some(first) = self.blocks[..i].iter().position(|other| other.name == block.name) {
                let message = format!("\"{}\" is already the name of block {first} of the list", block.name);
                diagnostics.push(Diagnostic::new(&key, message));
            }
        }
        let shapes = self.blocks.iter().enumerate().map(|(i, block)| {
            let wrong = |message| {
                Diagnostic::new(format!("blocks.{i}.vertices"), format!("block \"{}\": {message}", block.name))
            };
            take(polygon(&block.vertices).map_err(wrong), &mut diagnostics)
        });
        let shapes = shapes.collect();
        self.check_pairs(&mut diagnostics);
        (shapes, diagnostics)
    }

    fn check_pairs(&self, diagnostics: &mut Vec<Diagnostic>) {
        for (i, pair) in self.pairs.iter().enumerate() {
            for (end, name) in pair.between.iter().enumerate() {
                if self.position(name).is_none() {
                    let names = self.blocks.iter().map(|block| block.name.as_str());
                    diagnostics.push(unknown(&format!("pairs.{i}.between.{end}"), "block", name, names));
                }
            }
            diagnostics.extend(gap_mistakes(&format!("pairs.{i}.gap"), &pair.gap));
            let key = format!("pairs.{i}.between");
            if pair.between[0] == pair.between[1] {
                diagnostics.push(Diagnostic::new(&key, "names one block twice"));
            }
            let same = |other: &Pair| pair.is_between(&other.between[0], &other.between[1]);
            if let Some(first) = self.pairs[..i].iter().position(same) {
                diagnostics.push(Diagnostic::new(&key, format!("is already pair {first} of the list")));
            }
        }
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.blocks.iter().position(|block| block.name == name)
    }

    /// Returns the pair of two blocks, with its index.
    fn pair(&self, a: usize, b: usize) -> Option<(usize, &Pair)> {
        let (a, b) = (&self.blocks[a].name, &self.blocks[b].name);
        self.pairs.iter().enumerate().find(|(_, pair)| pair.is_between(a, b))
    }

    /// Returns the name of the law between two blocks, and the key that defines it.
    fn law_name(&self, a: usize, b: usize) -> Result<(&str, String), Diagnostic> {
        if let Some((i, pair)) = self.pair(a, b)
            && let Some(name) = &pair.joint
        {
            return Ok((name, format!("pairs.{i}.joint")));
        }
        match [a, b].map(|i| self.blocks[i].joint.as_deref().map(|name| (name, format!("blocks.{i}.joint")))) {
            [Some(one), Some(other)] if one.0 != other.0 => {
                let (first, second) = (&self.blocks[a].name, &self.blocks[b].name);
                let message = format!(
                    "blocks \"{first}\" and \"{second}\" touch and name different joint laws, \"{}\" and \"{}\"",
                    one.0, other.0
                );
                let help = format!("decide by pairs = [{{ between = [\"{first}\", \"{second}\"], joint = … }}]");
                Err(Diagnostic::new(other.1, message).help(help))
            }
            [Some(one), _] | [None, Some(one)] => Ok(one),
            [None, None] => match &self.joint {
                Some(name) => Ok((name, "joint".into())),
                None => {
                    Err(Diagnostic::new("joint", "is missing: the interface law of joints for which none is named"))
                }
            },
        }
    }

    fn validate(&self) -> Vec<(String, String)> {
        let (shapes, mut diagnostics) = self.shapes();
        if diagnostics.is_empty() {
            let bodies = self.bodies(shapes, &vec![0; self.blocks.len()]);
            diagnostics.extend(self.joints(&bodies, |_, _| Bond::Bonded).err().into_iter().flatten());
        }
        pairs_of(diagnostics)
    }

    fn bodies(&self, shapes: Vec<Option<Vec<Vec2>>>, materials: &[usize]) -> Vec<Body> {
        let body = |((block, shape), &material): ((&Block, Option<Vec<Vec2>>), &usize)| Body {
            name: block.name.clone(),
            vertices: shape.unwrap_or_default(),
            material,
            fixed: block.fixed,
        };
        self.blocks.iter().zip(shapes).zip(materials).map(body).collect()
    }

    /// Returns the joints of valid bodies. Overlaps, and pairs that share no joint, are mistakes.
    fn joints(&self, bodies: &[Body], bond: impl Fn(usize, usize) -> Bond) -> Result<Vec<Joint>, Vec<Diagnostic>> {
        let (low, high) = bounding_box(bodies.iter().flat_map(|body| &body.vertices));
        let gap = |a, b| self.pair(a, b).map_or(Gap::default(), |(_, pair)| pair.gap.clone());
        let (joints, overlaps) = find_joints(bodies, (high - low).norm(), |a, b| (bond(a, b), gap(a, b)));
        let mut diagnostics: Vec<_> = overlaps.iter().map(|overlap| self.overlap(overlap)).collect();
        for (i, pair) in self.pairs.iter().enumerate() {
            let [Some(a), Some(b)] = [0, 1].map(|end| self.position(&pair.between[end])) else {
                continue;
            };
            let overlap = overlaps.iter().any(|overlap| overlap.bodies == [a.min(b), a.max(b)]);
            if !overlap && !joints.iter().any(|joint| [joint.minus, joint.plus] == [a.min(b), a.max(b)]) {
                let reason = if bodies[a].fixed && bodies[b].fixed { "are both fixed" } else { "share no joint" };
                let message = format!("blocks \"{}\" and \"{}\" {reason}", pair.between[0], pair.between[1]);
                diagnostics.push(Diagnostic::new(format!("pairs.{i}.between"), message));
            }
        }
        if diagnostics.is_empty() { Ok(joints) } else { Err(diagnostics) }
    }

    fn overlap(&self, overlap: &Interpenetration) -> Diagnostic {
        let [a, b] = overlap.bodies;
        let (first, second) = (&self.blocks[a].name, &self.blocks[b].name);
        let message = format!("blocks \"{first}\" and \"{second}\" overlap, {:.3e} m deep", overlap.depth);
        Diagnostic::new(format!("blocks.{b}.vertices"), message)
    }
}

impl Pair {
    fn is_between(&self, a: &str, b: &str) -> bool {
        let [one, other] = &self.between;
        (one == a && other == b) || (one == b && other == a)
    }
}

#[typetag::serde(name = "blocks")]
impl Scene for Blocks {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        let (shapes, mut diagnostics) = self.shapes();
        let mut missing = false;
        let material_of = |(i, block): (usize, &Block)| match (&block.material, &self.material) {
            (Some(name), _) => take(material(catalogue, name, &format!("blocks.{i}.material")), &mut diagnostics),
            (None, Some(name)) => catalogue.material(name),
            (None, None) => {
                missing = true;
                None
            }
        };
        let materials: Option<Vec<_>> = self.blocks.iter().enumerate().map(material_of).collect();
        if missing {
            diagnostics.push(Diagnostic::new("material", "is missing: the material of blocks that name none"));
        }
        // Names are checked also if no joint uses them.
        if let Some(name) = &self.material {
            diagnostics.extend(material(catalogue, name, "material").err());
        }
        if let Some(name) = &self.joint {
            diagnostics.extend(law(catalogue, name, "joint").err());
        }
        for (i, name) in self.blocks.iter().enumerate().filter_map(|(i, block)| Some((i, block.joint.as_ref()?))) {
            diagnostics.extend(law(catalogue, name, &format!("blocks.{i}.joint")).err());
        }
        for (i, name) in self.pairs.iter().enumerate().filter_map(|(i, pair)| Some((i, pair.joint.as_ref()?))) {
            diagnostics.extend(law(catalogue, name, &format!("pairs.{i}.joint")).err());
        }
        let Some(materials) = materials.filter(|_| diagnostics.is_empty()) else {
            return Err(from_root(diagnostics));
        };
        let bodies = self.bodies(shapes, &materials);
        let mut joints = self.joints(&bodies, |_, _| Bond::Bonded).map_err(from_root)?;
        for joint in &mut joints {
            let index = self.law_name(joint.minus, joint.plus).and_then(|(name, key)| law(catalogue, name, &key));
            match index {
                Ok(index) => joint.bond = Bond::Law(index),
                Err(diagnostic) if diagnostics.contains(&diagnostic) => {}
                Err(diagnostic) => diagnostics.push(diagnostic),
            }
        }
        if !diagnostics.is_empty() {
            return Err(from_root(diagnostics));
        }
        let (width, plane, mesh) = (self.width, self.plane.into(), density(self.mesh));
        Ok(Assembly { catalogue: catalogue.clone(), bodies, joints, width, plane, mesh, arch: None, bridge: None })
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "blocks",
        summary: "any assembly of polygonal blocks",
        sources: &["Livesley 1978, Int. J. Numer. Methods Eng. 12"],
        samples: &[
            Sample::keys(r#"width = 0.5
material = "stone"
joint = "dry"
blocks = [
  { name = "ground", vertices = [[-1.0, -0.5], [2.0, -0.5], [2.0, 0.0], [-1.0, 0.0]], fixed = true },
  { name = "low", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]] },
  { name = "high", vertices = [[0.2, 0.5], [1.2, 0.5], [1.2, 1.0], [0.2, 1.0]], material = "brick" },
]
pairs = [{ between = ["low", "high"], joint = "mortar" }]"#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("blocks.md"),
        ..Card::of::<Blocks>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::test_catalogue::catalogue;
    use serde_json::{Value, json};

    fn build(blocks: Value, extra: Value) -> Result<Assembly, Vec<Diagnostic>> {
        let mut scene =
            json!({ "scene": "blocks", "width": 1.0, "material": "stone", "joint": "dry", "blocks": blocks });
        for (key, value) in extra.as_object().unwrap() {
            scene[key] = value.clone();
        }
        serde_json::from_value::<Box<dyn Scene>>(scene).unwrap().build(&catalogue())
    }

    fn box_at(name: &str, x: f64, y: f64) -> Value {
        json!({ "name": name, "vertices": [[x, y], [x, y + 1.0], [x + 1.0, y + 1.0], [x + 1.0, y]] })
    }

    fn ground() -> Value {
        json!({ "name": "ground", "vertices": [[-1, -1], [5, -1], [5, 0], [-1, 0]], "fixed": true })
    }

    #[test]
    fn clockwise_vertices_are_turned_round_from_the_same_first_vertex() {
        let scene = build(json!([ground(), box_at("a", 0.0, 0.0)]), json!({})).unwrap();
        let expected = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
        assert_eq!(scene.bodies[1].vertices, expected);
        assert_eq!(scene.joints.len(), 1);
        let joint = &scene.joints[0];
        assert_eq!((joint.minus, joint.plus, joint.frame().0), (0, 1, Vec2::new(0.0, 1.0)));
    }

    #[test]
    fn a_pair_decides_before_a_block_and_a_block_before_the_scene() {
        let mut b = box_at("b", 1.0, 0.0);
        b["joint"] = json!("wet");
        let blocks = json!([ground(), box_at("a", 0.0, 0.0), b]);
        let pairs = json!({ "pairs": [{ "between": ["b", "a"], "joint": "dry", "gap": [[0.0, 0.001], [1.0, 0.0]] }] });
        let scene = build(blocks, pairs).unwrap();
        let bonds: Vec<_> = scene.joints.iter().map(|j| (j.minus, j.plus, j.bond, j.gap.at(0.5))).collect();
        let expected = [(0, 1, Bond::Law(0), 0.0), (0, 2, Bond::Law(1), 0.0), (1, 2, Bond::Law(0), 0.0005)];
        assert_eq!(bonds, expected);
    }

    #[test]
    fn a_block_with_two_level_tops_or_a_vertex_within_an_edge_does_not_cross_itself() {
        let u = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        assert!(polygon(&u).is_ok());
        assert!(polygon(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]]).is_ok());
    }

    #[test]
    fn mistakes_are_refused_at_their_key() {
        let path = |blocks: Value, extra: Value| build(blocks, extra).unwrap_err()[0].path.clone();
        let a = || box_at("a", 0.0, 0.0);
        let none = || json!({});
        let shape = |vertices: Value| json!([ground(), { "name": "a", "vertices": vertices }]);
        assert_eq!(path(shape(json!([[0, 0], [1, 0]])), none()), "scene.blocks.1.vertices");
        assert_eq!(path(shape(json!([[0, 0], [1, 0], [2, 0]])), none()), "scene.blocks.1.vertices");
        assert_eq!(path(shape(json!([[0, 0], [1, 1], [1, 0], [0, 1]])), none()), "scene.blocks.1.vertices");
        assert_eq!(path(json!([ground(), a(), a()]), none()), "scene.blocks.2.name");
        assert_eq!(path(json!([a()]), none()), "scene.blocks");
        let pair = |one: &str, other: &str| json!({ "pairs": [{ "between": [one, other] }] });
        assert_eq!(path(json!([ground(), a()]), pair("a", "b")), "scene.pairs.0.between.1");
        let gap = |gap: Value| json!({ "pairs": [{ "between": ["a", "ground"], "gap": gap }] });
        assert_eq!(path(json!([ground(), a()]), gap(json!(-1.0))), "scene.pairs.0.gap");
        assert_eq!(path(json!([ground(), a()]), gap(json!([[0.0, 0.0], [1.0, -1.0]]))), "scene.pairs.0.gap.1.1");
        assert_eq!(path(json!([ground(), a()]), gap(json!([[0.0, 0.0], [0.0, 1.0]]))), "scene.pairs.0.gap.1.0");
        assert_eq!(path(json!([ground(), a()]), json!({ "mesh": { "order": 7 } })), "scene.mesh.order");
        let far = || json!([ground(), a(), box_at("b", 3.0, 0.0)]);
        assert_eq!(path(far(), pair("a", "b")), "scene.pairs.0.between");
        assert_eq!(path(far(), json!({ "joint": null })), "scene.joint");
        assert_eq!(path(far(), json!({ "material": null })), "scene.material");
        let overlap = build(json!([ground(), a(), box_at("b", 0.5, 0.0)]), none()).unwrap_err();
        assert_eq!(overlap[0].path, "scene.blocks.2.vertices");
        assert!(
            overlap[0].message.starts_with("blocks \"a\" and \"b\" overlap, 3.333e-1 m deep"),
            "{}",
            overlap[0].message
        );
    }
}
