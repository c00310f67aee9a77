//! Writers: the same results give the same bytes, and no other file has the name of one of their files.

use super::standard::for_writers;
use crate::kinds::read_study;
use crate::output::StudyOutput;
use crate::writers::{CaseTable, Writer, writers};
use serde_json::Value as Json;
use std::borrow::Cow;
use std::path::{Component, Path};
use voussoir_core::plugin::{Card, PluginKind, card};
use voussoir_study::config::default_table::default_table;
use voussoir_study::kind::RESULTS;
use voussoir_study::results::{CaseResult, Totals};
use voussoir_study::study::{Case, Study};
use voussoir_verify::conformance::{FurtherCheck, Options, Recorder};

voussoir_core::inventory::submit! { FurtherCheck(check) }

/// Checks a writer on the standard studies; does nothing for other plug-ins.
fn check(recorder: &mut Recorder, card: &Card, _: &Options) {
    if card.kind != PluginKind::Writer {
        return;
    }
    let mut written = 0;
    for text in for_writers() {
        let loaded = read_study(&text, "conformance.toml", &[]).expect("the standard study has no mistakes");
        let Some(study) = loaded.with_cases() else { continue };
        let mut results = study.run();
        written += check_on(recorder, card, study, &results.cases);
        // Results without forces, motions and factors.
        for case in &mut results.cases {
            *case = CaseResult { label: case.label.clone(), ..CaseResult::stalled("no answer") };
        }
        check_on(recorder, card, study, &results.cases);
    }
    if written == 0 {
        recorder.leave_out("the writer writes no file for the standard studies");
    }
}

/// Writes the files of some cases twice, and returns their number.
fn check_on(recorder: &mut Recorder, card: &Card, study: &Study, cases: &[CaseResult]) -> usize {
    let results = study.results(env!("CARGO_PKG_VERSION"), cases.to_vec());
    let totals = Totals::of(cases);
    let of: Vec<Cow<Case>> = cases.iter().filter_map(|case| study.case_of(&case.label)).collect();
    let output = StudyOutput::new(study, &results, &totals, &of);
    let Some(writer) = writer(card.tag) else {
        recorder.fail("card", "has a card, but no entry in the registry of writers".into());
        return 0;
    };
    let options = default_table(card);
    let [once, again] = [(); 2].map(|()| files(writer, &output, &options, cases));
    recorder.hold("purity", once == again, || "the same results give other bytes the second time".into());
    let others: Vec<String> = writers()
        .into_iter()
        .filter(|entry| entry.tag != card.tag)
        .flat_map(|entry| files(entry.writer, &output, &options_of(entry.tag), cases))
        .map(|(name, _)| name)
        .collect();
    for (index, (name, bytes)) in once.iter().enumerate() {
        let inside = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        recorder.hold("names", inside && !name.is_empty(), || format!("\"{name}\" is not inside the results folder"));
        let taken = once[..index].iter().any(|(other, _)| other == name) || others.contains(name) || name == RESULTS;
        recorder.hold("names", !taken, || format!("another file has the name \"{name}\""));
        recorder.hold("names", !bytes.is_empty(), || format!("\"{name}\" is empty"));
    }
    once.len()
}

fn writer(tag: &str) -> Option<&'static dyn Writer> {
    writers().into_iter().find(|entry| entry.tag == tag).map(|entry| entry.writer)
}

fn options_of(tag: &str) -> Json {
    card(PluginKind::Writer, tag).map(default_table).unwrap_or_default()
}

/// Returns all files of a writer with their bytes.
fn files(writer: &dyn Writer, output: &StudyOutput, options: &Json, cases: &[CaseResult]) -> Vec<(String, Vec<u8>)> {
    let mut files = writer.files(output, options);
    files.extend(writer.table(output, options).map(|table| (table.name(), bytes(table, cases))));
    files
}

/// Returns the bytes of a table of all cases.
fn bytes(mut table: Box<dyn CaseTable + '_>, cases: &[CaseResult]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let written = table
        .begin(&mut bytes)
        .and_then(|()| cases.iter().try_for_each(|case| table.add(case, &mut bytes)))
        .and_then(|()| table.end(&mut bytes));
    written.expect("memory has no errors");
    bytes
}
