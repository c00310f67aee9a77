//! The request of `[optimise]`.

use serde_json::Value as Json;
use voussoir_core::limit::Status;
use voussoir_core::plugin::Keys;
use voussoir_study::results::CaseResult;
use voussoir_study::study::Case;

/// The ids of cases made from one case of the study start at a multiple of this number, after the ids of the study.
pub(super) const STRIDE: usize = 1_000_000;

/// Greatest number of values on the scan.
const MAX_SCAN: usize = 100_000;

/// The sense of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Goal {
    /// Greater is better.
    Maximise,
    /// Less is better.
    Minimise,
}

/// A result that is optimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Optimised {
    /// The load factor of the case.
    LoadFactor,
    /// The factor of its first limit point.
    FirstLimitPoint,
}

/// `[optimise]`.
#[derive(Debug, Clone, Keys)]
pub(super) struct Request {
    /// path of the numeric key that varies, such as "scene.springing"
    #[key(optional = "parameters is given")]
    pub parameter: Option<String>,
    /// paths of several keys that vary in lockstep
    #[key(len = ">= 1, <= 100", optional = "parameter is given")]
    pub parameters: Option<Vec<String>>,
    /// least value, in the unit of the key
    #[key(unit = "-")]
    pub from: f64,
    /// greatest value, in the unit of the key
    #[key(unit = "-")]
    pub to: f64,
    /// maximise or minimise
    #[key(default = "maximise")]
    pub goal: Goal,
    /// result that is optimised
    #[key(optional = "load_factor for small displacements, first_limit_point for finite ones")]
    pub result: Option<Optimised>,
    /// number of even values that are tried first
    #[key(range = ">= 2, <= MAX_SCAN", default = 41)]
    pub scan: usize,
    /// of the best value, as a share of the range from `from` to `to`
    #[key(unit = "-", range = "> 0, <= 1", default = 1e-3)]
    pub tolerance: f64,
}

impl Request {
    /// Returns the least and greatest value.
    pub fn range(&self) -> [f64; 2] {
        [self.from, self.to]
    }

    /// Returns the keys that vary.
    pub fn keys(&self) -> Vec<String> {
        self.parameters.iter().flatten().chain(&self.parameter).cloned().collect()
    }

    /// Returns 1 to maximise, −1 to minimise.
    pub fn sense(&self) -> f64 {
        if self.goal == Goal::Minimise { -1.0 } else { 1.0 }
    }

    /// Returns the keys, all with one value.
    pub fn values(&self, value: f64) -> Vec<(String, Json)> {
        self.keys().into_iter().map(|key| (key, value.into())).collect()
    }

    /// Returns the merit of a result in the sense of the goal: greater is better. `None` if there is no finite result.
    pub fn merit(&self, case: &Case, result: &CaseResult) -> Option<f64> {
        Some(self.sense() * self.result_of(case, result)?)
    }

    /// Returns the result that is optimised; `None` if it is not finite.
    pub fn result_of(&self, case: &Case, result: &CaseResult) -> Option<f64> {
        let first = match self.result {
            Some(result) => result == Optimised::FirstLimitPoint,
            None => case.solver.settings.finite,
        };
        let answer = result.load_factor.filter(|_| matches!(result.status, Status::Collapse | Status::LimitPoint));
        // A proved limit point is an answer, for any continuation of the path.
        let limit_point = result.path.first_limit_point.filter(|_| answer.is_some() || result.status == Status::Open);
        limit_point.filter(|_| first).or(answer)
    }

    /// Returns true if a case with this status has no bound, so that there is no optimum.
    pub fn without_bound(&self, status: Status) -> bool {
        match self.sense() > 0.0 {
            true => matches!(status, Status::Unbounded | Status::Stands),
            false => status == Status::NoEquilibrium,
        }
    }
}
