//! `voussoir merge`: combines the parts of a study into the results of a whole run.

use super::by_case::backings;
use super::case_lines::CaseLines;
use super::error::{CliError, Outcome};
use super::files;
use super::folder::{JOURNAL, ResultFolder};
use super::options::useful_jobs;
use super::outputs::{tally, verdict, write_outputs};
use super::print::say;
use super::shard::{PART, PartEnd, PartHead, study_hash};
use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use voussoir_study::caught::{caught, silence_caught_panics};
use voussoir_study::regular_file::open_regular;
use voussoir_study::side_by_side::side_by_side;
use voussoir_study::study::Study;
use voussoir_verify::BackingCount;

/// Greatest number of ids in a message.
const NAMED: usize = 12;
/// Greatest length of a part.
const MAX_PART_BYTES: u64 = 1 << 40;
/// Greatest length of the first line of a part.
const MAX_HEAD_BYTES: u64 = 1 << 16;

/// Options of a merge.
pub struct MergeOptions {
    /// The folder for the results.
    pub out: Option<PathBuf>,
    /// Number of cases that are checked in parallel.
    pub jobs: usize,
    /// Print nothing but errors.
    pub quiet: bool,
}

/// Merges parts.
pub fn merge(dirs: &[PathBuf], options: &MergeOptions) -> Outcome {
    silence_caught_panics();
    caught(|| merged(dirs, options)).unwrap_or_else(|why| Err(wrong(why)))
}

fn wrong(text: impl std::fmt::Display) -> CliError {
    CliError::wrong_input(format_args!("voussoir merge: {text}; nothing was written"))
}

/// A part of a study.
struct Part {
    folder: PathBuf,
    head: PartHead,
}

fn merged(dirs: &[PathBuf], options: &MergeOptions) -> Outcome {
    let parts = dirs.iter().map(|dir| found(dir)).collect::<Result<Vec<_>, _>>()?.concat();
    let mut lines = CaseLines::default();
    let parts = parts.into_iter().map(|folder| read_part(&folder, &mut lines)).collect::<Result<Vec<_>, _>>()?;
    let first = parts.first().ok_or_else(|| wrong("no part was found"))?;
    same_study(&parts)?;
    let resolved = first.folder.join("resolved.toml");
    open_regular(&resolved, MAX_PART_BYTES).map_err(|error| CliError::of_file(&resolved, error))?;
    let study = files::study(&resolved, &[])?;
    if study_hash(study.resolved()) != first.head.study_hash {
        return Err(wrong(format!(
            "{}: resolved.toml has another hash than the study of its cases; copy the folder again",
            first.folder.display()
        )));
    }
    let cases = study.with_cases().ok_or_else(|| wrong("this kind of study is not solved in parts"))?;
    let doubles = lines.sort();
    if !doubles.is_empty() {
        return Err(wrong(format!("{} stand in two parts", named(&doubles))));
    }
    let there: BTreeSet<usize> = lines.ids().collect();
    let missing: Vec<usize> = (0..study.count()).filter(|id| !there.contains(id)).collect();
    if !missing.is_empty() {
        return Err(wrong(format!(
            "{} of {} are missing: {}",
            missing.len(),
            study.count(),
            hint(&parts, &missing, cases)
        )));
    }
    let jobs = useful_jobs(options.jobs);
    let count = confirmed(cases, &lines, jobs)?;
    let out = match (&options.out, dirs) {
        (Some(out), _) => out.clone(),
        (None, [dir]) if !dir.join(PART).is_file() => dir.clone(),
        _ => return Err(wrong("say where the results go with --out DIR")),
    };
    let text = files::read(&first.folder.join("resolved.toml"))?;
    let folder = ResultFolder::open(&out)?;
    if !options.quiet {
        say(format!("{} cases: {count}", lines.ids().count()));
    }
    let write = || write_outputs(cases, &folder, &text, &lines, (jobs, options.quiet));
    let made = side_by_side(jobs, write)?;
    if !options.quiet {
        say(made.table + &tally(&made.totals, &lines, cases.makes_cases()));
        say(format!("{} parts confirmed and merged; results in {}", parts.len(), out.display()));
    }
    Ok(verdict(&made.totals))
}

/// Returns the folders of parts in a folder, or the folder itself.
fn found(dir: &Path) -> Result<Vec<PathBuf>, CliError> {
    if dir.join(PART).is_file() {
        return Ok(vec![dir.into()]);
    }
    let listed = std::fs::read_dir(dir).map_err(|error| CliError::of_file(dir, error))?;
    let mut folders: Vec<PathBuf> = listed.flatten().map(|entry| entry.path()).collect();
    folders.retain(|folder| folder.file_name().is_some_and(|name| name.to_string_lossy().starts_with("shard-")));
    folders.sort();
    match folders.iter().find(|folder| !folder.join(PART).is_file()) {
        Some(folder) => {
            let why = match folder.join(JOURNAL).is_file() {
                true => "is not finished: run it again with --resume",
                false => "holds no cases",
            };
            Err(wrong(format!("{} {why}", folder.display())))
        }
        None if folders.is_empty() => Err(wrong(format!(
            "{} holds no part; parts are written by `voussoir run STUDY --shard M/N`",
            dir.display()
        ))),
        None => Ok(folders),
    }
}

/// Reads the head of a complete part and adds its lines.
fn read_part(folder: &Path, lines: &mut CaseLines) -> Result<Part, CliError> {
    let path = folder.join(PART);
    let mut file = open_regular(&path, MAX_PART_BYTES).map_err(|error| CliError::of_file(&path, error))?;
    let mut first = Vec::new();
    let read = BufReader::new(&file).take(MAX_HEAD_BYTES).read_until(b'\n', &mut first);
    read.map_err(|error| CliError::of_file(&path, error))?;
    let head: PartHead = serde_json::from_slice(&first)
        .map_err(|error| wrong(format!("{} is no part of a study: {error}", path.display())))?;
    let mut tail = Vec::new();
    let length = file.seek(SeekFrom::End(0)).unwrap_or(0);
    let read = file.seek(SeekFrom::Start(length.saturating_sub(64))).and_then(|_| file.read_to_end(&mut tail));
    read.map_err(|error| CliError::of_file(&path, error))?;
    let last = tail.trim_ascii_end().rsplit(|byte| *byte == b'\n').next().unwrap_or_default();
    let end: PartEnd =
        serde_json::from_slice(last).map_err(|_| wrong(format!("{} is cut short: copy it again", path.display())))?;
    let before = lines.ids().count();
    let damaged = lines.add(&path, 0, &mut |_| true).map_err(|error| CliError::of_file(&path, error))?;
    if damaged > 0 {
        return Err(wrong(format!("{damaged} lines of {} are damaged: copy it again", path.display())));
    }
    let count = lines.ids().count() - before;
    if count != end.cases_in_part {
        let what = format!("{} holds {count} cases and says {}", path.display(), end.cases_in_part);
        return Err(wrong(what));
    }
    Ok(Part { folder: folder.into(), head })
}

/// Checks that all parts have the same study, version and number of parts.
fn same_study(parts: &[Part]) -> Result<(), CliError> {
    let Some(first) = parts.first() else { return Ok(()) };
    for part in parts {
        let (a, b) = (&first.head, &part.head);
        let differ = |what: &str, x: &str, y: &str| {
            let (one, other) = (first.folder.display(), part.folder.display());
            Err(wrong(format!("{one} is of {what} {x}, {other} of {what} {y}")))
        };
        if b.version != env!("CARGO_PKG_VERSION") {
            let own = env!("CARGO_PKG_VERSION");
            return Err(wrong(format!("{} was solved by version {}, this is {own}", part.folder.display(), b.version)));
        }
        if a.study != b.study {
            return differ("the study", &format!("\"{}\"", a.study), &format!("\"{}\"", b.study));
        }
        if a.study_hash != b.study_hash {
            let (one, other) = (first.folder.display(), part.folder.display());
            return Err(wrong(format!("{one} and {other} were solved from different versions of the study file")));
        }
        if a.shard.of != b.shard.of {
            return differ("a study in parts of", &a.shard.of.to_string(), &b.shard.of.to_string());
        }
    }
    Ok(())
}

/// Formats the first ids of a list.
fn named(ids: &[usize]) -> String {
    let first: Vec<String> = ids.iter().take(NAMED).map(usize::to_string).collect();
    let more = if ids.len() > NAMED { format!(" and {} more", ids.len() - NAMED) } else { String::new() };
    format!("{} {}{more}", if ids.len() == 1 { "case" } else { "cases" }, first.join(", "))
}

/// Names the missing cases and the parts that should contain them.
fn hint(parts: &[Part], missing: &[usize], cases: &Study) -> String {
    let of = parts.first().map_or(1, |part| part.head.shard.of);
    let there: BTreeSet<usize> = parts.iter().map(|part| part.head.shard.number).collect();
    let absent: Vec<String> = (1..=of).filter(|number| !there.contains(number)).map(|n| format!("{n}/{of}")).collect();
    let mut text = named(missing);
    if !absent.is_empty() {
        text += &format!(
            "; the part{} {} {} not there",
            if absent.len() == 1 { "" } else { "s" },
            absent.join(", "),
            if absent.len() == 1 { "is" } else { "are" }
        );
    } else if let Some(part) = missing.first().and_then(|id| cases.part(*id, of)) {
        text += &format!("; the first belongs to the part {}/{of}", part + 1);
    }
    text
}

/// Checks that every case belongs to the study and is confirmed by its own proof.
fn confirmed(cases: &Study, lines: &CaseLines, jobs: usize) -> Result<BackingCount, CliError> {
    let found = backings(cases, lines, jobs).map_err(|error| CliError::of_file(Path::new(PART), error))?;
    let (mut count, mut findings) = (BackingCount::default(), Vec::new());
    for (id, backing) in lines.ids().zip(found) {
        match backing {
            Ok(backing) => count.add(backing),
            Err(wrong) => findings.extend(wrong.into_iter().map(|why| format!("case {id}: {why}"))),
        }
    }
    if findings.is_empty() {
        return Ok(count);
    }
    let mut error = wrong(format!("{} finding(s): the parts do not hold", findings.len()));
    error.diagnostics.splice(0..0, findings.into_iter().take(NAMED));
    Err(error)
}
