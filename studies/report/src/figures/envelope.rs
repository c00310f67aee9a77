//! Charts of searches: the load factor over the position of a moving load, with a line for each vehicle and direction, and the
//! result over the parameter of an optimisation.

use crate::output::StudyOutput;
use voussoir_plot::chart::chart_svg;
use voussoir_plot::series::{Marker, Series, Spot};
use voussoir_study::results::format::{format_number, status_word};
use voussoir_study::results::{CaseResult, OptimumEntry, PlaceEntry, WorstEntry, best_of, other_limit_point};
use voussoir_study::study::SweptKeys;

/// The chart of an envelope; `None` for other kinds.
pub fn envelope_chart(study: &StudyOutput) -> Option<String> {
    let (curve, worsts) = (study.results.own.curve.as_ref()?, study.results.own.worsts.as_ref()?);
    let mut series = curves(curve, &study.keys);
    for WorstEntry { place, .. } in worsts {
        let (x, Some(y)) = (place.value, place.result) else { continue };
        mark(&mut series, &line_name(place, &study.keys), (x, y), ("worst place", Marker::Dot, true));
    }
    let first: Vec<Series> =
        series.iter().filter_map(|line| first_limit_points(&line.name, curve, &study.keys)).collect();
    series.extend(first);
    series.retain(|line| !line.points.is_empty());
    let label = worsts.first().map_or("place".into(), |worst| study.keys.title(&worst.parameter));
    let title = format!("{}: load factor at collapse over the place of the load", study.name);
    (!series.is_empty()).then(|| chart_svg(&title, &label, "load factor at collapse [-]", &series, &[]))
}

/// The chart of an optimisation: the result at every value that was tried, with the optima; with several parameters the best result
/// up to each trial. `None` for other kinds.
pub fn optimum_chart(study: &StudyOutput) -> Option<String> {
    let optima = study.results.own.optima.as_ref()?;
    let first = optima.first()?;
    let several = first.keys().len() > 1;
    let quantity = if several { format!("{} {} so far", first.extreme(), first.quantity()) } else { first.quantity() };
    let places: Vec<PlaceEntry> = match &study.results.own.curve {
        Some(curve) if !several => curve.clone(),
        _ => optima.iter().flat_map(|own| trials(study, own)).collect(),
    };
    let mut series = curves(&places, &study.keys);
    series.iter_mut().for_each(|line| line.dots = true);
    let greatest = best_of(optima).unwrap_or(first);
    let mut notes = Vec::new();
    for own in optima {
        let Some(best) = &own.best_finite else { continue };
        let line = |place: &&PlaceEntry| place.case == best.case;
        let Some(place) = places.iter().find(line) else { continue };
        // Labels of neighbours would cover each other: only the best optimum has one.
        let labelled = std::ptr::eq(own, greatest);
        mark(
            &mut series,
            &line_name(place, &study.keys),
            (place.value, best.result),
            (own.extreme(), Marker::Ring, labelled),
        );
        if own.value.is_none() {
            let words = own.status.map_or("", status_word).replace('_', " ");
            notes.push(format!(
                "{}: {words} at some values, the mark is the best finite one",
                line_name(place, &study.keys)
            ));
        }
    }
    series.retain(|line| !line.points.is_empty());
    let label = match (several, &first.parameter) {
        (false, Some(key)) => study.keys.title(key),
        _ => "number of the trial".into(),
    };
    let title = format!("{}: {quantity} over {label}", study.name);
    (!series.is_empty()).then(|| chart_svg(&title, &label, &format!("{quantity} [-]"), &series, &notes))
}

/// The best result up to each trial of an optimum with several parameters, by the number of the trial.
fn trials(study: &StudyOutput, own: &OptimumEntry) -> Vec<PlaceEntry> {
    let key = own.parameter.as_deref().unwrap_or_default();
    let is_own = |case: &&CaseResult| {
        let label = &case.label;
        let swept = own.parameters.iter().all(|(key, value)| label.parameters.get(key) == Some(value));
        label.variant == own.variant && swept && label.parameters.contains_key(key)
    };
    let mut best: Option<f64> = None;
    let entry = |(number, case): (usize, &CaseResult)| {
        let result = if own.optimised == "first_limit_point" { case.path.first_limit_point } else { case.load_factor };
        let better = |a: f64, b: f64| if own.goal == "minimise" { a < b } else { a > b };
        // A trial that is better than the optimum has another volume.
        let result = result.filter(|x| own.best_finite.as_ref().is_none_or(|best| !better(*x, best.result)));
        best = result.filter(|x| best.is_none_or(|best| better(*x, best))).or(best);
        PlaceEntry {
            variant: own.variant.clone(),
            parameters: own.parameters.clone(),
            vehicle: None,
            direction: None,
            value: (number + 1) as f64,
            result: best,
            first_limit_point: case.path.first_limit_point,
            status: case.status,
            case: case.label.id,
        }
    };
    study.results.cases.iter().filter(is_own).enumerate().map(entry).collect()
}

/// A line for each variant, vehicle, direction and sweep point.
fn curves(curve: &[PlaceEntry], keys: &SweptKeys) -> Vec<Series> {
    let mut series: Vec<Series> = Vec::new();
    for place in curve {
        let name = line_name(place, keys);
        let index = series.iter().position(|line| line.name == name).unwrap_or_else(|| {
            series.push(Series { name: name.clone(), spots: Some(Vec::new()), ..Series::default() });
            series.len() - 1
        });
        series[index].points.extend(place.result.map(|y| (place.value, y)));
    }
    series
}

/// Marks a point of a line.
fn mark(series: &mut [Series], name: &str, at: (f64, f64), (kind, marker, labelled): (&'static str, Marker, bool)) {
    let spots = series.iter_mut().find(|line| line.name == name).and_then(|line| line.spots.as_mut());
    let label =
        if labelled { format!("{} at {}", format_number(at.1, 4), format_number(at.0, 4)) } else { String::new() };
    spots.into_iter().for_each(|spots| spots.push(Spot { at, kind, marker, label: label.clone() }));
}

/// The line of first limit points beside a line of load factors, if they differ at any place.
fn first_limit_points(name: &str, curve: &[PlaceEntry], keys: &SweptKeys) -> Option<Series> {
    let own: Vec<&PlaceEntry> = curve.iter().filter(|place| line_name(place, keys) == name).collect();
    own.iter().find(|place| other_limit_point(place.result, place.first_limit_point).is_some())?;
    let point = |place: &&PlaceEntry| Some((place.value, place.first_limit_point.or(place.result)?));
    let points = own.iter().filter_map(point).collect();
    Some(Series { name: format!("{name}, first limit point"), points, spots: Some(Vec::new()), ..Series::default() })
}

/// Variant, vehicle, direction and swept values of an entry.
pub(super) fn line_name(place: &PlaceEntry, keys: &SweptKeys) -> String {
    let name = place_name(place, keys);
    if name.is_empty() { "load".into() } else { name }
}

/// Variant, vehicle, direction and swept values of an entry; empty without any of them.
pub fn place_name(place: &PlaceEntry, keys: &SweptKeys) -> String {
    keys.named(place.names(), &place.parameters)
}
