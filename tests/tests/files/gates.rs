//! No certificate in the studies of the repository passes above its gate. Other tests check each of their results in
//! the same way.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use voussoir::kinds::{RunRequest, read_source_beside};
use voussoir::results::CaseResult;
use voussoir::solve::Unobserved;
use voussoir::study::{StudySource, beside};
use voussoir_tests::gates::above_gates;

/// Runs a study and returns its cases; empty if the kind has no case with a scene.
fn cases(path: &Path) -> Vec<CaseResult> {
    let text = std::fs::read_to_string(path).expect("a study");
    let source = StudySource::parse_with(&text, &path.display().to_string(), &[], &beside(path));
    let study = source.and_then(|source| read_source_beside(source, &beside(path)));
    let study = study.unwrap_or_else(|wrong| panic!("{wrong}"));
    if study.with_cases().is_none() {
        return Vec::new();
    }
    let request = RunRequest { wanted: (0..study.count()).collect(), jobs: 1, ..RunRequest::default() };
    let output = study.run(&request, &Unobserved);
    let (_, bytes) = output.files.iter().find(|(name, _)| name == "results.json").expect("results");
    let results: Value = serde_json::from_slice(bytes).expect("JSON");
    serde_json::from_value(results["cases"].clone()).expect("cases")
}

/// No certificate of a study in studies/cases passes above its gate; the variable `STUDIES` selects studies by name.
#[test]
#[ignore = "long: every study of the repository"]
fn no_certificate_of_the_studies_passes_above_its_gate() {
    let only = std::env::var("STUDIES").unwrap_or_default();
    let mut worst: BTreeMap<String, f64> = BTreeMap::new();
    let (mut count, mut above) = (0, Vec::new());
    for folder in ["cases", "cases/paper"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies").join(folder);
        let mut files: Vec<_> = std::fs::read_dir(folder).expect("studies").flatten().map(|file| file.path()).collect();
        files.retain(|file| {
            file.extension().is_some_and(|end| end == "toml") && file.display().to_string().contains(&only)
        });
        files.sort();
        for file in files {
            let cases = cases(&file);
            for case in cases.iter().filter(|case| case.certificate.passed) {
                let found = above_gates(case, 1e-9, 0.0);
                above.extend(found.into_iter().map(|why| format!("{}, case {}: {why}", file.display(), case.label.id)));
                for (name, value) in &case.certificate.residuals {
                    let own = worst.entry(name.clone()).or_insert(*value);
                    *own = own.max(*value);
                }
                count += 1;
            }
            println!("{}: {} cases", file.display(), cases.len());
        }
    }
    println!("{count} certificates; greatest residuals:");
    worst.iter().for_each(|(name, value)| println!("{name:24} {value:.1e}"));
    assert_eq!(above, Vec::<String>::new());
}
