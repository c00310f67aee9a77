//! Random arches and piers whose supports move before a load grows: the scenes of the energy program, of the comparison
//! of strategies and of the stress family of settlements.

use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};

/// Random numbers that are the same on every machine.
pub struct Random(TestRng);

impl Random {
    /// Creates the series of a seed.
    pub fn new(seed: u64) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        Random(TestRng::from_seed(RngAlgorithm::ChaCha, &bytes))
    }

    /// Returns a number uniformly distributed between `low` and `high`.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a whole number from `low` to `high`, both included.
    pub fn whole(&mut self, low: usize, high: usize) -> usize {
        low + (self.0.next_u64() % (high - low + 1) as u64) as usize
    }
}

/// The motion of the supports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Settling {
    /// The left support moves towards the other.
    In,
    /// The left support moves away from the other.
    Out,
    /// The left support moves downwards.
    Down,
    /// The left support rotates.
    Rotation,
    /// Both supports move and rotate.
    Both,
}

impl Settling {
    /// All motions.
    pub const ALL: [Settling; 5] = [Settling::In, Settling::Out, Settling::Down, Settling::Rotation, Settling::Both];
}

/// The parts that deform.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Deforming {
    /// No part deforms.
    Rigid,
    /// The joints deform.
    Compliant,
    /// The blocks deform.
    Elastic,
}

/// An arch, or a stack of blocks on a moving block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A segmental arch.
    Arch,
    /// A pier under a horizontal load at its top.
    Pier,
}

/// A scene with a support that moves; [`SettledScene::study`] writes it.
#[derive(Debug, Clone)]
pub struct SettledScene {
    /// The shape.
    pub shape: Shape,
    /// Diagonal or span, the unit of settlements \[m\].
    pub span: f64,
    scene: String,
    mirrored: String,
    materials: String,
    joint: String,
    settlement: String,
    load: String,
    mirrored_settlement: String,
    mirrored_load: String,
    /// Settlement and load, each shifted by 1e-6 of the scene.
    shifted: [String; 2],
    /// Scene, settlement and load with the blocks in another order, if such a form exists.
    renumbered: Option<[String; 3]>,
}

/// The parameters of a random scene.
#[derive(Debug, Clone, Copy)]
pub struct Draw {
    /// The shape.
    pub shape: Shape,
    /// The parts that deform.
    pub deforming: Deforming,
    /// The motion of the supports.
    pub settling: Settling,
    /// Settlement in spans (rotations in rad are four times that).
    pub size: f64,
    /// True for joints without slip, false for Coulomb friction.
    pub stuck: bool,
}

impl SettledScene {
    /// Returns the study: dead load, settlement, load until collapse, with these lines under `[solver]`.
    pub fn study(&self, solver: &str) -> String {
        self.written(solver, false, true)
    }

    /// Returns the study without the load.
    pub fn settlement_only(&self, solver: &str) -> String {
        self.written(solver, false, false)
    }

    /// Returns the study without its settlement, with associated slip.
    pub fn unmoved(&self, solver: &str) -> String {
        let text = self.study(solver);
        let stage = format!("[[stages]]\nname = \"settle\"\nsettlement = [{}]\n", self.settlement);
        text.replace(&stage, "").replace("law = \"coulomb\"", "law = \"coulomb_associated\"")
    }

    /// Returns the mirror image of [`study`](Self::study), with blocks numbered from the other end.
    pub fn mirrored(&self, solver: &str) -> String {
        self.written(solver, true, true)
    }

    /// Returns the study with the load, or the settled support, shifted by 1e-6 of the scene.
    pub fn shifted(&self, solver: &str, load: bool) -> String {
        let (settlement, live) =
            if load { (&self.settlement, &self.shifted[1]) } else { (&self.shifted[0], &self.load) };
        self.text(solver, [&self.scene, settlement, live], true)
    }

    /// Returns the study with its blocks in another order; `None` if ends are bonded.
    pub fn renumbered(&self, solver: &str) -> Option<String> {
        let [scene, settlement, load] = self.renumbered.as_ref()?;
        Some(self.text(solver, [scene, settlement, load], true))
    }

    fn written(&self, solver: &str, mirrored: bool, loaded: bool) -> String {
        let parts = if mirrored {
            [&self.mirrored, &self.mirrored_settlement, &self.mirrored_load]
        } else {
            [&self.scene, &self.settlement, &self.load]
        };
        self.text(solver, parts, loaded)
    }

    fn text(&self, solver: &str, [scene, settlement, load]: [&String; 3], loaded: bool) -> String {
        let live = format!("[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{load}]\n");
        format!(
            "name = \"settled\"\n{scene}{}[joints.dry]\n{}[solver]\n{solver}\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"settle\"\nsettlement = [{settlement}]\n{}",
            self.materials,
            self.joint,
            if loaded { &live } else { "" }
        )
    }
}

fn motion(support: &str, [x, y, turn]: [f64; 3]) -> String {
    format!("{{ support = \"{support}\", displacement = [{x:?}, {y:?}], rotation = {turn:?} }}")
}

/// Returns the motions of the left and the right support.
fn motions(random: &mut Random, settling: Settling, size: f64) -> [[f64; 3]; 2] {
    let sign = |random: &mut Random| if random.whole(0, 1) == 0 { 1.0 } else { -1.0 };
    let mut left = [0.0; 3];
    let mut right = [0.0; 3];
    match settling {
        Settling::In => left[0] = size,
        Settling::Out => left[0] = -size,
        Settling::Down => left[1] = -size,
        Settling::Rotation => left[2] = sign(random) * size / 0.25,
        Settling::Both => {
            left =
                [random.uniform(-1.0, 0.3) * size, random.uniform(-1.0, 0.2) * size, random.uniform(-1.0, 1.0) * size];
            right =
                [random.uniform(-0.3, 1.0) * size, random.uniform(-1.0, 0.2) * size, random.uniform(-1.0, 1.0) * size];
        }
    }
    [left, right]
}

fn shifted([x, y, turn]: [f64; 3], size: f64) -> [f64; 3] {
    [x + 1e-6 * size, y - 1e-6 * size, turn]
}

fn mirror([x, y, turn]: [f64; 3]) -> [f64; 3] {
    [0.0 - x, y, 0.0 - turn]
}

/// Returns a random scene with these parameters.
pub fn settled_scene(random: &mut Random, draw: Draw) -> SettledScene {
    let stiffness = 10f64.powf(random.uniform(9.5, 11.0));
    let friction = random.uniform(0.5, 0.9);
    let mut joint = if draw.stuck {
        "law = \"unilateral\"\ntangential = \"stuck\"\n".to_string()
    } else {
        format!("law = \"coulomb\"\nfriction = {friction:?}\n")
    };
    if draw.deforming == Deforming::Compliant {
        let shear = stiffness * random.uniform(0.3, 0.6);
        joint += &format!("normal_stiffness = {stiffness:?}\nshear_stiffness = {shear:?}\n");
    }
    let density = random.uniform(1800.0, 2600.0);
    let materials = if draw.deforming == Deforming::Elastic {
        let modulus = 10f64.powf(random.uniform(9.3, 10.5));
        format!(
            "[materials.stone]\nlaw = \"elastic\"\nyoung_modulus = {modulus:?}\npoisson_ratio = 0.2\ndensity = {density:?}\n"
        )
    } else {
        format!("[materials.stone]\nlaw = \"rigid\"\ndensity = {density:?}\n")
    };
    match draw.shape {
        Shape::Arch => arch(random, draw, materials, joint),
        Shape::Pier => pier(random, draw, materials, joint),
    }
}

fn arch(random: &mut Random, draw: Draw, materials: String, joint: String) -> SettledScene {
    let span = random.uniform(2.0, 12.0);
    let rise = span * random.uniform(0.15, 0.45);
    let thickness = span * random.uniform(0.07, 0.12);
    let voussoirs = random.whole(5, 13);
    let ends = if random.whole(0, 1) == 0 { "bonded" } else { "jointed" };
    let across = random.whole(2, 4);
    let place = random.uniform(0.2, 0.45);
    let across_load = random.uniform(-0.2, 0.2);
    let scene = format!(
        "[scene]\nscene = \"arch\"\nprofile = {{ shape = \"segmental\", span = {span:?}, rise = {rise:?} }}\nthickness = {thickness:?}\nwidth = 1.0\nvoussoirs = {voussoirs}\nends = \"{ends}\"\nmaterial = \"stone\"\njoint = \"dry\"\nmesh = {{ elements = [1, {across}] }}\n"
    );
    let [left, right] = motions(random, draw.settling, draw.size * span);
    let both = |left: [f64; 3], right: [f64; 3]| {
        let list: Vec<String> = [("left", left), ("right", right)]
            .into_iter()
            .filter(|(_, m)| *m != [0.0; 3])
            .map(|(name, m)| motion(name, m))
            .collect();
        list.join(", ")
    };
    let load = |place: f64, x: f64| {
        format!("{{ kind = \"point\", span_fraction = {place:?}, force = [{:?}, -1000.0] }}", 1000.0 * x)
    };
    SettledScene {
        renumbered: (ends == "jointed")
            .then(|| as_blocks(&scene, &materials, &joint, [left, right], across, across_load, place)),
        shifted: [both(shifted(left, span), right), load(place + 1e-6, across_load)],
        shape: Shape::Arch,
        span,
        mirrored: scene.clone(),
        scene,
        materials,
        joint,
        settlement: both(left, right),
        load: load(place, across_load),
        mirrored_settlement: both(mirror(right), mirror(left)),
        mirrored_load: load(1.0 - place, 0.0 - across_load),
    }
}

fn pier(random: &mut Random, draw: Draw, materials: String, joint: String) -> SettledScene {
    let width = random.uniform(0.5, 1.5);
    let courses = random.whole(2, 5);
    let height = width * random.uniform(0.4, 1.0);
    let total = height * courses as f64;
    let half = width / 2.0;
    let across = random.whole(2, 4);
    let block = |name: &str, x: f64, y: [f64; 2], fixed: &str| {
        format!(
            "{{ name = \"{name}\", vertices = [[{:?}, {1:?}], [{2:?}, {1:?}], [{2:?}, {3:?}], [{0:?}, {3:?}]]{fixed} }}",
            -x, y[0], x, y[1]
        )
    };
    let mut blocks = vec![block("ground", half, [-0.4, 0.0], ", fixed = true")];
    for k in 0..courses {
        blocks.push(block(&format!("b{k}"), half, [k as f64 * height, (k + 1) as f64 * height], ""));
    }
    let written = |blocks: &[String]| {
        format!(
            "[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\nmesh = {{ elements = [1, {across}] }}\nblocks = [\n{}\n]\n",
            blocks.join(",\n")
        )
    };
    let scene = written(&blocks);
    blocks.reverse();
    let mirrored = written(&blocks);
    let [mut left, right] = motions(random, draw.settling, draw.size * total);
    if draw.settling == Settling::Both {
        (0..3).for_each(|k| left[k] = 0.5 * (left[k] + right[k]));
    }
    let level = total * random.uniform(0.8, 0.99);
    let share = random.uniform(-0.3, 0.0);
    let load = |sign: f64, level: f64| {
        format!(
            "{{ kind = \"point\", block = \"b{}\", point = [{:?}, {level:?}], force = [{:?}, {:?}] }}",
            courses - 1,
            -sign * half,
            1000.0 * sign,
            1000.0 * share
        )
    };
    SettledScene {
        renumbered: Some([mirrored.clone(), motion("ground", left), load(1.0, level)]),
        shifted: [motion("ground", shifted(left, total)), load(1.0, level * (1.0 - 1e-6))],
        shape: Shape::Pier,
        span: total,
        scene,
        mirrored,
        materials,
        joint,
        settlement: motion("ground", left),
        load: load(1.0, level),
        mirrored_settlement: motion("ground", mirror(left)),
        mirrored_load: load(-1.0, level),
    }
}

/// Returns scene, settlement and load of the arch as blocks, odd places first, with its supports as separate blocks.
fn as_blocks(
    scene: &str,
    materials: &str,
    joint: &str,
    motions: [[f64; 3]; 2],
    across: usize,
    across_load: f64,
    place: f64,
) -> [String; 3] {
    let load = format!("{{ kind = \"point\", span_fraction = {place:?}, force = [0.0, -1.0] }}");
    let case = crate::first_case(&format!(
        "name = \"arch\"\n{scene}{materials}[joints.dry]\n{joint}[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{load}]\n[solver]\nsolver = \"limit_conic\"\n"
    ));
    let assembly = &case.assembly;
    let last = assembly.bodies.len() - 1;
    let vertices = |points: &[voussoir::core::model::geometry::Vec2]| {
        let all: Vec<String> = points.iter().map(|p| format!("[{:?}, {:?}]", p.x, p.y)).collect();
        format!("[{}]", all.join(", "))
    };
    let mut blocks = Vec::new();
    for (body, joint, outwards) in [(0, 0, -1.0), (last, assembly.joints.len() - 1, 1.0)] {
        let joint = &assembly.joints[joint];
        let off = joint.frame().0 * (0.3 * outwards);
        let quad = [joint.ends[0], joint.ends[1], joint.ends[1] + off, joint.ends[0] + off];
        blocks.push(format!("{{ name = \"ground{body}\", vertices = {}, fixed = true }}", vertices(&quad)));
    }
    let order = (1..last).filter(|k| k % 2 == 1).chain((1..last).filter(|k| k % 2 == 0));
    blocks
        .extend(order.map(|k| format!("{{ name = \"b{k}\", vertices = {} }}", vertices(&assembly.bodies[k].vertices))));
    let force = case.stages[0].forces[0];
    let scene = format!(
        "[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\nmesh = {{ elements = [1, {across}] }}\nblocks = [\n{}\n]\n",
        blocks.join(",\n")
    );
    let settlement: Vec<String> = [(0, motions[0]), (last, motions[1])]
        .into_iter()
        .filter(|(_, m)| *m != [0.0; 3])
        .map(|(body, m)| motion(&format!("ground{body}"), m))
        .collect();
    let load = format!(
        "{{ kind = \"point\", block = \"b{}\", point = [{:?}, {:?}], force = [{:?}, -1000.0] }}",
        force.body,
        force.point.x,
        force.point.y,
        1000.0 * across_load
    );
    [scene, settlement.join(", "), load]
}
