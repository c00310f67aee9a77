//! Studies of random scenes that are kept to be looked at.

use std::path::Path;

/// Writes a study into the folder that `KEEP` names, if it does; the folder is made.
pub fn keep(file: &str, study: &str) {
    let Some(folder) = std::env::var_os("KEEP") else { return };
    keep_in(folder.as_ref(), file, study);
}

/// Writes a study into a folder; the folder is made.
pub fn keep_in(folder: &Path, file: &str, study: &str) {
    let kept = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(folder.join(file), study));
    kept.unwrap_or_else(|error| panic!("{file} cannot be written into {}: {error}", folder.display()));
}
