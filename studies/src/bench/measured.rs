//! What was measured: problems, contestants at them, errors.

use crate::results::CaseResult;

/// One contestant at one problem.
#[derive(Debug, Clone)]
pub struct Measurement {
    /// Index of the problem.
    pub problem: usize,
    /// Name of the contestant.
    pub contestant: String,
    /// Relative error of the load factor; `None` where it has failed, or is the reference, or there is none.
    pub error: Option<f64>,
    /// Seconds, the least of all runs.
    pub seconds: f64,
    /// The answer.
    pub result: CaseResult,
}

impl Measurement {
    /// The load factor, where it is a certified collapse or limit point.
    pub fn factor(&self) -> Option<f64> {
        self.result.collapse_load()
    }
}

/// A case of the study without its variant, with what its errors are measured from.
#[derive(Debug, Clone, Default)]
pub struct Problem {
    /// Scene and swept values.
    pub name: String,
    /// λ*, and where it is from.
    pub reference: Option<(f64, String)>,
}

/// What was measured.
#[derive(Debug, Clone, Default)]
pub struct Bench {
    /// The problems.
    pub problems: Vec<Problem>,
    /// Every contestant at every problem, problem after problem.
    pub measurements: Vec<Measurement>,
    /// Contestants that cannot answer a problem, and why: (problem, contestant, reason).
    pub refused: Vec<(usize, String, String)>,
    /// Whether it was ended before all was measured.
    pub cut_short: bool,
}

impl Bench {
    /// Adds what was measured of another study, whose problems get its name.
    pub fn join(&mut self, name: &str, other: Bench) {
        let offset = self.problems.len();
        let named = |own: Problem| {
            let name = if own.name.is_empty() { name.to_string() } else { format!("{name}, {}", own.name) };
            Problem { name, ..own }
        };
        self.problems.extend(other.problems.into_iter().map(named));
        let moved = |own: Measurement| Measurement { problem: own.problem + offset, ..own };
        self.measurements.extend(other.measurements.into_iter().map(moved));
        self.refused.extend(other.refused.into_iter().map(|(problem, who, why)| (problem + offset, who, why)));
        self.cut_short |= other.cut_short;
    }
}
