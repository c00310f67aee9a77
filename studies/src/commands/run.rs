//! `voussoir run`.

use super::codes::{FINE, NO_ACCESS, NOT_PROVEN, WRONG_INPUT, say};
use super::files;
use super::folder::{JOURNAL, ResultFolder};
use super::progress::Progress;
use crate::kinds::{LoadedStudy, RunRequest};
use std::path::{Path, PathBuf};

/// Options of the command.
pub struct Options {
    /// Where results go.
    pub out: Option<PathBuf>,
    /// KEY=VALUE overrides.
    pub set: Vec<String>,
    /// Cases side by side.
    pub jobs: usize,
    /// Only this case.
    pub case: Option<usize>,
    /// Go on from finished cases.
    pub resume: bool,
    /// Print nothing but errors.
    pub quiet: bool,
}

/// Runs studies of any kind; the greatest exit code of them. Every study is checked before the first is run.
pub fn run(paths: &[PathBuf], options: &Options) -> u8 {
    let sets = match files::overrides(&options.set) {
        Ok(sets) => sets,
        Err(code) => return code,
    };
    let (mut studies, mut wrong) = (Vec::new(), FINE);
    for path in paths {
        match files::study(path, &sets) {
            Ok(study) => studies.push((path, study)),
            Err(code) => wrong = wrong.max(code),
        }
    }
    if wrong == FINE {
        wrong = same_names(&studies);
    }
    if wrong != FINE {
        return wrong;
    }
    let mut code = FINE;
    for (path, study) in &studies {
        let dir = match &options.out {
            Some(dir) if studies.len() > 1 => dir.join(study.name()),
            Some(dir) => dir.clone(),
            None => Path::new("results").join(study.name()),
        };
        let foreign = if options.out.is_none() { results_of_another(path, &dir) } else { FINE };
        code = code.max(match foreign {
            FINE => run_one(study.as_ref(), path, &dir, options).unwrap_or_else(|code| code),
            foreign => foreign,
        });
    }
    code
}

/// Refuses studies that would write into one folder.
fn same_names(studies: &[(&PathBuf, Box<dyn LoadedStudy>)]) -> u8 {
    for (index, (path, study)) in studies.iter().enumerate() {
        // File systems may not tell capitals apart.
        let same = |other: &str| other.to_lowercase() == study.name().to_lowercase();
        if let Some((first, _)) = studies[..index].iter().find(|(_, earlier)| same(earlier.name())) {
            eprintln!(
                "{}: this study is called \"{}\", as that of {}: their results would overwrite each other; give one another \
                 name, or run them one by one with --out",
                path.display(),
                study.name(),
                first.display()
            );
            return WRONG_INPUT;
        }
    }
    FINE
}

/// The first line of resolved.toml: which file was run.
const SOURCE: &str = "# study: ";

/// Refuses a default folder that holds the results of another study file that is still there.
fn results_of_another(path: &Path, dir: &Path) -> u8 {
    let resolved = std::fs::read_to_string(dir.join("resolved.toml")).unwrap_or_default();
    let Some(source) = resolved.lines().next().and_then(|line| line.strip_prefix(SOURCE)) else { return FINE };
    let places = (Path::new(source).canonicalize(), path.canonicalize());
    let (Ok(earlier), Ok(own)) = places else { return FINE };
    if earlier == own {
        return FINE;
    }
    eprintln!(
        "{}: {} holds the results of {source}, a study of the same name; give one of them another name, or say where \
         results go with --out",
        path.display(),
        dir.display()
    );
    WRONG_INPUT
}

/// Cases side by side that help: no more than processors.
pub(super) fn useful_jobs(jobs: usize) -> usize {
    jobs.clamp(1, std::thread::available_parallelism().map_or(1, usize::from))
}

/// Ids of the cases that are asked for.
fn wanted(study: &dyn LoadedStudy, case: Option<usize>) -> Result<Vec<usize>, u8> {
    match case {
        Some(id) if id < study.count() => Ok(vec![id]),
        Some(id) => {
            let last = study.count().saturating_sub(1);
            eprintln!("--case {id}: the study \"{}\" has cases 0 to {last}", study.name());
            Err(WRONG_INPUT)
        }
        None => Ok((0..study.count()).collect()),
    }
}

fn run_one(study: &dyn LoadedStudy, path: &Path, dir: &Path, options: &Options) -> Result<u8, u8> {
    let resolved = toml::to_string(study.resolved()).map_err(|error| {
        eprintln!("voussoir: the study \"{}\" cannot be written back: {error}", study.name());
        NO_ACCESS
    })?;
    let wanted = wanted(study, options.case)?;
    let folder = ResultFolder::open(dir)?;
    let (mut code, mut parts) = (FINE, Vec::new());
    for part in study.parts() {
        let own = dir.join(&part.folder);
        code = code.max(run_one(part.study.as_ref(), Path::new(&part.file), &own, options)?);
        parts.push(files::read(&own.join("results.json"))?);
    }
    let keep = options.case.is_some();
    let stored = (options.resume || keep).then(|| [folder.read("results.json"), folder.read(JOURNAL)]);
    let progress = Progress::new(study.name(), options.quiet, folder.journal(options.resume || keep));
    let request = RunRequest {
        wanted,
        jobs: useful_jobs(options.jobs),
        resume: options.resume,
        keep,
        stored,
        version: env!("CARGO_PKG_VERSION").into(),
        date: Some(today()),
        parts,
    };
    let output = study.run(&request, &progress);
    progress.finish();
    let resolved = format!("{SOURCE}{}\n{resolved}", path.display().to_string().replace(['\n', '\r'], " "));
    folder.write("resolved.toml", resolved.as_bytes())?;
    // What is worth most comes first: a disk may be full.
    let (results, others): (Vec<_>, Vec<_>) = output.files.iter().partition(|(name, _)| name == "results.json");
    for (name, bytes) in results.into_iter().chain(others) {
        folder.write(name, bytes)?;
    }
    folder.remove_left_over(&output.files);
    if !options.quiet {
        say(output.table);
        output.remarks.iter().for_each(say);
        say(format!("results in {}", folder.path().display()));
    }
    Ok(code.max(if output.certified { FINE } else { NOT_PROVEN }))
}

/// The day in UTC, as 2026-11-22.
fn today() -> String {
    let seconds = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |since| since.as_secs());
    date_of(seconds / 86_400)
}

/// The date so many days after the first of January 1970.
fn date_of(mut days: u64) -> String {
    let leap = |year: u64| year.is_multiple_of(4) && !year.is_multiple_of(100) || year.is_multiple_of(400);
    let mut year = 1970;
    while days >= 365 + u64::from(leap(year)) {
        days -= 365 + u64::from(leap(year));
        year += 1;
    }
    let lengths = [31, 28 + u64::from(leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 0;
    while days >= lengths[month] {
        days -= lengths[month];
        month += 1;
    }
    format!("{year}-{:02}-{:02}", month + 1, days + 1)
}

#[cfg(test)]
mod tests {
    use super::date_of;

    #[test]
    fn days_are_dates() {
        assert_eq!(
            [0, 59, 11_016, 11_017, 20_778].map(date_of),
            ["1970-01-01", "1970-03-01", "2000-02-29", "2000-03-01", "2026-11-21"]
        );
    }
}
