//! A study of studies, as commands use it: its parts are run first, then the page is made from their results.

use super::claims::{Answer, Verdict};
use super::contents::{Contents, ReportFile};
use super::figures::Chart;
use super::page::results_page;
use super::parts::Parts;
use super::value::{SeriesByName, Value};
use crate::kinds::read_source;
use crate::kinds::stored_results::altered;
use crate::writers::title_block::ReportOrigin;
use serde::Deserialize;
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use voussoir_core::plugin::KeyValue;
use voussoir_plot::svg::as_file;
use voussoir_study::cases::Observer;
use voussoir_study::caught::caught;
use voussoir_study::checks::Agreement;
use voussoir_study::config::check::Checker;
use voussoir_study::config::diagnostic::{LocatedDiagnostic, sort, suggest};
use voussoir_study::config::document::Node;
use voussoir_study::config::origin::Origin;
use voussoir_study::kind::StoredResults;
use voussoir_study::kind::{LoadedStudy, Part, RunOutput, RunRequest, Verification};
use voussoir_study::results::{StoredOutline, head, this_program, without_origin};
use voussoir_study::study::{DiagnosticList, Drawn, ReadFile, RecordTable, StudyError, StudySource};

/// A study of studies.
pub struct ReportStudy {
    /// Its name.
    pub name: String,
    /// Its content.
    pub contents: Contents,
    /// Head of the page.
    record: Option<RecordTable>,
    /// True if figures are drawn.
    figures: bool,
    parts: Vec<Part>,
    resolved: toml::Value,
}

impl ReportStudy {
    /// Reads a study of studies and its parts. The error contains all mistakes.
    pub fn read(source: StudySource, read: ReadFile) -> Result<Self, StudyError> {
        let StudySource { root, diagnostics, .. } = source;
        let mut checker = Checker::new(&root);
        let checked = checker.check(&root, &ReportFile::SHAPE, "");
        let found: Vec<_> = diagnostics.into_iter().chain(checker.diagnostics).collect();
        let (Some(table), true) = (checked, found.is_empty()) else { return Err(found.into()) };
        let file = ReportFile::deserialize(&table).map_err(|error| {
            vec![LocatedDiagnostic::new(&root.place("report"), "report", format!("cannot be read: {error}"))]
        })?;
        let ReportFile { name, report: contents, output, record, .. } = file;
        let mut diagnostics = DiagnosticList::new(&root, found);
        let parts = read_parts(&mut diagnostics, &contents, &root, read);
        contents.check(&mut diagnostics, &parts);
        if !diagnostics.found.is_empty() {
            sort(&mut diagnostics.found);
            return Err(diagnostics.found.into());
        }
        let mut resolved = root.to_toml();
        let named = &parts[..contents.studies.len().min(parts.len())];
        let own = named.iter().map(|part| toml::Value::from(format!("{}/resolved.toml", part.folder)));
        if let Some(report) = resolved.get_mut("report").and_then(toml::Value::as_table_mut) {
            // In the results folder, the file of each part is in its own folder.
            report.insert("studies".into(), own.collect::<Vec<_>>().into());
        }
        let figures = Drawn::of(output.figures, 1).anything();
        Ok(ReportStudy { name, contents, record, figures, parts, resolved })
    }

    /// Returns the page and all other output made from the results of the parts.
    fn output(&self, results: &[String], version: &str, date: Option<&str>) -> RunOutput {
        let parts = Parts::new(&self.parts, results, self.figures);
        let series = |level: usize| -> BTreeMap<&str, Value> {
            let results = |study: &str| parts.json(self.contents.at_level(study, level));
            self.contents.series.iter().map(|(name, own)| (name.as_str(), own.value(&results))).collect()
        };
        let levels: Vec<_> = (0..=self.contents.finer_levels()).map(series).collect();
        let named: Vec<_> = levels.iter().map(|series| |name: &str| series.get(name).cloned()).collect();
        let named: Vec<SeriesByName<'_>> = named.iter().map(|own| own as _).collect();
        let answers: Vec<Answer> = self.contents.claims.iter().map(|claim| claim.answer(&named)).collect();
        let mut files = Vec::new();
        if self.figures {
            let chart = |chart: &Chart| {
                (format!("figures/chart-{}.svg", chart.name), as_file(&chart.svg(&self.contents.series, &parts)))
            };
            files.extend(self.contents.charts.iter().map(chart));
        }
        let commit = &this_program().commit;
        let origin = ReportOrigin { version, commit, date, study: &self.resolved };
        let page = results_page(&self.name, &self.contents, &parts, &answers, (self.record.as_ref(), origin));
        files.push(("report.html".into(), page));
        let mut names: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
        names.sort();
        let mut whole = head((&self.name, &self.resolved), version, &names);
        whole.extend(date.map(|date| ("date".into(), date.into())));
        whole.insert("kind".into(), "report".into());
        whole.insert("cases".into(), json!([]));
        whole.insert("parts".into(), parts.entries());
        whole.insert("claims".into(), answers.iter().map(Answer::entry).collect());
        let whole = Json::from(whole);
        files.insert(0, ("results.json".to_string(), format!("{whole:#}\n")));
        RunOutput {
            files: files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect(),
            table: table(&answers, &parts),
            remarks: Vec::new(),
            certified: answers.iter().all(|answer| answer.verdict != Verdict::Undecided),
        }
    }
}

/// Reads the studies that a report names; their names must differ.
fn read_parts(diagnostics: &mut DiagnosticList<'_>, contents: &Contents, root: &Node, read: ReadFile) -> Vec<Part> {
    let own = match &root.origin {
        Origin::File { file, .. } => Path::new(&**file).with_file_name(""),
        _ => PathBuf::new(),
    };
    let mut parts: Vec<Part> = Vec::new();
    let mut texts: Vec<(String, String, String)> = Vec::new();
    for (index, name) in contents.studies.iter().enumerate() {
        let key = format!("report.studies.{index}");
        match read(name) {
            Ok(text) => {
                let file = own.join(name).display().to_string();
                read_part(diagnostics, &key, (name, &file, &text, &[]), read, &mut parts);
                let read = parts.last().filter(|part| part.file == file).map(|part| part.folder.clone());
                texts.extend(read.map(|folder| (folder, name.clone(), text)));
            }
            Err(why) => {
                diagnostics.wrong(&key, format!("{name} cannot be read: {why}"), "paths are relative to this file")
            }
        }
    }
    for (index, finer) in contents.finer.iter().enumerate() {
        let key = format!("report.finer.{index}");
        let Some((_, name, text)) = texts.iter().find(|(folder, ..)| *folder == finer.study) else {
            let known: Vec<&str> = texts.iter().map(|(folder, ..)| folder.as_str()).collect();
            let help = suggest(&finer.study, &known, "studies");
            diagnostics.wrong(&format!("{key}.study"), format!("there is no study \"{}\" here", finer.study), help);
            continue;
        };
        let sets = finer.set.iter().map(|(key, value)| (key.clone(), value.to_string()));
        let sets: Vec<_> = sets.chain([("name".to_string(), finer.name.clone())]).collect();
        let file = own.join(name).display().to_string();
        read_part(diagnostics, &key, (name, &file, text, &sets), read, &mut parts);
    }
    parts
}

/// Reads one study of a report, with overrides, and adds it to the parts.
fn read_part(
    diagnostics: &mut DiagnosticList<'_>,
    key: &str,
    (name, file, text, sets): (&str, &str, &str, &[(String, String)]),
    read: ReadFile,
    parts: &mut Vec<Part>,
) {
    // Files that a part names are in the folder of the part.
    let beside = |inner: &str| read(&Path::new(name).with_file_name(inner).display().to_string());
    match StudySource::parse_with(text, file, sets, &beside).and_then(read_source) {
        Ok(study) if !study.parts().is_empty() => {
            diagnostics.wrong(key, "is a report itself", "name the studies that it reports on");
        }
        Ok(study) if parts.iter().any(|part| part.folder.eq_ignore_ascii_case(study.name())) => {
            let message = format!("this study is called \"{}\", as an earlier one", study.name());
            diagnostics.wrong(key, message, "each study has a folder of its name: give one another name");
        }
        Ok(study) => parts.push(Part { folder: study.name().to_string(), file: file.to_string(), study }),
        Err(wrong) => diagnostics.found.extend_from_slice(wrong.mistakes()),
    }
}

/// Returns the table for the terminal: verdicts, then the time of each part.
fn table(answers: &[Answer], parts: &Parts) -> String {
    let mut text = String::new();
    for answer in answers {
        text += &format!("claim {:<4} {:<28} {}\n", answer.claim.id, answer.words(), answer.claim.claim);
    }
    text + "\n" + &parts.times()
}

impl LoadedStudy for ReportStudy {
    fn name(&self) -> &str {
        &self.name
    }

    fn count(&self) -> usize {
        0
    }

    fn resolved(&self) -> &toml::Value {
        &self.resolved
    }

    fn notes(&self) -> Vec<String> {
        self.parts
            .iter()
            .flat_map(|part| part.study.notes().into_iter().map(|note| format!("{}: {note}", part.folder)))
            .collect()
    }

    fn explain(&self) -> String {
        let parts = self.parts.iter().map(|part| part.study.explain());
        format!(
            "study \"{}\" (report): {} studies, {} claims\n\n",
            self.name,
            self.parts.len(),
            self.contents.claims.len()
        ) + &parts.collect::<Vec<_>>().join("\n")
    }

    fn parts(&self) -> &[Part] {
        &self.parts
    }

    fn run(&self, request: &RunRequest, _observer: &dyn Observer) -> RunOutput {
        self.output(&request.parts, &request.version, request.date.as_deref())
    }

    /// The page and the verdicts must be equal to those made from the results of the parts; the parts are verified separately.
    fn verify_stored(&self, stored: &StoredResults, _observer: &dyn Observer) -> Result<Verification, String> {
        let json: Json = serde_json::from_reader(stored.results()?).map_err(|error| error.to_string())?;
        let text = |part: &Part| stored.text(&format!("{}/results.json", part.folder)).unwrap_or_default();
        let results: Vec<String> = self.parts.iter().map(text).collect();
        let outline = StoredOutline::deserialize(&json).map_err(|error| error.to_string())?;
        let made = || self.output(&results, &outline.version, outline.date.as_deref());
        let made = match caught(made) {
            Ok(made) => made,
            Err(why) => return Ok(Verification { findings: vec![(0, why)], ..Verification::default() }),
        };
        let again = made.files.iter().find(|(name, _)| name == "results.json");
        let again: Json = again.and_then(|(_, bytes)| serde_json::from_slice(bytes).ok()).unwrap_or_default();
        let agreement = json.as_object().map_or(Agreement::Program, |head| Agreement::of_head(head, &self.resolved));
        let mut again = without_origin(again);
        if json.get("format").is_none() {
            again.as_object_mut().map(|older| older.shift_remove("files"));
        }
        let differences = agreement.differences(&without_origin(json), &again);
        let findings = outline.origin.too_new().into_iter().chain(differences).map(|why| (0, why)).collect();
        Ok(Verification {
            cases: self.contents.claims.len(),
            stalled: 0,
            findings,
            files: altered(stored, made.files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())), agreement),
            agreement,
            paths: [0, 0],
            own: self.contents.claims.len(),
            of: self.contents.claims.len(),
            how: "checked: verdicts, charts and page against the results of the parts, each of which is verified by itself",
        })
    }
}
