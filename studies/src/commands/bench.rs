//! `voussoir bench`.

use super::clock::processor_time;
use super::error::{CliError, ErrorKind, Outcome, Verdict};
use super::files;
use super::folder::ResultFolder;
use super::print::{complain, say};
use crate::bench::{
    Bench, BenchOptions, Measurement, PARAMETERS, Reference, Row, bench, csv, error_chart, names, problems,
    profile_chart, read_others, sweep, sweep_csv, sweep_table, table,
};
use std::io::Write;
use std::path::{Path, PathBuf};
use voussoir_plot::svg::as_file;
use voussoir_study::config::diagnostic::suggest;
use voussoir_study::file::HELD;
use voussoir_study::kind::LoadedStudy;
use voussoir_study::results::format::{format_short, status_word};
use voussoir_study::study::Study;

/// The options of `voussoir bench`.
pub struct BenchArguments {
    /// The folder for the results.
    pub out: Option<PathBuf>,
    /// Overrides of the study's keys.
    pub set: Vec<String>,
    /// Number of runs of each solver.
    pub runs: usize,
    /// The reference: the name of a solver or variant, or a load factor.
    pub reference: Option<String>,
    /// A CSV file with measurements of other programs.
    pub others: Option<PathBuf>,
    /// Greatest error of a solved problem in the performance profile.
    pub within: f64,
    /// Names of settings: each case is measured on a ladder of values of each.
    pub sweep: Vec<String>,
    /// The CSV file of a sweep.
    pub output: Option<PathBuf>,
    /// Print nothing but errors.
    pub quiet: bool,
}

/// Measures the variants of each study, or all solvers that support it, and compares them.
pub fn measure(paths: &[PathBuf], arguments: &BenchArguments) -> Outcome {
    if paths.len() > 1 && !arguments.sweep.is_empty() {
        return Err(CliError::wrong_input("--sweep measures one study; give one study file"));
    }
    let loaded = paths.iter().map(|path| files::study(path, &files::overrides(&arguments.set)?));
    let loaded = loaded.collect::<Result<Vec<_>, CliError>>()?;
    let studies = paths
        .iter()
        .zip(&loaded)
        .map(|(path, loaded)| with_cases(path, &**loaded))
        .collect::<Result<Vec<&Study>, CliError>>()?;
    let others = arguments.others.as_deref().map(|file| others(file, &studies)).transpose()?;
    let (mut found, mut title) = (Bench::default(), "bench".to_string());
    for study in studies {
        let reference = arguments.reference.as_deref().map(|word| reference(study, word)).transpose()?;
        let told = |own: &Measurement| {
            if !arguments.quiet {
                let status = status_word(own.result.status);
                complain(format_args!("{}: {status}, {} s", own.contestant, format_short(own.seconds, 3)));
            }
            true
        };
        let options = BenchOptions { runs: arguments.runs, reference, clock: &processor_time, told: &told };
        match paths {
            [_] if !arguments.sweep.is_empty() => return ladders(study, arguments, &options),
            [_] => (found, title) = (bench(study, &options), study.name.clone()),
            _ => found.join(&study.name, bench(study, &options)),
        }
    }
    found.beside(others.unwrap_or_default());
    let default = || match paths {
        [_] => Path::new("results").join(&title).join("bench"),
        _ => Path::new("results").join("bench"),
    };
    written(&found, &title, &arguments.out.clone().unwrap_or_else(default), arguments)
}

fn with_cases<'a>(path: &Path, loaded: &'a dyn LoadedStudy) -> Result<&'a Study, CliError> {
    loaded.with_cases().filter(|study| !study.cases.is_empty()).ok_or_else(|| {
        let path = path.display();
        CliError::wrong_input(format_args!("{path}: only studies with a scene and at most {HELD} cases can be benched"))
    })
}

/// Reads the measurements of other programs.
fn others(file: &Path, studies: &[&Study]) -> Result<Vec<Row>, CliError> {
    let names: Vec<String> = studies.iter().flat_map(|study| problems(study, studies.len() > 1)).collect();
    read_others(&files::read(file)?, &names)
        .map_err(|why| CliError::wrong_input(format_args!("--others {}: {why}", file.display())))
}

/// Writes the measurements and their figures.
fn written(found: &Bench, title: &str, dir: &Path, arguments: &BenchArguments) -> Outcome {
    let folder = ResultFolder::open(dir)?;
    folder.write("bench.csv", csv(found).as_bytes())?;
    let charts =
        [("bench.svg", error_chart(title, found)), ("profile.svg", profile_chart(title, found, arguments.within))];
    for (name, chart) in charts {
        match chart {
            Some(chart) => folder.write(name, as_file(&chart).as_bytes())?,
            None => folder.remove(name),
        }
    }
    if !arguments.quiet {
        say(table(found).trim_end());
        references(found).into_iter().for_each(say);
        say(format!("bench.csv and figures in {}", dir.display()));
    }
    let answered =
        |problem: usize| found.measurements.iter().any(|own| own.problem == problem && own.factor().is_some());
    Ok(Verdict::of((0..found.problems.len()).all(answered)))
}

/// Measures the cases of a study on the ladders of some settings.
fn ladders(study: &Study, arguments: &BenchArguments, options: &BenchOptions) -> Outcome {
    let known = |name: &String| {
        let found = PARAMETERS.into_iter().find(|known| known == name);
        let help = || suggest(name, &PARAMETERS, "settings that can be swept");
        found.ok_or_else(|| CliError::wrong_input(format_args!("--sweep {name}: not a setting; {}", help())))
    };
    let parameters = arguments.sweep.iter().map(known).collect::<Result<Vec<_>, _>>()?;
    if let Some(file) = arguments.output.as_ref().filter(|file| file.exists()) {
        let why = format_args!("--output {}: the file exists; nothing is overwritten", file.display());
        return Err(CliError::wrong_input(why));
    }
    let found = sweep(study, &parameters, options);
    if found.rungs.is_empty() {
        let reasons = found.refused.iter().map(|(_, name, why)| format!("--sweep {name}: {why}"));
        return Err(CliError::of_lines(ErrorKind::WrongInput, reasons));
    }
    if let Some(file) = &arguments.output {
        let new = std::fs::File::create_new(file);
        new.and_then(|mut new| new.write_all(sweep_csv(&found).as_bytes()))
            .map_err(|error| CliError::unwritten(file, error))?;
    }
    if !arguments.quiet {
        say(sweep_table(&found).trim_end());
    }
    Ok(Verdict::of(found.rungs.iter().all(|rung| rung.measured.factor().is_some())))
}

/// Reads the reference: a load factor, or the name of a solver or variant.
fn reference(study: &Study, word: &str) -> Result<Reference, CliError> {
    if let Some(factor) = word.parse().ok().filter(|factor: &f64| factor.is_finite()) {
        return Ok(Reference::Known(factor));
    }
    let names = names(study);
    if names.iter().any(|name| name == word) {
        return Ok(Reference::Named(word.into()));
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let what = if study.outline.variants.is_empty() { "contestants" } else { "variants" };
    Err(CliError::wrong_input(format_args!(
        "--reference {word}: neither a load factor nor one of those that take part; {}",
        suggest(word, &names, what)
    )))
}

/// Describes the references of the errors, each once for all problems that share it.
fn references(found: &Bench) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for problem in &found.problems {
        let line = match &problem.reference {
            Some(source) if source.from == "given" => "errors from the load factor that was given".to_string(),
            Some(source) => {
                let band = source.band.map(|band| format!(" (within {})", format_short(band, 2)));
                format!("errors from {}{}", source.from, band.unwrap_or_default())
            }
            None => "no errors: nothing to measure them from".into(),
        };
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines
}
