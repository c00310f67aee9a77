//! Stores the studies of random scenes for inspection.

use std::path::Path;

/// Writes a study into the folder that the variable `KEEP` names, if it is set. Creates the folder.
pub fn keep(file: &str, study: &str) {
    let Some(folder) = std::env::var_os("KEEP") else { return };
    keep_in(folder.as_ref(), file, study);
}

/// Writes a study into a folder. Creates the folder.
pub fn keep_in(folder: &Path, file: &str, study: &str) {
    let kept = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(folder.join(file), study));
    kept.unwrap_or_else(|error| panic!("{file} cannot be written into {}: {error}", folder.display()));
}
