//! The studies that are mutated.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// A study file.
pub struct Seed {
    pub path: PathBuf,
    pub table: toml::Table,
}

/// Size of the largest file that is mutated \[bytes\]: larger files repeat the keys of others.
const MAX_BYTES: usize = 5000;

/// All studies of the tree, valid and invalid.
pub static STUDIES: LazyLock<Vec<Seed>> = LazyLock::new(|| {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folders = ["studies/cases", "studies/cases/paper", "studies/src/commands/new"];
    let mut all: Vec<Seed> = folders.iter().flat_map(|folder| studies(&root.join(folder))).collect();
    all.extend(OWN.map(|text| Seed { path: root.join("tests/own.toml"), table: text.parse().expect("a study") }));
    all.extend(studies(&root.join(WRONG)));
    assert!(all.len() > 100, "{} studies", all.len());
    all
});

/// The number of valid studies, which come first.
pub static RIGHT: LazyLock<usize> =
    LazyLock::new(|| STUDIES.iter().position(|seed| seed.path.to_string_lossy().contains(WRONG)).expect("wrong ones"));

const WRONG: &str = "tests/mistakes";

fn studies(folder: &Path) -> Vec<Seed> {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    let seed = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a study");
        // Invalid studies may not be TOML.
        let table = (text.len() < MAX_BYTES).then(|| text.parse().ok())??;
        Some(Seed { path, table })
    };
    paths.into_iter().filter_map(seed).collect()
}

/// Kinds and keys that no small study of the tree has.
const OWN: [&str; 2] = [
    r#"
name = "walls"
kind = "compare"
[scene]
scene = "wall"
width = 0.2
courses = 3
bricks = 2
brick = [0.4, 0.2]
bond = "running"
material = "brick"
joint = "dry"
[materials.brick]
law = "rigid"
density = 1900
[joints.dry]
law = "coulomb"
friction = "31 deg"
[[stages]]
name = "dead"
gravity = "1 g"
[[stages]]
name = "push"
until = "collapse"
loads = [{ kind = "body", acceleration = [1.0, 0.0] }]
[[variants]]
name = "least"
set = { "solver.solver" = "limit_least" }
[[variants]]
name = "associated"
set = { "joints.dry.law" = "coulomb_associated" }
[output]
sensitivities = true
vtu = true
"#,
    r#"
name = "bridge"
kind = "envelope"
[scene]
scene = "bridge"
width = 3.8
material = "stone"
joint = "dry"
ring_joint = "dry"
spans = [{ profile = { shape = "segmental", span = 6.0, rise = 1.5 }, thickness = 0.4, voussoirs = 8, rings = 2, ends = "jointed" }, { profile = { shape = "pointed", span = 6.0, rise = 4.0 }, thickness = [0.4, 0.3], voussoirs = 7 }]
piers = [{ height = 3.0, width = 1.0, courses = 2, footing = "fixed" }]
[scene.fill]
cover = 0.2
density = "20 kN/m3"
friction_angle = 37.0
dispersion = { law = "boussinesq" }
resistance = { law = "fill_pressure", passive_factor = 0.33, lower = "zero" }
haunching = { level = 0.7 }
[vehicles.axle]
axles = [{ at = 0.0, force = "115 kN", wheel_width = 0.3, length = 0.3, lift_off = 1.0 }]
[materials.stone]
law = "rigid"
density = 2200
[joints.dry]
law = "mohr_coulomb"
friction = 0.6
cohesion = "10 kPa"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "vehicle"
until = "collapse"
loads = [{ kind = "vehicle", vehicle = "axle", at = 2.0 }]
[envelope]
parameter = "stages.vehicle.loads.0.at"
from = 1.0
to = 3.0
tolerance = 0.2
"#,
];
