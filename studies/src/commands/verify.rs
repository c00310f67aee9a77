//! `voussoir verify`.

use super::codes::{FINE, NO_ACCESS, NOT_PROVEN, WRONG_INPUT, say};
use super::files;
use super::folder::named_by_writers;
use super::options::useful_jobs;
use super::progress::{Progress, Shown};
use crate::kinds::StoredResults;
use std::io::Read;
use std::path::Path;

/// Checks a results folder, `jobs` cases side by side.
pub fn verify(dir: &Path, jobs: usize) -> u8 {
    match confirm(dir, jobs) {
        Ok(code) | Err(code) => code,
    }
}

fn confirm(dir: &Path, jobs: usize) -> Result<u8, u8> {
    let path = dir.join("results.json");
    let readable = std::fs::File::open(&path);
    readable.map_err(|error| {
        eprintln!("voussoir: cannot read {}: {error}", path.display());
        NO_ACCESS
    })?;
    let study = files::study(&dir.join("resolved.toml"), &[])?;
    let mut code = FINE;
    for part in study.parts() {
        code = code.max(confirm(&dir.join(&part.folder), jobs)?);
    }
    let progress = Progress::new(study.name(), Shown::Bar, None);
    let file = |name: &str| std::fs::File::open(dir.join(name)).ok().map(|file| Box::new(file) as Box<dyn Read>);
    let stored = StoredResults { jobs: useful_jobs(jobs), file: &file };
    let found = study.verify_stored(&stored, &progress);
    progress.finish();
    let mut found = found.map_err(|error| {
        eprintln!("{}: not a results file: {error}", path.display());
        WRONG_INPUT
    })?;
    // Where cases are missing nothing is made, and what they wrote is not foreign for that.
    if !found.made.is_empty() {
        let foreign = named_by_writers(dir).into_iter().filter(|name| !found.made.contains(name));
        found.files.extend(foreign.map(|name| format!("{name} is none of the files that results.json gives")));
    }
    found.findings.iter().for_each(|(id, why)| say(format!("case {id}: {why}")));
    found.files.iter().for_each(say);
    let wrong = found.findings.len() + found.files.len();
    if wrong == 0 {
        let confirmed = found.cases - found.stalled;
        let of = if found.cases < found.of { format!(" of the study's {}", found.of) } else { String::new() };
        say(format!("{}: {confirmed} case(s){of} confirmed, {} stalled", path.display(), found.stalled));
        say(found.how);
    } else {
        say(format!("{}: {wrong} finding(s); the results do not hold", path.display()));
    }
    Ok(if wrong == 0 && found.stalled == 0 { code } else { NOT_PROVEN })
}
