//! Forgeries of the tables, figures and pages beside results.json: every number and every word changed one at a time.
//! `verify` names each file that was changed.
//!
//! The short form tries a share of the places of pages and figures; `FORGERY=all` tries all of them.

use std::collections::BTreeSet;
use std::io::{Cursor, Read};
use voussoir::kinds::{LoadedStudy, RunRequest, StoredResults, altered, read_study};
use voussoir::solve::Unobserved;
use voussoir::verify::Agreement;
use voussoir_tests::{Arch, changed, elastic, friction};

/// Returns the start and end of the numbers and words of a text.
fn places(text: &str) -> Vec<(usize, usize)> {
    let of_token = |c: char| c.is_alphanumeric() || c == '.';
    let (mut out, mut from) = (Vec::new(), None);
    for (at, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match (of_token(c), from) {
            (true, None) => from = Some(at),
            (false, Some(start)) => {
                out.push((start, at));
                from = None;
            }
            _ => {}
        }
    }
    out
}

/// Returns a number with another last digit, or a word with another last letter.
fn other(token: &str) -> String {
    let mut kept: Vec<char> = token.chars().collect();
    let last = kept.pop().unwrap_or('x');
    kept.push(match last {
        '0'..='8' => (last as u8 + 1) as char,
        '9' => '8',
        'x' => 'y',
        _ => 'x',
    });
    kept.into_iter().collect()
}

type Files = Vec<(String, Vec<u8>)>;

/// Returns the files that a run of a study writes.
fn written(study: &dyn LoadedStudy) -> Files {
    let request =
        RunRequest { wanted: (0..study.count()).collect(), jobs: 1, version: "test".into(), ..RunRequest::default() };
    study.run(&request, &Unobserved).files
}

fn stored(files: &[(String, Vec<u8>)], name: &str) -> Option<Box<dyn Read>> {
    let (_, bytes) = files.iter().find(|(own, _)| own == name)?;
    Some(Box::new(Cursor::new(bytes.clone())))
}

/// Checks each place of each file against the files as written again, and all files at once with `verify`.
fn each_is_found(name: &str, text: &str) {
    let study = read_study(text, "test.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let files = written(study.as_ref());
    let verified = |files: &Files| {
        let file = |name: &str| stored(files, name);
        let found = study.verify_stored(&StoredResults { jobs: 1, file: &file }, &Unobserved).expect("results");
        (found.findings.len(), found.files.into_iter().collect::<BTreeSet<_>>())
    };
    assert_eq!(verified(&files), (0, BTreeSet::new()), "{name}: untouched");
    let all = std::env::var("FORGERY").is_ok_and(|form| form == "all");
    let (mut forged, mut tried) = (files.clone(), 0);
    for (index, (file, bytes)) in files.iter().enumerate().filter(|(_, (file, _))| file != "results.json") {
        let text = std::str::from_utf8(bytes).expect("text");
        let found = places(text);
        assert!(found.len() > 10, "{file}");
        let step = if all || file.ends_with(".csv") { 1 } else { found.len() / 40 + 1 };
        for &(from, to) in found.iter().step_by(step) {
            let forgery = [&text[..from], &other(&text[from..to]), &text[to..]].concat();
            forged[index].1 = forgery.into_bytes();
            let own = files[index..=index].iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice()));
            let open = |name: &str| stored(&forged[index..=index], name);
            let altered = altered(&StoredResults { jobs: 1, file: &open }, own, Agreement::Bits);
            assert_eq!(altered.len(), 1, "{name}: {file}, byte {from}");
            tried += 1;
        }
    }
    println!("{name}: {tried} places in {} files", files.len() - 1);
    // Each file has one changed place.
    let (findings, named) = verified(&forged);
    let expected = files.iter().map(|(name, _)| name).filter(|name| *name != "results.json");
    assert_eq!(findings, 0, "{name}");
    // The states of a path do not follow from results.json: their line has a checksum.
    let finding = |name: &String| match name.as_str() {
        "path_proofs.jsonl" => format!("{name}, line 1, case 0: the checksum is wrong"),
        _ => format!("{name} is not what results.json gives"),
    };
    assert_eq!(named, expected.map(finding).collect(), "{name}");
}

/// Every changed table and figure is found, for limit analysis, a path with its curve, a comparison, a map and an
/// optimum.
#[test]
fn every_table_and_figure_is_made_again() {
    let arch = Arch { joint: friction(0.6), ends: "jointed", voussoirs: 7, ..Arch::default() };
    let swept = format!("{}[sweep]\n\"scene.profile.rise\" = {{ list = [2.5, 3.0] }}\n", arch.study());
    each_is_found("limit analysis", &swept);
    let path =
        Arch { material: elastic(5e9, 0.2), mesh: "elements = [1, 2]".into(), solver: "event_path", ..arch.clone() };
    each_is_found("path", &format!("{}[output]\ncurve = true\nvtu = true\n", path.study()));
    let variants =
        "[[variants]]\nname = \"dry\"\n[[variants]]\nname = \"wet\"\nset = { \"joints.dry.friction\" = 0.35 }\n";
    each_is_found("compare", &format!("kind = \"compare\"\n{}{variants}", arch.study()));
    let axes =
        "[sweep]\n\"scene.profile.rise\" = { list = [2.5, 3.0] }\n\"joints.dry.friction\" = { list = [0.4, 0.6] }\n";
    each_is_found("map", &format!("kind = \"map\"\n{}{axes}", arch.study()));
    let best = "kind = \"optimise\"\noptimise = { parameter = \"joints.dry.friction\", from = 0.3, to = 0.6, goal = \"maximise\", \
                scan = 3, tolerance = 0.3 }\n";
    each_is_found("optimise", &format!("{best}{}", arch.study()));
}

/// Every changed table and figure of an envelope is found.
#[test]
fn every_table_and_figure_of_an_envelope_is_made_again() {
    let text = include_str!("../../../studies/cases/viaduct.toml");
    let text = changed(text, "from = -3.0, to = 20.0, scan = 47", "from = 1.0, to = 4.0, scan = 3, tolerance = 0.3");
    let text = changed(&text, "rings = 2", "rings = 1");
    each_is_found("envelope", &format!("{text}[output]\nanimation = true\n"));
}
