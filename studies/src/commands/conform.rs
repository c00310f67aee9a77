//! `voussoir conform`.

use super::codes::{FINE, NO_ACCESS, NOT_PROVEN, WRONG_INPUT, complain, say};
use crate::config::diagnostic::suggest;
use crate::conformance::{Options, Report, conform, conform_all};
use std::path::Path;
use voussoir_core::plugin::{PluginKind, cards_of};

/// Checks laws of these tags, or all; failures become studies in a folder.
pub fn conform_tags(tags: &[String], out: Option<&Path>) -> u8 {
    let kinds = [PluginKind::InterfaceLaw, PluginKind::BulkMaterial];
    let cards: Vec<_> = kinds.into_iter().flat_map(cards_of).collect();
    let names: Vec<&str> = cards.iter().map(|card| card.tag).collect();
    let mut unknown = FINE;
    for tag in tags.iter().filter(|tag| !names.contains(&tag.as_str())) {
        complain(format_args!("no law of joints or materials is called \"{tag}\"; {}", suggest(tag, &names, "laws")));
        unknown = WRONG_INPUT;
    }
    if unknown != FINE {
        return unknown;
    }
    let options = Options::default();
    let reports = match tags {
        [] => conform_all(&options),
        tags => {
            let wanted = cards.iter().filter(|card| tags.iter().any(|tag| tag == card.tag));
            wanted.map(|card| conform(card, &options)).collect()
        }
    };
    let mut code = FINE;
    for report in &reports {
        say(report.to_string().trim_end());
        code = code.max(if report.passed() { FINE } else { NOT_PROVEN });
        if let Some(dir) = out {
            code = code.max(write(report, dir));
        }
    }
    let failed: Vec<&str> =
        reports.iter().filter(|report| !report.passed()).map(|report| report.tag.as_str()).collect();
    match failed.as_slice() {
        [] => say(format!("{} law(s) conform", reports.len())),
        failed => say(format!("{} of {} law(s) do not conform: {}", failed.len(), reports.len(), failed.join(", "))),
    }
    code
}

/// Writes the studies that show what was found.
fn write(report: &Report, dir: &Path) -> u8 {
    let mut code = FINE;
    let studies = report.findings.iter().filter_map(|finding| Some((finding.check, finding.study.as_ref()?)));
    for (index, (check, study)) in studies.enumerate() {
        let place = dir.join(format!("{}_{check}_{index}.toml", report.tag));
        match std::fs::create_dir_all(dir).and_then(|()| std::fs::write(&place, study)) {
            Ok(()) => say(format!("  {check}: voussoir run {} shows it", place.display())),
            Err(error) => {
                complain(format_args!("voussoir: cannot write {}: {error}", place.display()));
                code = NO_ACCESS;
            }
        }
    }
    code
}
