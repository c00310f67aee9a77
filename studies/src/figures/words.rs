//! Keys of study files in words: what their cards say of them, short enough for the axis of a chart.

use super::format::unit_of_key;
use voussoir_core::plugin::{Parameter, Shape, cards};

/// What a card says of a key, by its last name in the table that the name before it stands for, else by its last name
/// alone; `None` where no card knows it.
pub fn summary_of_key(key: &str) -> Option<&'static str> {
    let mut names = key.rsplit('.').filter(|name| name.parse::<usize>().is_err());
    let name = names.next()?;
    let tables = || cards().iter().map(|card| card.parameters).chain([crate::study::study_keys()]);
    let own = names.next().and_then(|parent| tables().find_map(|table| below(table, parent, name)));
    own.or_else(|| tables().find_map(|table| in_table(table, name)))
}

/// What the first table in a shape gives.
fn in_shape(shape: &Shape, of: &dyn Fn(&'static [Parameter]) -> Option<&'static str>) -> Option<&'static str> {
    match shape {
        Shape::List { of: inner, .. } | Shape::Map(inner) => in_shape(inner, of),
        Shape::Table(parameters) => of(parameters),
        Shape::Tagged { variants, .. } => variants.iter().find_map(|variant| of(variant.parameters)),
        Shape::Either(shapes) => shapes.iter().find_map(|shape| in_shape(shape, of)),
        _ => None,
    }
}

/// A key of this table.
fn direct(table: &'static [Parameter], name: &str) -> Option<&'static str> {
    table.iter().find(|parameter| parameter.name == name).map(|parameter| parameter.doc)
}

/// A key of this table, or of one inside it.
fn in_table(table: &'static [Parameter], name: &str) -> Option<&'static str> {
    let inside = || table.iter().find_map(|parameter| in_shape(&parameter.shape, &|inner| in_table(inner, name)));
    direct(table, name).or_else(inside)
}

/// A key of a table that stands under the key `parent`.
fn below(table: &'static [Parameter], parent: &str, name: &str) -> Option<&'static str> {
    table.iter().find_map(|parameter| {
        let here = (parameter.name == parent).then(|| in_shape(&parameter.shape, &|inner| direct(inner, name)));
        here.flatten().or_else(|| in_shape(&parameter.shape, &|inner| below(inner, parent, name)))
    })
}

/// A key in words: `rise of the intrados`; its last name where no card knows more.
pub fn words_of_key(key: &str) -> String {
    let summary = summary_of_key(key).unwrap_or_default();
    let end = summary.find([',', ':', ';', '(']).unwrap_or(summary.len());
    let words = summary[..end].trim();
    let name = key.rsplit('.').find(|name| name.parse::<usize>().is_err()).unwrap_or(key).replace('_', " ");
    // "bonded: the faces move …" explains the choices, not the key.
    if words.is_empty() || words.starts_with("x ") || words.len() > 60 || summary[end..].starts_with(':') {
        return name;
    }
    // "of the fill" says of what, not what.
    if words.starts_with("of ") {
        return format!("{name} {words}");
    }
    let said = words.to_lowercase();
    let named = name.split(' ').any(|word| said.contains(&word.to_lowercase()[..word.len().min(5)]));
    if named { words.into() } else { format!("{name}, {words}") }
}

/// The title of an axis or a column: `rise of the intrados [m]`.
pub fn title_of_key(key: &str) -> String {
    // One of several numbers under a key says which.
    let words = match key.rsplit('.').next().and_then(|name| name.parse::<usize>().ok()) {
        Some(index) => format!("{}, number {}", words_of_key(key), index + 1),
        None => words_of_key(key),
    };
    unit_of_key(key).map_or(words.clone(), |unit| format!("{words} [{unit}]"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_words_with_units() {
        assert_eq!(title_of_key("scene.profile.rise"), "rise of the intrados [m]");
        assert_eq!(title_of_key("scene.brick.1"), "length and height of a brick, number 2");
        assert_eq!(words_of_key("no.such.strange_key"), "strange key");
        // Words of the table that a key stands in, not of another key of that name.
        assert_eq!(words_of_key("vehicles.bogie.axles.0.length"), "length of the loaded area");
        assert_eq!(words_of_key("scene.piers.0.width"), "width");
        assert!(!title_of_key("stages.1.loads.0.force.0").is_empty());
    }
}
