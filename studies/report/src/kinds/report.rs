//! `report`: several studies on one page, with claims about them that the numbers confirm or refute.
#![doc = include_str!("report.md")]

mod claims;
mod contents;
mod evaluate;
mod expression;
mod figures;
mod page;
mod parts;
mod sentence;
mod series;
mod study;
#[cfg(test)]
mod truth_tables;
mod types;
mod typing;
mod value;

use voussoir_core::plugin::{Capability, Card, Keys, Parameter, PluginKind, Sample};
use voussoir_study::kind::{KindEntry, LoadedStudy, StudyKind};
use voussoir_study::study::{ReadFile, StudyError, StudySource, no_files};

struct Report;

voussoir_core::inventory::submit! { KindEntry { tag: "report", kind: &Report } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        provides: &[Capability::OWN_FILE],
        tag: "report",
        summary: "runs several studies and writes one page: texts, charts of their results, verdicts on claims",
        samples: &[Sample::keys(r#"[report]
studies = ["run.toml"]

[report.series.load]
study = "standard"

[[report.claims]]
id = "1"
claim = "The arch carries a load"
tests = [{ of = "limit analysis", value = "max(load)", unit = "kN", holds = "value > 0" }]"#)],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("report.md"),
        ..Card::of::<contents::Contents>()
    }
}

impl StudyKind for Report {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        self.read_beside(source, &no_files)
    }

    fn read_beside(&self, source: StudySource, read: ReadFile) -> Result<Box<dyn LoadedStudy>, StudyError> {
        Ok(Box::new(study::ReportStudy::read(source, read)?))
    }

    fn file_keys(&self) -> Option<&'static [Parameter]> {
        Some(contents::ReportFile::PARAMETERS)
    }
}
