//! Checks of the form of an answer: lengths of lists, indices, numbers that are finite. An error names the part.

/// A list with as many entries as are needed.
pub(crate) fn check_length(what: &str, length: usize, needed: usize) -> Result<(), String> {
    if length == needed { Ok(()) } else { Err(format!("{what}: {length} entries, {needed} are needed")) }
}

/// Numbers that are all finite.
pub(crate) fn check_finite<'a>(what: &str, numbers: impl IntoIterator<Item = &'a f64>) -> Result<(), String> {
    let finite = numbers.into_iter().all(|number| number.is_finite());
    if finite { Ok(()) } else { Err(format!("{what}: a number is not finite")) }
}

/// An index of something that there is.
pub(crate) fn check_index(what: &str, index: usize, length: usize) -> Result<(), String> {
    if index < length { Ok(()) } else { Err(format!("{what} {index}: there are {length}")) }
}
