//! `voussoir verify`.

use super::error::{CliError, Outcome, Verdict};
use super::files;
use super::options::useful_jobs;
use super::print::say;
use super::progress::{Progress, Shown};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use voussoir_study::caught::{caught, silence_caught_panics};
use voussoir_study::kind::{LoadedStudy, StoredResults, Verification};
use voussoir_study::regular_file::open_regular;
use voussoir_study::results::stored_path::PATH_PROOFS;
use voussoir_verify::first_difference;

/// Greatest length of a results.json that is read into memory.
const MAX_HELD_BYTES: u64 = 4 << 30;
/// Greatest length of any other file of a results folder.
const MAX_FILE_BYTES: u64 = 1 << 40;
/// Greatest length of a resolved study.
const MAX_STUDY_BYTES: u64 = 64 << 20;
/// Greatest number of listed findings.
const LISTED: usize = 1000;

/// Arguments of `voussoir verify`.
pub struct VerifyOptions {
    /// The study file that the results must belong to.
    pub study: Option<PathBuf>,
    /// KEY=VALUE overrides of that file.
    pub set: Vec<String>,
    /// Accept a folder that contains only some of the cases.
    pub partial: bool,
    /// Number of cases that are checked in parallel.
    pub jobs: usize,
}

/// Checks a results folder.
pub fn verify(dir: &Path, options: &VerifyOptions) -> Outcome {
    silence_caught_panics();
    let checked = caught(|| {
        let sets = files::overrides(&options.set)?;
        let wanted = options.study.as_ref().map(|path| files::study(path, &sets)).transpose()?;
        confirm(dir, wanted.as_deref(), options).map(|checked| checked.verdict)
    });
    checked.unwrap_or_else(|why| {
        say(format!("{}: {why}", dir.display()));
        Ok(Verdict::NotProved)
    })
}

/// The outcome of the check of one folder.
struct Checked {
    verdict: Verdict,
    /// True if there are no findings, also not in its parts.
    holds: bool,
}

/// Opens a file that a results folder must have.
fn opened(dir: &Path, name: &str, limit: u64) -> Result<File, CliError> {
    let path = dir.join(name);
    open_regular(&path, limit).map_err(|error| {
        let help = match error.kind() {
            _ if dir.is_file() => "; verify checks a results folder, not a file".into(),
            ErrorKind::NotFound if !dir.exists() => files::did_you_mean(dir, &|own| own.is_dir()),
            ErrorKind::NotFound => "; is this a results folder?".into(),
            _ => String::new(),
        };
        let why = format!("voussoir: cannot read {}: {error}{help}", path.display());
        let no_results = error.kind() == ErrorKind::NotFound && dir.is_dir();
        match error.kind() {
            ErrorKind::InvalidInput | ErrorKind::FileTooLarge => CliError::wrong_input(why),
            _ if no_results => CliError::wrong_input(why),
            _ => CliError::no_access(why),
        }
    })
}

/// A file that cannot be read.
struct Unreadable(ErrorKind);

impl Read for Unreadable {
    fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
        Err(self.0.into())
    }
}

fn confirm(dir: &Path, wanted: Option<&dyn LoadedStudy>, options: &VerifyOptions) -> Result<Checked, CliError> {
    opened(dir, "results.json", MAX_FILE_BYTES)?;
    opened(dir, "resolved.toml", MAX_STUDY_BYTES)?;
    let study = files::study(&dir.join("resolved.toml"), &[])?;
    let mut whole = Checked { verdict: Verdict::Proved, holds: true };
    let mut findings = Vec::new();
    if let Some(why) = wanted.and_then(|wanted| first_difference(study.resolved(), wanted.resolved())) {
        findings.push(format!("the folder does not answer this study: {why}"));
    }
    for part in study.parts() {
        let own = wanted.and_then(|wanted| wanted.parts().iter().find(|own| own.folder == part.folder));
        let checked = confirm(&dir.join(&part.folder), own.map(|own| own.study.as_ref()), options)?;
        whole = Checked { verdict: whole.verdict.max(checked.verdict), holds: whole.holds && checked.holds };
    }
    if !whole.holds {
        say(format!("{}: not compared, because a study that it reports on does not hold", dir.display()));
        return Ok(whole);
    }
    let found = compared(dir, study.as_ref(), options.jobs)?;
    findings.extend(found.findings.iter().map(|(id, why)| format!("case {id}: {why}")));
    findings.extend(found.files.iter().cloned());
    if found.own < found.of && !options.partial {
        findings.push(format!(
            "the folder holds {} of the study's {} cases; `--partial` accepts that",
            found.own, found.of
        ));
    }
    Ok(told(&dir.join("results.json"), &findings, &found, whole.verdict))
}

/// Compares a folder with its study.
fn compared(dir: &Path, study: &dyn LoadedStudy, jobs: usize) -> Result<Verification, CliError> {
    let held = study.with_cases().is_none();
    let limit = |name: &str| if name == "results.json" && held { MAX_HELD_BYTES } else { MAX_FILE_BYTES };
    drop(opened(dir, "results.json", limit("results.json"))?);
    let file = |name: &str| match open_regular(&dir.join(name), limit(name)) {
        Ok(file) => Some(Box::new(file) as Box<dyn Read>),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => Some(Box::new(Unreadable(error.kind())) as Box<dyn Read>),
    };
    let progress = Progress::new(study.name(), Shown::Bar);
    let found = study.verify_stored(&StoredResults { jobs: useful_jobs(jobs), file: &file }, &progress);
    progress.finish();
    found.map_err(|error| {
        CliError::wrong_input(format_args!("{}: not a results file: {error}", dir.join("results.json").display()))
    })
}

/// Describes the number of cases that stored paths prove.
fn path_words([proved, not_solved]: [usize; 2]) -> Option<String> {
    let unproved = match not_solved {
        0 => String::new(),
        count => format!(
            "; {count} of them were not solved again: if they have events, branches, stability or rates behind limit points of finite \
             displacements, these are not checked"
        ),
    };
    (proved > 0).then(|| format!("{proved} path(s) proved by the states and witnesses in {PATH_PROOFS}{unproved}"))
}

/// Prints the findings, or the number of confirmed cases.
fn told(path: &Path, findings: &[String], found: &Verification, parts: Verdict) -> Checked {
    findings.iter().take(LISTED).for_each(say);
    if findings.len() > LISTED {
        say(format!("{} more findings are not listed", findings.len() - LISTED));
    }
    let holds = findings.is_empty();
    if holds {
        let confirmed = found.cases - found.stalled;
        let of = if found.own < found.of { format!(" of the study's {}", found.of) } else { String::new() };
        say(format!("{}: {confirmed} case(s){of} confirmed, {} stalled", path.display(), found.stalled));
        path_words(found.paths).iter().for_each(say);
        say(found.how);
        say(found.agreement.words());
    } else {
        say(format!("{}: {} finding(s); the results do not hold", path.display(), findings.len()));
    }
    Checked { verdict: parts.max(Verdict::of(holds && found.stalled == 0)), holds }
}
