//! Random elastic scenes for the stress tests of path solvers: walls, rings and arches with joints of several laws,
//! blocks of very different stiffness, and load histories before the load that grows.

use crate::Arch;
use proptest::prelude::*;

/// The law of the joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// No slip.
    Stuck,
    /// Slip along the normal of the friction cone.
    Associated,
    /// Slip without dilatancy.
    Coulomb,
    /// Slip with half the friction angle as dilatancy.
    Dilatant,
    /// Cohesion, tensile and crushing strength, associated.
    Strengths,
}

impl Law {
    /// Returns true if the last load is that of limit analysis, within rounding.
    pub fn is_sure(self) -> bool {
        matches!(self, Law::Stuck | Law::Associated)
    }

    /// Returns true if flow is associated or slip is impossible: every step is then a convex problem.
    pub fn is_monotone(self) -> bool {
        !matches!(self, Law::Coulomb | Law::Dilatant)
    }

    fn joint(self, friction: f64) -> String {
        match self {
            Law::Stuck => "law = \"unilateral\"\ntangential = \"stuck\"".into(),
            Law::Associated => format!("law = \"coulomb_associated\"\nfriction = {friction:?}"),
            Law::Coulomb => format!("law = \"coulomb\"\nfriction = {friction:?}"),
            Law::Dilatant => {
                let angle = friction.atan().to_degrees() / 2.0;
                format!("law = \"coulomb\"\nfriction = {friction:?}\ndilatancy_angle = {angle:?}")
            }
            Law::Strengths => format!(
                "law = \"mohr_coulomb\"\nfriction = {friction:?}\ncohesion = 2e4\ntensile_strength = 1e4\ncompressive_strength = 2e6"
            ),
        }
    }
}

/// The load history between the dead load and the load that grows until collapse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum History {
    /// The load grows directly after the dead load.
    None,
    /// The load grows to a share of its limit and falls back to zero.
    Unloading,
    /// A support settles.
    Settlement,
}

/// A scene; [`RandomScene::study`] writes it for a solver.
#[derive(Debug, Clone)]
pub struct RandomScene {
    /// Law of all joints.
    pub law: Law,
    /// True if it is a wall.
    pub is_wall: bool,
    /// Load history before the load grows.
    pub history: History,
    head: String,
    joint: String,
    live: String,
    back: String,
    settlement: String,
}

impl RandomScene {
    /// Returns the study for a solver. A history of unloading needs the limit load `limit`; without it the live load
    /// follows the dead load directly.
    pub fn study(&self, solver: &str, limit: Option<f64>) -> String {
        let mut stages = String::from("[[stages]]\nname = \"dead\"\ngravity = 9.81\n");
        if let (History::Unloading, Some(limit)) = (self.history, limit) {
            let factor = 0.6 * limit;
            stages += &format!("[[stages]]\nname = \"up\"\nfactor = {factor:?}\nloads = [{}]\n", self.live);
            stages += &format!("[[stages]]\nname = \"back\"\nfactor = {factor:?}\nloads = [{}]\n", self.back);
        }
        if let (History::Settlement, Some(_)) = (self.history, limit) {
            stages += &format!("[[stages]]\nname = \"settlement\"\nsettlement = [{}]\n", self.settlement);
        }
        format!(
            "{}[joints.dry]\n{}\n[solver]\nsolver = \"{solver}\"\n{stages}[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{}]\n",
            self.head, self.joint, self.live
        )
    }

    /// Returns the study for limit analysis with associated slip.
    pub fn associated(&self) -> String {
        let joint: Vec<String> = self
            .joint
            .lines()
            .filter(|line| !line.starts_with("dilatancy_angle"))
            .map(|line| if line == "law = \"coulomb\"" { "law = \"coulomb_associated\"".into() } else { line.into() })
            .collect();
        RandomScene { joint: joint.join("\n"), ..self.clone() }.study("limit_conic", None)
    }
}

/// The numbers that define a random scene, as `numbers` draws them.
pub type Numbers = (Law, f64, f64, u8, usize, f64, usize, f64, f64, u8);

/// Random numbers for [`scene`].
pub fn numbers() -> impl Strategy<Value = Numbers> {
    let laws = prop_oneof![
        2 => Just(Law::Stuck),
        4 => Just(Law::Associated),
        4 => Just(Law::Coulomb),
        2 => Just(Law::Dilatant),
        1 => Just(Law::Strengths)
    ];
    (laws, -1.3f64..0.3, 0.0f64..6.0, 0u8..9, 2usize..5, 0.2f64..0.8, 0usize..4, 0.1f64..0.9, 0.05f64..0.95, 0u8..6)
}

/// Returns materials m0 … m3 whose stiffnesses differ by up to `spread` powers of ten.
fn materials(spread: f64) -> String {
    (0..4)
        .map(|k| {
            let modulus = 1e10 * 10f64.powf(-spread * f64::from(k) / 3.0);
            format!("[materials.m{k}]\nlaw = \"elastic\"\nyoung_modulus = {modulus:?}\npoisson_ratio = 0.2\ndensity = 2000.0\n")
        })
        .collect()
}

fn blocks_head(blocks: &[String], spread: f64, elements: [usize; 2], order: usize) -> String {
    format!(
        "name = \"random\"\n[scene]\nscene = \"blocks\"\nwidth = 0.5\nmaterial = \"m0\"\njoint = \"dry\"\nblocks = [\n{}\n]\n[scene.mesh]\nelements = [{}, {}]\norder = {order}\n{}",
        blocks.join(",\n"),
        elements[0],
        elements[1],
        materials(spread)
    )
}

/// Returns the scene with these numbers; `None` if they give no valid scene.
pub fn scene(numbers: Numbers) -> Option<RandomScene> {
    let (law, exponent, spread, kind, size, shift, seed, rise, place, history) = numbers;
    let joint = law.joint(10f64.powf(exponent));
    let is_wall = kind < 4;
    let history = match history {
        0 if law != Law::Strengths => History::Unloading,
        1 if kind < 8 && !is_wall => History::Settlement,
        _ => History::None,
    };
    let settlement =
        format!("{{ support = \"right\", displacement = [{:?}, {:?}] }}", 4e-5 * (shift - 0.3), -2e-5 * place);
    let (head, live, back) = if is_wall {
        let blocks = wall(size, 2 + seed % 3, shift, seed);
        let sense = if place < 0.5 { 9.81 } else { -9.81 };
        let body = |a: f64| format!("{{ kind = \"body\", acceleration = [{a:?}, 0.0] }}");
        (blocks_head(&blocks, spread, [2, 2], 1 + seed % 2), body(sense), body(-sense))
    } else if kind < 8 {
        let voussoirs = 4 * size - 3 + seed;
        let blocks = ring(voussoirs, 4.0 * rise, 0.25 + 0.5 * shift, seed);
        let loaded = (place * voussoirs as f64) as usize;
        let radius = (4.0 + 16.0 * rise * rise) / (8.0 * rise);
        let half = f64::atan2(2.0, radius - 4.0 * rise);
        let angle = half * (1.0 - 2.0 * (loaded as f64 + 0.5) / voussoirs as f64);
        let (x, y) = (-(radius + 0.05) * angle.sin(), 4.0 * rise - radius + (radius + 0.05) * angle.cos());
        let point = |f: f64| {
            format!("{{ kind = \"point\", block = \"v{loaded}\", point = [{x:?}, {y:?}], force = [0.0, {f:?}] }}")
        };
        (blocks_head(&blocks, spread, [1, 3], 1 + seed % 3), point(-1000.0), point(1000.0))
    } else {
        // A strip load on an arch with compliant joints.
        let stiffness = 10f64.powf(11.0 - 0.5 * spread);
        let arch = Arch {
            voussoirs: 2 * size + 2 + seed,
            rise: 0.8 + 3.0 * rise,
            thickness: 0.3 + 0.5 * shift,
            joint: String::new(),
            ..Arch::default()
        };
        let text = arch.study();
        let head = text.split("[joints.dry]").next().unwrap_or_default().to_string();
        let strip = |p: f64| {
            format!("{{ kind = \"strip\", from = {:?}, to = {:?}, pressure = {p:?} }}", 0.6 * place, 0.6 * place + 0.2)
        };
        let joint = format!("{joint}\nnormal_stiffness = {stiffness:?}\nshear_stiffness = {:?}", 0.4 * stiffness);
        let scene =
            RandomScene { law, is_wall, history, head, joint, live: strip(1000.0), back: strip(-1000.0), settlement };
        return readable(scene);
    };
    readable(RandomScene { law, is_wall, history, head, joint, live, back, settlement })
}

fn readable(scene: RandomScene) -> Option<RandomScene> {
    voussoir::study::load(&scene.study("event_path", Some(1.0)), "random.toml", &[]).is_ok().then_some(scene)
}

/// Returns a wall in running bond with head joints off the middle.
fn wall(courses: usize, bricks: usize, shift: f64, seed: usize) -> Vec<String> {
    let (length, height) = (0.4, 0.2);
    let total = bricks as f64 * length;
    let mut blocks = vec![format!(
        "{{ name = \"ground\", vertices = [[-1.0, -0.2], [{:?}, -0.2], [{:?}, 0.0], [-1.0, 0.0]], fixed = true }}",
        total + 1.0,
        total + 1.0
    )];
    for row in 0..courses {
        let mut cuts = vec![0.0];
        let offset = if row % 2 == 0 { length } else { shift * length };
        cuts.extend((0..bricks).map(|k| offset + k as f64 * length).filter(|x| *x < total - 1e-9));
        cuts.push(total);
        for (k, x) in cuts.windows(2).enumerate() {
            let (y, top) = (row as f64 * height, (row + 1) as f64 * height);
            blocks.push(format!(
                "{{ name = \"b{row}_{k}\", vertices = [[{:?}, {y:?}], [{:?}, {y:?}], [{:?}, {top:?}], [{:?}, {top:?}]], material = \"m{}\" }}",
                x[0],
                x[1],
                x[1],
                x[0],
                (seed + 7 * row + 3 * k) % 4
            ));
        }
    }
    blocks
}

/// Returns a segmental ring between two fixed blocks.
fn ring(voussoirs: usize, rise: f64, thickness: f64, seed: usize) -> Vec<String> {
    let (span, outer) = (4.0, thickness);
    let radius = (span * span / 4.0 + rise * rise) / (2.0 * rise);
    let half = f64::atan2(span / 2.0, radius - rise);
    let centre = rise - radius;
    let at = |k: f64, r: f64| {
        let angle = half * (1.0 - 2.0 * k / voussoirs as f64);
        [-r * angle.sin(), centre + r * angle.cos()]
    };
    let quad = |a: f64, b: f64| {
        let points = [at(a, radius), at(b, radius), at(b, radius + outer), at(a, radius + outer)];
        let all: Vec<String> = points.iter().map(|p| format!("[{:?}, {:?}]", p[0], p[1])).collect();
        format!("[{}]", all.join(", "))
    };
    let mut blocks = vec![
        format!("{{ name = \"left\", vertices = {}, fixed = true }}", quad(-0.5, 0.0)),
        format!("{{ name = \"right\", vertices = {}, fixed = true }}", quad(voussoirs as f64, voussoirs as f64 + 0.5)),
    ];
    for k in 0..voussoirs {
        blocks.push(format!(
            "{{ name = \"v{k}\", vertices = {}, material = \"m{}\" }}",
            quad(k as f64, k as f64 + 1.0),
            (seed + 5 * k) % 4
        ));
    }
    blocks
}
