//! The search for the worst place of one run: a scan, then golden sections between its neighbours where it is least.

use super::places::Places;
use super::request::Request;
use crate::results::CaseResult;
use rayon::prelude::*;
use voussoir_core::limit::Status;

/// Local minima of the scan above the least by more than this share are not searched further.
const WORTHWHILE: f64 = 0.05;
/// Golden section: (√5 − 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The factor as the search compares it: what carries any load, or stands, is infinite, what cannot carry its dead load
/// is −∞; `None` where there is no answer.
pub(super) fn rank(result: &CaseResult) -> Option<f64> {
    match result.status {
        Status::NoEquilibrium => Some(f64::NEG_INFINITY),
        Status::Unbounded | Status::Stands => Some(f64::INFINITY),
        Status::Collapse | Status::LimitPoint => result.load_factor,
        Status::Stalled => None,
    }
}

/// Results at all places that were tried, in order of id.
pub(super) fn worst_place(
    places: &Places,
    request: &Request,
    solve: &(dyn Fn(usize, f64) -> Option<CaseResult> + Sync),
) -> Vec<CaseResult> {
    let ranked = |(x, result): &(f64, CaseResult)| Some((*x, rank(result)?));
    let mut tried = solve_all(0, &places.scan, solve);
    let mut values: Vec<(f64, f64)> = tried.iter().filter_map(ranked).collect();
    // Where the scan is low, edges of patches at joints are tried too.
    let within = |x: &&f64| valleys(&values).iter().any(|[low, high]| *low < **x && **x < *high);
    let joints: Vec<f64> = places.joints.iter().filter(within).copied().collect();
    let more = solve_all(places.scan.len(), &joints, solve);
    values.extend(more.iter().filter_map(ranked));
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    tried.extend(more);
    let mut next = places.scan.len() + joints.len();
    let mut found = Vec::new();
    let width = request.tolerance * (request.range[1] - request.range[0]);
    for bracket in valleys(&values) {
        golden_section(bracket, width, &mut next, solve, &mut found);
    }
    tried.into_iter().map(|(_, result)| result).chain(found).collect()
}

/// Brackets of the places that are lower than their neighbours and near the lowest of all.
fn valleys(values: &[(f64, f64)]) -> Vec<[f64; 2]> {
    let least = values.iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
    let valley = |i: usize| {
        let (before, value, after) = (values[i.saturating_sub(1)], values[i].1, values[(i + 1).min(values.len() - 1)]);
        let lowest = (value <= before.1 && value < after.1) || (value < before.1 && value <= after.1);
        let worthwhile = value.is_finite() && value <= least + WORTHWHILE * least.abs();
        (lowest && worthwhile).then_some([before.0, after.0])
    };
    (0..values.len()).filter_map(valley).collect()
}

/// Golden sections of a bracket down to a width; every result is kept.
fn golden_section(
    [mut low, mut high]: [f64; 2],
    width: f64,
    next: &mut usize,
    solve: &(dyn Fn(usize, f64) -> Option<CaseResult> + Sync),
    found: &mut Vec<CaseResult>,
) {
    let mut at = |x: f64| {
        let result = solve(*next, x)?;
        *next += 1;
        let value = rank(&result);
        found.push(result);
        value
    };
    let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (Some(mut f_a), Some(mut f_b)) = (at(a), at(b)) else { return };
    while high - low > width {
        // Equal values, as of two mirrored places, leave the left part.
        let value = if f_a <= f_b {
            (high, b, f_b) = (b, a, f_a);
            a = high - GOLDEN * (high - low);
            at(a).map(|value| f_a = value)
        } else {
            (low, a, f_a) = (a, b, f_b);
            b = low + GOLDEN * (high - low);
            at(b).map(|value| f_b = value)
        };
        if value.is_none() {
            return;
        }
    }
}

/// Solves places side by side, in order; those that make no case are left out.
fn solve_all(
    first: usize,
    places: &[f64],
    solve: &(dyn Fn(usize, f64) -> Option<CaseResult> + Sync),
) -> Vec<(f64, CaseResult)> {
    let one = |(index, value): (usize, &f64)| Some((*value, solve(first + index, *value)?));
    places.par_iter().enumerate().filter_map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(id: usize, factor: f64) -> CaseResult {
        let mut result = CaseResult::empty();
        result.label.id = id;
        result.status = Status::Collapse;
        result.load_factor = Some(factor);
        result
    }

    fn request(tolerance: f64) -> Request {
        let (parameter, range) = ("x".to_string(), [0.0, 10.0]);
        Request { parameter, range, tolerance, scan: 11, directions: None, vehicles: None }
    }

    /// Two valleys of nearly the same depth, one smooth and one with a kink: the deeper is found to the tolerance.
    #[test]
    fn the_deeper_of_two_valleys_is_found() {
        let f = |x: f64| (1.0 + (x - 2.3_f64).powi(2)).min(0.99 + 3.0 * (x - 7.777).abs());
        let solve = |id: usize, x: f64| Some(answer(id, f(x)));
        let places = Places { scan: (0..=10).map(f64::from).collect(), joints: vec![1.5, 7.5] };
        let results = worst_place(&places, &request(1e-4), &solve);
        let least = results.iter().filter_map(|result| result.load_factor).fold(f64::INFINITY, f64::min);
        assert!((least - 0.99).abs() < 3e-3, "{least}");
        let ids: Vec<usize> = results.iter().map(|result| result.label.id).collect();
        assert!(ids.windows(2).all(|pair| pair[0] < pair[1]), "{ids:?}");
    }

    /// Where every place carries any load there is nothing to search.
    #[test]
    fn what_stands_everywhere_is_only_scanned() {
        let solve = |id: usize, _: f64| {
            let mut result = answer(id, 1.0);
            (result.status, result.load_factor) = (Status::Unbounded, None);
            Some(result)
        };
        assert_eq!(
            worst_place(&Places { scan: vec![0.0, 1.0, 2.0], joints: vec![0.5] }, &request(1e-3), &solve).len(),
            3
        );
    }
}
