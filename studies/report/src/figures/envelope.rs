//! The chart of an envelope: the load factor over the place of the load, a line for each vehicle and way it stands.

use crate::output::StudyOutput;
use voussoir_plot::chart::chart_svg;
use voussoir_plot::series::{Marker, Series, Spot};
use voussoir_study::results::format::format_number;
use voussoir_study::results::{PlaceEntry, WorstEntry, other_limit_point};
use voussoir_study::study::SweptKeys;

/// The chart, where the results are those of an envelope.
pub fn envelope_chart(study: &StudyOutput) -> Option<String> {
    let (curve, worsts) = (study.results.own.curve.as_ref()?, study.results.own.worsts.as_ref()?);
    let mut series: Vec<Series> = Vec::new();
    for place in curve {
        let name = line_name(place, &study.keys);
        let index = series.iter().position(|line| line.name == name).unwrap_or_else(|| {
            series.push(Series { name: name.clone(), spots: Some(Vec::new()), ..Series::default() });
            series.len() - 1
        });
        series[index].points.extend(place.result.map(|y| (place.value, y)));
    }
    for WorstEntry { place, .. } in worsts {
        let (x, Some(y)) = (place.value, place.result) else { continue };
        let name = line_name(place, &study.keys);
        if let Some(spots) = series.iter_mut().find(|line| line.name == name).and_then(|line| line.spots.as_mut()) {
            let label = format!("{} at {}", format_number(y, 4), format_number(x, 4));
            spots.push(Spot { at: (x, y), kind: "worst place", marker: Marker::Dot, label });
        }
    }
    let first: Vec<Series> =
        series.iter().filter_map(|line| first_limit_points(&line.name, curve, &study.keys)).collect();
    series.extend(first);
    series.retain(|line| !line.points.is_empty());
    let label = worsts.first().map_or("place".into(), |worst| study.keys.title(&worst.parameter));
    let title = format!("{}: load factor at collapse over the place of the load", study.name);
    (!series.is_empty()).then(|| chart_svg(&title, &label, "load factor at collapse [-]", &series, &[]))
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
    let swept = keys.text(&place.parameters);
    let words: Vec<&str> = place.names().chain([swept.as_str()].into_iter().filter(|text| !text.is_empty())).collect();
    words.join(", ")
}
