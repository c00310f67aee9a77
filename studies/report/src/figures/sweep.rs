//! The chart of a study with one swept number: the load against it.

use super::map::load_factor_maps;
use crate::output::StudyOutput;
use voussoir_core::limit::Status;
use voussoir_core::plugin::OutputOf;
use voussoir_plot::axis::WIDE;
use voussoir_plot::chart::chart;
use voussoir_plot::series::{ChartStyle, Marker, Series, Spot};
use voussoir_study::results::format::{format_short, kind_words, status_word, unit_load};
use voussoir_study::results::{CaseResult, OutputColumn};

/// The value of a swept key in each case; NaN in cases that a search has solved without it. `None` if a value is not a number.
fn swept_values(study: &StudyOutput, key: &str) -> Option<Vec<f64>> {
    let value = |case: &CaseResult| case.label.parameters.get(key).map_or(Some(f64::NAN), |value| value.as_f64());
    study.results.cases.iter().map(value).collect()
}

/// The axis of a study's sweep chart: its label, and the value of each case. `None` unless exactly one key is swept and all its
/// values are numbers.
pub fn sweep_axis(study: &StudyOutput) -> Option<(String, Vec<f64>)> {
    let [key] = study.sweep_keys.as_slice() else { return None };
    let values = swept_values(study, key)?;
    (values.len() > 1).then(|| (study.keys.title(key), values))
}

/// More lines than this are not drawn in one chart.
const LINES: usize = 8;

/// Of a study with two swept numbers: the axis of the one with more values, and for each case the line that it
/// belongs to, named by the other. `None` where there would be too many lines.
fn two_axes(study: &StudyOutput) -> Option<(String, Vec<f64>, Vec<String>)> {
    let [first, second] = study.sweep_keys.as_slice() else { return None };
    let cases = &study.results.cases;
    let different = |values: &[f64]| {
        let mut values: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len()
    };
    let (a, b) = (swept_values(study, first)?, swept_values(study, second)?);
    let (key, values, other, others) =
        if different(&a) >= different(&b) { (first, a, second, b) } else { (second, b, first, a) };
    if others.iter().any(|value| value.is_nan()) {
        return None;
    }
    let line = |(case, value): (&CaseResult, &f64)| {
        let unit = study.keys.unit(other).map_or(String::new(), |unit| format!(" {unit}"));
        let swept = format!("{} {}{unit}", study.keys.words(other), format_short(*value, 5));
        case.label.variant.as_ref().map_or(swept.clone(), |variant| format!("{variant}, {swept}"))
    };
    let lines: Vec<String> = cases.iter().zip(&others).map(line).collect();
    let count = lines.iter().collect::<std::collections::BTreeSet<_>>().len();
    (count <= LINES && different(&values) > 1).then(|| (study.keys.title(key), values, lines))
}

/// The chart of a study: lines over a swept number or over one of two, or maps over two swept numbers that have too many
/// values for lines. It shows the load if all cases have the same load at factor 1, else the load factor.
pub fn study_chart(study: &StudyOutput) -> Option<String> {
    // The chart of an optimisation shows its optima.
    if study.results.own.optima.is_some() {
        return None;
    }
    lines(study).or_else(|| load_factor_maps(study).filter(|_| study.results.comparison.is_none()))
}

fn lines(study: &StudyOutput) -> Option<String> {
    let named: Vec<CaseResult>;
    let (cases, (label, values)) = match two_axes(study) {
        // Lines are told apart as variants are.
        Some((label, values, lines)) => {
            let name = |(case, line): (&CaseResult, String)| {
                let mut case = case.clone();
                case.label.variant = Some(line);
                case
            };
            named = study.results.cases.iter().zip(lines).map(name).collect();
            (&named, (label, values))
        }
        None => (&study.results.cases, sweep_axis(study)?),
    };
    let units: Vec<Option<f64>> = study.scenes.iter().map(|scene| unit_load(scene.stages)).collect();
    let unit = units
        .first()
        .copied()
        .flatten()
        .filter(|_| units.len() == values.len() && units.windows(2).all(|w| w[0] == w[1]));
    let cases: Vec<_> = cases.iter().zip(values).collect();
    sweep_chart(study.name, &cases, &label, unit)
}

/// The charts of the outputs of the case over a swept number: name and SVG.
pub fn output_charts<'a>(study: &StudyOutput<'a>) -> Vec<(String, String)> {
    let Some((label, values)) = sweep_axis(study) else { return Vec::new() };
    let columns = &study.totals.outputs;
    let of_case = columns.iter().filter(|column| column.of == OutputOf::Case);
    let chart = |column: &OutputColumn| {
        let name = column.name_among(columns);
        let point = |(case, x): (&'a CaseResult, &f64)| {
            Some((*x, column.value(&case.outputs, None).filter(|_| x.is_finite())?, case))
        };
        let mut points: Vec<(f64, f64, &CaseResult)> =
            study.results.cases.iter().zip(&values).filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut series: Vec<Series> = Vec::new();
        for (x, y, case) in points {
            let variant = case.label.variant.clone().unwrap_or_else(|| name.replace('_', " "));
            let place = series.iter().position(|own| own.name == variant).unwrap_or_else(|| {
                series.push(Series { name: variant, dots: true, ..Series::default() });
                series.len() - 1
            });
            series[place].points.push((x, y));
            series[place].cases.push(case.label.id);
        }
        let y_label = format!("{} [{}]", name.replace('_', " "), column.unit);
        let title = format!("{}: {y_label} over {label}", study.name);
        let drawn = series.iter().any(|own| own.points.len() > 1);
        drawn.then(|| (name, chart(&title, &label, &y_label, &series, &[], &ChartStyle::default())))
    };
    of_case.filter_map(chart).collect()
}

/// Load over a swept value, one series per variant. With `unit_load` \[N\], the load at factor 1,
/// the axis is the load in kN, otherwise the factor. `None` where no case has a load to show.
pub fn sweep_chart(study: &str, cases: &[(&CaseResult, f64)], x_label: &str, unit_load: Option<f64>) -> Option<String> {
    let mut variants: Vec<Option<&str>> = Vec::new();
    for (case, _) in cases {
        if !variants.contains(&case.label.variant.as_deref()) {
            variants.push(case.label.variant.as_deref());
        }
    }
    let mut series = Vec::new();
    let mut notes = Vec::new();
    for variant in variants {
        let mine = || cases.iter().filter(|(case, x)| case.label.variant.as_deref() == variant && x.is_finite());
        let scale = unit_load.map_or(1.0, |unit| unit / 1e3);
        let value = |case: &CaseResult| case.load_factor.map(|factor| factor * scale);
        let answered = mine().filter(|(case, _)| case.status != Status::Open);
        let mut found: Vec<(f64, f64, &CaseResult)> =
            answered.filter_map(|&(case, x)| Some((x, value(case)?, case))).collect();
        let ends = mine().filter(|(case, _)| case.status == Status::Open).filter_map(|&(case, x)| {
            let [lower, upper] = case.bounds?.map(|end| end.map(|end| end * scale));
            Some((x, lower, upper))
        });
        let ends = ends.collect();
        let unbounded = mine().filter(|(case, _)| case.status == Status::Unbounded);
        let mut open_points: Vec<(f64, f64)> = unbounded.map(|&(_, x)| (x, f64::INFINITY)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        open_points.sort_by(|a, b| a.0.total_cmp(&b.0));
        for status in [Status::NoEquilibrium, Status::Stalled, Status::Stands, Status::LimitPoint] {
            let ids: Vec<String> = mine()
                .filter(|(case, _)| case.status == status && case.load_factor.is_none())
                .map(|(case, _)| case.label.id.to_string())
                .collect();
            if !ids.is_empty() {
                let name = status_word(status).replace('_', " ");
                let shown =
                    if ids.len() > 12 { format!("{} cases", ids.len()) } else { format!("case {}", ids.join(", ")) };
                notes.push(format!("not shown, {name}: {shown}"));
            }
        }
        series.push(Series {
            name: variant.unwrap_or("collapse").to_string(),
            points: found.iter().map(|(x, y, _)| (*x, *y)).collect(),
            spots: Some(marks(&found, open_points.is_empty())).filter(|spots| !spots.is_empty()),
            dots: true,
            cases: found.iter().map(|(_, _, case)| case.label.id).collect(),
            open_points,
            ends,
            ..Series::default()
        });
        series.extend(first_limit_points(variant, mine().copied(), scale));
    }
    if series.iter().all(|s| s.points.is_empty() && s.open_points.is_empty() && s.ends.is_empty()) {
        return None;
    }
    let y_label = if unit_load.is_some() { "load at collapse [kN]" } else { "load factor at collapse [-]" };
    let title = format!("{study}: {y_label} over {x_label}");
    let (low, high) = cases.iter().fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), (_, x)| (l.min(*x), h.max(*x)));
    let style = ChartStyle { log: [low > 0.0 && high >= WIDE * low, false] };
    Some(chart(&title, x_label, y_label, &series, &notes, &style))
}

/// The line of first limit points beside that of load factors, if they differ anywhere. A proved limit point of an open case
/// belongs to it.
fn first_limit_points<'a>(
    variant: Option<&str>,
    cases: impl Iterator<Item = (&'a CaseResult, f64)> + Clone,
    scale: f64,
) -> Option<Series> {
    cases.clone().find(|(case, _)| case.snaps_from().is_some())?;
    let answer = |case: &CaseResult| case.load_factor.filter(|_| case.status != Status::Open);
    let place = |(case, x): (&'a CaseResult, f64)| {
        let first = case.path.first_limit_point.or_else(|| answer(case))?;
        Some((x, first * scale, case.label.id))
    };
    let mut found: Vec<(f64, f64, usize)> = cases.filter_map(place).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let own = "first limit point";
    Some(Series {
        name: variant.map_or(own.to_string(), |variant| format!("{variant}, {own}")),
        points: found.iter().map(|(x, y, _)| (*x, *y)).collect(),
        cases: found.iter().map(|(_, _, id)| *id).collect(),
        ..Series::default()
    })
}

/// Marks of a line: its greatest value where that lies inside, and each first case of another kind of mechanism.
fn marks(found: &[(f64, f64, &CaseResult)], bounded: bool) -> Vec<Spot> {
    let mut spots = Vec::new();
    let top = (0..found.len()).max_by(|a, b| found[*a].1.total_cmp(&found[*b].1));
    if let Some(top) = top.filter(|top| bounded && (1..found.len() - 1).contains(top)) {
        let (x, y, _) = found[top];
        spots.push(Spot { at: (x, y), kind: "greatest", marker: Marker::Ring, label: format_short(y, 4) });
    }
    let kind = |case: &CaseResult| case.mechanism.as_ref().map(|mechanism| kind_words(mechanism.kind));
    for pair in found.windows(2) {
        if let (Some(before), Some(after)) = (kind(pair[0].2), kind(pair[1].2))
            && before != after
        {
            let at = (pair[1].0, pair[1].1);
            spots.push(Spot { at, kind: "another mechanism", marker: Marker::Square, label: after.into() });
        }
    }
    spots
}
