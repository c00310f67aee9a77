//! `voussoir run`.

use super::{FINE, NO_ACCESS, NOT_PROVEN, WRONG_INPUT, files, say};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;
use voussoir::core::limit::Status;
use voussoir::core::model::{Assembly, Stage};
use voussoir::kinds::{Observer, OnPath, kind};
use voussoir::results::{CaseResult, StudyResults};
use voussoir::study::Study;
use voussoir::writers::{StudyOutput, writers};

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

/// Runs studies; the greatest exit code of them. Every study is checked before the first is run.
pub fn run(paths: &[PathBuf], options: &Options) -> u8 {
    let sets = match files::overrides(&options.set) {
        Ok(sets) => sets,
        Err(code) => return code,
    };
    let (mut studies, mut wrong) = (Vec::new(), FINE);
    for path in paths {
        match files::study(path, &sets) {
            Ok(study) => studies.push(study),
            Err(code) => wrong = wrong.max(code),
        }
    }
    if wrong != FINE {
        return wrong;
    }
    let mut code = FINE;
    for study in &studies {
        let dir = match &options.out {
            Some(dir) if studies.len() > 1 => dir.join(&study.name),
            Some(dir) => dir.clone(),
            None => Path::new("results").join(&study.name),
        };
        code = code.max(match run_one(study, &dir, options) {
            Ok(code) | Err(code) => code,
        });
    }
    code
}

/// Shows progress on a terminal and keeps finished cases for `--resume`.
struct Progress {
    bar: ProgressBar,
    name: String,
    started: Instant,
    /// When a path was last shown, in tenths of a second since the start.
    shown: AtomicU64,
    journal: Mutex<Option<std::fs::File>>,
}

/// Tenths of a second after which a path counts as long and is shown.
const LONG: u64 = 10;

impl Observer for Progress {
    fn answered(&self, case: &CaseResult) {
        self.bar.inc(1);
        let Ok(mut journal) = self.journal.lock() else { return };
        // A journal that cannot be written costs only the chance to resume.
        if let (Some(file), Ok(line)) = (journal.as_mut(), serde_json::to_string(case)) {
            let _ = writeln!(file, "{line}");
        }
    }

    fn on_path(&self, at: &OnPath) {
        let now = self.started.elapsed().as_millis() as u64 / 100;
        if self.bar.is_hidden() || now < LONG || self.shown.swap(now, Ordering::Relaxed) == now {
            return;
        }
        let OnPath { case, stage, gravity, factor, states } = at;
        let what = if *gravity { " (gravity)" } else { "" };
        self.bar.set_message(format!("{}: case {case}, {stage}{what}, factor {factor:.6}, {states} states", self.name));
        self.bar.tick();
    }
}

const JOURNAL: &str = "unfinished.jsonl";

/// Finished cases of an interrupted run of the same study.
fn finished(dir: &Path, resolved: &str) -> BTreeMap<usize, CaseResult> {
    let read = |name: &str| std::fs::read_to_string(dir.join(name)).unwrap_or_default();
    if read("resolved.toml") != resolved {
        return BTreeMap::new();
    }
    let whole = serde_json::from_str::<StudyResults>(&read("results.json")).map(|r| r.cases).unwrap_or_default();
    let journal = read(JOURNAL);
    // The last line of a killed run may be cut short: it does not parse and is done again.
    let lines = journal.lines().filter_map(|line| serde_json::from_str::<CaseResult>(line).ok());
    whole.into_iter().chain(lines).filter(|case| case.status != Status::Stalled).map(|case| (case.id, case)).collect()
}

fn run_one(study: &Study, dir: &Path, options: &Options) -> Result<u8, u8> {
    let resolved = toml::to_string(&study.resolved).map_err(|error| {
        eprintln!("voussoir: the study \"{}\" cannot be written back: {error}", study.name);
        NO_ACCESS
    })?;
    let wanted: Vec<usize> = match options.case {
        Some(id) if id < study.cases.len() => vec![id],
        Some(id) => {
            eprintln!(
                "--case {id}: the study \"{}\" has cases 0 to {}",
                study.name,
                study.cases.len().saturating_sub(1)
            );
            return Err(WRONG_INPUT);
        }
        None => (0..study.cases.len()).collect(),
    };
    let Some(kind) = kind(&study.kind) else {
        eprintln!("study \"{}\": no study kind is called \"{}\"", study.name, study.kind);
        return Err(WRONG_INPUT);
    };
    let mut done = if options.resume { finished(dir, &resolved) } else { BTreeMap::new() };
    done.retain(|id, _| wanted.contains(id));
    let rest: Vec<usize> = wanted.iter().copied().filter(|id| !done.contains_key(id)).collect();
    files::write(&dir.join("resolved.toml"), &resolved)?;
    let journal = dir.join(JOURNAL);
    if !options.resume {
        let _ = std::fs::remove_file(&journal);
    }
    let bar = ProgressBar::with_draw_target(Some(rest.len() as u64), ProgressDrawTarget::stderr());
    if options.quiet || rest.is_empty() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    // One case is no share of anything: what shows is where its path has come to, once that is long.
    let template = if rest.len() < 2 { "{msg}" } else { "{msg} {bar:30} {pos}/{len} {eta}" };
    bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
    if rest.len() > 1 {
        bar.set_message(study.name.clone());
    }
    let file = std::fs::OpenOptions::new().create(true).append(true).open(&journal).ok();
    let progress = Progress {
        bar,
        name: study.name.clone(),
        started: Instant::now(),
        shown: AtomicU64::new(0),
        journal: Mutex::new(file),
    };
    for case in kind.answer(study, &rest, options.jobs, &progress) {
        done.insert(case.id, case);
    }
    progress.bar.finish_and_clear();
    let cases: Vec<CaseResult> = done.into_values().collect();
    let results = StudyResults {
        study: study.name.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        comparison: kind.compare(study, &cases),
        cases,
    };
    write_results(study, &results, dir, options)?;
    let _ = std::fs::remove_file(&journal);
    let proven = results.cases.iter().all(|case| case.certificate.passed);
    Ok(if proven { FINE } else { NOT_PROVEN })
}

fn write_results(study: &Study, results: &StudyResults, dir: &Path, options: &Options) -> Result<(), u8> {
    let assemblies: Vec<&Assembly> = results.cases.iter().map(|case| &study.cases[case.id].assembly).collect();
    let stages: Vec<&[Stage]> = results.cases.iter().map(|case| study.cases[case.id].stages.as_slice()).collect();
    let kinematics: Vec<_> = results.cases.iter().map(|case| study.cases[case.id].solver.kinematics).collect();
    let sweep_keys: Vec<String> =
        study.cases.first().map(|case| case.parameters.keys().cloned().collect()).unwrap_or_default();
    let output = StudyOutput {
        name: &study.name,
        results,
        assemblies: &assemblies,
        stages: &stages,
        sweep_keys: &sweep_keys,
        figures: study.output.figures,
        vtu: study.output.vtu.then_some(kinematics.as_slice()),
    };
    for entry in writers() {
        for (name, text) in entry.writer.files(&output) {
            files::write(&dir.join(name), &text)?;
        }
    }
    if !options.quiet {
        say(voussoir::writers::table::results_table(&output));
        if let Some(comparison) = &results.comparison {
            say(voussoir::writers::comparison::comparison_table(comparison));
        }
        say(format!("results in {}", dir.display()));
    }
    Ok(())
}
