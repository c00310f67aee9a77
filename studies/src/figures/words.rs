//! Keys of study files in words: what their cards say of them, short enough for the axis of a chart.

use super::format::unit_of_key;
use voussoir_core::plugin::{Parameter, Shape, cards};

/// What a card says of a key, by the key's last name; `None` where no card knows it.
pub fn summary_of_key(key: &str) -> Option<&'static str> {
    let names = key.rsplit('.').filter(|name| name.parse::<usize>().is_err());
    let name = names.into_iter().next()?;
    let known = cards().into_iter().find_map(|card| in_table(card.parameters, name));
    known.or_else(|| in_table(crate::study::study_keys(), name))
}

fn in_shape(shape: &Shape, name: &str) -> Option<&'static str> {
    match shape {
        Shape::List { of, .. } | Shape::Map(of) => in_shape(of, name),
        Shape::Table(parameters) => in_table(parameters, name),
        Shape::Tagged { variants, .. } => variants.iter().find_map(|variant| in_table(variant.parameters, name)),
        Shape::Either(shapes) => shapes.iter().find_map(|shape| in_shape(shape, name)),
        _ => None,
    }
}

fn in_table(parameters: &[Parameter], name: &str) -> Option<&'static str> {
    let here = parameters.iter().find(|parameter| parameter.name == name).map(|parameter| parameter.doc);
    here.or_else(|| parameters.iter().find_map(|parameter| in_shape(&parameter.shape, name)))
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
        assert!(!title_of_key("stages.1.loads.0.force.0").is_empty());
    }
}
