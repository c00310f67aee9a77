//! Reading and writing files: written aside and renamed, so that a killed run leaves no half file.

use super::{NO_ACCESS, WRONG_INPUT};
use std::path::Path;
use voussoir::config::report::Mistake;
use voussoir::kinds::point::{self, PointStudy};
use voussoir::study::{Study, load};

/// Reads a file, or says why not.
pub fn read(path: &Path) -> Result<String, u8> {
    std::fs::read_to_string(path).map_err(|error| {
        eprintln!("voussoir: cannot read {}: {error}", path.display());
        NO_ACCESS
    })
}

/// Writes a file whole or not at all.
pub fn write(path: &Path, text: &str) -> Result<(), u8> {
    let aside = path.with_extension(format!("{}.tmp", path.extension().unwrap_or_default().to_string_lossy()));
    let attempt = || -> std::io::Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        std::fs::write(&aside, text)?;
        std::fs::rename(&aside, path)
    };
    attempt().map_err(|error| {
        eprintln!("voussoir: cannot write {}: {error}", path.display());
        NO_ACCESS
    })
}

/// Splits KEY=VALUE overrides.
pub fn overrides(sets: &[String]) -> Result<Vec<(String, String)>, u8> {
    sets.iter()
        .map(|set| match set.split_once('=') {
            Some((key, value)) => Ok((key.trim().to_string(), value.trim().to_string())),
            None => {
                eprintln!("--set {set}: expected KEY=VALUE, such as --set joints.dry.friction=0.5");
                Err(WRONG_INPUT)
            }
        })
        .collect()
}

/// Reads a study, printing every mistake in it.
pub fn study(path: &Path, sets: &[(String, String)]) -> Result<Study, u8> {
    let text = read(path)?;
    load(&text, &path.display().to_string(), sets).map_err(|mistakes| report(path, &mistakes))
}

fn report(path: &Path, mistakes: &[Mistake]) -> u8 {
    mistakes.iter().for_each(|mistake| eprintln!("{mistake}"));
    let count = mistakes.len();
    eprintln!("{}: {count} mistake{}; nothing was computed", path.display(), if count == 1 { "" } else { "s" });
    WRONG_INPUT
}

/// Whether a file holds a study of a driven point.
pub fn is_point(path: &Path, sets: &[(String, String)]) -> bool {
    std::fs::read_to_string(path).is_ok_and(|text| point::is_point(&text, sets))
}

/// Reads a study of a driven point, printing every mistake in it.
pub fn point_study(path: &Path, sets: &[(String, String)]) -> Result<PointStudy, u8> {
    let text = read(path)?;
    point::load(&text, &path.display().to_string(), sets).map_err(|mistakes| report(path, &mistakes))
}
