//! A study after reading: its cases, each with all data that are needed to solve it. [`super::load`] reads it.

use super::numeric_keys::NumericKey;
use super::outline::Outline;
use super::resolved::Resolved;
use super::space::SpaceCase;
use super::tables::{DrawnWord, Figures, RecordTable};
use crate::config::checked_keys::CheckedKeys;
use crate::config::checked_value::hash_of;
use crate::config::expand::Expansion;
use crate::results::{Origin, this_program};
use serde_json::{Map, Value as Json};
use std::sync::Arc;
use voussoir_core::limit::LimitSolver;
use voussoir_core::model::{Assembly, Stage};
use voussoir_core::path::{PathSettings, PathSolver};

/// The solver of a case.
#[derive(Debug, Clone)]
pub enum SelectedSolver {
    /// Chosen automatically: the fastest solver that supports the case, by the cards of the solvers.
    Auto,
    /// This limit solver, with its tag.
    Limit(String, Arc<dyn LimitSolver>),
    /// This path solver, with its tag.
    Path(String, Arc<dyn PathSolver>),
}

/// The table `[solver]` with its plug-ins.
#[derive(Debug, Clone)]
pub struct SolverChoice {
    /// The solver of the case.
    pub solver: SelectedSolver,
    /// Settings of a path solver; certificates use the same tolerance.
    pub settings: PathSettings,
    /// The solver of each stage, by index; `None` if the stage does not name a limit solver.
    pub of_stages: Vec<Option<SelectedSolver>>,
}

/// One case with all data for its solution.
#[derive(Debug, Clone)]
pub struct Case {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Name of its variant, if the study has variants.
    pub variant: Option<String>,
    /// Name of its scene, if the study compares several.
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Bodies and joints of a plane scene; without bodies if the scene is in space.
    pub assembly: Assembly,
    /// The scene in space with its loads; `None` for a plane scene.
    pub space: Option<Arc<SpaceCase>>,
    /// Loads, stage by stage.
    pub stages: Vec<Stage>,
    /// Solver and settings.
    pub solver: SolverChoice,
    /// True if force-displacement points are requested.
    pub output_curve: bool,
    /// Number of states of a path that are kept.
    pub output_states: usize,
    /// Numbers with respect to which the load factor is differentiated; empty unless this is requested.
    pub output_sensitivities: Vec<NumericKey>,
    /// True if the error of the load factor is estimated.
    pub output_accuracy: bool,
    /// True if results describe a load that is carried: forces of joints, reserve.
    pub output_joints: bool,
    /// Selects the carried loads for which results contain the zone of thrust.
    pub output_zone: ZoneOfThrust,
    /// True if results contain the forces and motions that prove them.
    pub output_fields: bool,
    /// Greatest number of numbers in the states of a path for which the states and the witnesses of its end are kept; 0 keeps
    /// none.
    pub output_path_proofs: usize,
    /// Notes, such as keys that are given but unused.
    pub notes: Vec<String>,
    /// True for one of many cases made from another case: its results omit the weights that both share.
    pub brief: bool,
    /// The case's own study file: numbers in SI units, defaults filled in.
    pub resolved: Resolved,
}

impl Case {
    /// Returns the hash of this case in results of this program.
    pub fn hash(&self) -> String {
        self.hash_in(this_program())
    }

    /// Returns a hash of this case: commit, sources and plug-ins of the program, its label and its whole resolved study. It is
    /// 128 bits of FNV-1a in hexadecimal. Tables contribute their own hashes, which cases share. The hash detects confused
    /// cases, not forged ones.
    pub fn hash_in(&self, origin: &Origin) -> String {
        let label = (self.id, &self.variant, &self.scene, &self.parameters);
        let mut hash = hash_of(&(origin.program(), label));
        self.resolved.add_hashes(&mut hash);
        hash.text()
    }
}

/// Selects the carried loads for which a result contains the zone of thrust.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ZoneOfThrust {
    /// No zone is computed.
    #[default]
    Never,
    /// Scenes whose zone is cheap to compute.
    Cheap,
    /// All carried loads.
    Always,
}

/// Selects the cases of a study that are drawn, in figures and in the report.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Drawn {
    /// All cases.
    #[default]
    All,
    /// The worst case of each variant.
    Worst,
    /// No case.
    Nothing,
}

impl Drawn {
    /// Greatest number of cases that are all drawn by default.
    const MOST: usize = 50;

    /// Returns the value of the key `figures` for a study with this number of cases.
    pub fn of(key: Figures, cases: usize) -> Drawn {
        match key {
            Figures::Any(false) | Figures::These(DrawnWord::None) => Drawn::Nothing,
            Figures::These(DrawnWord::All) => Drawn::All,
            Figures::These(DrawnWord::Worst) => Drawn::Worst,
            Figures::Any(true) if cases > Drawn::MOST => Drawn::Worst,
            Figures::Any(true) => Drawn::All,
        }
    }

    /// Returns true if some case is drawn.
    pub fn anything(self) -> bool {
        self != Drawn::Nothing
    }
}

/// Output besides the results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Output {
    /// Force-displacement points.
    pub curve: bool,
    /// Selection of the cases that are drawn.
    pub figures: Drawn,
    /// True if an envelope has a drawing of its moving load.
    pub animation: bool,
    /// True if files for ParaView are written.
    pub vtu: bool,
    /// True if path_proofs.jsonl is written, false if not; `None` decides by the number of cases.
    pub path_proofs: Option<bool>,
    /// Tags of the requested writers; `None` for all.
    pub writers: Option<Vec<String>>,
    /// Options of writers by tag, defaults filled in.
    pub options: Map<String, Json>,
}

/// A study file without mistakes.
#[derive(Debug, Clone)]
pub struct Study {
    /// Its name.
    pub name: String,
    /// Tag of the study kind.
    pub kind: String,
    /// Axes of the study and the table of its kind.
    pub outline: Outline,
    /// Head of the report, if the study has one.
    pub record: Option<RecordTable>,
    /// Output settings.
    pub output: Output,
    /// All cases in order, if they are kept in memory. The list is empty if the study was read one case at a time:
    /// [`Study::case`] makes a case.
    pub cases: Vec<Case>,
    /// Different notes of the cases, at most 100.
    pub notes: Vec<String>,
    /// The file with `--set` applied. Values are unchanged and defaults are not filled in, because a variant may change the
    /// meaning of a default or of a specific weight. If this file is read again, it gives exactly the same cases.
    pub resolved: toml::Value,
    /// Base, variants, scenes and axes, from which cases are made.
    pub(crate) expansion: Expansion,
    /// Checked keys that all cases share.
    pub(crate) checked: CheckedKeys,
}
