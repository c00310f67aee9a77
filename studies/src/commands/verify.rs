//! `voussoir verify`.

use super::{FINE, NOT_PROVEN, WRONG_INPUT, files, say};
use std::path::Path;
use voussoir::core::limit::Status;
use voussoir::results::StudyResults;

/// Checks a results folder.
pub fn verify(dir: &Path) -> u8 {
    match confirm(dir) {
        Ok(code) | Err(code) => code,
    }
}

fn confirm(dir: &Path) -> Result<u8, u8> {
    let path = dir.join("results.json");
    let results: StudyResults = serde_json::from_str(&files::read(&path)?).map_err(|error| {
        eprintln!("{}: not a results file: {error}", path.display());
        WRONG_INPUT
    })?;
    let study = files::study(&dir.join("resolved.toml"), &[])?;
    let wrong = voussoir::verify::verify(&study, &results);
    for (id, why) in &wrong {
        say(format!("case {id}: {why}"));
    }
    let stalled = results.cases.iter().filter(|case| case.status == Status::Stalled).count();
    if wrong.is_empty() {
        let proven = results.cases.len() - stalled;
        say(format!("{}: {proven} case(s) confirmed, {stalled} stalled", path.display()));
    } else {
        say(format!("{}: {} finding(s); the results do not hold", path.display(), wrong.len()));
    }
    Ok(if wrong.is_empty() && stalled == 0 { FINE } else { NOT_PROVEN })
}
