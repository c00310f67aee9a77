//! The search: a scan, bisection of the borders of ranges without a finite result, and golden sections around the best value.

use super::request::Request;
use crate::kinds::search::golden_section;
use rayon::prelude::*;
use voussoir_study::results::CaseResult;

/// The merit of a value (greater is better, `None` if there is no finite result) and its result; `None` if the value gives no
/// valid scene.
pub(super) type Answer = Option<(Option<f64>, CaseResult)>;

struct Search<'a> {
    solve: &'a (dyn Fn(usize, f64) -> Answer + Sync),
    results: Vec<CaseResult>,
    next: usize,
}

/// A value that was tried, with its merit.
type Tried = (f64, Option<f64>);

/// Returns the results at all values that were tried, in order of id.
pub(super) fn best_value(request: &Request, solve: &(dyn Fn(usize, f64) -> Answer + Sync)) -> Vec<CaseResult> {
    let [from, to] = request.range();
    let last = request.scan - 1;
    let place = |i: usize| if i == last { to } else { from + (to - from) * i as f64 / last as f64 };
    let scanned: Vec<(f64, Answer)> =
        (0..request.scan).into_par_iter().map(|i| (place(i), solve(i, place(i)))).collect();
    let mut search = Search { solve, results: Vec::new(), next: request.scan };
    let mut tried: Vec<Tried> = Vec::new();
    for (value, answer) in scanned {
        tried.push((value, answer.as_ref().and_then(|(merit, _)| *merit)));
        search.results.extend(answer.map(|(_, result)| result));
    }
    let width = request.tolerance * (to - from);
    let borders: Vec<Tried> = tried
        .windows(2)
        .filter(|pair| pair[0].1.is_some() != pair[1].1.is_some())
        .flat_map(|pair| search.border([pair[0], pair[1]], width))
        .collect();
    tried.extend(borders);
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    for bracket in peaks(&tried) {
        golden_section(bracket, width, |value| search.at(value));
    }
    search.results
}

/// Returns brackets of the finite values that are better than their neighbours. A value without a finite result ends a
/// bracket.
fn peaks(tried: &[Tried]) -> Vec<[f64; 2]> {
    let mut brackets = Vec::new();
    for stretch in tried.chunk_by(|a, b| a.1.is_some() == b.1.is_some()) {
        for i in 0..stretch.len() {
            let Some(own) = stretch[i].1 else { continue };
            let (low, high) = (i.saturating_sub(1), (i + 1).min(stretch.len() - 1));
            let (before, after) = (stretch[low].1.unwrap_or(own), stretch[high].1.unwrap_or(own));
            let better = (own >= before && own > after) || (own > before && own >= after);
            if better && low < high {
                brackets.push([stretch[low].0, stretch[high].0]);
            }
        }
    }
    brackets
}

impl Search<'_> {
    fn at(&mut self, value: f64) -> Option<f64> {
        let answer = (self.solve)(self.next, value);
        self.next += 1;
        let (merit, result) = answer?;
        self.results.push(result);
        merit
    }

    /// Bisects between a value with a finite result and one without, until the interval is narrow enough.
    fn border(&mut self, mut ends: [Tried; 2], width: f64) -> Vec<Tried> {
        let mut tried = Vec::new();
        while (ends[1].0 - ends[0].0).abs() > width {
            let middle = 0.5 * (ends[0].0 + ends[1].0);
            let merit = self.at(middle);
            tried.push((middle, merit));
            ends[usize::from(merit.is_some() == ends[1].1.is_some())] = (middle, merit);
        }
        tried
    }
}

#[cfg(test)]
mod tests {
    use super::super::request::Goal;
    use super::*;

    fn request(tolerance: f64) -> Request {
        let keys = vec!["x".to_string()];
        Request {
            parameter: None,
            parameters: Some(keys),
            from: 0.0,
            to: 10.0,
            goal: Goal::Maximise,
            result: None,
            scan: 11,
            tolerance,
        }
    }

    fn best(f: impl Fn(f64) -> Option<f64> + Sync) -> (f64, Vec<usize>) {
        let merits = std::sync::Mutex::new(Vec::new());
        let solve = |id: usize, x: f64| {
            let mut result = CaseResult::empty();
            result.label.id = id;
            merits.lock().expect("no panic").push((x, f(x)));
            Some((f(x), result))
        };
        let ids = best_value(&request(1e-4), &solve).iter().map(|result| result.label.id).collect();
        let tried = merits.into_inner().expect("no panic");
        let finite = tried.iter().filter_map(|(x, merit)| Some((*x, (*merit)?)));
        (finite.max_by(|a, b| a.1.total_cmp(&b.1)).expect("a value").0, ids)
    }

    /// Two optima, one smooth and one with a kink: the better one is found within the tolerance.
    #[test]
    fn the_better_of_two_optima_is_found() {
        let (x, ids) = best(|x| Some((-(x - 2.3_f64).powi(2)).max(0.01 - 3.0 * (x - 7.777).abs())));
        assert!((x - 7.777).abs() < 2e-3, "{x}");
        assert!(ids.windows(2).all(|pair| pair[0] < pair[1]), "{ids:?}");
    }

    /// An optimum beside values without a result is found up to the border.
    #[test]
    fn an_optimum_at_a_border_is_found() {
        let (x, _) = best(|x| (x < 6.2).then_some(x * x));
        assert!(x < 6.2 && x > 6.198, "{x}");
    }
}
