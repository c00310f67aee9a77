//! `voussoir conform`.

use super::error::{CliError, ErrorKind, Outcome, Verdict, joined};
use super::print::say;
use std::path::Path;
use voussoir_core::plugin::cards;
use voussoir_study::config::diagnostic::suggest;
use voussoir_verify::conformance::{Options, Report, conform, conform_all};

/// Checks plug-ins with these tags, or all plug-ins but solvers and strategies. For failures of laws, studies that
/// reproduce them are written to a folder.
pub fn conform_tags(tags: &[String], out: Option<&Path>) -> Outcome {
    let cards = cards();
    let names: Vec<&str> = cards.iter().map(|card| card.tag).collect();
    let unknown = tags.iter().filter(|tag| !names.contains(&tag.as_str())).map(|tag| {
        let help = suggest(tag, &names, "plug-ins");
        format!("no plug-in is called \"{tag}\"; {help}")
    });
    let diagnostics: Vec<String> = unknown.collect();
    if !diagnostics.is_empty() {
        return Err(CliError::of_lines(ErrorKind::WrongInput, diagnostics));
    }
    // Panics of a plug-in are findings. The deliberately wrong solvers of the checks panic too.
    let said = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let options = Options::default();
    let reports = match tags {
        [] => conform_all(&options),
        tags => {
            let wanted = cards.iter().filter(|card| tags.iter().any(|tag| tag == card.tag));
            wanted.map(|card| conform(card, &options)).collect()
        }
    };
    std::panic::set_hook(said);
    let mut outcomes = Vec::new();
    for report in &reports {
        say(report.to_string().trim_end());
        outcomes.push(Ok(Verdict::of(report.passed())));
        outcomes.extend(out.map(|dir| write(report, dir)));
    }
    let failed: Vec<&str> =
        reports.iter().filter(|report| !report.passed()).map(|report| report.tag.as_str()).collect();
    match failed.as_slice() {
        [] => say(format!("{} plug-in(s) conform", reports.len())),
        failed => {
            say(format!("{} of {} plug-in(s) do not conform: {}", failed.len(), reports.len(), failed.join(", ")))
        }
    }
    joined(outcomes)
}

/// Writes the studies that reproduce the findings.
fn write(report: &Report, dir: &Path) -> Outcome {
    let studies = report.findings.iter().filter_map(|finding| Some((finding.check, finding.study.as_ref()?)));
    for (index, (check, study)) in studies.enumerate() {
        let place = dir.join(format!("{}_{check}_{index}.toml", report.tag));
        let written = std::fs::create_dir_all(dir).and_then(|()| std::fs::write(&place, study));
        written.map_err(|error| CliError::unwritten(&place, error))?;
        say(format!("  {check}: voussoir run {} shows it", place.display()));
    }
    Ok(Verdict::Proved)
}
