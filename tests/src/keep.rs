//! Studies of random scenes that are kept to be looked at.

use std::path::Path;

/// Writes a study into the folder that `KEEP` names, if it does; the folder is made.
pub fn keep(file: &str, study: &str) {
    let Some(folder) = std::env::var_os("KEEP") else { return };
    let folder = Path::new(&folder);
    let kept = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(folder.join(file), study));
    kept.unwrap_or_else(|error| panic!("KEEP: {file} cannot be written into {}: {error}", folder.display()));
}
