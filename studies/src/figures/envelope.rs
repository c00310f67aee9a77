//! The chart of an envelope: the load factor over the place of the load, a line for each vehicle and way it stands.

use super::format::format_number;
use super::plot::chart::chart_svg;
use super::plot::series::{Marker, Series, Spot};
use crate::results::other_limit_point;
use crate::study::SweptKeys;
use crate::writers::StudyOutput;
use serde_json::Value as Json;

/// The chart, where the results are those of an envelope.
pub fn envelope_chart(study: &StudyOutput) -> Option<String> {
    let list = |name: &str| study.results.own.get(name).and_then(Json::as_array);
    let (curve, worsts) = (list("curve")?, list("worsts")?);
    let mut series: Vec<Series> = Vec::new();
    for place in curve {
        let name = line_name(place, &study.keys);
        let index = series.iter().position(|line| line.name == name).unwrap_or_else(|| {
            series.push(Series { name: name.clone(), spots: Some(Vec::new()), ..Series::default() });
            series.len() - 1
        });
        if let (Some(x), Some(y)) = (place["value"].as_f64(), place["result"].as_f64()) {
            series[index].points.push((x, y));
        }
    }
    for worst in worsts {
        let (Some(x), Some(y)) = (worst["value"].as_f64(), worst["result"].as_f64()) else { continue };
        let name = line_name(worst, &study.keys);
        if let Some(spots) = series.iter_mut().find(|line| line.name == name).and_then(|line| line.spots.as_mut()) {
            let label = format!("{} at {}", format_number(y, 4), format_number(x, 4));
            spots.push(Spot { at: (x, y), kind: "worst place", marker: Marker::Dot, label });
        }
    }
    let first: Vec<Series> =
        series.iter().filter_map(|line| first_limit_points(&line.name, curve, &study.keys)).collect();
    series.extend(first);
    series.retain(|line| !line.points.is_empty());
    let key = worsts.first().and_then(|worst| worst["parameter"].as_str());
    let label = key.map_or("place".into(), |key| study.keys.title(key));
    let title = format!("{}: load factor at collapse over the place of the load", study.name);
    (!series.is_empty()).then(|| chart_svg(&title, &label, "load factor at collapse [-]", &series, &[]))
}

/// The line of first limit points beside a line of load factors, if they differ at any place.
fn first_limit_points(name: &str, curve: &[Json], keys: &SweptKeys) -> Option<Series> {
    let number = |place: &Json, key: &str| place[key].as_f64();
    let own: Vec<&Json> = curve.iter().filter(|place| line_name(place, keys) == name).collect();
    let differs =
        |place: &&&Json| other_limit_point(number(place, "result"), number(place, "first_limit_point")).is_some();
    own.iter().find(differs)?;
    let place = |place: &&Json| {
        let first = number(place, "first_limit_point").or(number(place, "result"))?;
        Some((number(place, "value")?, first))
    };
    let points = own.iter().filter_map(place).collect();
    Some(Series { name: format!("{name}, first limit point"), points, spots: Some(Vec::new()), ..Series::default() })
}

/// Vehicle, way, variant and swept values of an entry.
pub(super) fn line_name(entry: &Json, keys: &SweptKeys) -> String {
    let words = ["variant", "vehicle", "direction"].iter().filter_map(|key| entry[key].as_str().map(str::to_string));
    let swept = entry["parameters"].as_object().map(|values| keys.text(values)).filter(|text| !text.is_empty());
    let name: Vec<String> = words.chain(swept).collect();
    if name.is_empty() { "load".into() } else { name.join(", ") }
}
