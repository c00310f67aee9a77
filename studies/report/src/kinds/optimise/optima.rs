//! The results of `optimise`: the best value of each case of the study, and the ranges without an optimum.

use super::request::{Request, STRIDE};
use crate::kinds::search::intervals;
use voussoir_study::results::format::status_word;
use voussoir_study::results::{CaseResult, FiniteEntry, KindEntries, OptimumEntry};
use voussoir_study::study::{Case, Study};

/// A value that was tried.
struct Tried<'a> {
    value: f64,
    /// The result; `None` if the value gives no valid scene.
    found: Option<(&'a CaseResult, Option<f64>)>,
}

impl Tried<'_> {
    fn status(&self) -> &'static str {
        self.found.map_or("impossible", |(result, _)| status_word(result.status))
    }
}

/// Returns `optima` for results.json.
pub(super) fn entries(study: &Study, request: &Request, cases: &[CaseResult]) -> KindEntries {
    let optimum = |base: &Case| {
        let first = study.count() + base.id * STRIDE;
        let own = cases.iter().filter(|result| (first..first + STRIDE).contains(&result.label.id));
        let mut tried: Vec<Tried> = own.filter_map(|result| of_case(request, base, result)).collect();
        (!tried.is_empty()).then(|| {
            add_impossible(request, &mut tried);
            entry(request, base, &tried)
        })
    };
    let optima = (0..study.count()).filter_map(|id| optimum(&*study.case(id)?)).collect();
    KindEntries { optima: Some(optima), ..KindEntries::default() }
}

fn of_case<'a>(request: &Request, base: &Case, result: &'a CaseResult) -> Option<Tried<'a>> {
    let value = result.label.parameters.get(request.keys().first()?)?.as_f64()?;
    Some(Tried { value, found: Some((result, request.result_of(base, result))) })
}

/// Adds the values of the scan that give no valid scene, and sorts.
fn add_impossible(request: &Request, tried: &mut Vec<Tried>) {
    let [from, to] = request.range();
    let spacing = (to - from) / (request.scan - 1) as f64;
    let scanned = (0..request.scan).map(|i| from + spacing * i as f64);
    let near = |value: f64| tried.iter().any(|tried| (tried.value - value).abs() <= 1e-9 * (to - from));
    let impossible: Vec<f64> = scanned.filter(|value| !near(*value)).collect();
    tried.extend(impossible.into_iter().map(|value| Tried { value, found: None }));
    tried.sort_by(|a, b| a.value.total_cmp(&b.value));
}

fn entry(request: &Request, base: &Case, tried: &[Tried]) -> OptimumEntry {
    let finite = tried.iter().filter_map(|t| t.found.and_then(|(result, own)| Some((t.value, result, own?))));
    // Of equal results the first one is the best: mirrored scenes have equal results.
    let better = |a: f64, b: f64| request.sense() * a > request.sense() * b;
    let best = finite.reduce(|best, other| if better(other.2, best.2) { other } else { best });
    let best_finite = best.map(|(value, case, result)| FiniteEntry { value, result, case: case.label.id });
    let without_bound = tried.iter().filter_map(|t| t.found).find(|(result, _)| request.without_bound(result.status));
    let (value, own, shown) = match (without_bound, best) {
        (Some((result, _)), _) => (None, None, Some(result)),
        (None, Some((value, result, own))) => (Some(value), Some(own), Some(result)),
        (None, None) => (None, None, tried.iter().find_map(|t| t.found).map(|(result, _)| result)),
    };
    let statuses: Vec<_> = tried.iter().map(|t| (t.value, t.status())).collect();
    OptimumEntry {
        variant: base.variant.clone(),
        parameters: base.parameters.clone(),
        parameter: request.keys().first().cloned(),
        value,
        result: own,
        status: shown.map(|result| result.status),
        case: shown.map(|result| result.label.id),
        best_finite,
        intervals: intervals(&statuses),
        scan_spacing: (request.range()[1] - request.range()[0]) / (request.scan - 1) as f64,
    }
}
