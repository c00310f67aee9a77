//! The standard studies on which kinds and writers are checked.

/// The standard study without name and kind: an arch under a force that grows until collapse.
const ARCH: &str = r#"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 4.0, rise = 1.0 }
thickness = 0.4
width = 1.0
voussoirs = 9
material = "stone"
joint = "dry"

[materials.stone]
law = "rigid"
density = 2200.0

[joints.dry]
law = "coulomb_associated"
friction = 0.7

[[stages]]
name = "dead"
gravity = 9.81

[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.25, force = [0.0, -1000.0] }]
"#;

/// Tables of a path with all its outputs.
const PATH: &str = r#"
[scene.mesh]
elements = [1, 2]

[solver]
solver = "event_path"

[output]
curve = true
vtu = true
states = 5
"#;

/// Returns the standard study with a name, a kind and further tables.
pub(super) fn arch(name: &str, kind: &str, tables: &str) -> String {
    format!("name = \"{name}\"\nkind = \"{kind}\"\n{ARCH}\n{tables}\n")
}

/// Returns the standard studies for writers: limit analysis with a sweep, a comparison, and a path of elastic stone.
pub(super) fn for_writers() -> [String; 3] {
    let elastic = "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2";
    let sweep = "[output]\nsensitivities = true\n\n[sweep]\n\"joints.dry.friction\" = { list = [0.5, 0.7] }\n";
    let variants = "[[variants]]\nname = \"as it is\"\n\n[[variants]]\nname = \"smooth\"\nset = { \"joints.dry.friction\" = 0.45 }\n";
    [
        arch("limit", "run", sweep),
        arch("comparison", "compare", variants),
        arch("path", "run", PATH).replace("law = \"rigid\"", elastic),
    ]
}
