//! `blocks_3d`: any assembly of polyhedra.
#![doc = include_str!("blocks_3d.md")]

use super::block::{Block3d, Names, Search, add_contacts, shapes, supports};
use crate::scenes::keys::SceneKeys;
use crate::scenes::lookup::{from_root, out_of_range, pairs_of};
use voussoir_core::model::{Assembly, Catalogue, Scene};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};
use voussoir_core::space::{Polyhedron, SpaceAssembly};

/// An assembly of polyhedra.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = Blocks3d::validate)]
pub struct Blocks3d {
    /// Material of blocks that do not name one.
    #[key(like = SceneKeys, optional = "every block names its own")]
    pub material: Option<String>,
    /// Law of contacts without another law.
    #[key(like = SceneKeys, optional = "every contact has a law from its blocks")]
    pub joint: Option<String>,
    /// the blocks
    #[key(len = ">= 1")]
    pub blocks: Vec<Block3d>,
    /// Tolerance of the search.
    #[key(like = Search)]
    pub tolerance: Option<f64>,
}

impl Blocks3d {
    fn shapes(&self) -> (Vec<Option<Polyhedron>>, Vec<Diagnostic>) {
        let (shapes, mut diagnostics) = shapes(&self.blocks);
        diagnostics.extend(self.tolerance.and_then(|tolerance| out_of_range::<Search>("tolerance", tolerance)));
        let fixed = self.blocks.iter().map(|block| block.fixed);
        diagnostics.extend(supports(fixed, "blocks", "give fixed = true to the blocks that are held"));
        (shapes, diagnostics)
    }

    fn validate(&self) -> Vec<(String, String)> {
        pairs_of(self.shapes().1)
    }

    fn assembly(&self, catalogue: &Catalogue) -> Result<SpaceAssembly, Vec<Diagnostic>> {
        let (shapes, mut diagnostics) = self.shapes();
        let names = Names { material: self.material.as_deref(), joint: self.joint.as_deref() };
        let assembly = names.assembly(&self.blocks, catalogue, shapes, &mut diagnostics);
        let mut assembly = assembly.ok_or(diagnostics)?;
        add_contacts(&mut assembly, self.tolerance).map_err(|wrong| vec![wrong])?;
        names.set_laws(&self.blocks, &mut assembly)?;
        Ok(assembly)
    }
}

#[typetag::serde(name = "blocks_3d")]
impl Scene for Blocks3d {
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
        tag: "blocks_3d",
        summary: "any assembly of polyhedra; their contacts are found",
        sources: &["Livesley 1992, Meccanica 27 (limit analysis of rigid blocks in space)"],
        samples: &[
            Sample::keys(r#"material = "stone"
joint = "dry"

[[blocks]]
name = "ground"
fixed = true
vertices = [[-1, -1, -1], [2, -1, -1], [-1, 2, -1], [2, 2, -1], [-1, -1, 0], [2, -1, 0], [-1, 2, 0], [2, 2, 0]]
faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]

[[blocks]]
name = "pyramid"
material = "brick"
joint = "mortar"
vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1.5]]
faces = [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]"#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("blocks_3d.md"),
        ..Card::of::<Blocks3d>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::parts::tests::{built, counts, wrong};
    use serde_json::{Value, json};
    use voussoir_core::space::Vec3;

    fn cuboid(name: &str, low: [f64; 3], high: [f64; 3]) -> Value {
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
        json!({
            "name": name, "vertices": (0..8).map(corner).collect::<Vec<_>>(),
            "faces": [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
        })
    }

    fn ground() -> Value {
        let mut ground = cuboid("ground", [-5.0, -5.0, -1.0], [5.0, 5.0, 0.0]);
        ground["fixed"] = json!(true);
        ground
    }

    /// The overlap of the upper block with the lower one is 0.8 m wide; faces seen from inside are turned round.
    #[test]
    fn a_shifted_block_touches_the_block_below_over_their_overlap() {
        let mut upper = cuboid("b", [0.2, 0.0, 1.0], [1.2, 1.0, 2.0]);
        let faces = upper["faces"].as_array_mut().unwrap();
        faces.iter_mut().for_each(|face| face.as_array_mut().unwrap().reverse());
        let blocks = json!([ground(), cuboid("a", [0.0; 3], [1.0; 3]), upper]);
        let scene = built("blocks_3d", &json!({ "blocks": blocks })).unwrap();
        assert_eq!(counts(&scene), [2, 2, 8]);
        let contact = &scene.contacts[1];
        assert_eq!((contact.minus, contact.plus, contact.normal), (1, 2, Vec3::z()));
        let xs: Vec<f64> = contact.points.iter().map(|point| point.x).collect();
        assert!(xs.iter().all(|x| (x - 0.2).abs() < 1e-15 || (x - 1.0).abs() < 1e-15), "{xs:?}");
        assert!((scene.bodies[2].shape.volume_and_centroid().0 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_block_decides_the_law_of_its_contacts() {
        let mut a = cuboid("a", [0.0; 3], [1.0; 3]);
        a["joint"] = json!("wet");
        let scene =
            built("blocks_3d", &json!({ "blocks": [ground(), a, cuboid("b", [2.0, 0.0, 0.0], [3.0, 1.0, 1.0])] }));
        let laws: Vec<usize> = scene.unwrap().contacts.iter().map(|contact| contact.law).collect();
        assert_eq!(laws, [1, 0]);
    }

    #[test]
    fn mistakes_are_reported_at_their_keys() {
        let paths = |blocks: Value| wrong("blocks_3d", &json!({ "blocks": blocks }));
        let a = || cuboid("a", [0.0; 3], [1.0; 3]);
        assert_eq!(paths(json!([a()])), ["scene.blocks"]);
        assert_eq!(paths(json!([ground()])), ["scene.blocks"]);
        assert_eq!(paths(json!([ground(), a(), a()])), ["scene.blocks.2.name"]);
        assert_eq!(paths(json!([ground(), cuboid("a", [0.0, 0.0, 1.0], [1.0; 3])])), ["scene.blocks.1.faces"]);
        assert_eq!(paths(json!([ground(), cuboid("a", [0.0, 0.0, 1.0], [1.0, 1.0, 2.0])])), ["scene.blocks"]);
        let mut open = a();
        open["faces"].as_array_mut().unwrap().pop();
        assert_eq!(paths(json!([ground(), open])), ["scene.blocks.1.faces"]);
        let mut beyond = a();
        beyond["faces"][0] = json!([0, 2, 9]);
        assert_eq!(paths(json!([ground(), beyond])), ["scene.blocks.1.faces"]);
    }
}
