//! `voussoir check`.

use super::{FINE, files, say};
use std::path::PathBuf;

/// Checks studies; prints what they hold.
pub fn check(paths: &[PathBuf], sets: &[String]) -> u8 {
    let sets = match files::overrides(sets) {
        Ok(sets) => sets,
        Err(code) => return code,
    };
    let mut code = FINE;
    for path in paths {
        if files::is_point(path, &sets) {
            match files::point_study(path, &sets) {
                Ok(study) => say(format!("{}: fine, {} case(s)", path.display(), study.cases.len())),
                Err(wrong) => code = code.max(wrong),
            }
            continue;
        }
        match files::study(path, &sets) {
            Ok(study) => say(format!("{}: fine, {} case(s)", path.display(), study.cases.len())),
            Err(wrong) => code = code.max(wrong),
        }
    }
    code
}
