//! What tests share: reading a study from text, answering it, and scenes in several disguises.
//!
//! One binary a folder of `tests/tests/`: `verification` holds other people's answers, `regression` our own last
//! ones, `invariance` what must not matter, `stress` random scenes, `conformance` every plug-in, `files` studies and
//! results read back, `messages` the exact text of every error, `architecture` the house itself. One file of one:
//! `cargo test --release -p voussoir-tests --test verification arch::`.

pub mod random;
pub mod samples;
pub mod seen;
pub mod written;

use voussoir::core::limit::Status;
use voussoir::core::model::Assembly;
use voussoir::core::model::geometry::Vec2;
use voussoir::core::path::PathSettings;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir::study::{Case, Study, load};

/// Reads a study that must be right.
pub fn study(text: &str) -> Study {
    load(text, "test.toml", &[]).unwrap_or_else(|mistakes| {
        let all: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
        panic!("the test's study is wrong:\n{}\n{text}", all.join("\n"))
    })
}

/// The first case of a study.
pub fn first_case(text: &str) -> Case {
    study(text).cases.swap_remove(0)
}

/// Answers the first case of a study.
pub fn answered(text: &str) -> CaseResult {
    solve_case(&first_case(text))
}

/// The load factor of a case that must collapse, with a certificate.
pub fn collapse_factor(text: &str) -> f64 {
    let result = answered(text);
    assert_eq!(result.status, Status::Collapse, "{:?} {:?}", result.notes, result.certificate);
    assert!(result.certificate.passed, "{:?}", result.certificate);
    result.load_factor.expect("a collapse has a factor")
}

/// What a path with small displacements is asked for where nothing else is.
pub fn small_displacements() -> PathSettings {
    PathSettings { finite: false, tolerance: 1e-9, stop_displacement: None, stop_factor: None, continuation: None }
}

/// Asserts |a − b| ≤ tolerance × |b|.
pub fn assert_close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a:.16} is not {b:.16}: relative difference {:.2e}", (a - b) / b);
}

/// The reference arch with its variations: everything a test may want to change.
#[derive(Debug, Clone)]
pub struct Arch {
    /// Intrados span \[m\].
    pub span: f64,
    /// Rise \[m\].
    pub rise: f64,
    /// Ring thickness \[m\].
    pub thickness: f64,
    /// Out of plane \[m\].
    pub width: f64,
    /// Number of voussoirs.
    pub voussoirs: usize,
    /// `bonded` or `jointed`.
    pub ends: &'static str,
    /// Table of the joint law, without brackets.
    pub joint: String,
    /// Load position along the span.
    pub span_fraction: f64,
    /// Downward load for factor 1 \[N\].
    pub load: f64,
    /// ρ \[kg/m³\].
    pub density: f64,
    /// Solver tag.
    pub solver: &'static str,
}

impl Default for Arch {
    /// The Strathmashie bridge of Drosopoulos et al. (2008), 15 voussoirs, bonded ends, μ 0.6.
    fn default() -> Self {
        Arch {
            span: 9.42,
            rise: 2.99,
            thickness: 0.6,
            width: 5.81,
            voussoirs: 15,
            ends: "bonded",
            joint: friction(0.6),
            span_fraction: 0.25,
            load: 1000.0,
            density: 2200.0,
            solver: "auto",
        }
    }
}

/// Associated Coulomb friction.
pub fn friction(mu: f64) -> String {
    format!("law = \"coulomb_associated\"\nfriction = {mu:?}")
}

/// Friction with a crushing strength \[Pa\].
pub fn crushing(mu: f64, strength: f64) -> String {
    format!("law = \"mohr_coulomb\"\nfriction = {mu:?}\ncompressive_strength = {strength:?}")
}

impl Arch {
    /// The scene and its laws without stages.
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
[materials.stone]
law = "rigid"
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
            self.density,
            self.joint,
            self.solver
        )
    }

    /// The study with a point load grown until collapse.
    pub fn study(&self) -> String {
        format!(
            "{}[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{{ kind = \"point\", span_fraction = {:?}, force = [0.0, {:?}] }}]\n",
            self.head(),
            self.span_fraction,
            -self.load
        )
    }

    /// The study under its own weight only.
    pub fn dead_study(&self) -> String {
        self.head()
    }
}

/// A `blocks` study of the same blocks and laws as the arch, every point sent through `map`, gravity
/// and load through `turn`; `order` gives the order of the blocks.
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
[materials.stone]
law = "rigid"
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
