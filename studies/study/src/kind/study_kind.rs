//! The trait of a study kind: how its files are read, how its cases are solved, and what it adds to results.

use crate::cases::{Observer, Unobserved, solve_cases};
use crate::checks::Agreement;
use crate::kind::{RESULTS, StoredResults};
use crate::results::{CaseLabel, CaseResult, Comparison, KindEntries};
use crate::study::{Case, Outline, ReadFile, Study, StudyError, StudySource};
use std::borrow::Cow;
use std::io::{Cursor, Read};
use voussoir_core::plugin::{Diagnostic, Parameter, PluginKind, Registered};

/// A kind of study, chosen by `kind = …`. Instances register with `inventory::submit! { KindEntry { … } }` beside their card.
/// The parameters of the card are the keys of the table with the name of the kind.
pub trait StudyKind: Sync {
    /// Reads a study file of this kind. A study with a scene is returned as `voussoir::kinds::SceneStudy`.
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError>;

    /// Like [`StudyKind::read`], if the study may name other files: `read` opens them, with paths relative to the study file.
    fn read_beside(&self, source: StudySource, read: ReadFile) -> Result<Box<dyn LoadedStudy>, StudyError> {
        let _ = read;
        self.read(source)
    }

    /// Returns all keys of its study files; `None` if they are the keys of studies with a scene. A kind with separate keys also
    /// offers [`Capability::OWN_FILE`](voussoir_core::plugin::Capability::OWN_FILE) on its card.
    fn file_keys(&self) -> Option<&'static [Parameter]> {
        None
    }

    /// Returns the mistakes in a study's axes and in the table of this kind, beyond mistakes of single keys.
    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        let _ = outline;
        Vec::new()
    }

    /// Solves the cases of a study whose ids are in `wanted`, in order of id, with `jobs` cases in parallel. The results do not
    /// depend on `jobs`. A kind that chooses values itself makes further cases by [`Study::at`]. Their ids come after the ids of
    /// the study, and [`StudyKind::case`] finds them again.
    fn solve(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        solve_cases(study, wanted, jobs, observer)
    }

    /// Returns true if [`StudyKind::solve`] makes cases besides the cases of the study.
    fn makes_cases(&self) -> bool {
        false
    }

    /// Returns the case of a result: a case of the study, or a case that this kind has made, from the parameters of the result.
    /// It needs no solver, so that `verify` and writers can call it.
    fn case<'a>(&self, study: &'a Study, label: &CaseLabel) -> Option<Cow<'a, Case>> {
        study.case(label.id)
    }

    /// Returns the parts of a result that [`StudyKind::own_results`] reads.
    fn needed(&self, result: &CaseResult) -> CaseResult {
        result.brief()
    }

    /// Returns the additions of this kind to the results of the cases. It is a pure function of its arguments, so that `verify`
    /// can repeat it.
    fn own_results(&self, study: &Study, cases: &[CaseResult]) -> OwnResults {
        let _ = (study, cases);
        OwnResults::default()
    }
}

/// The additions of a study kind to the results of the cases.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OwnResults {
    /// Comparison of the cases.
    pub comparison: Option<Comparison>,
    /// Other entries of results.json.
    pub entries: KindEntries,
}

/// A study of any kind without mistakes, as commands use it.
pub trait LoadedStudy: Send + Sync {
    /// Returns the name of the study.
    fn name(&self) -> &str;

    /// Returns the number of its cases.
    fn count(&self) -> usize;

    /// Returns the file with `--set` applied.
    fn resolved(&self) -> &toml::Value;

    /// Returns the file with `--set` applied as text; an error if TOML cannot represent it.
    fn resolved_text(&self) -> Result<String, String> {
        toml::to_string(self.resolved()).map_err(|error| error.to_string())
    }

    /// Returns notes for the user before the run; each note of its cases appears once.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// Describes the problem that will be solved.
    fn explain(&self) -> String;

    /// Returns the studies that are run before it, each into its own folder inside the folder of this study.
    fn parts(&self) -> &[Part] {
        &[]
    }

    /// Returns a piece of a page about results as HTML or SVG; `results` is the text of results.json. `None` if there is no such
    /// piece.
    fn piece(&self, results: &str, piece: Piece) -> Option<String> {
        let _ = (results, piece);
        None
    }

    /// Returns its first case as a study of the scene `blocks`. The error gives the reason if this is not possible.
    fn as_blocks(&self) -> Result<String, String> {
        Err("this study has no scene".into())
    }

    /// Returns the study if it has cases with a scene, which are solved and stored one by one.
    fn with_cases(&self) -> Option<&Study> {
        None
    }

    /// Solves the requested cases and returns all files in memory.
    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput;

    /// Checks stored results; an error if they cannot be read.
    fn verify_stored(&self, stored: &StoredResults, observer: &dyn Observer) -> Result<Verification, String>;

    /// Checks the text of a results.json alone.
    fn verify(&self, results: &str) -> Result<Verification, String> {
        let file = |name: &str| (name == RESULTS).then(|| Box::new(Cursor::new(results.to_string())) as Box<dyn Read>);
        self.verify_stored(&StoredResults { jobs: 1, file: &file }, &Unobserved)
    }
}

/// A study that is run for another study, which reports on it.
pub struct Part {
    /// Name of its folder.
    pub folder: String,
    /// Name of its file, for messages.
    pub file: String,
    /// The study.
    pub study: Box<dyn LoadedStudy>,
}

/// A piece of a page about a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Piece {
    /// The input: geometry, materials, joints, loads, solver.
    Record,
    /// The chart of all its cases.
    Chart,
    /// The scene of a case.
    Scene(usize),
    /// The mechanism of a case.
    Mechanism(usize),
    /// The load-displacement curve of a case.
    Curve(usize),
}

/// The request of a run.
#[derive(Debug, Clone, Default)]
pub struct RunRequest {
    /// Ids of the cases, in order.
    pub wanted: Vec<usize>,
    /// Number of cases in parallel.
    pub jobs: usize,
    /// The existing results.json, if stored cases that are not requested stay in the results.
    pub kept: Option<String>,
    /// Version of the program, for results.json.
    pub version: String,
    /// The day of the run, for results.json.
    pub date: Option<String>,
    /// The results.json of each of the study's parts, in order.
    pub parts: Vec<String>,
    /// True if no table is needed: it stays empty.
    pub quiet: bool,
}

/// The output of a run.
#[derive(Debug, Clone, Default)]
pub struct RunOutput {
    /// (file name relative to the result folder, bytes), in a fixed order.
    pub files: Vec<(String, Vec<u8>)>,
    /// The table for the terminal.
    pub table: String,
    /// Remarks for the user, line by line.
    pub remarks: Vec<String>,
    /// True if every case is answered and certified.
    pub certified: bool,
}

/// The findings of a check of results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Verification {
    /// Number of cases in the results.
    pub cases: usize,
    /// Number of stalled cases.
    pub stalled: usize,
    /// Mistakes by case.
    pub findings: Vec<(usize, String)>,
    /// Mistakes in the other files.
    pub files: Vec<String>,
    /// Number of the study's own cases in the results.
    pub own: usize,
    /// Number of cases of the study.
    pub of: usize,
    /// Number of cases whose ends are proved by stored paths, and number of these cases that were not solved again for this
    /// reason.
    pub paths: [usize; 2],
    /// The comparison with a second run.
    pub agreement: Agreement,
    /// Description of the checks.
    pub how: &'static str,
}

/// Connects a tag with a study kind.
pub struct KindEntry {
    /// The tag of its card.
    pub tag: &'static str,
    /// The study kind.
    pub kind: &'static dyn StudyKind,
}

voussoir_core::inventory::collect!(KindEntry);

voussoir_core::inventory::submit! {
    Registered { kind: PluginKind::StudyKind, names: |_| kinds().into_iter().map(|entry| entry.tag).collect() }
}

/// Returns all study kinds, sorted by tag.
pub fn kinds() -> Vec<&'static KindEntry> {
    let mut all: Vec<_> = voussoir_core::inventory::iter::<KindEntry>.into_iter().collect();
    all.sort_by_key(|entry| entry.tag);
    all
}

/// Returns the study kind with this tag.
pub fn kind(tag: &str) -> Option<&'static dyn StudyKind> {
    kinds().into_iter().find(|entry| entry.tag == tag).map(|entry| entry.kind)
}
