//! What `[optimise]` asks for.

use crate::results::CaseResult;
use crate::study::{Case, Outline};
use serde_json::Value as Json;
use voussoir_core::limit::Status;

/// Cases made from one case of the study have ids from a multiple of this on, after those of the study.
pub(super) const STRIDE: usize = 1_000_000;

/// `[optimise]`, read.
#[derive(Debug, Clone)]
pub(super) struct Request {
    pub keys: Vec<String>,
    pub range: [f64; 2],
    pub scan: usize,
    pub tolerance: f64,
    /// 1 to maximise, −1 to minimise.
    pub sense: f64,
    /// `load_factor` or `first_limit_point`; as the displacements say where there is none.
    pub result: Option<String>,
}

impl Request {
    pub fn of(outline: &Outline) -> Option<Self> {
        let table = &outline.table;
        let number = |key: &str| table.get(key)?.as_f64();
        let text = |key: &str| Some(table.get(key)?.as_str()?.to_string());
        let several = table.get("parameters").and_then(|list| serde_json::from_value(list.clone()).ok());
        Some(Request {
            keys: several.or_else(|| Some(vec![text("parameter")?]))?,
            range: [number("from")?, number("to")?],
            scan: table.get("scan").and_then(Json::as_u64).map_or(41, |scan| scan as usize),
            tolerance: number("tolerance").unwrap_or(1e-3),
            sense: if text("goal").as_deref() == Some("minimise") { -1.0 } else { 1.0 },
            result: text("result"),
        })
    }

    /// The keys, all at one value.
    pub fn values(&self, value: f64) -> Vec<(String, Json)> {
        self.keys.iter().map(|key| (key.clone(), value.into())).collect()
    }

    /// What an answer counts in the sense of the goal: better is greater. `None` where there is no finite result.
    pub fn merit(&self, case: &Case, result: &CaseResult) -> Option<f64> {
        Some(self.sense * self.result_of(case, result)?)
    }

    /// The result that is optimised; `None` where it is not finite.
    pub fn result_of(&self, case: &Case, result: &CaseResult) -> Option<f64> {
        let first = match self.result.as_deref() {
            Some(word) => word == "first_limit_point",
            None => case.solver.settings.finite,
        };
        let answer = result.load_factor.filter(|_| matches!(result.status, Status::Collapse | Status::LimitPoint));
        // A proved limit point is an answer, whatever lies beyond it.
        let limit_point = result.path.first_limit_point.filter(|_| answer.is_some() || result.status == Status::Open);
        limit_point.filter(|_| first).or(answer)
    }

    /// The statuses for which there is no optimum.
    pub fn without_bound(&self, status: Status) -> bool {
        match self.sense > 0.0 {
            true => matches!(status, Status::Unbounded | Status::Stands),
            false => status == Status::NoEquilibrium,
        }
    }
}
