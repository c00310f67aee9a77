//! Loads that you can drag: the position of each, and the keys that change with it.

use serde_json::{Value as Json, json};
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::Vec2;
use voussoir_study::config::document::Node;
use voussoir_study::config::dotted_key::join;
use voussoir_study::loads::VehicleAxles;
use voussoir_study::study::Case;

/// Returns the start and the length of the span of span fractions \[m\].
pub(super) fn span(assembly: &Assembly) -> Option<(f64, f64)> {
    match (&assembly.bridge, &assembly.arch) {
        (Some(bridge), _) => Some((bridge.springings[0], bridge.springings[1] - bridge.springings[0])),
        (None, Some(arch)) => Some((assembly.joints.first()?.ends[0].x, arch.span)),
        (None, None) => None,
    }
}

/// Returns the loads of all stages that have a position: the position \[m\], the keys that move the load, and the change of
/// each key per metre. `vertical` is the key of the height, if the load has one.
pub(super) fn handles(case: &Case, root: &Node) -> Json {
    let mut out = Vec::new();
    for (stage, node) in
        root.table().and_then(|table| table.get("stages")?.array()).unwrap_or_default().iter().enumerate()
    {
        let loads = node.table().and_then(|table| table.get("loads")?.array()).unwrap_or_default();
        for index in 0..loads.len() {
            let key = join(&join(&join("stages", &stage.to_string()), "loads"), &index.to_string());
            let load = &case.resolved["stages"][stage]["loads"][index];
            out.extend(handle(case, stage, &key, load));
        }
    }
    out.into()
}

fn handle(case: &Case, stage: usize, key: &str, load: &Json) -> Option<Json> {
    let span = span(&case.assembly);
    let at_fraction = |fraction: f64| span.map(|(left, long)| left + fraction * long);
    let number = |name: &str| load[name].as_f64();
    let (x, keys, per_metre, vertical) = match (key_of_position(load), load["kind"].as_str()?) {
        (Some(key), "vehicle") => (number(key)?, vec![key], 1.0, None),
        (Some(key), _) => (at_fraction(number(key)?)?, vec![key], 1.0 / span?.1, None),
        (None, "strip") => {
            let (from, to) = (number("from")?, number("to")?);
            (at_fraction((from + to) / 2.0)?, vec!["from", "to"], 1.0 / span?.1, None)
        }
        (None, "point") => (load["point"][0].as_f64()?, vec!["point.0"], 1.0, Some("point.1")),
        _ => return None,
    };
    // The height of the nearest force of its stage.
    let forces = case.stages.get(stage)?.forces.iter();
    let far = |point: &Vec2| (point.x - x).abs();
    let y = forces.map(|force| force.point).min_by(|a, b| far(a).total_cmp(&far(b))).map_or(0.0, |point| point.y);
    let whole: Vec<String> = keys.iter().map(|name| format!("{key}.{name}")).collect();
    let values: Option<Vec<f64>> =
        keys.iter().map(|name| load.pointer(&format!("/{}", name.replace('.', "/"))).and_then(Json::as_f64)).collect();
    Some(json!({
        "x": x, "y": y, "keys": whole, "values": values?, "per_metre": per_metre,
        "vertical": vertical.map(|name| format!("{key}.{name}")),
        "axles": axles(case, load, x),
    }))
}

/// Returns the key that moves a load along the structure, if it is one number.
pub(super) fn key_of_position(load: &Json) -> Option<&'static str> {
    let kind = load["kind"].as_str()?;
    let key = if matches!(kind, "axles" | "vehicle") { "at" } else { "span_fraction" };
    load[key].is_number().then_some(key)
}

/// Returns the axles of a vehicle at `x`: place and length of the patch on the road, and height of the road \[m\]. Axles off the
/// road are omitted.
fn axles(case: &Case, load: &Json, x: f64) -> Json {
    let vehicle = load["vehicle"].as_str().and_then(|name| case.resolved.get("vehicles")?.get(name).cloned());
    let vehicle = vehicle.and_then(|table| serde_json::from_value::<VehicleAxles>(table).ok());
    let (Some(vehicle), Some(bridge)) = (vehicle, &case.assembly.bridge) else { return Json::Null };
    let sense = if load["direction"].as_str() == Some("backward") { -1.0 } else { 1.0 };
    let place = |at: f64| x + sense * at;
    vehicle
        .axles
        .iter()
        .filter_map(|axle| Some(json!([place(axle.at), bridge.road_at(place(axle.at))?, axle.length])))
        .collect()
}
