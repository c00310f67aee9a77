//! Reports over several studies: verdicts follow from the numbers of the parts, changed verdicts are found, mistakes
//! have places.

use serde_json::Value as Json;
use voussoir::kinds::{LoadedStudy, RunOutput, RunRequest, StoredResults, read_source_beside};
use voussoir::solve::Unobserved;
use voussoir::study::{StudyError, StudySource};
use voussoir_tests::{Arch, changed};

/// Returns the reference arch and a flat arch.
fn rises() -> String {
    let arch = changed(&Arch::default().study(), "name = \"arch\"", "name = \"rises\"");
    format!("{arch}[sweep]\n\"scene.profile.rise\" = {{ list = [2.99, 1.19] }}\n")
}

const REPORT: &str = r#"
name = "report"
kind = "report"
[report]
studies = ["rises.toml"]
text = ["Loads: ![loads](chart:loads) and ![bridge](mechanism:loads@2.99) <script>bad()</script>"]
[report.series]
loads = { study = "rises" }
[[report.charts]]
name = "loads"
title = "Loads"
x_label = "rise [m]"
y_label = "load [kN]"
series = ["loads"]
[[report.claims]]
id = "1"
claim = "The bridge carries 698.02 kN"
tests = [{ of = "limit analysis", value = "at(loads, 2.99)", unit = "kN", holds = "abs(value - 698.0226652123788) < 1e-6" }]
[[report.claims]]
id = "2"
claim = "The deeper arch carries more"
reading = "The authors probably had <b>finite displacements</b>."
tests = [{ of = "limit analysis", value = "argmax(loads)", unit = "m", holds = "value > 2" }]
[[report.claims]]
id = "3"
claim = "Loads are finite"
depends_on = "the rise"
tests = [
  { of = "2.99 m", value = "at(loads, 2.99)", unit = "kN", holds = "value < 1e9" },
  { of = "1.19 m", value = "at(loads, 1.19)", unit = "kN", holds = "value < 1e9" },
]
"#;

fn read(report: &str) -> Result<Box<dyn LoadedStudy>, Vec<String>> {
    let neighbour = |name: &str| if name == "rises.toml" { Ok(rises()) } else { Err("no such file".into()) };
    let words = |wrong: StudyError| wrong.mistakes().iter().map(|w| w.to_string()).collect();
    let source = StudySource::parse(report, "report.toml", &[]).map_err(words)?;
    read_source_beside(source, &neighbour).map_err(words)
}

/// Returns the results.json of the only part, and the output of the report.
fn run(report: &dyn LoadedStudy) -> (String, RunOutput) {
    let part = &report.parts()[0].study;
    let request = RunRequest { wanted: (0..part.count()).collect(), jobs: 1, ..RunRequest::default() };
    let results = text(&part.run(&request, &Unobserved), "results.json");
    let request = RunRequest { parts: vec![results.clone()], version: "test".into(), ..RunRequest::default() };
    (results, report.run(&request, &Unobserved))
}

fn text(output: &RunOutput, name: &str) -> String {
    let (_, bytes) = output.files.iter().find(|(own, _)| own == name).unwrap_or_else(|| panic!("no {name}"));
    String::from_utf8(bytes.clone()).expect("text")
}

#[test]
fn verdicts_are_computed_and_changed_ones_are_found() {
    let report = read(REPORT).expect("a report");
    let (part, output) = run(report.as_ref());
    let results = text(&output, "results.json");
    let json: Json = serde_json::from_str(&results).expect("JSON");
    let verdicts: Vec<&str> = (0..3).map(|i| json["claims"][i]["verdict"].as_str().expect("a verdict")).collect();
    // The load is unbounded at rise 1.19 m: the greatest load does not exist.
    assert_eq!(verdicts, ["reproduced", "refuted", "depends_on"]);
    assert!(output.certified);
    let page = text(&output, "report.html");
    assert!(
        page.matches("<figure><svg").count() == 2 && page.contains("&lt;script&gt;bad()") && page.contains("carries")
    );
    assert!(
        page.contains("The place of the greatest value of loads is greater than 2.") && page.contains("argmax(loads)")
    );
    let reading = "The authors probably had <b>finite displacements</b>.";
    assert!(page.contains(&reading.replace('<', "&lt;").replace('>', "&gt;")) && !page.contains(reading));
    assert_eq!((&json["claims"][0].get("reading"), &json["claims"][1]["reading"]), (&None, &Json::from(reading)));
    // Page and results name version and commit.
    let commit = json["commit"].as_str().expect("a commit");
    assert!(json["version"] == "test" && page.contains("Voussoir test") && page.contains(commit));
    assert!(text(&output, "figures/chart-loads.svg").contains("rise [m]"));

    let file = |name: &str| match name {
        "rises/results.json" => Some(part.clone().into_bytes()),
        other => output.files.iter().find(|(own, _)| own == other).map(|(_, bytes)| bytes.clone()),
    };
    let verify = |results: &str| {
        let file = |name: &str| {
            let bytes = if name == "results.json" { results.as_bytes().to_vec() } else { file(name)? };
            Some(Box::new(std::io::Cursor::new(bytes)) as Box<dyn std::io::Read>)
        };
        let stored = StoredResults { jobs: 1, file: &file };
        let found = report.verify_stored(&stored, &Unobserved).expect("results");
        found.findings.len() + found.files.len()
    };
    assert_eq!(verify(&results), 0);
    assert!(verify(&results.replacen("refuted", "reproduced", 1)) > 0);
    assert!(verify(&results.replacen("698.02", "699.02", 2)) > 0);
    assert!(verify(&results.replacen("\"format\": 1", "\"format\": 2", 1)) > 0, "a newer program has written it");
}

/// A claim about a case without an answer is undecided, and the run reports it.
#[test]
fn what_no_study_has_proven_is_undecided() {
    let report = read(REPORT).expect("a report");
    let (part, _) = run(report.as_ref());
    let mut json: Json = serde_json::from_str(&part).expect("JSON");
    json["cases"][1]["status"] = "stalled".into();
    let request = RunRequest { parts: vec![json.to_string()], ..RunRequest::default() };
    let output = report.run(&request, &Unobserved);
    let json: Json = serde_json::from_str(&text(&output, "results.json")).expect("JSON");
    assert_eq!(json["claims"][1]["verdict"], "undecided");
    assert!(!output.certified);
}

#[test]
fn mistakes_say_where_and_what() {
    let wrong = |from: &str, to: &str| {
        let found = read(&REPORT.replacen(from, to, 1)).err().unwrap_or_default();
        assert_eq!(found.len(), 1, "{to}: {found:?}");
        found[0].clone()
    };
    for (from, to, said) in [
        ("reading = ", "readings = ", "reading"),
        ("argmax(loads)", "argmx(loads)", "there is no function \"argmx\""),
        ("argmax(loads)", "argmax(load)", "there is no series \"load\""),
        ("at(loads, 2.99)", "at(loads)", "at takes 2 argument(s), not 1"),
        ("value > 2", "value > ", "is missing at its end"),
        ("\"rises.toml\"", "\"rise.toml\"", "rise.toml cannot be read"),
        ("chart:loads", "chart:load", "there is no \"load\""),
        ("series = [\"loads\"]", "series = [\"lods\"]", "there is no series \"lods\""),
        ("study = \"rises\"", "study = \"rise\"", "there is no study \"rise\""),
        ("depends_on = \"the rise\"", "", "the claim has several tests"),
    ] {
        let found = wrong(from, to);
        assert!(found.starts_with("report.toml:") && found.contains(said), "{found}");
    }
}
