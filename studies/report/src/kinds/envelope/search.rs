//! The search for the most onerous position of one run: a scan, then refinement of its minima.

use super::places::Places;
use super::request::Request;
use crate::kinds::search::{Goal, Point, refine};
use rayon::prelude::*;
use voussoir_study::results::{CaseResult, load_rank};

/// If a local minimum of the scan exceeds the least value by more than this share, edges of patches are not tried there.
const WORTHWHILE: f64 = 0.05;

/// Values whose relative difference is below this are equal.
const TIE: f64 = 1e-9;

/// Returns the results at all positions that were tried, in order of id.
pub(super) fn worst_place(
    places: &Places,
    request: &Request,
    solve: &(dyn Fn(usize, f64) -> Option<CaseResult> + Sync),
) -> Vec<CaseResult> {
    let ranked = |(x, result): &(f64, CaseResult)| Some((*x, load_rank(result)?));
    let mut tried = solve_all(0, &places.scan, solve);
    let mut values: Vec<(f64, f64)> = tried.iter().filter_map(ranked).collect();
    // In the minima of the scan, positions of patch edges at joints are tried too.
    let ends = |at: &usize| [values[at.saturating_sub(1)].0, values[(at + 1).min(values.len() - 1)].0];
    let brackets: Vec<[f64; 2]> = valleys(&values, WORTHWHILE).iter().map(ends).collect();
    let within = |x: &&f64| brackets.iter().any(|[low, high]| *low < **x && **x < *high);
    let joints: Vec<f64> = places.joints.iter().filter(within).copied().collect();
    let more = solve_all(places.scan.len(), &joints, solve);
    values.extend(more.iter().filter_map(ranked));
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    tried.extend(more);
    let mut next = places.scan.len() + joints.len();
    let mut found = Vec::new();
    let goal =
        Goal { accuracy: request.accuracy, width: request.tolerance * (request.range()[1] - request.range()[0]) };
    let mut least = f64::INFINITY;
    for at in valleys(&values, f64::INFINITY) {
        let mut points = around(&values, at);
        refine(&mut points, goal, -least, |x| {
            let result = solve(next, x)?;
            next += 1;
            let rank = load_rank(&result);
            found.push(result);
            rank.filter(|rank| rank.is_finite()).map(|rank| -rank)
        });
        least = points.iter().map(|(_, merit)| -merit).fold(least, f64::min);
    }
    tried.into_iter().map(|(_, result)| result).chain(found).collect()
}

/// Returns the indices of the positions that are lower than their neighbours and exceed the least value by at most a share of it,
/// the lowest first.
fn valleys(values: &[(f64, f64)], excess: f64) -> Vec<usize> {
    let least = values.iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
    let valley = |i: &usize| {
        let (before, value, after) =
            (values[i.saturating_sub(1)].1, values[*i].1, values[(i + 1).min(values.len() - 1)].1);
        let lowest = (value <= before && value < after) || (value < before && value <= after);
        lowest && value.is_finite() && value - least <= excess * least.abs().max(f64::MIN_POSITIVE)
    };
    let mut found: Vec<usize> = (0..values.len()).filter(valley).collect();
    // Values of mirrored scenes differ by rounding: the first is the lowest.
    let level = |i: usize| (values[i].1 / least.abs() / TIE).round();
    found.sort_by(|a, b| level(*a).total_cmp(&level(*b)));
    found
}

/// Returns the finite values around a position as merits, at most two on each side.
fn around(values: &[(f64, f64)], at: usize) -> Vec<Point> {
    let finite = |i: &usize| values[*i].1.is_finite();
    let first = (at.saturating_sub(2)..at).rev().take_while(finite).last().unwrap_or(at);
    let last = (at + 1..(at + 3).min(values.len())).take_while(finite).last().unwrap_or(at);
    values[first..=last].iter().map(|(x, value)| (*x, -value)).collect()
}

/// Solves positions in parallel and returns them in order; positions that give no case are omitted.
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
    use voussoir_core::limit::Status;

    fn answer(id: usize, factor: f64) -> CaseResult {
        let mut result = CaseResult::empty();
        result.label.id = id;
        result.status = Status::Collapse;
        result.load_factor = Some(factor);
        result
    }

    fn request(tolerance: f64) -> Request {
        let parameter = "x".to_string();
        let accuracy = 1e-6;
        Request { parameter, from: 0.0, to: 10.0, tolerance, accuracy, scan: 11, directions: None, vehicles: None }
    }

    /// Two minima with nearly the same value, one smooth and one with a kink: the lower one is found to the accuracy.
    #[test]
    fn the_deeper_of_two_valleys_is_found() {
        let f = |x: f64| (1.0 + (x - 2.3_f64).powi(2)).min(0.99 + 0.05 * (x - 7.777).abs());
        let solve = |id: usize, x: f64| Some(answer(id, f(x)));
        let places = Places { scan: (0..=10).map(f64::from).collect(), joints: vec![1.5, 7.5] };
        let results = worst_place(&places, &request(1e-4), &solve);
        let least = results.iter().filter_map(|result| result.load_factor).fold(f64::INFINITY, f64::min);
        assert!((least - 0.99).abs() < 1e-6, "{least}");
        let ids: Vec<usize> = results.iter().map(|result| result.label.id).collect();
        assert!(ids.windows(2).all(|pair| pair[0] < pair[1]), "{ids:?}");
    }

    /// If every position carries any load, there is nothing to search.
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
