//! The description of the parts of a bridge.

use crate::config::common_keys::own_keys;
use crate::loads::VehicleAxles;
use crate::scenes::abutments;
use crate::scenes::bridge::BridgeScene;
use crate::study::Case;
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use std::fmt::Write;
use voussoir_core::model::{Assembly, Bridge};

/// Bodies whose names have the same beginning.
struct Named<'a> {
    assembly: &'a Assembly,
    prefix: String,
}

impl Named<'_> {
    /// Returns their number, mass \[kg\], and the first and last name.
    fn sum(&self) -> Option<(usize, f64, &str, &str)> {
        let named = |body: &usize| self.assembly.bodies[*body].name.starts_with(&self.prefix);
        let own: Vec<usize> = (0..self.assembly.bodies.len()).filter(named).collect();
        let name = |body: &usize| self.assembly.bodies[*body].name.as_str();
        let mass = own.iter().map(|body| self.assembly.inertia(*body).mass).sum();
        Some((own.len(), mass, own.first().map(name)?, own.last().map(name)?))
    }
}

/// Adds one line for every ring, pier and piece of damage, and for road, fill, vehicles and factors.
pub fn explain_bridge(case: &Case, bridge: &Bridge, text: &mut String) {
    let assembly = &case.assembly;
    let scene: Option<BridgeScene> = case.resolved.get("scene").and_then(own_keys);
    let line = |text: &mut String, what: String, prefix: String| {
        let named = Named { assembly, prefix };
        if let Some((count, mass, first, last)) = named.sum() {
            let names = if first == last { first.to_string() } else { format!("{first} … {last}") };
            let _ = writeln!(text, "  {what}: {count} block(s) {names}, {:.3} t", mass / 1000.0);
        }
    };
    if assembly.arch.is_some() {
        let _ = writeln!(text, "  span 0, ring 0: {} block(s) 0 … {}", bridge.radial - 1, bridge.radial - 2);
    }
    for (i, span) in scene.iter().flat_map(|scene| &scene.spans).enumerate() {
        let shape =
            case.resolved.at(&format!("scene.spans.{i}.profile.shape")).and_then(Json::as_str).unwrap_or_default();
        for ring in 0..span.rings {
            line(text, format!("span {i} ({shape}), ring {ring}"), format!("s{i}r{ring}v"));
        }
    }
    for i in 0..scene.as_ref().map_or(0, |scene| scene.piers.len()) {
        line(text, format!("pier {i}"), format!("p{i}c"));
    }
    for (side, name) in ["left", "right"].into_iter().zip(abutments::NAMES) {
        line(text, format!("{side} abutment"), name.into());
    }
    for (i, damage) in scene.iter().flat_map(|scene| &scene.damage).enumerate() {
        let _ = writeln!(text, "  damage {i}: {}", words(&json!(damage)));
    }
    if !bridge.road.is_empty() {
        let mass: f64 = bridge.masses.iter().map(|fill| fill.mass).sum();
        let levels: Vec<f64> = bridge.layers.iter().map(|layer| layer.0).filter(|level| level.is_finite()).collect();
        let layers = if levels.is_empty() { String::new() } else { format!(", layers up to {levels:?} m") };
        let spread = case.resolved.at("scene.fill.dispersion.law").and_then(Json::as_str).unwrap_or("none");
        let _ = writeln!(
            text,
            "  fill: {:.3} t on {} faces{layers}; dispersion {spread}; {} horizontal reactions at chords of the extrados",
            mass / 1000.0,
            bridge.extrados.len(),
            bridge.reactions.len()
        );
    }
    let vehicles: BTreeMap<String, VehicleAxles> = case.resolved.read("vehicles").unwrap_or_default();
    for (name, VehicleAxles { axles }) in &vehicles {
        let total: f64 = axles.iter().map(|axle| axle.force * axle.lift_off).sum();
        let _ = writeln!(text, "  vehicle \"{name}\": {} axle(s), {:.3} kN", axles.len(), total / 1000.0);
    }
    if let Some(factors) = case.resolved.get("factors") {
        let _ = writeln!(text, "  partial factors: {}", words(factors));
    }
}

/// Returns a table in one line.
fn words(table: &Json) -> String {
    let entry = |(key, value): (&String, &Json)| match value {
        Json::String(text) => format!("{key} {text}"),
        value => format!("{key} {value}"),
    };
    table
        .as_object()
        .into_iter()
        .flatten()
        .filter(|(_, value)| !value.is_null())
        .map(entry)
        .collect::<Vec<_>>()
        .join(", ")
}
