//! Load-displacement curves of paths, with the joints that became hinges on the way.

use crate::output::StudyOutput;
use crate::postprocess::joint_events::{JointEvent, JointState, joint_events};
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Stage};
use voussoir_plot::chart::chart_svg;
use voussoir_plot::series::{Marker, Series, Spot};
use voussoir_study::results::CaseResult;
use voussoir_study::results::format::{format_force, unit_load};

/// More curves are not drawn in one chart.
const TOGETHER: usize = 7;

const X_LABEL: &str = "displacement of the load along itself, rigid motion of its blocks [mm]";

/// The axis of load factors, saying which force λ = 1 is.
fn factor_label(unit: Option<f64>) -> String {
    match unit {
        Some(unit) => format!("load factor λ [-]; λ = 1 is {}", format_force(unit)),
        None => "load factor λ [-]".into(),
    }
}

fn points(curve: &[[f64; 2]]) -> Vec<(f64, f64)> {
    curve.iter().map(|&[displacement, factor]| (displacement * 1e3, factor)).collect()
}

/// Where on the curve each factor is met, one after the other; `None` where it is not.
fn places(curve: &[(f64, f64)], factors: impl Iterator<Item = f64>) -> Vec<Option<(f64, f64)>> {
    let mut from = 0;
    factors
        .map(|factor| {
            let slack = 1e-9 * factor.abs();
            let between = |pair: &[(f64, f64)]| {
                let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
                low - slack <= factor && factor <= high + slack
            };
            let found = from + curve.get(from..)?.windows(2).position(between)?;
            from = found;
            let (a, b) = (curve[found], curve[found + 1]);
            let share = if a.1 == b.1 { 1.0 } else { ((factor - a.1) / (b.1 - a.1)).clamp(0.0, 1.0) };
            Some((a.0 + share * (b.0 - a.0), factor))
        })
        .collect()
}

/// The mark of what a case claims: at the peak of the load where there is a load factor, else where the path ends.
fn end(result: &CaseResult, line: &[(f64, f64)]) -> Option<Spot> {
    let last = *line.last()?;
    let off = |point: &(f64, f64), factor: f64| (point.1 - factor).abs();
    let peak = result
        .load_factor
        .and_then(|factor| line.iter().copied().min_by(|a, b| off(a, factor).total_cmp(&off(b, factor))));
    let kind = match (result.status, peak) {
        (Status::Collapse, _) => "collapse",
        (_, Some(_)) => "limit point",
        (_, None) => "end of the path",
    };
    Some(Spot { at: peak.unwrap_or(last), kind, marker: Marker::Ring, label: String::new() })
}

/// Marks of a curve: hinges and sliding joints of the last stage, and where it ends.
fn spots(result: &CaseResult, events: &[JointEvent], line: &[(f64, f64)], labelled: bool) -> Vec<Spot> {
    let last_stage = result.stages.last().map(|stage| stage.name.as_str());
    let kind = |event: &JointEvent| match event.became {
        Some(JointState::Hinge(_)) => Some(("a joint becomes a hinge", Marker::Dot)),
        Some(JointState::Slides) => Some(("a joint slides", Marker::Square)),
        _ => None,
    };
    let range = |axis: fn(&(f64, f64)) -> f64| {
        let values = line.iter().map(axis);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    };
    let (wide, high) = (range(|p| p.0), range(|p| p.1));
    let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() <= 0.08 * wide && (a.1 - b.1).abs() <= 0.04 * high;
    let shown: Vec<(&JointEvent, (&'static str, Marker))> = events
        .iter()
        .filter(|event| !event.gravity && Some(event.stage.as_str()) == last_stage)
        .filter_map(|event| Some((event, kind(event)?)))
        .collect();
    let at = places(line, shown.iter().map(|(event, _)| event.factor));
    let mut spots: Vec<Spot> = shown
        .iter()
        .zip(at)
        .filter_map(|((event, (kind, marker)), at)| {
            let label = if labelled { format!("joint {}", event.joint) } else { String::new() };
            Some(Spot { at: at?, kind, marker: *marker, label })
        })
        .collect();
    // Peaks before the one that is reported; that one has its own mark.
    let earlier = result.path.limit_points.iter().filter(|peak| {
        !peak.gravity && Some(peak.stage.as_str()) == last_stage && Some(peak.factor) != result.load_factor
    });
    spots.extend(earlier.map(|peak| {
        let at = (peak.displacement * 1e3, peak.factor);
        Spot { at, kind: "limit point", marker: Marker::Ring, label: String::new() }
    }));
    spots.extend(end(result, line));
    // Labels of events near each other would cover each other: the last names them all.
    for late in 1..spots.len() {
        let (before, after) = spots.split_at_mut(late);
        let (own, other) = (&mut after[0], &mut before[late - 1]);
        if !own.label.is_empty() && !other.label.is_empty() && near(own.at, other.at) {
            own.label = format!("{}, {}", std::mem::take(&mut other.label), own.label.trim_start_matches("joint "));
        }
    }
    spots
}

/// The curve of one case, its hinges labelled; `None` without a curve of two points or more.
pub fn curve_svg(title: &str, assembly: &Assembly, stages: &[Stage], result: &CaseResult) -> Option<String> {
    let line = points(result.path.curve.as_deref().filter(|curve| curve.len() > 1)?);
    let spots = spots(result, &joint_events(assembly, result), &line, true);
    let name = result.stages.last().map_or("path".into(), |stage| format!("stage \"{}\"", stage.name));
    let series = [Series { name, points: line, spots: Some(spots), ..Series::default() }];
    Some(chart_svg(title, X_LABEL, &factor_label(unit_load(stages)), &series, &[]))
}

/// (name, chart) of the curves of several cases: one chart for all where they are few, else one for
/// each variant. Charts of one curve, or of more than seven, are left out.
pub fn curve_charts(study: &StudyOutput) -> Vec<(String, String)> {
    let cases = &study.results.cases;
    let with_curve: Vec<usize> =
        (0..cases.len()).filter(|&i| cases[i].path.curve.as_ref().is_some_and(|curve| curve.len() > 1)).collect();
    let mut groups: Vec<(String, Vec<usize>)> = vec![("curve".into(), with_curve.clone())];
    if with_curve.len() > TOGETHER {
        let mut variants: Vec<Option<&str>> = Vec::new();
        for &i in &with_curve {
            if !variants.contains(&cases[i].label.variant.as_deref()) {
                variants.push(cases[i].label.variant.as_deref());
            }
        }
        let of = |variant: &Option<&str>| {
            with_curve.iter().copied().filter(|&i| cases[i].label.variant.as_deref() == *variant).collect()
        };
        groups = variants.iter().enumerate().map(|(n, variant)| (format!("curve-{n}"), of(variant))).collect();
    }
    let chart = |(name, group): (String, Vec<usize>)| {
        if !(2..=TOGETHER).contains(&group.len()) {
            return None;
        }
        let mut units = Vec::new();
        let mut series = Vec::new();
        let one_variant = group.windows(2).all(|pair| cases[pair[0]].label.variant == cases[pair[1]].label.variant);
        for &place in &group {
            let (assembly, stages) = study.scene(place)?;
            units.push(unit_load(stages));
            let line = points(cases[place].path.curve.as_deref()?);
            let spots = spots(&cases[place], &joint_events(assembly, &cases[place]), &line, false);
            let words = [
                cases[place].label.variant.clone().filter(|_| !one_variant).unwrap_or_default(),
                study.keys.text(&cases[place].label.parameters),
            ];
            let words: Vec<_> = words.into_iter().filter(|words| !words.is_empty()).collect();
            let title = if words.is_empty() { format!("case {}", cases[place].label.id) } else { words.join(", ") };
            series.push(Series { name: title, points: line, spots: Some(spots), ..Series::default() });
        }
        let unit = units[0].filter(|_| units.windows(2).all(|pair| pair[0] == pair[1]));
        let variant = cases[group[0]].label.variant.as_ref().filter(|_| one_variant);
        let title =
            format!("{}{}: load over displacement", study.name, variant.map_or(String::new(), |v| format!(", {v}")));
        Some((name, chart_svg(&title, X_LABEL, &factor_label(unit), &series, &[])))
    };
    groups.into_iter().filter_map(chart).collect()
}
