//! The request of `[optimise]`.

use crate::kinds::search::range_mistakes;
use serde_json::Value as Json;
use voussoir_core::limit::Status;
use voussoir_core::plugin::{Diagnostic, Keys};
use voussoir_study::results::CaseResult;
use voussoir_study::study::{Case, Outline};

/// Greatest number of independent parameters.
const MAX_PARAMETERS: usize = 8;
/// The ids of cases made from one case of the study start at a multiple of a power of ten, at least this one.
const LEAST_STRIDE: usize = 1000;
/// Number of cases, for each value of the scan, that a search can make.
const PER_VALUE: usize = 4;

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

/// A key that varies independently of others.
#[derive(Debug, Clone, PartialEq, Keys)]
pub(super) struct Range {
    /// path of the numeric key
    pub key: String,
    /// least value, in the unit of the key
    #[key(unit = "-")]
    pub from: f64,
    /// greatest value, in the unit of the key
    #[key(unit = "-")]
    pub to: f64,
}

/// An entry of `parameters`.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(untagged)]
pub(super) enum Varied {
    /// Path of a key that varies in lockstep with the others.
    Key(String),
    /// A key with its own range.
    Range(Range),
}

/// Keys that have one value, with its range.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    /// Paths of the keys.
    pub keys: Vec<String>,
    /// Least and greatest value.
    pub range: [f64; 2],
}

impl Axis {
    /// Returns the length of the range.
    pub fn length(&self) -> f64 {
        self.range[1] - self.range[0]
    }
}

/// `[optimise]`.
#[derive(Debug, Clone, Keys)]
pub(super) struct Request {
    /// path of the numeric key that varies, such as "scene.springing"
    #[key(optional = "parameters is given")]
    pub parameter: Option<String>,
    /// several keys: paths vary in lockstep; tables { key, from, to } vary independently
    #[key(len = ">= 1, <= 100", optional = "parameter is given")]
    pub parameters: Option<Vec<Varied>>,
    /// least value, in the unit of the key
    #[key(unit = "-", optional = "parameters are tables with their own ranges")]
    pub from: Option<f64>,
    /// greatest value, in the unit of the key
    #[key(unit = "-", optional = "parameters are tables with their own ranges")]
    pub to: Option<f64>,
    /// volume in m³ that the blocks keep, without fixed blocks; it needs several independent parameters
    #[key(unit = "-", range = "> 0", optional = "the volume is free")]
    pub volume: Option<f64>,
    /// maximise or minimise
    #[key(default = "maximise")]
    pub goal: Goal,
    /// result that is optimised
    #[key(optional = "load_factor for small displacements, first_limit_point for finite ones")]
    pub result: Option<Optimised>,
    /// number of values that are tried first
    #[key(range = ">= 2, <= MAX_SCAN", default = 41)]
    pub scan: usize,
    /// of the best value, as a share of the range from `from` to `to`
    #[key(unit = "-", range = "> 0, <= 1", default = 1e-3)]
    pub tolerance: f64,
    /// of the best result, as a share of it: the search ends if its neighbours do not permit a better one
    #[key(unit = "-", range = "> 0, <= 1", default = 1e-6)]
    pub accuracy: f64,
}

impl Request {
    /// Returns the independent parameters; empty if the table has mistakes.
    pub fn axes(&self) -> Vec<Axis> {
        let common = self.from.zip(self.to).map(|(from, to)| [from, to]);
        let lockstep = |keys: Vec<String>| common.map(|range| Axis { keys, range }).into_iter().collect();
        match (&self.parameter, &self.parameters) {
            (Some(key), None) => lockstep(vec![key.clone()]),
            (None, Some(varied)) => {
                let (mut keys, mut axes) = (Vec::new(), Vec::new());
                for entry in varied {
                    match entry {
                        Varied::Key(key) => keys.push(key.clone()),
                        Varied::Range(own) => {
                            axes.push(Axis { keys: vec![own.key.clone()], range: [own.from, own.to] });
                        }
                    }
                }
                match (keys.is_empty(), axes.is_empty()) {
                    (true, _) => axes,
                    (false, true) => lockstep(keys),
                    (false, false) => Vec::new(),
                }
            }
            _ => Vec::new(),
        }
    }

    /// Returns the mistakes in the combination of keys.
    pub fn mistakes(&self, outline: &Outline) -> Vec<Diagnostic> {
        let wrong = |key: &str, message: &str, help: &str| {
            let key = if key.is_empty() { "optimise".to_string() } else { format!("optimise.{key}") };
            vec![Diagnostic::new(key, message.to_string()).help(help.to_string())]
        };
        if self.parameter.is_some() == self.parameters.is_some() {
            let help =
                "[optimise] parameter = \"scene.springing\", from, to; several keys in lockstep: parameters = [...]";
            return wrong("", "needs parameter, or parameters, and not both", help);
        }
        let tables = self.parameters.iter().flatten().filter(|own| matches!(own, Varied::Range(_))).count();
        let help = "paths in lockstep: [\"a\", \"b\"] with from and to; independent: [{ key = \"a\", from = 0.0, to = 1.0 }, ...]";
        if tables > 0 && tables < self.parameters.iter().flatten().count() {
            return wrong("parameters", "mixes paths of keys and tables", help);
        }
        if tables > 0 && (self.from.is_some() || self.to.is_some()) {
            return wrong(if self.from.is_some() { "from" } else { "to" }, "is in each table of parameters", help);
        }
        if tables == 0 && (self.from.is_none() || self.to.is_none()) {
            return wrong(
                if self.from.is_none() { "from" } else { "to" },
                "is missing",
                "give the range of the parameter",
            );
        }
        if tables > MAX_PARAMETERS {
            return wrong(
                "parameters",
                &format!("has {tables} independent parameters, at most {MAX_PARAMETERS} are possible"),
                help,
            );
        }
        if self.volume.is_some() && tables < 2 {
            return wrong("volume", "needs at least two independent parameters", help);
        }
        let axes = self.axes();
        let mut found = Vec::new();
        for (i, axis) in axes.iter().enumerate() {
            let at = if tables > 0 { format!("optimise.parameters.{i}") } else { "optimise".into() };
            let named = match (tables > 0, &self.parameter) {
                (true, _) => format!("{at}.key"),
                (false, Some(_)) => "optimise.parameter".into(),
                (false, None) => "optimise.parameters".into(),
            };
            found.extend(range_mistakes([&at, &named], axis.range, &axis.keys, outline));
            if tables > 0 && axes[..i].iter().any(|other| other.keys == axis.keys) {
                found.push(Diagnostic::new(named, format!("\"{}\" appears twice", axis.keys[0])));
            }
        }
        found
    }

    /// Returns the distance of the first ids of the searches.
    pub fn stride(&self) -> usize {
        let mut stride = LEAST_STRIDE;
        while stride < PER_VALUE * self.scan {
            stride *= 10;
        }
        stride
    }

    /// Returns 1 to maximise, −1 to minimise.
    pub fn sense(&self) -> f64 {
        if self.goal == Goal::Minimise { -1.0 } else { 1.0 }
    }

    /// Returns the keys with their values; `point` has a value for each axis.
    pub fn values(axes: &[Axis], point: &[f64]) -> Vec<(String, Json)> {
        let of = |(axis, value): (&Axis, &f64)| axis.keys.iter().map(|key| (key.clone(), Json::from(*value))).collect();
        axes.iter().zip(point).flat_map(|pair| -> Vec<(String, Json)> { of(pair) }).collect()
    }

    /// Returns the merit of a result in the sense of the goal: greater is better. `None` if there is no finite result.
    pub fn merit(&self, case: &Case, result: &CaseResult) -> Option<f64> {
        Some(self.sense() * self.result_of(case, result)?)
    }

    /// Returns true if the first limit point is optimised.
    pub fn of_first_limit_point(&self, case: &Case) -> bool {
        match self.result {
            Some(result) => result == Optimised::FirstLimitPoint,
            None => case.solver.settings.finite,
        }
    }

    /// Returns the result that is optimised; `None` if it is not finite.
    pub fn result_of(&self, case: &Case, result: &CaseResult) -> Option<f64> {
        let first = self.of_first_limit_point(case);
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
