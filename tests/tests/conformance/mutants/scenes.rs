//! Scenes and loads with one fault each.

use super::every_fault_is_found;
use serde_json::json;
use std::sync::atomic::{AtomicUsize, Ordering};
use voussoir::core::model::geometry::Vec2;
use voussoir::core::model::{Assembly, Catalogue, PointForce, Scene};
use voussoir::core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};
use voussoir::core::{inventory, typetag};
use voussoir::loads::{LoadKind, LoadSite, Placed};

/// Changes with every call: no pure function reads it.
static CALLS: AtomicUsize = AtomicUsize::new(0);

fn calls() -> f64 {
    CALLS.fetch_add(1, Ordering::Relaxed) as f64
}

/// A block on the ground.
#[derive(Debug, Clone, Keys)]
struct FaultyScene {
    /// name of the fault
    fault: String,
    /// edge of the block
    #[key(unit = "m", range = "> 0")]
    edge: f64,
    /// material of both blocks
    #[key(reference = "materials")]
    material: String,
}

#[typetag::serde(name = "faulty_scene")]
impl Scene for FaultyScene {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        let edge = match self.fault.as_str() {
            "impure" => self.edge * (1.0 + 1e-3 * calls()),
            "hidden length" => self.edge + 0.1,
            "unused key" => 0.8,
            _ => self.edge,
        };
        let square = |x: f64, y: f64, size: f64| json!([[x, y], [x + size, y], [x + size, y + size], [x, y + size]]);
        let scene = json!({
            "scene": "blocks", "width": edge, "material": self.material, "joint": "dry",
            "blocks": [
                { "name": "ground", "fixed": true, "vertices": square(-edge, -3.0 * edge, 3.0 * edge) },
                { "name": "block", "vertices": square(0.0, 0.0, edge) },
            ],
        });
        let scene: Box<dyn Scene> = serde_json::from_value(scene).expect("a scene of blocks");
        let mut built = scene.build(catalogue)?;
        match self.fault.as_str() {
            "first material" => built.bodies[1].material = 0,
            "clockwise" => built.bodies[1].vertices.reverse(),
            "one name" => built.bodies[1].name = "ground".into(),
            "not finite" => built.bodies[1].vertices[0].x = f64::NAN,
            "joint to nothing" => built.joints[0].plus = 7,
            "turned joint" => built.joints[0].ends.reverse(),
            _ => (),
        }
        Ok(built)
    }
}

const SCENE: Card = Card {
    kind: PluginKind::Scene,
    tag: "faulty_scene",
    summary: "a block on the ground",
    file: file!(),
    page: "# `faulty_scene`\n\nA block on the ground.\n",
    ..Card::of::<FaultyScene>()
};

inventory::submit! { SCENE }

#[test]
fn faults_of_scenes() {
    let faults: [(&str, &[&str]); 9] = [
        ("impure", &["purity"]),
        ("hidden length", &["units"]),
        ("unused key", &["keys", "units"]),
        ("first material", &["numbering"]),
        ("clockwise", &["geometry"]),
        ("one name", &["geometry"]),
        ("not finite", &["geometry"]),
        ("joint to nothing", &["geometry"]),
        ("turned joint", &["geometry"]),
    ];
    every_fault_is_found(&SCENE, "edge = 0.5\nmaterial = \"brick\"", Sample::keys(""), &faults);
}

/// A force on a block.
#[derive(Debug, Clone, Keys)]
struct FaultyLoad {
    /// name of the fault
    fault: String,
    /// downwards
    #[key(unit = "N")]
    force: f64,
    /// height of the point above the centroid of the block
    #[key(unit = "m", default = 0.0)]
    above: f64,
}

#[typetag::serde(name = "faulty_load")]
impl LoadKind for FaultyLoad {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        let body = if self.fault == "fixed number" { 7 } else { site.assembly.body("7").expect("a voussoir") };
        let mut point = site.assembly.inertia(body).centroid + Vec2::new(0.0, self.above);
        let mut force = Vec2::new(0.0, -self.force);
        match self.fault.as_str() {
            "impure" => force *= 1.0 + 1e-3 * calls(),
            "hidden force" => force.y -= 100.0,
            "off the block" => point.y += 10.0 * site.assembly.width,
            "not finite" => force.x = f64::INFINITY,
            "nothing" => force *= 0.0,
            _ => (),
        }
        Ok(Placed { forces: vec![PointForce { body, point, force }], ..Placed::default() })
    }
}

const LOAD: Card = Card {
    kind: PluginKind::LoadKind,
    tag: "faulty_load",
    summary: "a force on a block",
    file: file!(),
    page: "# `faulty_load`\n\nA force on a block.\n",
    ..Card::of::<FaultyLoad>()
};

inventory::submit! { LOAD }

#[test]
fn faults_of_loads() {
    let faults: [(&str, &[&str]); 6] = [
        ("impure", &["purity"]),
        ("hidden force", &["units"]),
        ("fixed number", &["numbering"]),
        ("off the block", &["geometry"]),
        ("not finite", &["finite"]),
        ("nothing", &["samples"]),
    ];
    every_fault_is_found(&LOAD, "force = 1e3\nabove = 0.05", Sample::keys(""), &faults);
}
