//! The reference arch with its variations, also as a scene of blocks.

use crate::{first_case, friction};
use voussoir::core::model::Assembly;
use voussoir::core::model::geometry::Vec2;

/// The reference arch with all parameters that tests change.
#[derive(Debug, Clone)]
pub struct Arch {
    /// Intrados span \[m\].
    pub span: f64,
    /// Rise \[m\].
    pub rise: f64,
    /// Ring thickness \[m\].
    pub thickness: f64,
    /// Width out of plane \[m\].
    pub width: f64,
    /// Number of voussoirs.
    pub voussoirs: usize,
    /// Joints at the ends: `bonded` or `jointed`.
    pub ends: &'static str,
    /// Law of the blocks and its parameters, without the density.
    pub material: String,
    /// Table of the mesh, without brackets; empty for the default mesh.
    pub mesh: String,
    /// Table of the joint law, without brackets.
    pub joint: String,
    /// Position of the load as a fraction of the span.
    pub span_fraction: f64,
    /// Downward load for factor 1 \[N\].
    pub load: f64,
    /// Density ρ \[kg/m³\].
    pub density: f64,
    /// Tag of the solver.
    pub solver: &'static str,
}

impl Default for Arch {
    /// The Strathmashie bridge of Drosopoulos et al. (2008) with 15 voussoirs, bonded ends, μ = 0.6.
    fn default() -> Self {
        Arch {
            span: 9.42,
            rise: 2.99,
            thickness: 0.6,
            width: 5.81,
            voussoirs: 15,
            ends: "bonded",
            material: "law = \"rigid\"".into(),
            mesh: String::new(),
            joint: friction(0.6),
            span_fraction: 0.25,
            load: 1000.0,
            density: 2200.0,
            solver: "auto",
        }
    }
}

impl Arch {
    fn mesh_table(&self) -> String {
        if self.mesh.is_empty() { String::new() } else { format!("[scene.mesh]\n{}\n", self.mesh) }
    }

    /// Returns the scene and its laws without stages.
    fn head(&self) -> String {
        format!(
            r#"name = "arch"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = {:?}, rise = {:?} }}
thickness = {:?}
width = {:?}
voussoirs = {}
ends = "{}"
material = "stone"
joint = "dry"
{}[materials.stone]
{}
density = {:?}
[joints.dry]
{}
[solver]
solver = "{}"
[[stages]]
name = "dead"
gravity = 9.81
"#,
            self.span,
            self.rise,
            self.thickness,
            self.width,
            self.voussoirs,
            self.ends,
            self.mesh_table(),
            self.material,
            self.density,
            self.joint,
            self.solver
        )
    }

    /// Returns the study with a point load that grows until collapse.
    pub fn study(&self) -> String {
        format!(
            "{}[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{{ kind = \"point\", span_fraction = {:?}, force = [0.0, {:?}] }}]\n",
            self.head(),
            self.span_fraction,
            -self.load
        )
    }

    /// Returns the study under its own weight only.
    pub fn dead_study(&self) -> String {
        self.head()
    }
}

/// Returns a `blocks` study with the same blocks and laws as the arch. `map` transforms points, `turn` gravity and
/// load; `order` is the order of the blocks.
pub fn as_blocks(arch: &Arch, map: impl Fn(Vec2) -> Vec2, turn: impl Fn(Vec2) -> Vec2, order: &[usize]) -> String {
    let case = first_case(&arch.study());
    let assembly: &Assembly = &case.assembly;
    let vertices = |points: &[Vec2]| {
        let all: Vec<String> = points.iter().map(|p| map(*p)).map(|p| format!("[{:?}, {:?}]", p.x, p.y)).collect();
        format!("[{}]", all.join(", "))
    };
    let mut blocks: Vec<String> = Vec::new();
    for (body, outwards) in [(0, -1.0), (assembly.bodies.len() - 1, 1.0)] {
        let joint = &assembly.joints[if body == 0 { 0 } else { assembly.joints.len() - 1 }];
        let off = joint.frame().0 * (0.3 * outwards);
        let quad = [joint.ends[0], joint.ends[1], joint.ends[1] + off, joint.ends[0] + off];
        blocks.push(format!("{{ name = \"ground{body}\", vertices = {}, fixed = true }}", vertices(&quad)));
    }
    for &k in order {
        let body = &assembly.bodies[1 + k];
        blocks.push(format!("{{ name = \"b{k}\", vertices = {} }}", vertices(&body.vertices)));
    }
    let load = case.stages[1].forces[0];
    let (point, force) = (map(load.point), turn(load.force));
    let gravity = turn(Vec2::new(0.0, -9.81));
    format!(
        r#"name = "blocks"
[scene]
scene = "blocks"
width = {:?}
material = "stone"
joint = "dry"
blocks = [
{}
]
{}[materials.stone]
{}
density = {:?}
[joints.dry]
{}
[solver]
solver = "{}"
[[stages]]
name = "dead"
gravity = [{:?}, {:?}]
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "point", block = "b{}", point = [{:?}, {:?}], force = [{:?}, {:?}] }}]
"#,
        arch.width,
        blocks.join(",\n"),
        arch.mesh_table(),
        arch.material,
        arch.density,
        arch.joint,
        arch.solver,
        gravity.x,
        gravity.y,
        load.body - 1,
        point.x,
        point.y,
        force.x,
        force.y
    )
}
