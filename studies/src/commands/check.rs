//! `voussoir check`.

use super::codes::{FINE, say};
use super::files;
use std::path::PathBuf;

/// Checks studies; prints what they hold.
pub fn check(paths: &[PathBuf], sets: &[String]) -> u8 {
    let sets = match files::overrides(sets) {
        Ok(sets) => sets,
        Err(code) => return code,
    };
    let mut code = FINE;
    for path in paths {
        match files::study(path, &sets) {
            Ok(study) => {
                study.notes().into_iter().for_each(|note| say(format!("{}: note: {note}", path.display())));
                say(format!("{}: fine, {} case(s)", path.display(), study.count()));
            }
            Err(wrong) => code = code.max(wrong),
        }
    }
    code
}
