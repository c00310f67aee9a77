//! The search over one parameter: a scan, bisection of the borders of ranges without a finite result, and refinement of the best
//! values.

use super::request::{Axis, Request};
use super::trials::{Answer, Trials};
use crate::kinds::search::{Goal, Point, refine};
use rayon::prelude::*;
use voussoir_study::results::CaseResult;

/// Merits whose relative difference is below this are equal.
const TIE: f64 = 1e-9;

/// A value that was tried, with its merit.
type Tried = (f64, Option<f64>);

/// Returns the values of the scan.
pub(super) fn scanned(request: &Request, axis: &Axis) -> Vec<f64> {
    let ([from, to], last) = (axis.range, request.scan - 1);
    (0..request.scan).map(|i| if i == last { to } else { from + (to - from) * i as f64 / last as f64 }).collect()
}

/// Returns the results at all values that were tried, in order of id.
pub(super) fn best_value(
    request: &Request,
    axis: &Axis,
    solve: &(dyn Fn(usize, &[f64]) -> Answer + Sync),
) -> Vec<CaseResult> {
    let places = scanned(request, axis);
    let answers = places.par_iter().enumerate().map(|(i, x)| solve(i, &[*x])).collect::<Vec<_>>();
    let mut trials = Trials::new(solve, request.stride());
    let mut tried: Vec<Tried> =
        places.into_iter().zip(answers).map(|(x, answer)| (x, trials.add(answer).flatten())).collect();
    let width = request.tolerance * axis.length();
    let borders: Vec<Tried> = tried
        .windows(2)
        .filter(|pair| pair[0].1.is_some() != pair[1].1.is_some())
        .flat_map(|pair| border(&mut trials, [pair[0], pair[1]], width))
        .collect();
    tried.extend(borders);
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let goal = Goal { accuracy: request.accuracy, width };
    let mut most = f64::NEG_INFINITY;
    for mut points in peaks(&tried) {
        refine(&mut points, goal, most, |x| trials.at(&[x]).flatten());
        most = points.iter().map(|(_, merit)| *merit).fold(most, f64::max);
    }
    trials.results
}

/// Returns the finite values that are better than their neighbours, the best first, each with at most two values on each side.
fn peaks(tried: &[Tried]) -> Vec<Vec<Point>> {
    let mut found: Vec<(f64, Vec<Point>)> = Vec::new();
    for points in stretches(tried) {
        let merit = |i: usize| points[i].1;
        for i in 0..points.len() {
            let (before, after) = (merit(i.saturating_sub(1)), merit((i + 1).min(points.len() - 1)));
            let better = (merit(i) >= before && merit(i) > after) || (merit(i) > before && merit(i) >= after);
            if better {
                let around = points[i.saturating_sub(2)..(i + 3).min(points.len())].to_vec();
                found.push((merit(i), around));
            }
        }
    }
    let most = found.iter().map(|(merit, _)| *merit).fold(f64::NEG_INFINITY, f64::max);
    // Values of mirrored scenes differ by rounding: the first is the best.
    let level = |merit: f64| (merit / most.abs() / TIE).round();
    found.sort_by(|a, b| level(b.0).total_cmp(&level(a.0)));
    found.into_iter().map(|(_, around)| around).collect()
}

/// Returns the stretches of neighbouring values with finite results.
pub(super) fn stretches(tried: &[Tried]) -> impl Iterator<Item = Vec<Point>> + '_ {
    let parts = tried.chunk_by(|a, b| a.1.is_some() == b.1.is_some());
    let finite = |part: &[Tried]| part.iter().filter_map(|(x, merit)| Some((*x, (*merit)?))).collect::<Vec<_>>();
    parts.map(finite).filter(|points| !points.is_empty())
}

/// Bisects between a value with a finite result and one without, until the interval is narrow enough.
fn border(trials: &mut Trials, mut ends: [Tried; 2], width: f64) -> Vec<Tried> {
    let mut tried = Vec::new();
    while (ends[1].0 - ends[0].0).abs() > width && !trials.spent() {
        let middle = 0.5 * (ends[0].0 + ends[1].0);
        if middle <= ends[0].0 || middle >= ends[1].0 {
            break;
        }
        let merit = trials.at(&[middle]).flatten();
        tried.push((middle, merit));
        ends[usize::from(merit.is_some() == ends[1].1.is_some())] = (middle, merit);
    }
    tried
}

#[cfg(test)]
mod tests {
    use super::super::request::{Request, Varied};
    use super::*;
    use voussoir_core::plugin::Keys;

    fn best(f: impl Fn(f64) -> Option<f64> + Sync) -> (f64, Vec<usize>) {
        let request = Request {
            parameters: Some(vec![Varied::Key("x".into())]),
            from: Some(0.0),
            to: Some(10.0),
            scan: 11,
            tolerance: 1e-4,
            ..Request::defaults()
        };
        let merits = std::sync::Mutex::new(Vec::new());
        let solve = |id: usize, x: &[f64]| {
            let mut result = CaseResult::empty();
            result.label.id = id;
            merits.lock().expect("no panic").push((x[0], f(x[0])));
            Some((f(x[0]), result))
        };
        let ids = best_value(&request, &request.axes()[0], &solve).iter().map(|result| result.label.id).collect();
        let tried = merits.into_inner().expect("no panic");
        let finite = tried.iter().filter_map(|(x, merit)| Some((*x, (*merit)?)));
        (finite.max_by(|a, b| a.1.total_cmp(&b.1)).expect("a value").0, ids)
    }

    /// Two optima, one smooth and one with a kink: the better one is found to the accuracy.
    #[test]
    fn the_better_of_two_optima_is_found() {
        let (x, ids) = best(|x| Some((-(x - 2.3_f64).powi(2)).max(0.01 - 3.0 * (x - 7.777).abs())));
        assert!((x - 7.777).abs() < 1e-8, "{x}");
        assert!(ids.windows(2).all(|pair| pair[0] < pair[1]), "{ids:?}");
    }

    /// An optimum beside values without a result is found up to the border.
    #[test]
    fn an_optimum_at_a_border_is_found() {
        let (x, _) = best(|x| (x < 6.2).then_some(x * x));
        assert!(x < 6.2 && x > 6.198, "{x}");
    }
}
