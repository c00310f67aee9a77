//! The chart of a study with one swept number: the load against it.

use super::chart::{Series, chart_svg};
use super::format::{key_with_unit, unit_load};
use crate::results::CaseResult;
use crate::writers::StudyOutput;
use voussoir_core::limit::Status;

/// The axis of a study's sweep chart: its label, and the value of each case.
///
/// `None` unless exactly one key is swept and all its values are numbers. On arches whose rise or
/// span is swept it is span/rise.
pub fn sweep_axis(study: &StudyOutput) -> Option<(String, Vec<f64>)> {
    let [key] = study.sweep_keys.as_slice() else { return None };
    let cases = &study.results.cases;
    let values: Vec<f64> = cases.iter().map(|case| case.label.parameters.get(key)?.as_f64()).collect::<Option<_>>()?;
    if cases.len() < 2 {
        return None;
    }
    let ratios = || {
        let layouts = study.scenes.iter().map(|scene| scene.assembly.arch.as_ref());
        let ratios: Vec<f64> = layouts.map(|arch| arch.map(|a| a.span / a.rise)).collect::<Option<_>>()?;
        (ratios.len() == cases.len() && ratios.iter().all(|r| r.is_finite())).then_some(ratios)
    };
    if ["scene.profile.rise", "scene.profile.span"].contains(&key.as_str())
        && let Some(ratios) = ratios()
    {
        return Some(("span / rise [-]".into(), ratios));
    }
    Some((key_with_unit(key), values))
}

/// The chart of a study, if it has one: the load where all cases have the same at factor 1, else
/// the load factor.
pub fn study_chart(study: &StudyOutput) -> Option<String> {
    let (label, values) = sweep_axis(study)?;
    let units: Vec<Option<f64>> = study.scenes.iter().map(|scene| unit_load(scene.stages)).collect();
    let unit = units
        .first()
        .copied()
        .flatten()
        .filter(|_| units.len() == values.len() && units.windows(2).all(|w| w[0] == w[1]));
    let cases: Vec<_> = study.results.cases.iter().zip(values).collect();
    sweep_chart(study.name, &cases, &label, unit)
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
        let value =
            |case: &CaseResult| case.load_factor.map(|factor| factor * unit_load.map_or(1.0, |unit| unit / 1e3));
        let mut points: Vec<(f64, f64)> = mine().filter_map(|&(case, x)| Some((x, value(case)?))).collect();
        let unbounded = mine().filter(|(case, _)| case.status == Status::Unbounded);
        let mut open_points: Vec<(f64, f64)> = unbounded.map(|&(_, x)| (x, f64::INFINITY)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        open_points.sort_by(|a, b| a.0.total_cmp(&b.0));
        for status in [Status::NoEquilibrium, Status::Stalled, Status::Stands, Status::LimitPoint] {
            let ids: Vec<String> = mine()
                .filter(|(case, _)| case.status == status && case.load_factor.is_none())
                .map(|(case, _)| case.label.id.to_string())
                .collect();
            if !ids.is_empty() {
                let name = super::format::status_word(status).replace('_', " ");
                let shown =
                    if ids.len() > 12 { format!("{} cases", ids.len()) } else { format!("case {}", ids.join(", ")) };
                notes.push(format!("not shown, {name}: {shown}"));
            }
        }
        series.push(Series { name: variant.unwrap_or("collapse").to_string(), points, open_points, spots: None });
    }
    if series.iter().all(|s| s.points.is_empty() && s.open_points.is_empty()) {
        return None;
    }
    let y_label = if unit_load.is_some() { "load at collapse [kN]" } else { "load factor at collapse [-]" };
    let title = format!("{study}: {y_label} over {x_label}");
    Some(chart_svg(&title, x_label, y_label, &series, &notes))
}
