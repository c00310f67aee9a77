//! The order of answers by what they carry.

use super::case_result::CaseResult;
use voussoir_core::limit::Status;

/// The load factor as answers are compared: what carries any load, or stands, is infinite, what cannot carry its dead
/// load is −∞; `None` where there is no answer.
pub fn load_rank(case: &CaseResult) -> Option<f64> {
    match case.status {
        Status::NoEquilibrium => Some(f64::NEG_INFINITY),
        Status::Unbounded | Status::Stands => Some(f64::INFINITY),
        Status::Collapse | Status::LimitPoint => case.load_factor,
        Status::Stalled => None,
    }
}
