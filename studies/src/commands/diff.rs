//! `voussoir diff`.

use super::error::{CliError, Outcome, Verdict};
use super::files;
use super::print::{say, say_data};
use super::shard::PART;
use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Component, Path};
use voussoir_report::difference::{RunDifference, StoredRun, compare};
use voussoir_study::regular_file::open_regular;

/// Greatest length of a results.json.
const MAX_RESULTS_BYTES: u64 = 1 << 40;

/// Arguments of `voussoir diff`.
pub struct DiffOptions {
    /// Greatest relative difference of numbers that count as equal.
    pub tolerance: f64,
    /// Print JSON.
    pub json: bool,
}

/// Reads a tolerance.
///
/// # Errors
/// The reason why it is not one.
pub fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => Err("give a number of at least 0, such as 1e-6 or 0.01 for 1 %".into()),
    }
}

/// Compares two results folders; reports are compared with the folders of their studies.
pub fn diff(a: &Path, b: &Path, options: &DiffOptions) -> Outcome {
    let mut found: Vec<(String, RunDifference)> = Vec::new();
    compare_folders([a, b], "", options, &mut found)?;
    if options.json {
        let entry = |(part, own): &(String, RunDifference)| {
            let mut entry = serde_json::to_value(own).unwrap_or_default();
            entry["equal"] = own.is_equal().into();
            if !part.is_empty() {
                entry["part"] = part.as_str().into();
            }
            entry
        };
        found.iter().map(entry).for_each(|line| say_data(&line.to_string()));
    } else {
        for (part, own) in &found {
            if !part.is_empty() {
                say(format!("\nstudy {part} of the report:"));
            }
            own.text().lines().for_each(say);
        }
    }
    Ok(Verdict::of(found.iter().all(|(_, own)| own.is_equal())))
}

/// Compares two folders, then the folders of the studies that both reports contain.
fn compare_folders(
    folders: [&Path; 2],
    part: &str,
    options: &DiffOptions,
    found: &mut Vec<(String, RunDifference)>,
) -> Result<(), CliError> {
    let [a, b] = [stored(folders[0])?, stored(folders[1])?];
    found.push((part.into(), compare(&a, &b, options.tolerance)));
    let inside =
        |name: &&String| matches!(Path::new(name).components().collect::<Vec<_>>()[..], [Component::Normal(_)]);
    let parts: BTreeSet<&String> = a.parts.iter().filter(|name| b.parts.contains(name)).filter(inside).collect();
    for own in parts {
        let inner = folders.map(|folder| folder.join(own));
        compare_folders([&inner[0], &inner[1]], &format!("{part}{own}"), options, found)?;
    }
    Ok(())
}

/// Reads a results folder, or a results file with the resolved study beside it.
fn stored(path: &Path) -> Result<StoredRun, CliError> {
    let file = if path.is_dir() { path.join("results.json") } else { path.into() };
    let results = open_regular(&file, MAX_RESULTS_BYTES).map_err(|error| not_opened(path, &file, &error))?;
    let resolved = file.with_file_name("resolved.toml");
    let resolved = if resolved.is_file() { Some(files::read(&resolved)?) } else { None };
    StoredRun::read(results, resolved.as_deref())
        .map_err(|why| CliError::wrong_input(format_args!("voussoir: {}: not a results file: {why}", file.display())))
}

/// The error for a missing or unreadable results file, with the most similar name beside it.
fn not_opened(path: &Path, file: &Path, error: &std::io::Error) -> CliError {
    if error.kind() != ErrorKind::NotFound {
        return CliError::of_file(file, error);
    }
    if path.is_dir() {
        let parts = path.join(PART).is_file() || has_parts(path);
        let help = match parts {
            true => "it has parts of a study: put them together with `voussoir merge`",
            false => "`voussoir run STUDY --out DIR` writes one",
        };
        return CliError::wrong_input(format_args!("voussoir: {} has no results.json; {help}", path.display()));
    }
    let results = |own: &Path| own.is_dir() || own.extension().is_some_and(|ending| ending == "json");
    let why = format!("voussoir: there is no results folder {}{}", path.display(), files::did_you_mean(path, &results));
    CliError::no_access(why)
}

/// Returns true if a folder contains folders of parts.
fn has_parts(path: &Path) -> bool {
    let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name()).any(|name| name.to_string_lossy().starts_with("shard-"))
}
