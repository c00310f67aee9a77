//! `assembly`: polyhedra and interfaces from a file.
#![doc = include_str!("assembly.md")]

use super::block::{Block3d, Names, Search, add_contacts, shapes, supports};
use crate::scenes::keys::SceneKeys;
use crate::scenes::lookup::{from_root, out_of_range, outside, pairs_of, unknown};
use std::collections::HashMap;
use voussoir_core::model::{Assembly, CONTACT_TOLERANCE, Catalogue, Scene};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Range, Sample};
use voussoir_core::space::{Contact, Polyhedron, SpaceAssembly, Vec3, hull, tangents};

/// A stored interface.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct StoredContact {
    /// names of two blocks
    pub between: [String; 2],
    /// points of a plane convex polygon, in any order
    #[key(names = ["x", "y", "z"], unit = "m", len = ">= 3")]
    pub points: Vec<[f64; 3]>,
    /// normal of the polygon, from the first block to the second
    #[key(names = ["x", "y", "z"], unit = "-")]
    pub normal: [f64; 3],
}

/// Blocks with another material or law.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Group {
    /// names of blocks
    #[key(len = ">= 1")]
    pub blocks: Vec<String>,
    /// Their material.
    #[key(like = SceneKeys, optional = "the scene's")]
    pub material: Option<String>,
    /// Law of their contacts.
    #[key(like = SceneKeys, optional = "the scene's")]
    pub joint: Option<String>,
}

/// Polyhedra and interfaces from a file.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = FileAssembly::validate)]
pub struct FileAssembly {
    /// file in the folder of the study: an assembly as JSON (.json, .json.gz), or polyhedra (.obj); its blocks and
    /// interfaces replace this key before the table is read
    #[key(optional = "the blocks are given")]
    pub file: Option<String>,
    /// the blocks
    #[key(optional = "file is given")]
    pub blocks: Vec<Block3d>,
    /// stored interfaces
    #[key(default = [])]
    pub contacts: Vec<StoredContact>,
    /// true: the stored interfaces are the contacts; false: contacts are found from the blocks
    #[key(default = true)]
    pub interfaces: bool,
    /// names of blocks that are held by the ground, besides those that the file marks
    #[key(default = [])]
    pub supports: Vec<String>,
    /// factor of all lengths in the file, in metres
    #[key(unit = "-", range = "> 0", default = 1.0)]
    pub scale: f64,
    /// blocks with another material or law
    #[key(default = [])]
    pub groups: Vec<Group>,
    /// Tolerance of the search.
    #[key(like = Search)]
    pub tolerance: Option<f64>,
    /// Material of the blocks.
    #[key(like = SceneKeys)]
    pub material: String,
    /// Interface law of the contacts.
    #[key(like = SceneKeys)]
    pub joint: String,
}

/// Indices of blocks by name.
type Indices<'a> = HashMap<&'a str, usize>;

impl FileAssembly {
    /// Returns the blocks in metres, with their supports, materials and laws. Mistakes have paths from the scene's table.
    fn blocks(&self, diagnostics: &mut Vec<Diagnostic>) -> Vec<Block3d> {
        let mut blocks = self.blocks.clone();
        let indices = self.indices();
        let mut find = |path: String, name: &str| {
            let index = indices.get(name).copied();
            if index.is_none() {
                diagnostics.push(unknown(&path, "block", name, indices.keys().copied()));
            }
            index
        };
        for (i, name) in self.supports.iter().enumerate() {
            if let Some(index) = find(format!("supports.{i}"), name) {
                blocks[index].fixed = true;
            }
        }
        for (i, group) in self.groups.iter().enumerate() {
            for (k, name) in group.blocks.iter().enumerate() {
                if let Some(index) = find(format!("groups.{i}.blocks.{k}"), name) {
                    blocks[index].material = group.material.clone().or(blocks[index].material.take());
                    blocks[index].joint = group.joint.clone().or(blocks[index].joint.take());
                }
            }
        }
        let coordinates = blocks.iter_mut().flat_map(|block| &mut block.vertices).flatten();
        coordinates.for_each(|coordinate| *coordinate *= self.scale);
        blocks
    }

    fn indices(&self) -> Indices<'_> {
        self.blocks.iter().enumerate().map(|(index, block)| (block.name.as_str(), index)).collect()
    }

    /// Returns blocks with their shapes, and the mistakes that need no catalogue.
    fn parts(&self) -> (Vec<Block3d>, Vec<Option<Polyhedron>>, Vec<Diagnostic>) {
        let mut mistakes = Vec::new();
        mistakes.extend(out_of_range::<Self>("scale", self.scale));
        mistakes.extend(self.tolerance.and_then(|tolerance| out_of_range::<Search>("tolerance", tolerance)));
        if self.blocks.is_empty() {
            let wrong = Diagnostic::new("file", "is missing: the file with the blocks");
            return (Vec::new(), Vec::new(), vec![wrong.help("or give the blocks themselves")]);
        }
        let blocks = self.blocks(&mut mistakes);
        let (shapes, wrong) = shapes(&blocks);
        mistakes.extend(wrong);
        let fixed = blocks.iter().map(|block| block.fixed);
        mistakes.extend(supports(fixed, "supports", "name the blocks that are held: supports = [\"0\"]"));
        if self.interfaces && self.contacts.is_empty() {
            let wrong = Diagnostic::new("interfaces", "there are no stored interfaces");
            mistakes.push(wrong.help("interfaces = false finds the contacts from the blocks"));
        }
        if self.interfaces && mistakes.is_empty() {
            let indices = self.indices();
            let contacts = self.contacts.iter().enumerate();
            mistakes.extend(contacts.filter_map(|(i, contact)| self.contact(i, contact, &indices, 0.0).err()));
        }
        (blocks, shapes, mistakes)
    }

    fn validate(&self) -> Vec<(String, String)> {
        pairs_of(self.parts().2)
    }

    /// Returns a stored contact in metres, with the vertices of its hull.
    fn contact(
        &self,
        i: usize,
        stored: &StoredContact,
        indices: &Indices<'_>,
        rounding: f64,
    ) -> Result<Contact, Diagnostic> {
        let index = |end: usize| {
            let name = &stored.between[end];
            let path = format!("contacts.{i}.between.{end}");
            indices.get(name.as_str()).copied().ok_or_else(|| unknown(&path, "block", name, indices.keys().copied()))
        };
        let (minus, plus) = (index(0)?, index(1)?);
        if minus == plus {
            return Err(Diagnostic::new(format!("contacts.{i}.between"), "names one block twice"));
        }
        let key = |key: &str| format!("contacts.{i}.{key}");
        let coordinates = stored.points.iter().flatten().chain(&stored.normal);
        if let Some(wrong) = coordinates.copied().find_map(|x| outside(Range::ANY, &key("points"), x)) {
            return Err(wrong);
        }
        let normal = Vec3::from(stored.normal).try_normalize(0.0);
        let normal = normal.ok_or_else(|| Diagnostic::new(key("normal"), "has no length"))?;
        let points: Vec<Vec3> = stored.points.iter().map(|&point| Vec3::from(point) * self.scale).collect();
        let points = hull(&points, &normal, rounding);
        if points.len() < 3 {
            return Err(Diagnostic::new(key("points"), "are on a line: a contact has an area"));
        }
        Ok(Contact { minus, plus, points, normal, tangents: tangents(&normal), law: 0 })
    }

    fn assembly(&self, catalogue: &Catalogue) -> Result<SpaceAssembly, Vec<Diagnostic>> {
        let (blocks, shapes, mut diagnostics) = self.parts();
        let names = Names { material: Some(&self.material), joint: Some(&self.joint) };
        let assembly = names.assembly(&blocks, catalogue, shapes, &mut diagnostics);
        let mut assembly = assembly.ok_or(diagnostics)?;
        if self.interfaces {
            self.add_stored(&mut assembly)?;
        } else {
            add_contacts(&mut assembly, self.tolerance).map_err(|wrong| vec![wrong])?;
        }
        names.set_laws(&blocks, &mut assembly)?;
        Ok(assembly)
    }

    /// Adds the stored contacts except those between two supports.
    fn add_stored(&self, assembly: &mut SpaceAssembly) -> Result<(), Vec<Diagnostic>> {
        let (low, high) = assembly.bounding_box();
        let rounding = CONTACT_TOLERANCE * (high - low).norm();
        let indices = self.indices();
        for (i, stored) in self.contacts.iter().enumerate() {
            let contact = self.contact(i, stored, &indices, rounding).map_err(|wrong| vec![wrong])?;
            if !(assembly.bodies[contact.minus].fixed && assembly.bodies[contact.plus].fixed) {
                assembly.contacts.push(contact);
            }
        }
        Ok(())
    }
}

#[typetag::serde(name = "assembly")]
impl Scene for FileAssembly {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        Ok(Assembly::without_blocks(catalogue.clone()))
    }

    fn build_space(&self, catalogue: &Catalogue) -> Option<Result<SpaceAssembly, Vec<Diagnostic>>> {
        Some(self.assembly(catalogue).map_err(from_root))
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "assembly",
        summary: "polyhedra and interfaces from a file of COMPAS, or polyhedra from an OBJ file",
        sources: &["Frick, Van Mele & Block 2015 (compas_assembly)", "Kao et al. 2022, Comput.-Aided Des. 146 (compas_cra)"],
        samples: &[
            Sample::keys(r#"material = "stone"
joint = "dry"
supports = ["0"]
scale = 0.5

[[blocks]]
name = "0"
vertices = [[0, 0, -1], [1, 0, -1], [0, 1, -1], [1, 1, -1], [0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]

[[blocks]]
name = "1"
vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]]
faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]

[[contacts]]
between = ["0", "1"]
points = [[0, 0, 0], [0, 1, 0], [1, 1, 0], [0.75, 0, 0]]
normal = [0, 0, 1]"#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("assembly.md"),
        ..Card::of::<FileAssembly>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::import::keys_of_file;
    use super::super::parts::tests::{built, counts, wrong};
    use crate::study::beside;
    use serde_json::{Value, json};
    use std::path::{Path, PathBuf};
    use voussoir_core::space::{SpaceAssembly, Vec3};

    fn cuboid(name: &str, low: [f64; 3], high: [f64; 3]) -> Value {
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
        json!({
            "name": name, "vertices": (0..8).map(corner).collect::<Vec<_>>(),
            "faces": [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
        })
    }

    /// Three cubes in a row with stored interfaces; the points of the second repeat a corner and have the middle of a side.
    fn row(extra: Value) -> Value {
        let square = |x: f64| json!([[x, 0, 0], [x, 0, 1], [x, 1, 1], [x, 1, 0], [x, 1.0, 1e-12], [x, 0.5, 0]]);
        let cube = |k: i32| cuboid(&k.to_string(), [f64::from(k), 0.0, 0.0], [f64::from(k + 1), 1.0, 1.0]);
        let mut keys = json!({
            "blocks": ([0, 1, 2].map(cube)),
            "contacts": [
                { "between": ["0", "1"], "points": square(1.0), "normal": [2, 0, 0] },
                { "between": ["2", "1"], "points": square(2.0), "normal": [-1, 0, 0] },
            ],
            "supports": ["0"],
        });
        for (key, value) in extra.as_object().unwrap() {
            keys[key] = value.clone();
        }
        keys
    }

    #[test]
    fn stored_interfaces_keep_their_order_and_lose_points_that_are_no_corners() {
        let scene =
            built("assembly", &row(json!({ "scale": 0.5, "groups": [{ "blocks": ["2"], "material": "elastic" }] })));
        let scene = scene.unwrap();
        assert_eq!(counts(&scene), [2, 2, 8]);
        let contact = &scene.contacts[1];
        assert_eq!((contact.minus, contact.plus, contact.normal), (2, 1, -Vec3::x()));
        assert!(contact.points.iter().all(|point| point.x == 1.0 && point.y.max(point.z) <= 0.5));
        assert_eq!([0, 1, 2].map(|body| scene.bodies[body].material), [0, 0, 1]);
        assert!((scene.bodies[1].shape.volume_and_centroid().0 - 0.125).abs() < 1e-15);
        let found = built("assembly", &row(json!({ "interfaces": false, "scale": 0.5 }))).unwrap();
        assert_eq!(counts(&found), [2, 2, 8]);
        let held = built("assembly", &row(json!({ "supports": ["0", "1"] }))).unwrap();
        assert_eq!(counts(&held), [1, 1, 4], "two supports have no contact");
    }

    #[test]
    fn mistakes_are_reported_at_their_keys() {
        let paths = |extra: Value| wrong("assembly", &row(extra));
        assert_eq!(paths(json!({ "supports": ["3"] })), ["scene.supports.0", "scene.supports"]);
        assert_eq!(paths(json!({ "supports": [] })), ["scene.supports"]);
        assert_eq!(paths(json!({ "contacts": [] })), ["scene.interfaces"]);
        assert_eq!(paths(json!({ "blocks": [] })), ["scene.file"]);
        let contact = |a: &str, normal: [f64; 3], points: Value| {
            paths(json!({ "contacts": [{ "between": [a, "1"], "normal": normal, "points": points }] }))
        };
        let square = || json!([[1, 0, 0], [1, 0, 1], [1, 1, 1]]);
        assert_eq!(contact("7", [1.0, 0.0, 0.0], square()), ["scene.contacts.0.between.0"]);
        assert_eq!(contact("1", [1.0, 0.0, 0.0], square()), ["scene.contacts.0.between"]);
        assert_eq!(contact("0", [0.0; 3], square()), ["scene.contacts.0.normal"]);
        assert_eq!(
            contact("0", [1.0, 0.0, 0.0], json!([[1, 0, 0], [1, 1, 1], [1, 2, 2]])),
            ["scene.contacts.0.points"]
        );
        let groups = json!({ "groups": [
            { "blocks": ["1"], "joint": "dry" }, { "blocks": ["2"], "joint": "wet" }, { "blocks": ["9"] }] });
        assert_eq!(paths(groups), ["scene.groups.2.blocks.0"]);
    }

    /// Returns the folder of published assemblies, which is not part of the repository.
    fn published() -> Option<PathBuf> {
        let folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|folder| folder.join("shared/space/data"));
        folders.into_iter().find(|folder| folder.is_dir())
    }

    fn read(folder: &Path, file: &str, extra: &Value) -> SpaceAssembly {
        let text = beside(&folder.join("study.toml"))(file).unwrap();
        let mut keys = Value::Object(keys_of_file(file, &text).unwrap());
        for (key, value) in extra.as_object().unwrap() {
            keys[key] = value.clone();
        }
        built("assembly", &keys).unwrap()
    }

    /// Free blocks, contacts and hull vertices of published files; contacts between two supports are left out. A hull with
    /// a tolerance on the cross product has fewer vertices in the cross vault (1954 of 2033 points) and the vault
    /// `armadillo` (4819 of 5031).
    #[test]
    fn published_assemblies_have_their_numbers_of_contacts_and_vertices() {
        let Some(folder) = published() else { return };
        for (file, numbers) in [
            ("arch_assembly.json", [28, 29, 116]),
            ("wall_assembly.json", [42, 80, 480]),
            ("crossvault_assembly.json.gz", [180, 488, 1954]),
            ("armadillo_cra.json.gz", [366, 1014, 4819]),
        ] {
            assert_eq!(counts(&read(&folder, file, &json!({}))), numbers, "{file}");
        }
        let dome = counts(&read(&folder, "dome_assembly.json.gz", &json!({})));
        assert_eq!(dome[..2], [496, 1519 - 31]);
        let held = json!({ "supports": ["0"] });
        assert_eq!(counts(&read(&folder, "curve-3-blocks.json", &held)), [2, 40, 160]);
        assert_eq!(counts(&read(&folder, "concave-long.json", &held)), [1, 7, 28]);
    }

    /// Without the stored interfaces the same contacts are found. The faces of the cross vault are up to 4e-4 m apart.
    #[test]
    fn published_interfaces_are_found_again() {
        let Some(folder) = published() else { return };
        for (file, extra) in [
            ("arch_assembly.json", json!({})),
            ("wall_assembly.json", json!({})),
            ("crossvault_assembly.json.gz", json!({ "tolerance": 1e-3 })),
            ("concave-short.json", json!({ "supports": ["0"] })),
            ("concave-long.json", json!({ "supports": ["0"] })),
        ] {
            let mut search = extra.clone();
            search["interfaces"] = json!(false);
            let (stored, found) = (read(&folder, file, &extra), read(&folder, file, &search));
            assert_eq!(counts(&stored), counts(&found), "{file}");
            let area = |scene: &SpaceAssembly| -> f64 {
                let fan = |points: &[Vec3]| -> Vec3 {
                    points[1..].windows(2).map(|pair| (pair[0] - points[0]).cross(&(pair[1] - points[0]))).sum()
                };
                scene.contacts.iter().map(|contact| fan(&contact.points).norm() / 2.0).sum()
            };
            assert!((area(&stored) / area(&found) - 1.0).abs() < 1e-7, "{file}");
        }
    }
}
