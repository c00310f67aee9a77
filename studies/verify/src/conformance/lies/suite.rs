//! A solver or strategy under test: its own answers, and the answers of dishonest solvers made from it.

use super::limit_liar::{DishonestLimit, limit_lies};
use super::limit_lie::LimitLie;
use super::path_liar::{DishonestPath, path_lies};
use super::path_lie::PathLie;
use super::scenes::{KnownScene, LIMIT_SCENES, PATH_SCENES};
use super::strategy_lies::{DishonestStrategy, STRATEGY_LIES, StrategyLie};
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::sync::mpsc::channel;
use std::time::Duration;
use voussoir_core::plugin::{PluginKind, WithoutCard};
use voussoir_study::cases::solve_case;
use voussoir_study::results::CaseResult;
use voussoir_study::study::{Case, SelectedSolver};

// No study names the dishonest plug-ins.
voussoir_core::inventory::submit! { WithoutCard { kind: PluginKind::LimitSolver, name: "dishonest_limit" } }
voussoir_core::inventory::submit! { WithoutCard { kind: PluginKind::PathSolver, name: "dishonest_path" } }
voussoir_core::inventory::submit! { WithoutCard { kind: PluginKind::Continuation, name: "dishonest_strategy" } }

/// Stack of the thread in which a case is solved \[bytes\]: the usual stack of a program's first thread.
const STACK: usize = 8 << 20;

/// A lie of any kind.
#[derive(Debug, Clone, Copy)]
pub enum Lie {
    /// A lie of a limit solver.
    Limit(&'static LimitLie),
    /// A lie of a path solver.
    Path(&'static PathLie),
    /// A lie of a continuation strategy.
    Strategy(&'static StrategyLie),
}

impl Lie {
    /// Returns all lies for a kind of plug-in.
    pub fn of(kind: PluginKind) -> Vec<Lie> {
        match kind {
            PluginKind::LimitSolver => limit_lies().map(Lie::Limit).collect(),
            PluginKind::PathSolver => path_lies().map(Lie::Path).collect(),
            PluginKind::Continuation => STRATEGY_LIES.iter().map(Lie::Strategy).collect(),
            _ => Vec::new(),
        }
    }

    /// Returns the name of the lie.
    pub fn name(&self) -> &'static str {
        match self {
            Lie::Limit(lie) => lie.name,
            Lie::Path(lie) => lie.name,
            Lie::Strategy(lie) => lie.name,
        }
    }

    /// Replaces the honest plug-in by the dishonest one and returns its counter of lies. Returns `None` if the case has no such
    /// plug-in.
    pub fn put_into(self, case: &mut Case) -> Option<Arc<AtomicUsize>> {
        let told = Arc::<AtomicUsize>::default();
        let counter = told.clone();
        let choice = &mut case.solver;
        match (self, &choice.solver, &choice.settings.continuation) {
            (Lie::Limit(lie), SelectedSolver::Limit(_, honest), _) => {
                let solver =
                    DishonestLimit { honest: Some(honest.clone()), lie: Some(lie), told, ..Default::default() };
                choice.solver = SelectedSolver::Limit("dishonest_limit".into(), Arc::new(solver));
            }
            (Lie::Path(lie), SelectedSolver::Path(_, honest), _) => {
                let solver = DishonestPath { honest: Some(honest.clone()), lie: Some(lie), told, ..Default::default() };
                choice.solver = SelectedSolver::Path("dishonest_path".into(), Arc::new(solver));
            }
            (Lie::Strategy(lie), _, Some(honest)) => {
                let strategy = DishonestStrategy { honest: Some(honest.clone()), lie: Some(lie), asked: told };
                choice.settings.continuation = Some(Arc::new(strategy));
            }
            _ => return None,
        }
        Some(counter)
    }
}

/// Returns the scenes for a kind of plug-in. Dishonest strategies take many steps, so the ring, which is the first scene, is
/// omitted for them.
pub fn scenes(kind: PluginKind) -> &'static [KnownScene] {
    match kind {
        PluginKind::LimitSolver => LIMIT_SCENES,
        PluginKind::PathSolver => PATH_SCENES,
        _ => &PATH_SCENES[1..],
    }
}

/// Returns the keys of `[solver]` that name a plug-in.
pub fn solver_keys(kind: PluginKind, tag: &str) -> String {
    match kind {
        PluginKind::Continuation => {
            format!("solver = \"newton_path\"\ncontinuation = {{ strategy = \"{tag}\" }}")
        }
        _ => format!("solver = \"{tag}\""),
    }
}

/// Returns the answer to a case; `None` after the time limit. A solver cannot be stopped from outside: its thread runs until
/// the program ends.
pub fn answered_within(limit: Duration, case: Case) -> Option<CaseResult> {
    let (sender, receiver) = channel();
    let solve = move || _ = sender.send(solve_case(&case));
    std::thread::Builder::new().stack_size(STACK).spawn(solve).ok()?;
    receiver.recv_timeout(limit).ok()
}

/// Returns the result of our own solver, which is compared with the paths of a scene.
pub fn reference(scene: &KnownScene) -> Option<CaseResult> {
    let case = scene.case(&format!("solver = \"{}\"", scene.reference?)).ok()?;
    Some(solve_case(&case)).filter(|result| result.certificate.passed)
}
