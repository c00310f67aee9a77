//! Tables of keys in other units.

use serde_json::Value as Json;
use voussoir_core::plugin::{Parameter, Quantity, Shape, unit_powers};

/// The other units: a length and a stress. They are powers of two, so that nothing is rounded.
pub(super) const LENGTH: f64 = 8.0;
pub(super) const STRESS: f64 = 0.25;

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
    scale_of(unit)
}

/// Returns the factor of a unit of a state or an output; `None` if it is unknown.
pub(super) fn scale_of(unit: &str) -> Option<f64> {
    let [length, stress, ..] = unit_powers(unit)?;
    Some(LENGTH.powi(length) * STRESS.powi(stress))
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

/// Returns a table in the other units.
pub(super) fn scaled_table(table: &Json, parameters: &[Parameter]) -> Json {
    let mut table = table.clone();
    for parameter in parameters {
        if let Some(value) = table.get(parameter.name) {
            table[parameter.name] = scaled(value, &parameter.shape);
        }
    }
    table
}
