//! Units: a joint described in other units behaves in the same way. This finds parameters with a missing or wrong unit.

use super::findings::Recorder;
use super::random::random_step;
use super::samples::{Law, own_check};
use super::subject::Subject;
use serde_json::Value as Json;
use voussoir_core::plugin::{Card, Parameter, Quantity, Shape};
use voussoir_core::random::Random;

/// The other units: a length and a stress. They are powers of two, so that nothing is rounded.
pub(super) const LENGTH: f64 = 8.0;
const STRESS: f64 = 0.25;

/// Returns the factor that converts a quantity into these units.
fn factor(quantity: Quantity) -> f64 {
    match quantity {
        Quantity::Length => LENGTH,
        Quantity::Force => STRESS * LENGTH * LENGTH,
        Quantity::Stress => STRESS,
        Quantity::Stiffness => STRESS / LENGTH,
        Quantity::EnergyPerArea => STRESS * LENGTH,
        Quantity::Ratio
        | Quantity::Degrees
        | Quantity::Radians
        | Quantity::Density
        | Quantity::Acceleration
        | Quantity::Temperature
        | Quantity::Time => 1.0,
    }
}

/// Returns the factor of a state number, from the unit in its name, such as `"slip [m]"`; `None` if the name has no unit.
pub(super) fn state_unit(name: &str) -> Option<f64> {
    let (_, unit) = name.trim_end().strip_suffix(']')?.rsplit_once('[')?;
    match unit {
        "-" | "deg" | "rad" => Some(1.0),
        "m" => Some(LENGTH),
        "1/m" => Some(1.0 / LENGTH),
        "Pa" | "J/m3" => Some(STRESS),
        "Pa/m" => Some(STRESS / LENGTH),
        "J/m2" | "N/m" => Some(STRESS * LENGTH),
        _ => None,
    }
}

/// Returns a value in the other units.
fn scaled(value: &Json, shape: &Shape) -> Json {
    match (shape, value) {
        (Shape::Number(quantity, _), value) => value.as_f64().map_or(value.clone(), |x| (x * factor(*quantity)).into()),
        (Shape::List { of, .. }, Json::Array(entries)) => entries.iter().map(|entry| scaled(entry, of)).collect(),
        (Shape::Tuple(shapes), Json::Array(entries)) => {
            entries.iter().zip(*shapes).map(|(entry, (_, shape))| scaled(entry, shape)).collect()
        }
        (Shape::Table(parameters), value) => scaled_table(value, parameters),
        (Shape::Tagged { key, variants }, value) => {
            let own = variants.iter().find(|variant| value[*key] == variant.tag);
            own.map_or(value.clone(), |variant| scaled_table(value, variant.parameters))
        }
        (Shape::Map(shape), Json::Object(entries)) => {
            entries.iter().map(|(key, entry)| (key.clone(), scaled(entry, shape))).collect()
        }
        (Shape::Either(shapes), value) => {
            let fits = |shape: &&Shape| match shape {
                Shape::Number(..) => value.is_number(),
                Shape::List { .. } | Shape::Tuple(_) => value.is_array(),
                Shape::Table(_) | Shape::Tagged { .. } | Shape::Map(_) => value.is_object(),
                _ => value.is_string(),
            };
            shapes.iter().find(fits).map_or(value.clone(), |shape| scaled(value, shape))
        }
        _ => value.clone(),
    }
}

fn scaled_table(table: &Json, parameters: &[Parameter]) -> Json {
    let mut table = table.clone();
    for parameter in parameters {
        if let Some(value) = table.get(parameter.name) {
            table[parameter.name] = scaled(value, &parameter.shape);
        }
    }
    table
}

/// Returns the law of a sample in the other units; records a finding if there is no such law.
pub(super) fn other_units(recorder: &mut Recorder, card: &Card, table: &Json) -> Option<Law> {
    let table = scaled_table(table, card.parameters);
    let wrong = own_check(card, &table);
    let law = Law::read(card.kind, &table);
    let refused = law.as_ref().err().cloned().or((!wrong.is_empty()).then(|| format!("{wrong:?}")));
    recorder.hold("units", refused.is_none(), || {
        format!(
            "with lengths × {LENGTH} and stresses × {STRESS} it is refused: {}",
            refused.clone().unwrap_or_default()
        )
    });
    law.ok()
}

/// Compares walks in both units.
pub(super) fn check(recorder: &mut Recorder, subject: &Subject, other: &super::point::Point) {
    let Subject { point, sample, stiffness, .. } = subject;
    let joint = point.components() == 2;
    let place = if joint { LENGTH } else { 1.0 };
    let units: Vec<f64> = point.state_names().iter().map(|name| state_unit(name).unwrap_or(1.0)).collect();
    let (mut random, worst) = (Random::new(13), 1e-6 * stiffness * sample.size);
    for _ in 0..30 {
        let (mut old, mut old_there) = (point.untouched(), other.untouched());
        let (mut at, mut path) = ([0.0; 6], Vec::new());
        for _ in 0..20 {
            random_step(&mut random, &mut at, point.components(), sample.size);
            path.push(at);
            let (mut new, mut new_there) = (old.clone(), old_there.clone());
            let here = point.update(&at, &old, &mut new);
            let there = other.update(&at.map(|x| x * place), &old_there, &mut new_there);
            let (Ok(here), Ok(there)) = (here, there) else { break };
            let off = (0..6).map(|i| (there.force[i] / STRESS - here.force[i]).abs()).fold(0.0, f64::max);
            recorder.hold_on("units", off <= worst, &path, || {
                format!(
                    "with lengths × {LENGTH} and stresses × {STRESS} it carries {:?}, not {:?}: a parameter's unit is missing or wrong",
                    there.force.map(|f| f / STRESS),
                    here.force
                )
            });
            let energy = if joint { STRESS * LENGTH } else { STRESS };
            let off = (there.stored / energy - here.stored).abs() + (there.dissipated / energy - here.dissipated).abs();
            recorder.hold_on("units", off <= worst * sample.size, &path, || "its energies depend on the units".into());
            let near = |i: usize| {
                let (a, b) = (new[i], new_there[i] / units[i]);
                (a - b).abs() <= 1e-6 * (a.abs() + b.abs()) + 1e-9 * sample.size
            };
            recorder.hold_on("state", (0..units.len()).all(near), &path, || {
                format!(
                    "in other units the state is {new_there:?}, not {new:?}: a number of {:?} has another unit",
                    point.state_names()
                )
            });
            (old, old_there) = (new, new_there);
        }
    }
}
