//! Study kinds: two runs give the same results, `verify` confirms them, and refuses results with an altered number.

use super::standard::arch;
use crate::kinds::read_source_beside;
use serde_json::{Value as Json, json};
use voussoir_core::plugin::{Capability, Card, PluginKind};
use voussoir_study::cases::Unobserved;
use voussoir_study::kind::{LoadedStudy, RESULTS, RunRequest};
use voussoir_study::study::StudySource;
use voussoir_verify::conformance::{FurtherCheck, Options, Recorder};

voussoir_core::inventory::submit! { FurtherCheck(check) }

/// Keys of results that differ between two runs and that `verify` does not compare.
const NOT_COMPARED: [&str; 2] = ["counters", "seconds"];

/// Number of numbers that are altered, one at a time.
const ALTERED: usize = 24;

/// Checks every sample of a study kind; does nothing for other plug-ins.
fn check(recorder: &mut Recorder, card: &Card, _: &Options) {
    if card.kind != PluginKind::StudyKind {
        return;
    }
    recorder.hold("card", !card.samples.is_empty(), || "has no sample: nothing can be checked".into());
    for sample in card.samples {
        recorder.sample(sample);
        let study = match read(card, sample.table) {
            Ok(study) => study,
            Err(why) => {
                recorder.fail("samples", format!("the study of the sample is refused: {why}"));
                continue;
            }
        };
        let [once, again] = [1, 2].map(|jobs| results(study.as_ref(), jobs));
        let Some(once) = once else {
            recorder.fail("samples", format!("a run writes no {RESULTS}"));
            continue;
        };
        let same = again.as_ref().is_some_and(|again| compared(again) == compared(&once));
        recorder.hold("purity", same, || "a second run with two jobs gives other results".into());
        confirm(recorder, study.as_ref(), &once);
    }
}

/// Reads the study of a sample: the sample alone for a kind with separate study files, otherwise added to the standard study.
/// Every other file that it names is the standard study.
fn read(card: &Card, sample: &str) -> Result<Box<dyn LoadedStudy>, String> {
    let text = match card.offers(Capability::OWN_FILE) {
        true => format!("name = \"conformance\"\nkind = \"{}\"\n{sample}\n", card.tag),
        false => arch("conformance", card.tag, sample),
    };
    let other = |_: &str| Ok(arch("standard", "run", ""));
    let source = StudySource::parse(&text, "conformance.toml", &[]).map_err(|why| why.to_string())?;
    read_source_beside(source, &other).map_err(|why| why.to_string())
}

/// Runs a study, after the studies that it reports on, and returns its results.json.
fn results(study: &dyn LoadedStudy, jobs: usize) -> Option<Json> {
    let parts: Option<Vec<String>> =
        study.parts().iter().map(|part| Some(results(part.study.as_ref(), jobs)?.to_string())).collect();
    let request = RunRequest {
        wanted: (0..study.count()).collect(),
        jobs,
        version: env!("CARGO_PKG_VERSION").into(),
        parts: parts?,
        ..RunRequest::default()
    };
    let files = study.run(&request, &Unobserved).files;
    let (_, bytes) = files.iter().find(|(name, _)| name == RESULTS)?;
    serde_json::from_slice(bytes).ok()
}

/// Checks that `verify` confirms the results, and refuses each of some altered numbers.
fn confirm(recorder: &mut Recorder, study: &dyn LoadedStudy, results: &Json) {
    if !study.parts().is_empty() {
        return recorder.leave_out("verify: the kind reports on other studies, which are checked in their folders");
    }
    let refused = |results: &Json| match study.verify(&results.to_string()) {
        Ok(found) if found.findings.is_empty() && found.files.is_empty() => None,
        Ok(found) => found.findings.into_iter().map(|(_, why)| why).chain(found.files).next(),
        Err(why) => Some(why),
    };
    let wrong = refused(results);
    recorder.hold("verify", wrong.is_none(), || wrong.clone().unwrap_or_default());
    if wrong.is_some() {
        return;
    }
    let numbers = numbers(results, &mut String::new());
    for place in numbers.iter().step_by((numbers.len() / ALTERED).max(1)) {
        let mut altered = results.clone();
        let Some(number) = altered.pointer_mut(place) else { continue };
        *number = json!(number.as_f64().unwrap_or_default() * 1.1 + 0.1);
        recorder.hold("lies", refused(&altered).is_some(), || format!("an altered number at {place} is not found"));
    }
}

/// Returns the results without the entries that may differ between two runs.
fn compared(results: &Json) -> Json {
    match results {
        Json::Object(table) => {
            let kept = table.iter().filter(|(key, _)| !NOT_COMPARED.contains(&key.as_str()));
            kept.map(|(key, value)| (key.clone(), compared(value))).collect()
        }
        Json::Array(entries) => entries.iter().map(compared).collect(),
        other => other.clone(),
    }
}

/// Returns the places of all numbers that `verify` compares, as JSON pointers.
fn numbers(value: &Json, at: &mut String) -> Vec<String> {
    let entries: Vec<(String, &Json)> = match value {
        Json::Number(number) if number.is_f64() => return vec![at.clone()],
        Json::Object(table) => {
            let kept = table.iter().filter(|(key, _)| !NOT_COMPARED.contains(&key.as_str()));
            kept.map(|(key, value)| (key.replace('~', "~0").replace('/', "~1"), value)).collect()
        }
        Json::Array(entries) => entries.iter().enumerate().map(|(index, value)| (index.to_string(), value)).collect(),
        _ => return Vec::new(),
    };
    let mut found = Vec::new();
    for (key, value) in entries {
        let length = at.len();
        *at += "/";
        *at += &key;
        found.extend(numbers(value, at));
        at.truncate(length);
    }
    found
}
