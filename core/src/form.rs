//! Checks of the form of a solver's answer: lengths of lists, indices, finite numbers. An error names the part that is
//! wrong.

/// Returns an error if a list does not have the length that is needed.
pub(crate) fn check_length(what: &str, length: usize, needed: usize) -> Result<(), String> {
    if length == needed { Ok(()) } else { Err(format!("{what}: {length} entries, {needed} are needed")) }
}

/// Returns an error if a number is not finite.
pub(crate) fn check_finite<'a>(what: &str, numbers: impl IntoIterator<Item = &'a f64>) -> Result<(), String> {
    let finite = numbers.into_iter().all(|number| number.is_finite());
    if finite { Ok(()) } else { Err(format!("{what}: a number is not finite")) }
}

/// Returns an error if an index is outside a list of this length.
pub(crate) fn check_index(what: &str, index: usize, length: usize) -> Result<(), String> {
    if index < length { Ok(()) } else { Err(format!("{what} {index}: there are {length}")) }
}
