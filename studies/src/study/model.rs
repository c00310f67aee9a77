//! A study as it was read: its cases, each with everything that is needed to solve it. How it is read
//! stands in [`super::load`].

use super::fnv::Fnv;
use super::numeric_keys::NumericKey;
use super::outline::Outline;
use super::resolved::Resolved;
use super::tables::{DrawnWord, Figures};
use crate::config::checked_keys::CheckedKeys;
use crate::config::expand::Expansion;
use crate::results::{Origin, this_program};
use serde_json::{Map, Value as Json};
use std::sync::Arc;
use voussoir_core::limit::LimitSolver;
use voussoir_core::model::{Assembly, Stage};
use voussoir_core::path::{PathSettings, PathSolver};

/// Who solves a case.
#[derive(Debug, Clone)]
pub enum SelectedSolver {
    /// The cheapest that answers, chosen by the cards of solvers.
    Auto,
    /// This limit solver, with its tag.
    Limit(String, Arc<dyn LimitSolver>),
    /// This path solver, with its tag.
    Path(String, Arc<dyn PathSolver>),
}

/// How a case is to be solved: `[solver]`, built.
#[derive(Debug, Clone)]
pub struct SolverChoice {
    /// Who solves it.
    pub solver: SelectedSolver,
    /// What a path solver is told; its tolerance is that of certificates too.
    pub settings: PathSettings,
    /// Who solves a stage that names its own limit solver, by index.
    pub of_stages: Vec<Option<SelectedSolver>>,
}

/// One case, ready to be solved.
#[derive(Debug, Clone)]
pub struct Case {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Name of its variant, if the study has variants.
    pub variant: Option<String>,
    /// Name of its scene, where the study compares several.
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Bodies and joints.
    pub assembly: Assembly,
    /// Loads, stage by stage.
    pub stages: Vec<Stage>,
    /// How it is to be solved.
    pub solver: SolverChoice,
    /// Whether force-displacement points are asked for.
    pub output_curve: bool,
    /// How many states of a path are kept.
    pub output_states: usize,
    /// Numbers with respect to which the load factor is differentiated; none unless that is asked for.
    pub output_sensitivities: Vec<NumericKey>,
    /// Whether the error of the load factor is estimated.
    pub output_accuracy: bool,
    /// True if results describe a load that is carried: forces of joints, reserve.
    pub output_joints: bool,
    /// For which of these loads results have the zone of thrust.
    pub output_zone: ZoneOfThrust,
    /// Whether results keep the forces and motions that prove them.
    pub output_fields: bool,
    /// Most numbers in the states of a path for which they are kept with the witnesses that prove its end; 0 keeps none.
    pub output_path_proofs: usize,
    /// Keys that were given and have no influence.
    pub notes: Vec<String>,
    /// One of many made from another case, which has the weights that both have: its results leave them out.
    pub brief: bool,
    /// The case's own study file: numbers in SI units, defaults filled in.
    pub resolved: Resolved,
}

impl Case {
    /// The hash of this case in results of this program.
    pub fn hash(&self) -> String {
        self.hash_in(this_program())
    }

    /// A hash of this case: commit, sources and plug-ins of the program, its label and its whole resolved study. It has 128
    /// bits of FNV-1a in hexadecimal. Tables enter with their own hashes, which cases share. It finds confused cases, not
    /// forged ones.
    pub fn hash_in(&self, origin: &Origin) -> String {
        let label = (self.id, &self.variant, &self.scene, &self.parameters);
        let mut hash = Fnv::of(&(origin.program(), label));
        self.resolved.add_hashes(&mut hash);
        hash.text()
    }
}

/// For which loads that are carried a result has the zone of thrust.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ZoneOfThrust {
    /// For none.
    #[default]
    Never,
    /// For scenes whose zone costs little.
    Cheap,
    /// For all.
    Always,
}

/// Which cases of a study are drawn, in figures and in the report.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Drawn {
    /// Every one.
    #[default]
    All,
    /// The worst of each variant.
    Worst,
    /// None.
    Nothing,
}

impl Drawn {
    /// Cases up to which all are drawn where a study does not say.
    const MOST: usize = 50;

    /// The value of the key `figures` in a study with this number of cases.
    pub(crate) fn of(key: Figures, cases: usize) -> Drawn {
        match key {
            Figures::Any(false) | Figures::These(DrawnWord::None) => Drawn::Nothing,
            Figures::These(DrawnWord::All) => Drawn::All,
            Figures::These(DrawnWord::Worst) => Drawn::Worst,
            Figures::Any(true) if cases > Drawn::MOST => Drawn::Worst,
            Figures::Any(true) => Drawn::All,
        }
    }

    /// Whether anything is drawn.
    pub fn anything(self) -> bool {
        self != Drawn::Nothing
    }
}

/// What is written besides the results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Output {
    /// Force-displacement points.
    pub curve: bool,
    /// Which cases are drawn.
    pub figures: Drawn,
    /// The load of an envelope on its way.
    pub animation: bool,
    /// Files for ParaView.
    pub vtu: bool,
    /// True if path_proofs.jsonl is asked for, false if it is not wanted; `None` leaves it to the number of cases.
    pub path_proofs: Option<bool>,
    /// Tags of the writers that are wanted; all where there is no list.
    pub writers: Option<Vec<String>>,
    /// Options of writers by tag, defaults filled in.
    pub options: Map<String, Json>,
}

/// A study file that holds no mistake.
#[derive(Debug, Clone)]
pub struct Study {
    /// Its name.
    pub name: String,
    /// What is done with the cases: the tag of a study kind.
    pub kind: String,
    /// Its axes and the table of its kind.
    pub outline: Outline,
    /// What is written.
    pub output: Output,
    /// All cases in order.
    pub cases: Vec<Case>,
    /// The file with `--set` applied. Values stand as they were written and defaults are not filled
    /// in, because a variant may change what a default or a specific weight means; read again, it
    /// makes exactly the same cases.
    pub resolved: toml::Value,
    /// Its base, variants, scenes and axes, from which cases are made.
    pub(crate) expansion: Expansion,
    /// What all of them share.
    pub(super) checked: CheckedKeys,
}
