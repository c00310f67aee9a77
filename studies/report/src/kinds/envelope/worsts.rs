//! The results of an envelope: the most onerous position of each case of the study, and the factor at all positions.

use super::request::Request;
use crate::kinds::search::intervals;
use serde_json::Value as Json;
use voussoir_study::results::format::status_word;
use voussoir_study::results::{CaseResult, KindEntries, PlaceEntry, WorstEntry, least_of};
use voussoir_study::study::{Case, Study};

/// A position that was tried.
struct Place<'a> {
    value: f64,
    vehicle: Option<&'a str>,
    direction: Option<&'a str>,
    result: &'a CaseResult,
}

impl Place<'_> {
    /// Returns the entry of a position that was tried for a case of the study.
    fn entry(&self, base: &Case) -> PlaceEntry {
        PlaceEntry {
            variant: base.variant.clone(),
            parameters: base.parameters.clone(),
            vehicle: self.vehicle.map(String::from),
            direction: self.direction.map(String::from),
            value: self.value,
            result: self.result.load_factor,
            first_limit_point: self.result.path.first_limit_point,
            status: self.result.status,
            case: self.result.label.id,
        }
    }
}

/// Returns `worsts` and `curve` for results.json.
pub(super) fn entries(study: &Study, request: &Request, cases: &[CaseResult]) -> KindEntries {
    let (mut worsts, mut curve) = (Vec::new(), Vec::new());
    for base in (0..study.count()).filter_map(|id| study.case(id)) {
        let base = base.as_ref();
        let mut places: Vec<Place> = Vec::new();
        for result in cases.iter().filter(|result| belongs(base, result)) {
            let of = |key: &str| result.label.parameters.get(key).or_else(|| base.resolved.at(key));
            let Some(value) = of(&request.parameter).and_then(Json::as_f64) else { continue };
            let text = |key: &str| of(&request.beside(key)).and_then(Json::as_str);
            places.push(Place { value, vehicle: text("vehicle"), direction: text("direction"), result });
        }
        places
            .sort_by(|a, b| (a.vehicle, a.direction).cmp(&(b.vehicle, b.direction)).then(a.value.total_cmp(&b.value)));
        worsts.extend(worst(request, base, &places));
        curve.extend(places.iter().map(|place| place.entry(base)));
    }
    KindEntries { worsts: Some(worsts), curve: Some(curve), ..KindEntries::default() }
}

/// Returns true if a result belongs to a case of the study, or to a case made from it.
fn belongs(base: &Case, result: &CaseResult) -> bool {
    let label = &result.label;
    label.variant == base.variant
        && label.scene == base.scene
        && base.parameters.iter().all(|(key, value)| label.parameters.get(key) == Some(value))
}

/// Returns the entry with the least factor.
fn worst(request: &Request, base: &Case, places: &[Place]) -> Option<WorstEntry> {
    let least = least_of(places.iter().map(|place| place.result))?;
    let place = places.iter().find(|place| place.result.label.id == least.label.id)?;
    let own = places.iter().filter(|p| p.vehicle == place.vehicle && p.direction == place.direction);
    let own: Vec<_> = own.map(|place| (place.value, status_word(place.result.status))).collect();
    Some(WorstEntry { place: place.entry(base), parameter: request.parameter.clone(), intervals: intervals(&own) })
}
