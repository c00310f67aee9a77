//! Small scenes whose answers are known.

use super::truth::Truth;
use voussoir_core::limit::Status;
use voussoir_study::file::load;
use voussoir_study::study::{Case, StudyError};

/// A scene and its known answer.
#[derive(Debug, Clone, Copy)]
pub struct KnownScene {
    /// Its name.
    pub name: &'static str,
    /// Source of the answer.
    pub source: &'static str,
    /// TOML of scene, materials and joints.
    scene: &'static str,
    /// TOML of the stages.
    stages: &'static str,
    /// Further keys of `[solver]`.
    solver: &'static str,
    /// The answer.
    pub truth: Truth,
    /// Our solver whose curve, events and stability are compared with the path.
    pub reference: Option<&'static str>,
}

impl KnownScene {
    /// A scene of limit analysis whose answer is found by hand.
    const fn by_hand(name: &'static str, scene: &'static str, stages: &'static str, truth: Truth) -> Self {
        KnownScene { name, source: "by hand", scene, stages, solver: "", truth, reference: None }
    }

    /// A scene of paths whose answer is found by hand, with small displacements.
    const fn by_hand_on_a_path(name: &'static str, scene: &'static str, stages: &'static str, truth: Truth) -> Self {
        let (solver, reference) = ("kinematics = \"small\"", Some("event_path"));
        KnownScene { solver, reference, ..Self::by_hand(name, scene, stages, truth) }
    }

    /// Returns the study with a solver, given as the TOML keys of `[solver]`.
    pub fn study(&self, solver: &str) -> String {
        format!(
            "name = \"{}\"\n[scene]\nmaterial = \"stone\"\njoint = \"dry\"\n{}\n{}\n[solver]\n{solver}\n{}\n\
             [output]\nfigures = false\ncurve = true\n",
            self.name, self.scene, self.stages, self.solver
        )
    }

    /// Returns the case with a solver.
    ///
    /// # Errors
    /// The mistakes of the study, also if the solver does not accept the scene.
    pub fn case(&self, solver: &str) -> Result<Case, StudyError> {
        Ok(load(&self.study(solver), "known_scene.toml", &[])?.cases.remove(0))
    }
}

/// A block 1 m long and 2 m high on the ground: it weighs 20 kN at g = 10 m/s².
macro_rules! block {
    ($dry:literal) => {
        concat!(
            "scene = \"blocks\"\nwidth = 1.0\nblocks = [\n",
            "{ name = \"ground\", vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]], fixed = true },\n",
            "{ name = \"a\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]] },\n]\n",
            "[materials.stone]\ndensity = 1000.0\nlaw = \"rigid\"\n[joints.dry]\n",
            $dry
        )
    };
}

/// Two such blocks of half the height, one on the other. A force pushes the upper block below its middle.
macro_rules! stack {
    ($dry:literal) => {
        concat!(
            "scene = \"blocks\"\nwidth = 1.0\nblocks = [\n",
            "{ name = \"ground\", vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]], fixed = true },\n",
            "{ name = \"a\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] },\n",
            "{ name = \"b\", vertices = [[0.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]] },\n]\n",
            "[materials.stone]\ndensity = 1000.0\nlaw = \"rigid\"\n[joints.dry]\n",
            $dry
        )
    };
}

/// Two such blocks side by side, each with a push: either can tip.
macro_rules! pair {
    ($dry:literal) => {
        concat!(
            "scene = \"blocks\"\nwidth = 1.0\nblocks = [\n",
            "{ name = \"ground\", vertices = [[-1.0, -1.0], [6.0, -1.0], [6.0, 0.0], [-1.0, 0.0]], fixed = true },\n",
            "{ name = \"a\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]] },\n",
            "{ name = \"b\", vertices = [[3.0, 0.0], [4.0, 0.0], [4.0, 2.0], [3.0, 2.0]] },\n]\n",
            "[materials.stone]\ndensity = 1000.0\nlaw = \"rigid\"\n[joints.dry]\n",
            $dry
        )
    };
}

macro_rules! live {
    ($end:literal, $load:literal) => {
        concat!(
            "[[stages]]\nname = \"dead\"\ngravity = 10.0\n[[stages]]\nname = \"live\"\n",
            $end,
            "\nloads = [{ kind = \"point\", ",
            $load,
            " }]"
        )
    };
}

const TIPS: Truth = Truth { mechanisms: &["rocking"], ..Truth::collapse(5.0) };
const TIPS_ALONG_A_PATH: Truth =
    Truth { endings: &[Status::Collapse, Status::LimitPoint], limit_points: Some(&[5.0]), ..TIPS };
const SLIDES: Truth = Truth { mechanisms: &["sliding"], ..Truth::collapse(4.0) };
const CARRIES_5: Truth = Truth { endings: &[Status::Stands], ..Truth::collapse(5.0) };
const LEANS: Truth = Truth { endings: &[Status::NoEquilibrium], ..Truth::collapse(14.0) };
const RING: &str = "scene = \"arch\"\nprofile = { shape = \"segmental\", span = 9.42, rise = 2.99 }\nthickness = 0.6\nwidth = 5.81\n\
     voussoirs = 15\nends = \"bonded\"\n[materials.stone]\nlaw = \"rigid\"\ndensity = 2200.0\n[joints.dry]\n\
     law = \"coulomb_associated\"\nfriction = 0.6";
const RING_LIVE: &str = "[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\n\
     loads = [{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }]";

const PUSHED_PAIR: &str = "[[stages]]\nname = \"dead\"\ngravity = 10.0\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [\
             { kind = \"point\", block = \"a\", point = [0.0, 2.0], force = [1000.0, 0.0] }, \
             { kind = \"point\", block = \"b\", point = [3.0, 2.0], force = [1000.0, 0.0] }]";

const DRY_BLOCK: &str = block!("law = \"coulomb_associated\"\nfriction = 0.6");
const COMPLIANT_BLOCK: &str =
    block!("law = \"coulomb_associated\"\nfriction = 0.6\nnormal_stiffness = 1e8\nshear_stiffness = 5e7");
const SOFTENING_BLOCK: &str = block!(
    "law = \"cohesive\"\nfriction = 0.6\ntensile_strength = 2e4\ncohesion = 4e4\nnormal_stiffness = 1e9\n\
     shear_stiffness = 4e8\ntensile_fracture_energy = 10.0\nshear_fracture_energy = 40.0\n\
     [scene.mesh]\nelements = [1, 1]\norder = 1"
);
const PUSHED_TO_COLLAPSE: &str =
    live!("until = \"collapse\"", "block = \"a\", point = [0.0, 2.0], force = [1000.0, 0.0]");

/// Scenes of limit analysis.
pub const LIMIT_SCENES: &[KnownScene] = &[
    KnownScene::by_hand("block_tips", DRY_BLOCK, PUSHED_TO_COLLAPSE, TIPS),
    KnownScene::by_hand(
        "block_slides",
        block!("law = \"coulomb_associated\"\nfriction = 0.2"),
        live!("until = \"collapse\"", "block = \"a\", point = [0.0, 1.0], force = [1000.0, 0.0]"),
        SLIDES,
    ),
    KnownScene::by_hand(
        "block_falls_short_of_its_target",
        DRY_BLOCK,
        live!("factor = 8.0", "block = \"a\", point = [0.0, 2.0], force = [1000.0, 0.0]"),
        TIPS,
    ),
    KnownScene::by_hand(
        "block_stands_at_its_target",
        DRY_BLOCK,
        live!("factor = 2.5", "block = \"a\", point = [0.0, 2.0], force = [1000.0, 0.0]"),
        CARRIES_5,
    ),
    KnownScene::by_hand(
        "stack_tips",
        stack!("law = \"coulomb_associated\"\nfriction = 0.8"),
        live!("until = \"collapse\"", "block = \"b\", point = [0.0, 1.5], force = [1000.0, 0.0]"),
        Truth { mechanisms: &["rocking"], ..Truth::collapse(20.0 / 3.0) },
    ),
    KnownScene::by_hand(
        "two_blocks_tip",
        pair!("law = \"coulomb_associated\"\nfriction = 0.6"),
        PUSHED_PAIR,
        Truth { mechanisms: &[], unique: Some(false), ..TIPS },
    ),
    KnownScene {
        name: "ring",
        source: "two independent programs: 698.0226652123788",
        scene: RING,
        stages: RING_LIVE,
        solver: "",
        truth: Truth { mechanisms: &["four_hinge"], ..Truth::collapse(698.022_665_212_378_8) },
        reference: None,
    },
    KnownScene::by_hand(
        "block_is_pressed",
        DRY_BLOCK,
        live!("until = \"collapse\"", "block = \"a\", point = [0.5, 2.0], force = [0.0, -1000.0]"),
        Truth { endings: &[Status::Unbounded], ..Truth::collapse(f64::INFINITY) },
    ),
    KnownScene::by_hand(
        "block_slides_by_its_weight",
        DRY_BLOCK,
        "[[stages]]\nname = \"dead\"\ngravity = [8.0, -10.0]\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\n\
                 loads = [{ kind = \"point\", block = \"a\", point = [1.0, 1.0], force = [-2000.0, 0.0] }]",
        Truth { feasible: Some([3.0, 13.0]), ..LEANS },
    ),
    KnownScene {
        name: "block_is_lifted_between_walls",
        source: "by hand: the weight is lifted; walls press as much as they like",
        scene: "scene = \"blocks\"\nwidth = 1.0\nblocks = [\n\
             { name = \"ground\", vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]], fixed = true },\n\
             { name = \"left\", vertices = [[-1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [-1.0, 1.0]], fixed = true },\n\
             { name = \"right\", vertices = [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]], fixed = true },\n\
             { name = \"a\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] },\n]\n\
             [materials.stone]\nlaw = \"rigid\"\ndensity = 1000.0\n[joints.dry]\nlaw = \"coulomb\"\nfriction = 0.5",
        stages: live!("until = \"collapse\"", "block = \"a\", point = [0.5, 1.0], force = [0.0, 1000.0]"),
        solver: "",
        truth: Truth {
            endings: &[Status::Collapse, Status::Unbounded],
            collapse: [10.0, f64::INFINITY],
            associated: f64::INFINITY,
            mechanisms: &["sliding"],
            ..Truth::collapse(10.0)
        },
        reference: None,
    },
];

/// Scenes of paths.
pub const PATH_SCENES: &[KnownScene] = &[
    KnownScene {
        name: "ring",
        source: "two independent programs: 698.0226652123788",
        scene: "scene = \"arch\"\nprofile = { shape = \"segmental\", span = 9.42, rise = 2.99 }\nthickness = 0.6\n\
             width = 5.81\nvoussoirs = 15\nends = \"bonded\"\nmesh = { elements = [1, 1], order = 2 }\n[materials.stone]\n\
             law = \"rigid\"\ndensity = 2200.0\n[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = 0.6\n\
             normal_stiffness = 1e10\nshear_stiffness = 4e9",
        stages: RING_LIVE,
        solver: "kinematics = \"small\"",
        truth: Truth {
            endings: &[Status::Collapse, Status::LimitPoint],
            mechanisms: &["four_hinge"],
            limit_points: Some(&[698.022_665_212_378_8]),
            ..Truth::collapse(698.022_665_212_378_8)
        },
        reference: Some("event_path"),
    },
    KnownScene::by_hand_on_a_path("block_tips", COMPLIANT_BLOCK, PUSHED_TO_COLLAPSE, TIPS_ALONG_A_PATH),
    KnownScene::by_hand_on_a_path(
        "block_slides",
        block!("law = \"coulomb\"\nfriction = 0.2\nnormal_stiffness = 1e8\nshear_stiffness = 5e7"),
        live!("until = \"collapse\"", "block = \"a\", point = [0.0, 1.0], force = [1000.0, 0.0]"),
        Truth { endings: &[Status::Collapse, Status::LimitPoint], limit_points: Some(&[4.0]), ..SLIDES },
    ),
    KnownScene::by_hand_on_a_path(
        "block_falls_short_of_its_target",
        COMPLIANT_BLOCK,
        live!("factor = 8.0", "block = \"a\", point = [0.0, 2.0], force = [1000.0, 0.0]"),
        TIPS_ALONG_A_PATH,
    ),
    KnownScene::by_hand_on_a_path(
        "block_stands_at_its_target",
        COMPLIANT_BLOCK,
        live!("factor = 4.0", "block = \"a\", point = [0.0, 2.0], force = [1000.0, 0.0]"),
        Truth { limit_points: Some(&[]), ..CARRIES_5 },
    ),
    KnownScene::by_hand_on_a_path(
        "two_blocks_tip",
        pair!("law = \"coulomb_associated\"\nfriction = 0.6\nnormal_stiffness = 1e8\nshear_stiffness = 5e7"),
        PUSHED_PAIR,
        Truth { mechanisms: &[], unique: Some(false), ..TIPS_ALONG_A_PATH },
    ),
    KnownScene {
        name: "soft_block_tips",
        source: "by hand, to first order: its middle lifts at a lean of 24 mm, the corner carries W = K × 12 mm, K = 1e7/6 N/m",
        scene: block!(
            "law = \"coulomb_associated\"\nfriction = 0.6\nnormal_stiffness = 1e7\nshear_stiffness = 1e9\n\
             [scene.mesh]\nelements = [1, 1]\norder = 1"
        ),
        stages: PUSHED_TO_COLLAPSE,
        solver: "kinematics = \"finite\"\nstop = { displacement = 0.05 }",
        truth: Truth {
            endings: &[Status::Collapse, Status::LimitPoint],
            limit_points: Some(&[4.703_5]),
            associated: 5.0,
            tolerance: 1e-3,
            ..Truth::collapse(4.703_5)
        },
        reference: Some("newton_path"),
    },
    KnownScene {
        name: "two_blocks_snap_through",
        source: "least energy of two blocks on springs, by an independent program: 22.594774717",
        scene: "scene = \"arch\"\nprofile = { shape = \"segmental\", span = 4.0, rise = 0.1 }\nthickness = 0.4\nwidth = 1.0\n\
             voussoirs = 2\nends = \"jointed\"\nmesh = { elements = [1, 1] }\n[materials.stone]\nlaw = \"rigid\"\n\
             density = 2000.0\n[joints.dry]\nlaw = \"unilateral\"\ntangential = \"stuck\"\nnormal_stiffness = 1e8\n\
             shear_stiffness = 5e7",
        stages: "[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [\
             { kind = \"point\", span_fraction = 0.4, force = [0.0, -1000.0] }, \
             { kind = \"point\", span_fraction = 0.6, force = [0.0, -1000.0] }]",
        solver: "kinematics = \"finite\"\nstop = { displacement = 0.1 }",
        truth: Truth {
            endings: &[Status::Collapse, Status::LimitPoint],
            limit_points: Some(&[22.594_774_717]),
            associated: f64::INFINITY,
            ..Truth::collapse(22.594_774_717)
        },
        reference: Some("newton_path"),
    },
    KnownScene {
        name: "bond_softens",
        source: "by hand: the weight of 20 kN and a bond of 20 kPa on 1 m²",
        scene: SOFTENING_BLOCK,
        stages: live!("until = \"collapse\"", "block = \"a\", point = [0.5, 2.0], force = [0.0, 1000.0]"),
        solver: "kinematics = \"small\"\nstop = { factor = 30.0 }",
        truth: Truth {
            endings: &[Status::Collapse, Status::LimitPoint],
            limit_points: Some(&[40.0]),
            associated: f64::INFINITY,
            tolerance: 1e-6,
            ..Truth::collapse(40.0)
        },
        reference: Some("newton_path"),
    },
    KnownScene {
        name: "bond_reaches_its_strength",
        source: "by hand: the weight of 20 kN and a bond of 20 kPa on 1 m²",
        scene: SOFTENING_BLOCK,
        stages: live!("until = \"first_limit_point\"", "block = \"a\", point = [0.5, 2.0], force = [0.0, 1000.0]"),
        solver: "kinematics = \"small\"",
        truth: Truth {
            endings: &[Status::LimitPoint],
            limit_points: Some(&[40.0]),
            associated: f64::INFINITY,
            tolerance: 1e-6,
            ..Truth::collapse(40.0)
        },
        reference: Some("newton_path"),
    },
    KnownScene {
        name: "slab_moves_away",
        source: "by hand: a wall holds the block, and its corner leaves the slab after 0.5 of 0.8 m",
        scene: "scene = \"blocks\"\nwidth = 1.0\nblocks = [\n\
             { name = \"slab\", vertices = [[-0.5, -1.0], [2.5, -1.0], [2.5, 0.0], [-0.5, 0.0]], fixed = true },\n\
             { name = \"wall\", vertices = [[1.0, 0.5], [2.0, 0.5], [2.0, 1.0], [1.0, 1.0]], fixed = true },\n\
             { name = \"a\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]] },\n]\n\
             [scene.mesh]\nelements = [1, 1]\norder = 1\n[materials.stone]\nlaw = \"rigid\"\ndensity = 1000.0\n\
             [joints.dry]\nlaw = \"coulomb\"\nfriction = 0.2\nnormal_stiffness = 1e8\nshear_stiffness = 5e7",
        stages: "[[stages]]\nname = \"dead\"\ngravity = 10.0\n[[stages]]\nname = \"slide\"\n\
             settlement = [{ support = \"slab\", displacement = [0.8, 0.0] }]",
        solver: "kinematics = \"finite\"",
        truth: Truth {
            endings: &[Status::LimitPoint],
            limit_points: Some(&[0.625]),
            associated: f64::INFINITY,
            tolerance: 1e-3,
            ..Truth::collapse(0.625)
        },
        reference: Some("newton_path"),
    },
];
