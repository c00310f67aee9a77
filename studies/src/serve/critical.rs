//! The most onerous position of a load, by the search of an envelope.

use super::answer;
use super::handles::{key_of_position, span};
use super::runs::Run;
use serde_json::{Value as Json, json};
use voussoir_study::cases::Observer;
use voussoir_study::config::diagnostic::LocatedDiagnostic;
use voussoir_study::config::document::{Node, from_json};
use voussoir_study::config::origin::Origin;
use voussoir_study::config::overlay::set;
use voussoir_study::loads::VehicleAxles;
use voussoir_study::study::{Case, Study, StudyError, StudySource};

/// Positions of the scan for a load that has no envelope in its study.
const SCAN: usize = 21;

/// Returns the dotted keys that move a load of the case over the structure, with the name of each load.
pub(super) fn movable(case: &Case, envelope: Option<&Node>) -> Vec<(String, String)> {
    if let Some(parameter) = envelope.and_then(|own| own.table()?.get("parameter")?.text()) {
        return vec![(parameter.into(), "the load of [envelope]".into())];
    }
    let mut found = Vec::new();
    for (stage, table) in case.resolved["stages"].as_array().into_iter().flatten().enumerate() {
        for (index, load) in table["loads"].as_array().into_iter().flatten().enumerate() {
            let key = format!("stages.{stage}.loads.{index}");
            let name = match load["vehicle"].as_str() {
                Some(vehicle) => format!("vehicle \"{vehicle}\""),
                None => format!("the {} load", load["kind"].as_str().unwrap_or("moving")),
            };
            let moves = key_of_position(load).filter(|_| range(case, load).is_some());
            found.extend(moves.map(|position| (format!("{key}.{position}"), name.clone())));
        }
    }
    found
}

/// Returns the least and the greatest position of a load: the whole vehicle crosses the bridge.
fn range(case: &Case, load: &Json) -> Option<[f64; 2]> {
    let [left, right] = span(&case.assembly).map(|(left, long)| [left, left + long])?;
    let vehicle = load["vehicle"].as_str().and_then(|name| case.resolved.get("vehicles")?.get(name).cloned());
    let axles = vehicle.and_then(|table| serde_json::from_value::<VehicleAxles>(table).ok()).map(|own| own.axles);
    Some(match axles {
        Some(axles) => {
            let reach = axles.iter().map(|axle| axle.at.abs()).fold(0.0, f64::max);
            [left - reach, right + reach]
        }
        None => [0.0, 1.0],
    })
}

/// Returns the answer at the most onerous position of the load that `key` moves; `None` if the search is stopped.
pub(super) fn most_onerous(
    root: &Node,
    key: &str,
    envelope: &Option<Node>,
    run: &Run,
) -> Result<Option<Json>, StudyError> {
    let study_of =
        |root: &Node| Study::from_source(StudySource { root: root.clone(), sets: Vec::new(), diagnostics: Vec::new() });
    let put = |root: &mut Node, key: &str, value: Json| {
        let mut node = from_json(&value)?;
        let origin = Origin::Set(key.into());
        node.set_origin(&origin);
        set(root, key, node, &origin).map_err(|wrong| vec![*wrong])
    };
    let mut searched = root.clone();
    put(&mut searched, "kind", "envelope".into())?;
    let case = study_of(root)?.cases.into_iter().next();
    let case = case.filter(|case| movable(case, envelope.as_ref()).iter().any(|(own, _)| own == key));
    let Some(case) = case else {
        let message = "moves no load over the structure".to_string();
        return Err(vec![LocatedDiagnostic::new(&Origin::Value, key, message)].into());
    };
    match envelope {
        Some(own) => set(&mut searched, "envelope", own.clone(), &Origin::Value).map_err(|wrong| vec![*wrong])?,
        None => {
            let load = key.rsplit_once('.').map_or("", |(load, _)| load);
            let [from, to] = case.resolved.at(load).and_then(|load| range(&case, load)).unwrap_or([0.0, 1.0]);
            put(&mut searched, "envelope", json!({ "parameter": key, "from": from, "to": to, "scan": SCAN }))?;
        }
    }
    let study = study_of(&searched)?;
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let mut results = Vec::new();
    study.solve(&[0], jobs, run, &mut |result| results.push(result));
    if run.cancelled() {
        return Ok(None);
    }
    let results = study.results(env!("CARGO_PKG_VERSION"), results);
    let worst = results.own.worsts.iter().flatten().next();
    let result = worst.and_then(|worst| results.case(worst.place.case));
    // If every position carries any load, the load stays at its place.
    let result = result.or(results.cases.first());
    let Some((result, case)) = result.and_then(|result| Some((result, study.case_of(&result.label)?))) else {
        return Ok(None);
    };
    let mut placed = root.clone();
    let mut position = Vec::new();
    for (key, value) in &result.label.parameters {
        put(&mut placed, key, value.clone())?;
        position.push(json!([key, value]));
    }
    let mut answer = answer::answer(&case, result, &placed);
    answer["position"] = position.into();
    answer["positions"] = results.cases.len().into();
    Ok(Some(answer))
}
