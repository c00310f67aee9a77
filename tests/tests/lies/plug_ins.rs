//! Dishonest plug-ins, registered like any plug-in of another project. Each names the honest plug-in `of` that it is
//! made from, and its `lie`.

use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock, Mutex};
use voussoir::conformance::lies::{DishonestLimit, DishonestPath, DishonestStrategy, Lie};
use voussoir::core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, SettlementAnswer};
use voussoir::core::model::Wrenches;
use voussoir::core::path::{
    Constraint, Continuation, Increment, Monitor, PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver,
};
use voussoir::core::plugin::{Capability, Card, Need, Parameter, PluginKind, Shape};
use voussoir::core::{inventory, typetag};

/// Number of lies so far, by name.
static TOLD: LazyLock<Mutex<BTreeMap<String, usize>>> = LazyLock::new(Mutex::default);

/// Returns the number of times that a plug-in has used this lie.
pub fn told(kind: PluginKind, lie: &str) -> usize {
    TOLD.lock().map_or(0, |told| told.get(&format!("{kind:?} {lie}")).copied().unwrap_or(0))
}

/// Counts a lie when it is dropped, also in a panic.
struct Count(PluginKind, String, Arc<AtomicUsize>);

impl Drop for Count {
    fn drop(&mut self) {
        let panics = std::thread::panicking();
        let count = self.2.load(Ordering::Relaxed) + usize::from(panics);
        *TOLD.lock().expect("no panic while it is held").entry(format!("{:?} {}", self.0, self.1)).or_default() +=
            count;
    }
}

fn lie_of(kind: PluginKind, name: &str) -> Option<Lie> {
    Lie::of(kind).into_iter().find(|lie| lie.name() == name)
}

/// `solver = "lying_limit"`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LyingLimit {
    of: String,
    lie: String,
}

impl LyingLimit {
    fn solver(&self) -> DishonestLimit {
        let honest: Box<dyn LimitSolver> = serde_json::from_value(json!({ "solver": self.of })).expect("a solver");
        let lie = lie_of(PluginKind::LimitSolver, &self.lie);
        let lie = lie.map(|lie| if let Lie::Limit(lie) = lie { lie } else { unreachable!("a lie of limit solvers") });
        DishonestLimit { honest: Some(Arc::from(honest)), lie, ..Default::default() }
    }
}

#[typetag::serde(name = "lying_limit")]
impl LimitSolver for LyingLimit {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let solver = self.solver();
        let _count = Count(PluginKind::LimitSolver, self.lie.clone(), solver.told.clone());
        solver.solve(problem, question)
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        self.solver().refuses(problem)
    }

    fn settle(&self, problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]]) -> SettlementAnswer {
        self.solver().settle(problem, loads, openings)
    }
}

/// `solver = "lying_path"`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LyingPath {
    of: String,
    lie: String,
}

impl LyingPath {
    fn solver(&self) -> DishonestPath {
        let honest: Box<dyn PathSolver> = serde_json::from_value(json!({ "solver": self.of })).expect("a solver");
        let lie = lie_of(PluginKind::PathSolver, &self.lie);
        let lie = lie.map(|lie| if let Lie::Path(lie) = lie { lie } else { unreachable!("a lie of path solvers") });
        DishonestPath { honest: Some(Arc::from(honest)), lie, ..Default::default() }
    }
}

#[typetag::serde(name = "lying_path")]
impl PathSolver for LyingPath {
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
        let solver = self.solver();
        let _count = Count(PluginKind::PathSolver, self.lie.clone(), solver.told.clone());
        solver.trace(problem, settings, observer)
    }

    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String> {
        self.solver().refuses(problem, settings)
    }

    fn energy_tolerance(&self) -> f64 {
        self.solver().energy_tolerance()
    }
}

/// `strategy = "lying_strategy"`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LyingStrategy {
    of: String,
    lie: String,
    #[serde(skip)]
    asked: Arc<AtomicUsize>,
}

impl LyingStrategy {
    fn strategy(&self) -> DishonestStrategy {
        let honest: Box<dyn Continuation> = serde_json::from_value(json!({ "strategy": self.of })).expect("a strategy");
        let lie = lie_of(PluginKind::Continuation, &self.lie);
        let lie = lie.map(|lie| if let Lie::Strategy(lie) = lie { lie } else { unreachable!("a lie of strategies") });
        DishonestStrategy { honest: Some(Arc::from(honest)), lie, asked: self.asked.clone() }
    }
}

#[typetag::serde(name = "lying_strategy")]
impl Continuation for LyingStrategy {
    fn monitors(&self) -> Vec<Monitor> {
        self.strategy().monitors()
    }

    fn constraint(&self, increment: &Increment, previous: Option<&Increment>) -> Constraint {
        self.strategy().constraint(increment, previous)
    }

    fn passes_limit_points(&self) -> bool {
        self.strategy().passes_limit_points()
    }

    fn first_step(&self) -> f64 {
        self.strategy().first_step()
    }

    fn largest_step(&self) -> f64 {
        self.strategy().largest_step()
    }
}

const KEYS: &[Parameter] = &[
    Parameter { name: "of", doc: "the honest plug-in", shape: Shape::Text, need: Need::Required },
    Parameter { name: "lie", doc: "the lie", shape: Shape::Text, need: Need::Required },
];

pub const LIAR: Card = Card {
    summary: "a lie",
    parameters: KEYS,
    file: file!(),
    page: "# A lie\n\nMade from the answer of an honest plug-in.\n",
    ..Card::BLANK
};

inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "lying_limit",
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        provides: &[Capability::NON_ASSOCIATED],
        ..LIAR
    }
}

inventory::submit! {
    Card {
        kind: PluginKind::PathSolver,
        tag: "lying_path",
        requires: &[&[Capability::FACETS, Capability::RESPONSE]],
        provides: &[Capability::FINITE_DISPLACEMENTS, Capability::SETTLEMENT],
        ..LIAR
    }
}

inventory::submit! {
    Card { kind: PluginKind::Continuation, tag: "lying_strategy", ..LIAR }
}
