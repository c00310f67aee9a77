//! Scenes that benches share, made from study files, so that a user can repeat a bench with `voussoir run`.

pub mod point;

use voussoir::study::{Case, load};

/// A jointed segmental ring of `voussoirs` (span 9.42 m, rise 2.99 m, thickness 0.6 m, 1 m wide,
/// μ 0.6) with a load above quarter span: the scene all peers were measured on. `solver` is a tag.
pub fn ring(voussoirs: usize, solver: &str) -> Case {
    ring_of(voussoirs, solver, "law = \"rigid\"", "")
}

/// The same ring with compliant joints.
pub fn compliant_ring(voussoirs: usize) -> Case {
    ring_of(voussoirs, "auto", "law = \"rigid\"", "normal_stiffness = 1e10\nshear_stiffness = 4e9")
}

/// The same ring of elastic voussoirs, E 5 GPa.
pub fn elastic_ring(voussoirs: usize) -> Case {
    ring_of(voussoirs, "auto", "law = \"elastic\"\nyoung_modulus = \"5 GPa\"\npoisson_ratio = 0.3", "")
}

fn ring_of(voussoirs: usize, solver: &str, material: &str, stiffness: &str) -> Case {
    case(&format!(
        r#"
name = "ring"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = 9.42, rise = 2.99 }}
thickness = 0.6
width = 1.0
voussoirs = {voussoirs}
ends = "jointed"
material = "stone"
joint = "dry"
[materials.stone]
{material}
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
{stiffness}
[[stages]]
gravity = 9.81
name = "dead"
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "point", span_fraction = 0.25, force = [0.0, -1000.0] }}]
[solver]
solver = "{solver}"
"#
    ))
}

/// A wall of `courses` × `bricks` under a horizontal force proportional to weight.
pub fn wall(courses: usize, bricks: usize) -> Case {
    case(&format!(
        r#"
name = "wall"
[scene]
scene = "wall"
width = 1.0
brick = [0.4, 0.175]
courses = {courses}
bricks = {bricks}
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "coulomb_associated"
friction = 0.65
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "push"
until = "collapse"
loads = [{{ kind = "body", acceleration = [9.81, 0.0] }}]
"#
    ))
}

fn case(text: &str) -> Case {
    match load(text, "bench.toml", &[]) {
        Ok(mut study) => study.cases.swap_remove(0),
        Err(mistakes) => panic!("a bench's study is wrong: {}", mistakes[0]),
    }
}
