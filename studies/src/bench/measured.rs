//! Measured data of a bench: problems, results and errors of the contestants.

use std::fmt;
use voussoir_study::results::CaseResult;

/// A setting that differs from the study: one rung of a ladder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refinement {
    /// `mesh`, `order`, `grading` or `steps`.
    pub ladder: &'static str,
    /// Order or grading; number of elements or length of steps, divided by the value in the study.
    pub value: f64,
}

impl fmt::Display for Refinement {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let by = if matches!(self.ladder, "mesh" | "steps") { "× " } else { "" };
        write!(f, "{} {by}{}", self.ladder, self.value)
    }
}

/// The measurement of one contestant for one problem.
#[derive(Debug, Clone)]
pub struct Measurement {
    /// Index of the problem.
    pub problem: usize,
    /// Name of the contestant.
    pub contestant: String,
    /// The setting that differs from the study, if one does.
    pub rung: Option<Refinement>,
    /// Relative error of the load factor. `None` if the contestant has failed or is the reference, or if there is no reference.
    pub error: Option<f64>,
    /// Least time of all runs \[s\].
    pub seconds: f64,
    /// Result of the contestant.
    pub result: CaseResult,
}

impl Measurement {
    /// Returns the load factor if the result is a certified collapse or limit point.
    pub fn factor(&self) -> Option<f64> {
        self.result.collapse_load()
    }
}

/// The measurement of another program.
#[derive(Debug, Clone, PartialEq)]
pub struct Other {
    /// Index of the problem.
    pub problem: usize,
    /// Name of the program.
    pub program: String,
    /// Its load factor.
    pub factor: f64,
    /// Its time \[s\].
    pub seconds: f64,
    /// Relative error of the load factor. `None` if there is no reference.
    pub error: Option<f64>,
}

/// A case of the study without its variant, with the reference of its errors.
#[derive(Debug, Clone, Default)]
pub struct Problem {
    /// Name of the study, if several are measured.
    pub class: String,
    /// Scene and swept values.
    pub name: String,
    /// Reference of the errors.
    pub reference: Option<Source>,
}

/// The load factor from which errors are measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// λ*.
    pub factor: f64,
    /// Its origin: a contestant, `given`, or an extrapolation.
    pub from: String,
    /// Greatest relative error of λ* if it is estimated.
    pub band: Option<f64>,
}

impl Source {
    /// Returns the relative error of a load factor, or its magnitude if λ* = 0.
    pub fn error_of(&self, factor: f64) -> f64 {
        if self.factor == 0.0 { factor.abs() } else { (factor / self.factor - 1.0).abs() }
    }
}

/// All measurements of a bench.
#[derive(Debug, Clone, Default)]
pub struct Bench {
    /// The problems.
    pub problems: Vec<Problem>,
    /// Measurements of every contestant, sorted by problem.
    pub measurements: Vec<Measurement>,
    /// Measurements of other programs.
    pub others: Vec<Other>,
    /// Contestants that cannot solve a problem: (problem, contestant, reason).
    pub refused: Vec<(usize, String, String)>,
    /// True if the bench was stopped before the last measurement.
    pub cut_short: bool,
}

/// Returns the name of a problem if several studies are measured.
pub(super) fn name_in(study: &str, problem: &str) -> String {
    if problem.is_empty() { study.to_string() } else { format!("{study}, {problem}") }
}

impl Bench {
    /// Adds the measurements of another study; the names of its problems get the name of the study.
    pub fn join(&mut self, name: &str, other: Bench) {
        let offset = self.problems.len();
        let named = |own: Problem| Problem { class: name.to_string(), name: name_in(name, &own.name), ..own };
        self.problems.extend(other.problems.into_iter().map(named));
        let moved = |own: Measurement| Measurement { problem: own.problem + offset, ..own };
        self.measurements.extend(other.measurements.into_iter().map(moved));
        self.refused.extend(other.refused.into_iter().map(|(problem, who, why)| (problem + offset, who, why)));
        self.cut_short |= other.cut_short;
    }
}
