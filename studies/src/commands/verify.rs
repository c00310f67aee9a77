//! `voussoir verify`.

use super::codes::{FINE, NOT_PROVEN, WRONG_INPUT, say};
use super::files;
use std::path::Path;

/// Checks a results folder.
pub fn verify(dir: &Path) -> u8 {
    match confirm(dir) {
        Ok(code) | Err(code) => code,
    }
}

fn confirm(dir: &Path) -> Result<u8, u8> {
    let path = dir.join("results.json");
    let results = files::read(&path)?;
    let study = files::study(&dir.join("resolved.toml"), &[])?;
    let found = study.verify(&results).map_err(|error| {
        eprintln!("{}: not a results file: {error}", path.display());
        WRONG_INPUT
    })?;
    for (id, why) in &found.findings {
        say(format!("case {id}: {why}"));
    }
    if found.findings.is_empty() {
        let confirmed = found.cases - found.stalled;
        say(format!("{}: {confirmed} case(s) confirmed, {} stalled", path.display(), found.stalled));
    } else {
        say(format!("{}: {} finding(s); the results do not hold", path.display(), found.findings.len()));
    }
    Ok(if found.findings.is_empty() && found.stalled == 0 { FINE } else { NOT_PROVEN })
}
