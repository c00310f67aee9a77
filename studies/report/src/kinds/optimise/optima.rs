//! The results of `optimise`: the best value of each case of the study, and the ranges without an optimum.

use super::request::{Axis, Request};
use super::search::{scanned, stretches};
use super::shape::keeps_volume;
use crate::kinds::search::{Bracket, Point, bracket, intervals};
use serde_json::{Map, Value as Json};
use voussoir_study::results::format::status_word;
use voussoir_study::results::{CaseResult, FiniteEntry, KindEntries, OptimumEntry, PlaceEntry};
use voussoir_study::study::{Case, Study};

/// A value that was tried.
struct Tried<'a> {
    /// The value of the first parameter.
    value: f64,
    /// The result; `None` if the value gives no valid scene.
    found: Option<(&'a CaseResult, Option<f64>)>,
}

impl Tried<'_> {
    fn status(&self) -> &'static str {
        self.found.map_or("impossible", |(result, _)| status_word(result.status))
    }
}

/// Returns `optima` and `curve` for results.json.
pub(super) fn entries(study: &Study, request: &Request, cases: &[CaseResult]) -> KindEntries {
    let (mut optima, mut curve) = (Vec::new(), Vec::new());
    let axes = request.axes();
    let Some(axis) = axes.first() else { return KindEntries::default() };
    for base in (0..study.count()).filter_map(|id| study.case(id)) {
        let base = base.as_ref();
        let first = study.count() + base.id * request.stride();
        let own = cases.iter().filter(|result| (first..first + request.stride()).contains(&result.label.id));
        let own = own.filter(|result| keeps_volume(study, base.id, request, &axes, result));
        let mut tried: Vec<Tried> = own.filter_map(|result| of_case(request, axis, base, result)).collect();
        if tried.is_empty() {
            continue;
        }
        if axes.len() == 1 {
            add_impossible(request, axis, &mut tried);
            curve.extend(tried.iter().filter_map(|tried| place(base, tried)));
        }
        optima.push(entry(request, &axes, base, &tried));
    }
    let curve = Some(curve).filter(|_| axes.len() == 1);
    KindEntries { optima: Some(optima), curve, ..KindEntries::default() }
}

fn of_case<'a>(request: &Request, axis: &Axis, base: &Case, result: &'a CaseResult) -> Option<Tried<'a>> {
    let value = result.label.parameters.get(axis.keys.first()?)?.as_f64()?;
    Some(Tried { value, found: Some((result, request.result_of(base, result))) })
}

/// Returns the entry of the curve.
fn place(base: &Case, tried: &Tried) -> Option<PlaceEntry> {
    let (result, own) = tried.found?;
    Some(PlaceEntry {
        variant: base.variant.clone(),
        parameters: base.parameters.clone(),
        vehicle: None,
        direction: None,
        value: tried.value,
        result: own,
        first_limit_point: result.path.first_limit_point,
        status: result.status,
        case: result.label.id,
    })
}

/// Adds the values of the scan that give no valid scene, and sorts.
fn add_impossible(request: &Request, axis: &Axis, tried: &mut Vec<Tried>) {
    let near = |value: f64| tried.iter().any(|tried| (tried.value - value).abs() <= 1e-9 * axis.length());
    let impossible: Vec<f64> = scanned(request, axis).into_iter().filter(|value| !near(*value)).collect();
    tried.extend(impossible.into_iter().map(|value| Tried { value, found: None }));
    tried.sort_by(|a, b| a.value.total_cmp(&b.value));
}

/// Returns the bracket of the value in its stretch of finite results.
fn neighbours(request: &Request, tried: &[Tried], value: f64) -> Option<Bracket> {
    let merit = |tried: &Tried| tried.found.and_then(|(_, own)| Some(request.sense() * own?));
    let merits: Vec<(f64, Option<f64>)> = tried.iter().map(|tried| (tried.value, merit(tried))).collect();
    let at = |points: &Vec<Point>| points.iter().position(|point| point.0 == value);
    stretches(&merits).find_map(|points| Some(bracket(&points, at(&points)?)))
}

fn entry(request: &Request, axes: &[Axis], base: &Case, tried: &[Tried]) -> OptimumEntry {
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
    let single = axes.len() == 1;
    let around = best.filter(|_| single).and_then(|(value, ..)| neighbours(request, tried, value));
    let statuses: Vec<_> = tried.iter().filter(|_| single).map(|t| (t.value, t.status())).collect();
    let keys = axes.iter().filter(|_| !single).flat_map(|axis| &axis.keys);
    let of_best = |key: &String| Some((key.clone(), best?.1.label.parameters.get(key)?.clone()));
    let values: Map<String, Json> = keys.filter_map(of_best).collect();
    OptimumEntry {
        variant: base.variant.clone(),
        parameters: base.parameters.clone(),
        parameter: axes.first().and_then(|axis| axis.keys.first()).cloned(),
        value,
        result: own,
        status: shown.map(|result| result.status),
        case: shown.map(|result| result.label.id),
        best_finite,
        goal: if request.sense() > 0.0 { "maximise" } else { "minimise" }.into(),
        optimised: if request.of_first_limit_point(base) { "first_limit_point" } else { "load_factor" }.into(),
        values,
        bracket: around.map(|own| own.ends),
        possible_gain: around.map(|own| own.gain),
        tried: tried.iter().filter(|tried| tried.found.is_some()).count(),
        intervals: intervals(&statuses),
        scan_spacing: single.then(|| axes[0].length() / (request.scan - 1) as f64),
    }
}
