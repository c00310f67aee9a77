//! What a study kind is: how its files are read, what it does with cases, and what it adds to results.

use super::stored_results::{RESULTS, StoredResults};
use crate::results::{CaseLabel, CaseResult, Comparison};
use crate::solve::{Observer, Unobserved, solve_cases};
use crate::study::{Case, Outline, ReadFile, Study, StudyError, StudySource};
use crate::verify::Agreement;
use serde_json::{Map, Value as Json};
use std::borrow::Cow;
use std::io::{Cursor, Read};
use voussoir_core::plugin::{Diagnostic, Parameter};

/// A kind of study, chosen by `kind = …`. Instances register with
/// `inventory::submit! { KindEntry { … } }` beside their card. The card's parameters are the keys of the
/// table that is called like the kind.
pub trait StudyKind: Sync {
    /// Reads a study file of this kind.
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError>;

    /// The same where files that the study names can be read: relative to its own, by `read`.
    fn read_beside(&self, source: StudySource, read: ReadFile) -> Result<Box<dyn LoadedStudy>, StudyError> {
        let _ = read;
        self.read(source)
    }

    /// All keys of its study files, where they are not those of studies with a scene.
    fn file_keys(&self) -> Option<&'static [Parameter]> {
        None
    }

    /// Mistakes in a study's axes and in the table of this kind, beyond those of single keys.
    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        let _ = outline;
        Vec::new()
    }

    /// Solves the cases of a study whose ids are in `wanted`, in order of id. `jobs` cases side by
    /// side; the results do not depend on it. A kind that chooses values itself makes further cases
    /// by [`Study::at`], gives them ids after those of the study, and finds them again by [`StudyKind::case`].
    fn solve(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        solve_cases(study, wanted, jobs, observer)
    }

    /// Whether [`StudyKind::solve`] makes cases besides those of the study.
    fn makes_cases(&self) -> bool {
        false
    }

    /// The case that a result belongs to: one of the study's, or one that this kind has made, which the result's
    /// parameters describe. Without the solver, so that `verify` and writers can ask.
    fn case<'a>(&self, study: &'a Study, label: &CaseLabel) -> Option<Cow<'a, Case>> {
        study.case(label.id)
    }

    /// What this kind adds to the results of the cases; a pure function of its arguments, so that
    /// `verify` can repeat it.
    fn own_results(&self, study: &Study, cases: &[CaseResult]) -> OwnResults {
        let _ = (study, cases);
        OwnResults::default()
    }
}

/// What a study kind adds to the results of the cases.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OwnResults {
    /// The cases beside each other.
    pub comparison: Option<Comparison>,
    /// Other entries of results.json, by name.
    pub other: Map<String, Json>,
}

/// A study of any kind, free of mistakes, as commands see it.
pub trait LoadedStudy: Send + Sync {
    /// Its name.
    fn name(&self) -> &str;

    /// Number of its cases.
    fn count(&self) -> usize;

    /// The file with `--set` applied.
    fn resolved(&self) -> &toml::Value;

    /// The same as text; an error where TOML cannot hold it.
    fn resolved_text(&self) -> Result<String, String> {
        toml::to_string(self.resolved()).map_err(|error| error.to_string())
    }

    /// What a user should know before it is run: each note of its cases once.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// What will be solved, in words.
    fn explain(&self) -> String;

    /// Studies that are run before it, each into a folder of its own inside this study's.
    fn parts(&self) -> &[Part] {
        &[]
    }

    /// A piece of a page about the results whose results.json is given, as HTML or SVG; `None` where there is no such
    /// piece.
    fn piece(&self, results: &str, piece: Piece) -> Option<String> {
        let _ = (results, piece);
        None
    }

    /// Its first case as a study of the scene `blocks`; an error says why there is none.
    fn as_blocks(&self) -> Result<String, String> {
        Err("this study has no scene".into())
    }

    /// The study, if it has cases with a scene, which are solved and stored one by one.
    fn with_cases(&self) -> Option<&Study> {
        None
    }

    /// Solves what is wanted and turns it into files, all of them held.
    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput;

    /// Checks stored results; an error where they cannot be read.
    fn verify_stored(&self, stored: &StoredResults, observer: &dyn Observer) -> Result<Verification, String>;

    /// Checks the text of a results.json alone.
    fn verify(&self, results: &str) -> Result<Verification, String> {
        let file = |name: &str| (name == RESULTS).then(|| Box::new(Cursor::new(results.to_string())) as Box<dyn Read>);
        self.verify_stored(&StoredResults { jobs: 1, file: &file }, &Unobserved)
    }
}

/// A study that is run for another one, which reports on it.
pub struct Part {
    /// Name of its folder.
    pub folder: String,
    /// Name of its file, for messages.
    pub file: String,
    /// The study.
    pub study: Box<dyn LoadedStudy>,
}

/// What a page can show of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Piece {
    /// What was given: geometry, materials, joints, loads, solver.
    Record,
    /// The chart of all its cases.
    Chart,
    /// The scene of a case.
    Scene(usize),
    /// Its mechanism.
    Mechanism(usize),
    /// Its load-displacement curve.
    Curve(usize),
}

/// What is asked of a run.
#[derive(Debug, Clone, Default)]
pub struct RunRequest {
    /// Ids of the cases, in order.
    pub wanted: Vec<usize>,
    /// Cases side by side.
    pub jobs: usize,
    /// The results.json that is there, if stored cases that are not wanted stay in the results.
    pub kept: Option<String>,
    /// Version of the program, for results.json.
    pub version: String,
    /// The day of the run, for results.json.
    pub date: Option<String>,
    /// The results.json of each of the study's parts, in order.
    pub parts: Vec<String>,
    /// Whether nobody reads the table: it stays empty.
    pub quiet: bool,
}

/// What a run has made.
#[derive(Debug, Clone, Default)]
pub struct RunOutput {
    /// (file name relative to the result folder, bytes), in a fixed order.
    pub files: Vec<(String, Vec<u8>)>,
    /// The table for the terminal.
    pub table: String,
    /// What a user should know of the run, line by line.
    pub remarks: Vec<String>,
    /// Whether every case is answered and certified.
    pub certified: bool,
}

/// What a check of results has found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Verification {
    /// Number of cases in the results.
    pub cases: usize,
    /// How many of them are stalled.
    pub stalled: usize,
    /// What is wrong, by case.
    pub findings: Vec<(usize, String)>,
    /// What is wrong with the other files.
    pub files: Vec<String>,
    /// Number of the study's own cases that are in the results.
    pub own: usize,
    /// Number of cases of the study.
    pub of: usize,
    /// Number of cases whose ends are proved by stored paths, and of those that were not solved again for that.
    pub paths: [usize; 2],
    /// The comparison with a second run.
    pub agreement: Agreement,
    /// What was checked how.
    pub how: &'static str,
}

/// Connects a tag with a study kind.
pub struct KindEntry {
    /// The tag of its card.
    pub tag: &'static str,
    /// What answers.
    pub kind: &'static dyn StudyKind,
}

voussoir_core::inventory::collect!(KindEntry);

/// All study kinds, sorted by tag.
pub fn kinds() -> Vec<&'static KindEntry> {
    let mut all: Vec<_> = voussoir_core::inventory::iter::<KindEntry>.into_iter().collect();
    all.sort_by_key(|entry| entry.tag);
    all
}

/// The study kind with this tag.
pub fn kind(tag: &str) -> Option<&'static dyn StudyKind> {
    kinds().into_iter().find(|entry| entry.tag == tag).map(|entry| entry.kind)
}
