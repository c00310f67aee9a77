//! Shapes of values in words, and the check that a value has the outer form of a shape.

use crate::config::diagnostic::any_of;
use crate::config::document::{Node, Value};
use voussoir_core::plugin::{Quantity, Shape};

/// Describes the values that a shape accepts.
pub fn describe(shape: &Shape) -> String {
    match shape {
        Shape::Number(Quantity::Ratio, _) => "a number".into(),
        Shape::Number(quantity, _) => {
            format!("a number in {0} or a text with a unit such as \"1 {0}\"", quantity.unit())
        }
        Shape::Integer { .. } => "a whole number".into(),
        Shape::Boolean => "true or false".into(),
        Shape::Text => "a text in quotes".into(),
        Shape::Choice(words) => any_of(words.iter().copied()),
        Shape::Reference(table) => format!("the name of an entry of [{table}]"),
        Shape::List { of, min, max } => match (*min, *max) {
            (least, most) if least == most => {
                format!("a list of {least} entries, each {}", describe(of))
            }
            _ => format!("a list, each entry {}", describe(of)),
        },
        Shape::Tuple(shapes) => {
            let names: Vec<_> = shapes.iter().map(|(name, _)| *name).collect();
            let mut entries: Vec<_> = shapes.iter().map(|(_, shape)| describe(shape)).collect();
            entries.dedup();
            let each = if entries.len() == 1 { "each " } else { "" };
            format!("a list [{}], {each}{}", names.join(", "), entries.join(" and "))
        }
        Shape::Table(_) | Shape::Map(_) => "a table".into(),
        Shape::Tagged { key, .. } => format!("a table with the key {key}"),
        Shape::Plugin(kind) => format!("a table with the key {}", kind.tag_key()),
        Shape::Either(shapes) => any_shape(shapes),
        Shape::Free => "anything".into(),
    }
}

/// Describes the values that one of several shapes accepts.
pub fn any_shape(shapes: &[Shape]) -> String {
    shapes.iter().map(describe).collect::<Vec<_>>().join(", or ")
}

/// Returns true if a value has the outer form of a shape.
pub fn fits(node: &Node, shape: &Shape) -> bool {
    match (shape, &node.value) {
        (Shape::Free, _) => true,
        (Shape::Either(shapes), _) => shapes.iter().any(|shape| fits(node, shape)),
        (Shape::Number(..), Value::Integer(_) | Value::Float(_)) | (Shape::Integer { .. }, Value::Integer(_)) => true,
        (Shape::Number(..), Value::String(text)) => {
            text.trim_start().starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'))
        }
        (Shape::Boolean, Value::Boolean(_)) => true,
        (Shape::Text | Shape::Choice(_) | Shape::Reference(_), Value::String(_)) => true,
        (Shape::List { .. } | Shape::Tuple(_), Value::Array(_)) => true,
        (Shape::Table(_) | Shape::Map(_) | Shape::Tagged { .. } | Shape::Plugin(_), Value::Table(_)) => true,
        _ => false,
    }
}
