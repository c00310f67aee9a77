//! The gravity of a study, which converts specific weights into densities.

use crate::config::document::{Node, Value};
use voussoir_core::plugin::{Quantity, STANDARD_GRAVITY};

/// Returns the magnitude of the first gravity in the stages of the study; standard gravity if no stage has one.
pub fn gravity_of(root: &Node) -> f64 {
    let number = |node: &Node| match &node.value {
        Value::String(text) => Quantity::Acceleration.parse(text, STANDARD_GRAVITY).ok(),
        _ => node.number(),
    };
    let stages = root.table().and_then(|table| table.get("stages")?.array()).unwrap_or_default();
    let given = stages.iter().find_map(|stage| stage.table()?.get("gravity"));
    let size = given.and_then(|node| match node.array() {
        Some(components @ ([_, _] | [_, _, _])) => {
            components.iter().map(number).try_fold(0.0_f64, |size, component| Some(size.hypot(component?)))
        }
        _ => number(node).map(f64::abs),
    });
    size.filter(|size| size.is_finite() && *size > 0.0).unwrap_or(STANDARD_GRAVITY)
}
