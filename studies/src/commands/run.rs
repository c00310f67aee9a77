//! `voussoir run`.

use super::by_case::{refill, solve_into_journal};
use super::error::{CliError, Outcome, Verdict, joined};
use super::files;
use super::folder::{JOURNAL, ResultFolder};
use super::open::open;
use super::options::{Options, useful_jobs};
use super::outputs::{tally, verdict, write_outputs};
use super::print::{say, say_data};
use super::progress::Progress;
use super::today::today;
use super::{interrupt, shard};
use serde_json::{Value as Json, json};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use voussoir_report::kinds::one_case;
use voussoir_study::cases::{Observer, label_of};
use voussoir_study::kind::{LoadedStudy, RunRequest};
use voussoir_study::regular_file::open_regular;
use voussoir_study::results::FinishedCases;
use voussoir_study::side_by_side::side_by_side;
use voussoir_study::study::Study;

/// Returns the arguments that continue a run after an interruption.
pub fn going_on(arguments: &[String]) -> Vec<String> {
    let resume = (!arguments.iter().any(|word| word == "--resume")).then(|| "--resume".to_string());
    arguments.iter().cloned().chain(resume).collect()
}

/// Runs studies of any kind. Every study is checked before the first is run.
pub fn run(paths: &[PathBuf], options: &Options) -> Outcome {
    match useful_jobs(options.jobs) {
        1 => run_all(paths, options),
        // The same threads read, solve and write all cases.
        jobs => side_by_side(jobs, || run_all(paths, options)),
    }
}

fn run_all(paths: &[PathBuf], options: &Options) -> Outcome {
    let sets = files::overrides(&options.set)?;
    let mut studies = Vec::new();
    // All mistakes of all studies are reported together.
    joined(paths.iter().map(|path| {
        studies.push((path, files::study(path, &sets)?));
        Ok(Verdict::Proved)
    }))?;
    same_names(&studies)?;
    if options.list {
        return joined(studies.iter().map(|(_, study)| list(study.as_ref(), options)));
    }
    interrupt::catch(&options.again);
    let one = |(path, study): &(&PathBuf, Box<dyn LoadedStudy>)| {
        let dir = match &options.out {
            Some(dir) if studies.len() > 1 => dir.join(study.name()),
            Some(dir) => dir.clone(),
            None => Path::new("results").join(study.name()),
        };
        if options.out.is_none() {
            results_of_another(path, &dir)?;
        }
        run_one(study.as_ref(), path, &dir, options)
    };
    let outcome = joined(studies.iter().map(one));
    // The program ends now; freeing the memory would take as long as reading the studies.
    std::mem::forget(studies);
    outcome
}

/// Refuses several studies that would write into the same folder.
fn same_names(studies: &[(&PathBuf, Box<dyn LoadedStudy>)]) -> Result<(), CliError> {
    for (index, (path, study)) in studies.iter().enumerate() {
        // Some file systems ignore case.
        let same = |other: &str| other.to_lowercase() == study.name().to_lowercase();
        if let Some((first, _)) = studies[..index].iter().find(|(_, earlier)| same(earlier.name())) {
            return Err(CliError::wrong_input(format_args!(
                "{}: this study is called \"{}\", as that of {}: their results would overwrite each other; give one another \
                 name, or run them one by one with --out",
                path.display(),
                study.name(),
                first.display()
            )));
        }
    }
    Ok(())
}

/// Prefix of the first line of resolved.toml, which names the study file.
const SOURCE: &str = "# study: ";

/// Refuses a default folder with results of a different study file that still exists.
fn results_of_another(path: &Path, dir: &Path) -> Result<(), CliError> {
    let mut first = Vec::new();
    if let Ok(file) = open_regular(&dir.join("resolved.toml"), u64::MAX) {
        drop(BufReader::new(file).take(1 << 16).read_until(b'\n', &mut first));
    }
    let first = String::from_utf8_lossy(&first);
    let Some(source) = first.trim_end().strip_prefix(SOURCE) else { return Ok(()) };
    let places = (Path::new(source).canonicalize(), path.canonicalize());
    let (Ok(earlier), Ok(own)) = places else { return Ok(()) };
    if earlier == own {
        return Ok(());
    }
    Err(CliError::wrong_input(format_args!(
        "{}: {} holds the results of {source}, a study of the same name; give one of them another name, or say where \
         results go with --out",
        path.display(),
        dir.display()
    )))
}

/// Returns the ids of the requested cases.
fn wanted(study: &dyn LoadedStudy, case: Option<usize>) -> Result<Vec<usize>, CliError> {
    match case {
        Some(id) if id < study.count() => Ok(vec![id]),
        Some(id) => {
            let last = study.count().saturating_sub(1);
            let what = format_args!("--case {id}: the study \"{}\" has cases 0 to {last}", study.name());
            Err(CliError::wrong_input(what))
        }
        None => Ok((0..study.count()).collect()),
    }
}

/// Prints the label of each case as a line of JSON.
fn list(study: &dyn LoadedStudy, options: &Options) -> Outcome {
    let Some(cases) = study.with_cases() else {
        (0..study.count()).for_each(|id| say_data(&json!({ "study": study.name(), "id": id }).to_string()));
        return Ok(Verdict::Proved);
    };
    let ids = match options.case {
        Some(id) => vec![id],
        None => shard::ids_of(study, options.shard)?,
    };
    for case in ids.into_iter().filter_map(|id| cases.case(id)) {
        say_data(&serde_json::to_string(&label_of(&case)).unwrap_or_default());
    }
    Ok(Verdict::Proved)
}

fn run_one(study: &dyn LoadedStudy, path: &Path, dir: &Path, options: &Options) -> Outcome {
    let resolved = study.resolved_text().map_err(|error| {
        CliError::no_access(format_args!("voussoir: the study \"{}\" cannot be written back: {error}", study.name()))
    })?;
    let resolved = format!("{SOURCE}{}\n{resolved}", path.display().to_string().replace(['\n', '\r'], " "));
    let wanted = wanted(study, options.case)?;
    match (options.shard, study.with_cases()) {
        (Some(shard), _) => shard::run(study, shard, dir, &resolved, options),
        (None, Some(study)) => run_cases(study, &wanted, dir, &resolved, options),
        (None, None) => run_whole(study, wanted, dir, &resolved, options),
    }
}

/// Runs a study whose cases are stored one by one.
fn run_cases(study: &Study, wanted: &[usize], dir: &Path, resolved: &str, options: &Options) -> Outcome {
    let folder = ResultFolder::open(dir)?;
    if options.resume || options.case.is_some() {
        refill(&folder)?;
    }
    let progress = Progress::new(&study.name, options.shown());
    let solved = solve_into_journal(study, wanted, &folder, options, &progress)?;
    progress.phase("writing and drawing");
    let quiet = options.quiet || options.json;
    let made = write_outputs(study, &folder, resolved, &solved.lines, (options.jobs, quiet))?;
    progress.finish();
    if options.json {
        let said = solved.lines.each(&mut |cases| {
            cases.iter().for_each(|case| progress.say_other(case));
            Ok(())
        });
        said.map_err(|error| CliError::of_file(folder.path(), error))?;
    } else if !options.quiet {
        say(made.table + &tally(&made.totals, &solved.lines, study.makes_cases()));
        solved.remarks.iter().for_each(say);
        options
            .case
            .iter()
            .filter(|_| study.count() > 1)
            .for_each(|id| say(one_case(*id, study.count(), solved.others)));
        say(format!("results in {}", folder.path().display()));
    }
    open_report(&folder, &made.names, options);
    Ok(verdict(&made.totals))
}

/// Opens the report if `--open` is set.
fn open_report(folder: &ResultFolder, names: &[String], options: &Options) {
    if options.open && names.iter().any(|name| name == "report.html") {
        open(folder.path().join("report.html"));
    }
}

/// Runs a study of a kind that writes all its files together, after the studies that it reports on.
fn run_whole(study: &dyn LoadedStudy, wanted: Vec<usize>, dir: &Path, resolved: &str, options: &Options) -> Outcome {
    let folder = ResultFolder::open(dir)?;
    let (mut verdict, mut parts) = (Verdict::Proved, Vec::new());
    for part in study.parts() {
        let own = dir.join(&part.folder);
        verdict = verdict.max(run_one(part.study.as_ref(), Path::new(&part.file), &own, options)?);
        parts.push(files::read(&own.join("results.json"))?);
    }
    let progress = Progress::new(study.name(), options.shown());
    let request = RunRequest {
        wanted,
        jobs: useful_jobs(options.jobs),
        kept: options.case.map(|_| folder.read("results.json")),
        version: env!("CARGO_PKG_VERSION").into(),
        date: Some(today()),
        parts,
        quiet: options.quiet || options.json,
    };
    let output = study.run(&request, &progress);
    progress.finish();
    // The results are written first, because the disk may be full.
    let (results, others): (Vec<_>, Vec<_>) = output.files.iter().partition(|(name, _)| name == "results.json");
    let names: Vec<String> = others.iter().map(|(name, _)| name.clone()).collect();
    folder.make_room(&names).map_err(CliError::of_io)?;
    for (name, bytes) in results.iter() {
        folder.write(name, bytes)?;
    }
    folder.write("resolved.toml", resolved.as_bytes())?;
    for (name, bytes) in others {
        folder.write(name, bytes)?;
    }
    folder.remove(JOURNAL);
    if options.json {
        let results: Json =
            results.first().and_then(|(_, bytes)| serde_json::from_slice(bytes).ok()).unwrap_or_default();
        results["cases"].as_array().into_iter().flatten().for_each(|case| say_data(&case.to_string()));
    } else if !options.quiet {
        say(output.table);
        output.remarks.iter().for_each(say);
        say(format!("results in {}", folder.path().display()));
    }
    open_report(&folder, &names, options);
    Ok(verdict.max(Verdict::of(output.certified)))
}
