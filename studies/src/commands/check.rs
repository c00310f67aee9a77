//! `voussoir check`.

use super::error::{Outcome, Verdict, joined};
use super::files;
use super::print::say;
use std::path::{Path, PathBuf};

/// Checks studies and prints their contents.
pub fn check(paths: &[PathBuf], sets: &[String]) -> Outcome {
    let sets = files::overrides(sets)?;
    let one = |path: &Path| {
        let study = files::study(path, &sets)?;
        study.notes().into_iter().for_each(|note| say(format!("{}: note: {note}", path.display())));
        say(format!("{}: fine, {} case(s)", path.display(), study.count()));
        Ok(Verdict::Proved)
    };
    joined(paths.iter().map(|path| one(path)))
}
