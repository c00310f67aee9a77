//! The head of a report for the people who sign it: project, author, checker, date, version, and the origin of the results.

use super::page::sha256::hexadecimal;
use maud::{Markup, html};
use voussoir_study::study::RecordTable;

/// The origin of a report.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReportOrigin<'a> {
    /// Version of the program.
    pub version: &'a str,
    /// Commit of the program.
    pub commit: &'a str,
    /// Day of the run.
    pub date: Option<&'a str>,
    /// The study with all its keys.
    pub study: &'a toml::Value,
}

impl ReportOrigin<'_> {
    /// Version and commit of the program.
    fn program(&self) -> String {
        match self.commit {
            "" => format!("Voussoir {}", self.version),
            commit => format!("Voussoir {} (commit {commit})", self.version),
        }
    }

    /// SHA-256 of the text of resolved.toml without its first line, which names the study file.
    fn study_hash(&self) -> String {
        hexadecimal(&toml::to_string(self.study).unwrap_or_default())
    }

    /// The sentence at the end of a report.
    pub fn sentence(&self) -> Markup {
        html! {
            "Written by " (self.program()) @if let Some(date) = self.date { ", " (date) } ". SHA-256 of the study (resolved.toml \
             without its first line): " (self.study_hash()) ". "
        }
    }
}

/// The block with space for signatures; empty if the study has no table `[record]`.
pub(crate) fn title_block(name: &str, record: Option<&RecordTable>, origin: ReportOrigin) -> Markup {
    let Some(record) = record else { return html! {} };
    let date = record.date.as_deref().or(origin.date).unwrap_or_default();
    let texts = [
        ("Project", record.project.as_deref().unwrap_or_default()),
        ("Study", name),
        ("Version", record.version.as_deref().unwrap_or_default()),
        ("Date", date),
    ];
    let signed = [("Author", &record.author), ("Checker", &record.checker)];
    html! {
        table class="title-block" {
            tbody {
                @for row in texts.chunks(2) {
                    tr { @for (heading, text) in row { th scope="row" { (heading) } td { (text) } } }
                }
                @for (heading, name) in signed {
                    tr class="signed" {
                        th scope="row" { (heading) }
                        td { (name.as_deref().unwrap_or_default()) }
                        th scope="row" { "Signed" }
                        td {}
                    }
                }
                tr { th scope="row" { "Program" } td colspan="3" { (origin.program()) } }
                tr {
                    th scope="row" { "SHA-256 of the study" }
                    td colspan="3" { (origin.study_hash()) }
                }
            }
        }
    }
}
