//! A user-defined scene, kind of load, limit solver and continuation strategy.

use serde_json::json;
use voussoir::loads::{LoadKind, LoadSite, Placed};
use voussoir::solvers::limit::conic::LimitConic;
use voussoir_plug::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver};
use voussoir_plug::model::geometry::Vec2;
use voussoir_plug::model::{Assembly, Catalogue, Scene};
use voussoir_plug::path::{Constraint, Continuation, Increment};
use voussoir_plug::plugin::{Capability, Card, Diagnostic, Keys, PluginKind, STANDARD_GRAVITY, Sample};
use voussoir_plug::{inventory, typetag};

/// `scene = "tower"`: equal blocks on each other, each `lean` further to the right than the one below.
#[derive(Debug, Keys)]
pub struct Tower {
    /// number of blocks
    #[key(range = ">= 1, <= 1000")]
    blocks: usize,
    /// size of a block
    #[key(names = ["length", "height"], unit = "m", range = "> 0")]
    block: [f64; 2],
    /// step to the right from block to block
    #[key(unit = "m", default = 0.0)]
    lean: f64,
    /// width out of plane
    #[key(unit = "m", range = "> 0", default = 1.0)]
    width: f64,
}

#[typetag::serde(name = "tower")]
impl Scene for Tower {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        let [length, height] = self.block;
        if self.lean.abs() >= length {
            return Err(vec![Diagnostic::new("scene.lean", "blocks would not stand on each other")]);
        }
        let box_at = |x: f64, y: f64, l: f64, h: f64| json!([[x, y], [x + l, y], [x + l, y + h], [x, y + h]]);
        let wide = length + self.lean.abs() * self.blocks as f64;
        let mut blocks =
            vec![json!({ "name": "ground", "fixed": true, "vertices": box_at(-wide, -height, 3.0 * wide, height) })];
        blocks.extend((0..self.blocks).map(|i| {
            let corner = [self.lean * i as f64, height * i as f64];
            json!({ "name": format!("block {i}"), "vertices": box_at(corner[0], corner[1], length, height) })
        }));
        let scene =
            json!({ "scene": "blocks", "width": self.width, "material": "stone", "joint": "dry", "blocks": blocks });
        let scene: Box<dyn Scene> = serde_json::from_value(scene).expect("a scene of blocks");
        scene.build(catalogue)
    }
}

inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "tower",
        summary: "equal blocks on each other, each further to the right",
        samples: &[Sample::keys("blocks = 3\nblock = [0.4, 0.2]\nlean = 0.05")],
        file: file!(),
        package: voussoir_plug::package!(),
        page: "# `tower`\n\nA stack that leans.\n",
        ..Card::of::<Tower>()
    }
}

/// `kind = "quake"`: a share of their weight pushes all blocks to the right.
#[derive(Debug, Keys)]
pub struct Quake {
    /// share of the weight, to the right
    #[key(unit = "-")]
    share: f64,
}

#[typetag::serde(name = "quake")]
impl LoadKind for Quake {
    fn place(&self, _: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        Ok(Placed { accelerations: vec![Vec2::new(self.share * STANDARD_GRAVITY, 0.0)], ..Placed::default() })
    }
}

inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "quake",
        summary: "a share of all weights, to the right",
        samples: &[Sample::keys("share = 0.1")],
        file: file!(),
        package: voussoir_plug::package!(),
        page: "# `quake`\n\nA share of all weights, to the right.\n",
        ..Card::of::<Quake>()
    }
}

/// `solver = "counted_conic"`: the conic program, which also counts its calls. `auto` chooses the cheapest solver that
/// does not refuse; here it is this one.
#[derive(Debug, Keys)]
pub struct CountedConic {}

#[typetag::serde(name = "counted_conic")]
impl LimitSolver for CountedConic {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let mut answer = LimitConic {}.solve(problem, question);
        answer.counters.insert("asked".into(), 1);
        answer
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        LimitConic {}.refuses(problem)
    }
}

inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "counted_conic",
        summary: "limit_conic, which counts how often it is asked",
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        cost: Some(0),
        file: file!(),
        package: voussoir_plug::package!(),
        page: "# `counted_conic`\n\nAs `limit_conic`.\n",
        ..Card::of::<CountedConic>()
    }
}

/// `strategy = "taxicab"`: the sum of the displacement and of the load factor of a step equals its length.
#[derive(Debug, Clone, Keys)]
pub struct Taxicab {
    /// first step of a load step
    #[key(unit = "-", range = "> 0", default = 0.1)]
    first_step: f64,
}

#[typetag::serde(name = "taxicab")]
impl Continuation for Taxicab {
    fn constraint(&self, increment: &Increment, _: Option<&Increment>) -> Constraint {
        let value = increment.motion + increment.factor.abs();
        let derivative = Increment { motion: 1.0, factor: increment.factor.signum(), ..Increment::default() };
        Constraint { value, derivative }
    }

    fn first_step(&self) -> f64 {
        self.first_step
    }
}

inventory::submit! {
    Card {
        kind: PluginKind::Continuation,
        tag: "taxicab",
        summary: "movement plus load factor",
        file: file!(),
        package: voussoir_plug::package!(),
        page: "# `taxicab`\n\nMovement plus load factor.\n",
        ..Card::of::<Taxicab>()
    }
}
