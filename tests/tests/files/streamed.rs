//! Results are verified case by case, from file to file: forged, missing, doubled and foreign entries are found.

use serde_json::{Value, json};
use std::io::{Cursor, Read};
use voussoir::kinds::{LoadedStudy, RunRequest, SceneStudy, StoredResults};
use voussoir::solve::Unobserved;
use voussoir::study::{StudyFile, StudySource};
use voussoir_tests::Arch;

/// A change of a result file.
type Forgery<'f> = &'f dyn Fn(&mut Value);

/// Returns five cases as a sweep that is not stored in memory.
fn sweep() -> SceneStudy {
    let arch = Arch { voussoirs: 7, ends: "jointed", ..Arch::default() };
    let text = arch.study()
        + "[output]\nwriters = [\"results_json\", \"results_csv\", \"results_parquet\"]\n[sweep]\n\"scene.width\" = { list = [1.0, 2.0, 3.0, 4.0, 5.0] }\n";
    let source = StudySource::parse(&text, "test.toml", &[]).expect("a study");
    StudyFile::read(source).and_then(StudyFile::study_unchecked).map(SceneStudy).expect("a sweep")
}

/// Returns the findings of `verify` for results.json and results.csv.
fn findings(sweep: &SceneStudy, results: &[u8], table: Option<&[u8]>) -> Vec<String> {
    findings_of(sweep, results, table, None)
}

/// Returns the findings of `verify` for results.json and both tables.
fn findings_of(sweep: &SceneStudy, results: &[u8], table: Option<&[u8]>, parquet: Option<&[u8]>) -> Vec<String> {
    let bytes = |name: &str| match name {
        "results.json" => Some(results.to_vec()),
        "results.csv" => table.map(<[u8]>::to_vec),
        "results.parquet" => parquet.map(<[u8]>::to_vec),
        _ => None,
    };
    let file = |name: &str| Some(Box::new(Cursor::new(bytes(name)?)) as Box<dyn Read>);
    match sweep.verify_stored(&StoredResults { jobs: 2, file: &file }, &Unobserved) {
        Ok(found) => found.findings.into_iter().map(|(id, why)| format!("{id}: {why}")).chain(found.files).collect(),
        Err(why) => vec![why],
    }
}

#[test]
fn what_is_forged_is_found() {
    let sweep = sweep();
    let request = RunRequest { wanted: (0..5).collect(), jobs: 1, ..RunRequest::default() };
    let output = LoadedStudy::run(&sweep, &request, &Unobserved);
    let bytes = |name: &str| &output.files.iter().find(|(own, _)| own == name).expect("a file").1;
    let (results, table) = (bytes("results.json"), bytes("results.csv"));
    assert_eq!(findings(&sweep, results, Some(table)), Vec::<String>::new());
    assert_eq!(findings(&sweep, results, None), Vec::<String>::new());
    let original: Value = serde_json::from_slice(results).expect("JSON");
    let found = |change: &dyn Fn(&mut Value)| {
        let mut changed = original.clone();
        change(&mut changed);
        findings(&sweep, changed.to_string().as_bytes(), None)
    };
    let list = |value: &mut Value| value["cases"].as_array_mut().expect("cases").clone();
    let forgeries: [(&str, Forgery); 9] = [
        ("3: load_factor", &|v| v["cases"][3]["load_factor"] = json!(1.0)),
        ("2: status", &|v| v["cases"][2]["status"] = json!("stands")),
        ("4: is missing", &|v| v["cases"] = list(v)[..4].into()),
        ("1: is missing", &|v| v["cases"] = [&list(v)[..1], &list(v)[2..]].concat().into()),
        ("4: appears twice", &|v| v["cases"] = [&list(v)[..], &list(v)[4..]].concat().into()),
        ("1: the entries of cases are not in the order", &|v| v["cases"].as_array_mut().expect("cases").swap(1, 2)),
        ("0: study is", &|v| v["study"] = json!("another")),
        ("0: the entries of kind = \"run\"", &|v| v["worsts"] = json!([])),
        ("0: only_cases", &|v| v["only_cases"] = json!([0, 1, 2, 3, 4])),
    ];
    for (why, change) in forgeries {
        let found = found(change);
        assert!(found.iter().any(|line| line.starts_with(why)), "{why}: {found:?}");
    }
    let fewer = found(&|v| {
        v["cases"] = list(v)[..2].into();
        v["only_cases"] = json!([0, 1, 2]);
    });
    assert!(!fewer.is_empty(), "cases that were asked for are not there");
    let chosen = found(&|v| {
        v["cases"] = list(v)[..2].into();
        v["only_cases"] = json!([0, 1]);
    });
    assert_eq!(chosen, Vec::<String>::new(), "a run of two cases");
    // The table: a changed cell, one row more, one row less, another header.
    let text = String::from_utf8(table.clone()).expect("text");
    let last = text.trim_end().rfind('\n').expect("rows");
    for forged in
        [text.replacen("four_hinge", "five_hinge", 1), text.clone() + "5\n", text[..=last].into(), String::new()]
    {
        assert_eq!(findings(&sweep, results, Some(forged.as_bytes())), ["results.csv is not what results.json gives"]);
    }
    // The typed table: unchanged, with a changed byte at several places, longer and shorter.
    let parquet = bytes("results.parquet");
    assert_eq!(findings_of(&sweep, results, Some(table), Some(parquet)), Vec::<String>::new());
    let cut = parquet.len() - 1;
    let changed = |at: usize| parquet.iter().enumerate().map(|(i, byte)| byte ^ u8::from(i == at)).collect();
    let places = (0..parquet.len()).step_by(parquet.len() / 12).chain([cut]).map(changed);
    for forged in places.chain([parquet[..cut].to_vec(), [&parquet[..], b"P"].concat(), Vec::new()]) {
        let found = findings_of(&sweep, results, Some(table), Some(&forged));
        assert_eq!(found, ["results.parquet is not what results.json gives"]);
    }
    // Truncated files.
    assert!(!findings(&sweep, &results[..results.len() / 2], None).is_empty());
    assert!(!findings(&sweep, b"", None).is_empty());
}
