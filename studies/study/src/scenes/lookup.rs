//! Names and numbers in a scene's table, and the messages for wrong ones.

use crate::config::synonyms::nearest_name;
use voussoir_core::model::Catalogue;
use voussoir_core::plugin::keys::like;
use voussoir_core::plugin::{Diagnostic, Keys, Range, Shape};

/// Returns the index of a material, or a mistake at `path`.
pub(crate) fn material(catalogue: &Catalogue, name: &str, path: &str) -> Result<usize, Diagnostic> {
    catalogue
        .material(name)
        .ok_or_else(|| unknown(path, "material", name, catalogue.materials.iter().map(|(name, _)| name.as_str())))
}

/// Returns the index of an interface law, or a mistake at `path`.
pub(crate) fn law(catalogue: &Catalogue, name: &str, path: &str) -> Result<usize, Diagnostic> {
    catalogue
        .law(name)
        .ok_or_else(|| unknown(path, "joint law", name, catalogue.laws.iter().map(|(name, _)| name.as_str())))
}

/// Reports an unknown name, with the nearest valid name.
pub(crate) fn unknown<'a>(path: &str, kind: &str, name: &str, names: impl Iterator<Item = &'a str>) -> Diagnostic {
    let diagnostic = Diagnostic::new(path, format!("there is no {kind} called \"{name}\""));
    match nearest_name(name, names) {
        Some(near) => diagnostic.help(format!("did you mean \"{near}\"?")),
        None => diagnostic,
    }
}

/// Returns a diagnostic for a number outside a range; `None` if it is inside.
pub(crate) fn outside(range: Range, path: &str, value: f64) -> Option<Diagnostic> {
    (!range.contains(value)).then(|| Diagnostic::new(path, format!("{value} must be {}", range.describe())))
}

/// Returns a diagnostic for a number outside the range of its key, which is the last name in `path`; `None` if it is inside.
///
/// # Panics
/// The table `T` has no such key, or the key is no number.
pub(crate) fn out_of_range<T: Keys>(path: &str, value: f64) -> Option<Diagnostic> {
    let name = path.rsplit('.').find(|word| word.parse::<usize>().is_err()).unwrap_or(path);
    match &like(T::PARAMETERS, name).shape {
        Shape::Number(_, range) | Shape::Tuple([(_, Shape::Number(_, range)), ..]) => outside(*range, path, value),
        _ => panic!("{name} is no number"),
    }
}

/// Returns the value, or adds its mistake to the list.
pub(crate) fn take<T>(result: Result<T, Diagnostic>, diagnostics: &mut Vec<Diagnostic>) -> Option<T> {
    result.map_err(|diagnostic| diagnostics.push(diagnostic)).ok()
}

/// Returns diagnostics with paths from the scene's table in the form of a card's check.
pub(crate) fn pairs_of(diagnostics: Vec<Diagnostic>) -> Vec<(String, String)> {
    let words = |diagnostic: Diagnostic| match diagnostic.help {
        Some(help) => (diagnostic.path, format!("{}; {help}", diagnostic.message)),
        None => (diagnostic.path, diagnostic.message),
    };
    diagnostics.into_iter().map(words).collect()
}

/// Converts paths from the scene's table into paths from the study's root.
pub(crate) fn from_root(diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics.into_iter().map(|wrong| wrong.below("scene")).collect()
}
