//! The order of results by the load that they carry.

use super::case_result::CaseResult;
use voussoir_core::limit::Status;

/// Returns the load factor for comparisons: infinite if any load is carried or the case stands, −∞ if the dead load is
/// not carried (a limit point of it has no load factor), `None` without a result.
pub fn load_rank(case: &CaseResult) -> Option<f64> {
    match case.status {
        Status::NoEquilibrium => Some(f64::NEG_INFINITY),
        Status::Unbounded | Status::Stands => Some(f64::INFINITY),
        Status::Collapse => case.load_factor,
        Status::LimitPoint => Some(case.load_factor.unwrap_or(f64::NEG_INFINITY)),
        // The proved lower bound is carried in any case. Without it, the upper bound is used.
        Status::Open => case.bounds.and_then(|[lower, upper]| lower.or(upper)),
        Status::Stalled => None,
    }
}

/// Smaller relative differences of load factors count as equal, for example those of a position and its mirror image.
const TIE: f64 = 1e-9;

/// Returns the case with the least load; among equal ones, the case with the lowest number.
pub fn least_of<'a>(cases: impl Iterator<Item = &'a CaseResult>) -> Option<&'a CaseResult> {
    let ranked: Vec<(f64, &CaseResult)> = cases.filter_map(|case| Some((load_rank(case)?, case))).collect();
    let least = ranked.iter().map(|(rank, _)| *rank).min_by(f64::total_cmp)?;
    let alike = |rank: f64| rank == least || (rank - least).abs() <= TIE * least.abs().min(rank.abs());
    ranked.into_iter().filter(|(rank, _)| alike(*rank)).map(|(_, case)| case).min_by_key(|case| case.label.id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::blank;

    #[test]
    fn of_cases_alike_the_first_is_the_least() {
        let case = |id: usize, factor: f64| CaseResult { load_factor: Some(factor), ..blank(id, Status::Collapse) };
        let cases = [case(3, 4.0), case(7, 2.0 * (1.0 - 1e-15)), case(5, 2.0), case(9, 2.0 * (1.0 + 1e-6))];
        assert_eq!(least_of(cases.iter()).map(|case| case.label.id), Some(5));
        let infinite = blank(4, Status::Unbounded);
        assert_eq!(least_of([&infinite].into_iter()).map(|case| case.label.id), Some(4));
        assert!(least_of([&blank(0, Status::Stalled)].into_iter()).is_none());
        let under_dead_load = blank(8, Status::LimitPoint);
        assert_eq!(least_of([&case(1, 0.1), &under_dead_load].into_iter()).map(|case| case.label.id), Some(8));
    }
}
