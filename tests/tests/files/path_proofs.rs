//! `path_proofs.jsonl`: states and witnesses that prove the end of a path without its solver, and every forgery of
//! them.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{Cursor, Read};
use std::sync::atomic::{AtomicUsize, Ordering};
use voussoir::kinds::{LoadedStudy, RunRequest, SceneStudy, StoredResults, Verification, read_study};
use voussoir::results::CaseResult;
use voussoir::results::sealed_line::{case_in, sealed_text};
use voussoir::results::stored_path::PATH_PROOFS;
use voussoir::solve::{Observer, Unobserved};
use voussoir::study::{StudyFile, StudySource};
use voussoir_tests::changed;

/// Two rings of elastic voussoirs with associated friction: collapse by a mechanism, without a tree of decisions.
const RINGS: &str = r#"
name = "rings"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 9.42, rise = 2.99 }
thickness = 0.60
width = 5.81
voussoirs = 7
ends = "bonded"
material = "stone"
joint = "dry"
[scene.mesh]
elements = [1, 2]
[materials.stone]
law = "elastic"
young_modulus = "5 GPa"
poisson_ratio = 0.3
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.25, force = [0.0, -1000.0] }]
[solver]
solver = "event_path"
[output]
figures = false
curve = true
[sweep]
"scene.thickness" = { list = [0.6, 0.7] }
"#;

/// A block that is pushed over its edge: a limit point of finite displacements, proved by a witness.
const TIPS: &str = r#"
name = "tips"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "dry"
blocks = [
  { name = "ground", vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]], fixed = true },
  { name = "a", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]] },
]
[materials.stone]
law = "rigid"
density = 1000.0
[joints.dry]
law = "coulomb"
friction = 0.7
normal_stiffness = 1e8
shear_stiffness = 1e8
[[stages]]
name = "dead"
gravity = 10.0
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", block = "a", point = [0.0, 2.0], force = [1000.0, 0.0] }]
[solver]
solver = "newton_path"
kinematics = "finite"
[output]
figures = false
"#;

type Files = BTreeMap<String, Vec<u8>>;

/// Returns a study and the files that its run writes.
fn run(text: &str) -> (Box<dyn LoadedStudy>, Files) {
    let study = read_study(text, "paths.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let request = RunRequest { wanted: (0..study.count()).collect(), jobs: 1, ..RunRequest::default() };
    let files = study.run(&request, &Unobserved).files.into_iter().collect();
    (study, files)
}

/// Counts the cases that are solved.
#[derive(Default)]
struct Solved(AtomicUsize);

impl Observer for Solved {
    fn answered(&self, _: &CaseResult) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

/// Checks files; returns the result and the number of cases that were solved.
fn verified(study: &dyn LoadedStudy, files: &Files) -> (Verification, usize) {
    let solved = Solved::default();
    let file = |name: &str| files.get(name).map(|bytes| Box::new(Cursor::new(bytes.clone())) as Box<dyn Read>);
    let found = study.verify_stored(&StoredResults { jobs: 1, file: &file }, &solved).expect("results");
    (found, solved.0.into_inner())
}

/// Returns all findings in words.
fn findings(study: &dyn LoadedStudy, files: &Files) -> Vec<String> {
    let (found, _) = verified(study, files);
    let cases = found.findings.iter().map(|(id, why)| format!("case {id}: {why}"));
    cases.chain(found.files.iter().cloned()).collect()
}

fn results(files: &Files) -> Value {
    serde_json::from_slice(&files["results.json"]).expect("JSON")
}

/// Returns the files with another results.json.
fn with_results(files: &Files, results: &Value) -> Files {
    let mut files = files.clone();
    files.insert("results.json".into(), serde_json::to_vec(results).expect("JSON"));
    files
}

/// Returns the same files as another kind of processor would have written them.
fn elsewhere(files: &Files) -> Files {
    let mut results = results(files);
    results["platform"] = json!("elsewhere");
    with_results(files, &results)
}

/// Returns the lines of the file, without checksums.
fn lines(files: &Files) -> Vec<Value> {
    let text = &files[PATH_PROOFS];
    let lines = text.split(|byte| *byte == b'\n').filter(|line| !line.is_empty());
    lines.map(|line| serde_json::from_slice(&line[case_in(line).expect("a checksum")]).expect("JSON")).collect()
}

/// Returns the files with other lines, which have correct checksums.
fn with_lines(files: &Files, lines: &[Value]) -> Files {
    let mut files = files.clone();
    let text = lines.iter().flat_map(|line| sealed_text(line.to_string().as_bytes())).collect();
    files.insert(PATH_PROOFS.into(), text);
    files
}

/// Returns the files after a change of the path in the first line.
fn forged(files: &Files, change: impl FnOnce(&mut Value)) -> Files {
    let mut lines = lines(files);
    change(&mut lines[0]["path"]);
    with_lines(files, &lines)
}

/// Multiplies a number.
fn times(value: &mut Value, by: f64) {
    *value = json!(by * value.as_f64().expect("a number"));
}

/// A forged place of a mechanism is found: the factors of the last states show if the load is constant.
#[test]
fn a_forged_place_of_a_mechanism_is_found() {
    let (study, files) = run(RINGS);
    let mut forged = results(&files);
    assert_eq!(forged["cases"][0]["mechanism"]["at"], json!("plateau"));
    forged["cases"][0]["mechanism"]["at"] = json!("peak");
    let found = findings(&*study, &elsewhere(&with_results(&files, &forged)));
    assert!(found.iter().any(|why| why.contains("mechanism.at is \"peak\", but by field_factor")), "{found:?}");
}

/// The stored states prove the results of both paths. On another processor no case is solved again; on this one the
/// unproved parts are.
#[test]
fn stored_states_prove_a_path_without_its_solver() {
    for (text, cases) in [(RINGS, 2), (TIPS, 1)] {
        let (study, files) = run(text);
        let head = &results(&files)["files"];
        assert!(head.as_array().expect("a list").contains(&json!(PATH_PROOFS)), "{head}");
        assert_eq!(findings(study.as_ref(), &files), Vec::<String>::new());
        let (found, solved) = verified(study.as_ref(), &files);
        assert_eq!((found.paths, solved), ([cases, 0], cases), "{}", study.name());
        let there = elsewhere(&files);
        assert_eq!(findings(study.as_ref(), &there), Vec::<String>::new());
        let (found, solved) = verified(study.as_ref(), &there);
        assert_eq!((found.paths, solved), ([cases, cases], 0), "{}", study.name());
        println!("{}: {} bytes a case", study.name(), files[PATH_PROOFS].len() / cases);
    }
}

/// If the file is missing, the case is solved again.
#[test]
fn without_the_file_cases_are_solved_again() {
    let (study, mut files) = run(RINGS);
    files.remove(PATH_PROOFS);
    assert_eq!(findings(study.as_ref(), &files), Vec::<String>::new());
    let mut results = results(&files);
    results["files"].as_array_mut().expect("a list").retain(|name| name != PATH_PROOFS);
    let files = elsewhere(&with_results(&files, &results));
    let (found, solved) = verified(study.as_ref(), &files);
    assert_eq!((found.findings, found.files, found.paths, solved), (vec![], vec![], [0, 0], 2));
}

/// `[output] path_proofs` decides if the file is written; by default studies with few cases have it.
#[test]
fn the_study_decides() {
    let with = |keys: &str| run(&changed(RINGS, "figures = false", &format!("figures = false\n{keys}"))).1;
    assert!(!with("path_proofs = false").contains_key(PATH_PROOFS));
    assert!(with("path_proofs = true").contains_key(PATH_PROOFS));
    let many = changed(RINGS, "{ list = [0.6, 0.7] }", "{ from = 0.6, to = 0.7, count = 21 }");
    let study = read_study(&many, "paths.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let request = RunRequest { wanted: vec![0], jobs: 1, ..RunRequest::default() };
    assert!(study.run(&request, &Unobserved).files.iter().all(|(name, _)| name != PATH_PROOFS));
}

/// States that are moved, dropped, exchanged or doubled, false indices and false witnesses are found, with line and
/// case.
#[test]
fn forged_states_and_witnesses_are_found() {
    type Forgery = (&'static str, fn(&mut Value));
    const ALL: &[Forgery] = &[
        ("a force", |path| times(greatest(&mut middle(path)["force"]), 1.0 + 1e-6)),
        ("a motion", |path| times(greatest(&mut middle(path)["motion"]), 1.001)),
        ("a factor", |path| times(&mut middle(path)["factor"], 1.0 + 1e-6)),
        ("a displacement", |path| times(&mut middle(path)["displacement"], 1.0 + 1e-6)),
        ("dissipation", |path| middle(path)["energies"][1] = json!(1e9)),
        ("a load step", |path| middle(path)["load_step"] = json!(1_000_000)),
        ("the first half dropped", |path| drop(first_half(path))),
        ("swapped states", |path| swap_middle(path)),
        ("no states", |path| list(path, "states").clear()),
        ("another end", |path| path["end"] = json!(1)),
        ("no end", |path| path["end"] = json!(u32::MAX)),
        ("another status", |path| path["status"] = json!("stands")),
        ("unbounded", |path| path["status"] = json!("unbounded")),
        ("a short list", |path| drop(list(middle(path), "force").pop())),
        ("a great number", |path| middle(path)["motion"][1][2] = json!(1e200)),
        ("an unknown key", |path| path["more"] = json!(1)),
    ];
    for text in [RINGS, TIPS] {
        let (study, files) = run(text);
        for (name, forge) in ALL {
            let forged = forged(&elsewhere(&files), forge);
            let found = findings(study.as_ref(), &forged);
            let named = found.iter().any(|why| why.contains("path_proofs.jsonl, line 1"));
            assert!(named && found[0].contains("case 0"), "{}: {name}: {found:?}", study.name());
        }
    }
    // A state on a straight piece between two others may be missing, but not a state at which a point changes its mode.
    let (study, files) = run(RINGS);
    let count = lines(&files)[0]["path"]["states"].as_array().expect("states").len();
    let dropped = (0..count).filter(|place| {
        let forged = forged(&elsewhere(&files), |path| {
            let end = path["end"].as_u64().expect("an index") as usize;
            path["end"] = json!(end - usize::from(*place < end));
            drop(list(path, "states").remove(*place));
        });
        !findings(study.as_ref(), &forged).is_empty()
    });
    let found = dropped.count();
    assert!(10 * found >= 9 * count, "{found} of {count} states that are dropped are found");
    println!("{found} of {count} states that are dropped are found");
    // A mechanism of associated flow needs no separate witness.
    let (study, files) = run(RINGS);
    for by in [0.5, -1.0] {
        let forged = forged(&files, |path| {
            let rates = list(path, "motion").iter_mut().flat_map(|rates| rates.as_array_mut().expect("rates"));
            rates.for_each(|rate| times(rate, by));
        });
        assert!(!findings(study.as_ref(), &forged).is_empty(), "a mechanism times {by}");
    }
    let (study, files) = run(TIPS);
    let witnesses = |change: fn(&mut Value)| {
        forged(&files, |path| list(path, "witnesses").iter_mut().for_each(|own| change(&mut own["claim"])))
    };
    for (name, forged) in [
        ("turned", witnesses(|claim| each_number(&mut claim["none_rises"], &|x| -x))),
        ("bent", witnesses(|claim| each_number(&mut claim["none_rises"], &|x| x * x))),
        ("cut", witnesses(|claim| drop(list(claim, "none_rises").pop()))),
        ("lengthened", witnesses(|claim| list(claim, "none_rises").push(json!({ "split": [0, []] })))),
        ("none", forged(&files, |path| list(path, "witnesses").clear())),
        (
            "elsewhere",
            forged(&files, |path| list(path, "witnesses").iter_mut().for_each(|own| own["state"] = json!(0))),
        ),
    ] {
        assert!(!findings(study.as_ref(), &forged).is_empty(), "witnesses: {name}");
    }
}

/// Returns the state in the middle of a path.
fn middle(path: &mut Value) -> &mut Value {
    let states = list(path, "states");
    let place = states.len() / 2;
    &mut states[place]
}

fn first_half(path: &mut Value) -> Vec<Value> {
    let states = list(path, "states");
    let half = states.len() / 2;
    path["end"] = json!(path["end"].as_u64().expect("an index") as usize - half);
    list(path, "states").drain(..half).collect()
}

/// Returns the greatest number of a list of lists.
fn greatest(lists: &mut Value) -> &mut Value {
    let numbers = lists.as_array_mut().expect("a list").iter_mut().flat_map(|own| own.as_array_mut().expect("a list"));
    let size = |number: &&mut Value| number.as_f64().expect("a number").abs();
    numbers.max_by(|a, b| size(a).total_cmp(&size(b))).expect("a number")
}

fn swap_middle(path: &mut Value) {
    let states = list(path, "states");
    let place = states.len() / 2;
    states.swap(place, place - 1);
}

fn list<'a>(value: &'a mut Value, key: &str) -> &'a mut Vec<Value> {
    value[key].as_array_mut().expect("a list")
}

/// Changes every float of a tree.
fn each_number(value: &mut Value, change: &dyn Fn(f64) -> f64) {
    match value {
        Value::Number(number) if number.is_f64() => *value = json!(change(number.as_f64().expect("a float"))),
        Value::Array(items) => items.iter_mut().for_each(|item| each_number(item, change)),
        Value::Object(map) => map.values_mut().for_each(|item| each_number(item, change)),
        _ => {}
    }
}

/// Lines of another case and damaged, doubled, misplaced or surplus lines are found without panic.
#[test]
fn damaged_and_foreign_lines_are_found() {
    let (study, files) = run(RINGS);
    let own = lines(&files);
    let text = files[PATH_PROOFS].clone();
    let with_text = |text: Vec<u8>| {
        let mut files = files.clone();
        files.insert(PATH_PROOFS.into(), text);
        files
    };
    let with_path = |path: &Value| {
        let mut line = own[0].clone();
        line["path"] = path.clone();
        with_lines(&files, &[line, own[1].clone()])
    };
    let flipped = |at: usize| with_text(text.iter().enumerate().map(|(i, byte)| byte ^ u8::from(i == at)).collect());
    let mut renamed = own.clone();
    renamed[1]["id"] = json!(7);
    let mut deep = own[0]["path"].clone();
    let split = json!({ "split": [0, ["stick"]] });
    deep["witnesses"] = json!([{ "state": 0, "claim": { "none_rises": vec![split; 100_000] } }]);
    for (name, forged, line) in [
        ("another case's line", with_path(&own[1]["path"]), "case 0: path_proofs.jsonl, line 1"),
        ("a flipped bit", flipped(text.len() / 3), "path_proofs.jsonl, line 1, case 0: the checksum is wrong"),
        ("cut short", with_text(text[..text.len() - 9].to_vec()), "path_proofs.jsonl, line 2, case 1"),
        ("doubled", with_lines(&files, &[&own[..1], &own[..]].concat()), "path_proofs.jsonl, line 2, case 0"),
        ("swapped", with_lines(&files, &[own[1].clone(), own[0].clone()]), "path_proofs.jsonl, line 2, case 0"),
        ("of no case", with_lines(&files, &renamed), "path_proofs.jsonl, line 2: case 7"),
        ("no JSON", with_text(sealed_text(b"{\"id\":0,\"path\":[1e999")), "path_proofs.jsonl, line 1, case 0"),
        ("a deep tree", with_path(&deep), "path_proofs.jsonl, line 1"),
        ("zeros", with_text(vec![0; 4096]), "path_proofs.jsonl, line 1"),
    ] {
        let found = findings(study.as_ref(), &forged);
        assert!(found.iter().any(|why| why.contains(line)), "{name}: {found:?}");
    }
}

/// Claims of results.json that the states do not prove are found without solving again.
#[test]
fn claims_beyond_the_states_are_found() {
    for (text, paths) in [
        (
            RINGS,
            &[
                "/load_factor",
                "/field/0/force/0",
                "/displacements/3/displacement/0",
                "/curve/2/1",
                "/motion/3/velocity/0",
            ][..],
        ),
        (TIPS, &["/load_factor", "/first_limit_point", "/limit_points/0/factor", "/followed_to/factor"]),
    ] {
        let (study, files) = run(text);
        for path in paths {
            let mut results = results(&elsewhere(&files));
            let place = results["cases"][0].pointer_mut(path).unwrap_or_else(|| panic!("{path}"));
            times(place, 1.01);
            let found = findings(study.as_ref(), &with_results(&files, &results));
            assert!(found.iter().any(|why| why.contains("path_proofs.jsonl, line 1")), "{path}: {found:?}");
        }
        let mut added = results(&elsewhere(&files));
        added["cases"][0]["sensitivities"] =
            json!([{ "key": "scene.width", "value": 1.0, "left": 1.0, "right": 1.0, "kink": false }]);
        assert!(!findings(study.as_ref(), &with_results(&files, &added)).is_empty());
        let mut results = results(&elsewhere(&files));
        results["cases"][0]["status"] = json!("stands");
        let last = results["cases"][0]["stages"].as_array().expect("stages").len() - 1;
        results["cases"][0]["stages"][last]["status"] = json!("stands");
        assert!(!findings(study.as_ref(), &with_results(&files, &results)).is_empty());
    }
}

/// Cases that are not held have the file if the study asks for it, and its lines are checked in the same way.
#[test]
fn streamed_cases_have_their_lines() {
    let source = StudySource::parse(&changed(RINGS, "curve = true", "path_proofs = true"), "paths.toml", &[]);
    let sweep = StudyFile::read(source.expect("a study"))
        .and_then(StudyFile::study_unchecked)
        .map(SceneStudy)
        .expect("a sweep");
    let request = RunRequest { wanted: vec![0, 1], jobs: 1, ..RunRequest::default() };
    let files: Files = LoadedStudy::run(&sweep, &request, &Unobserved).files.into_iter().collect();
    let there = elsewhere(&files);
    assert_eq!(findings(&sweep, &there), Vec::<String>::new());
    let (found, solved) = verified(&sweep, &there);
    assert_eq!((found.paths, solved), ([2, 2], 0));
    assert_eq!(verified(&sweep, &files).0.paths, [2, 0]);
    let found = findings(&sweep, &forged(&there, |path| list(path, "states").swap(3, 4)));
    assert!(found[0].starts_with("case 0: path_proofs.jsonl, line 1: "), "{found:?}");
    let found = findings(&sweep, &with_lines(&there, &[lines(&files), lines(&files)].concat()));
    assert!(found.iter().any(|why| why.starts_with("path_proofs.jsonl, line 3, case 0")), "{found:?}");
}

/// A continued run, a run with finished results and merged parts write the same file.
#[test]
fn resume_and_merge_keep_the_lines() {
    let folder = std::env::temp_dir().join(format!("voussoir_path_proofs_{}", std::process::id()));
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir_all(&folder).expect("a folder");
    let at = |name: &str| folder.join(name).display().to_string();
    std::fs::write(at("a.toml"), RINGS).expect("written");
    let voussoir = |words: &[&str]| voussoir::cli::main_from(words.iter().map(Into::into)).expect("arguments");
    let text = |name: &str| std::fs::read(folder.join(name).join(PATH_PROOFS)).expect("a file");
    let (study, out) = (at("a.toml"), at("whole"));
    assert_eq!(voussoir(&["run", &study, "--quiet", "--out", &out]), 0);
    let whole = text("whole");
    assert_eq!(whole.iter().filter(|byte| **byte == b'\n').count(), 2);
    assert_eq!(voussoir(&["run", &study, "--quiet", "--resume", "--out", &out]), 0);
    assert_eq!(text("whole"), whole);
    assert_eq!(voussoir(&["run", &study, "--quiet", "--case", "1", "--out", &out]), 0);
    assert_eq!(text("whole"), whole);
    assert_eq!(voussoir(&["verify", &out]), 0);
    for part in ["1/2", "2/2"] {
        assert_eq!(voussoir(&["run", &study, "--quiet", "--shard", part, "--out", &at("parts")]), 0);
    }
    assert_eq!(voussoir(&["merge", &at("parts"), "--quiet", "--out", &at("merged")]), 0);
    assert_eq!(text("merged"), whole);
    // A run without the file removes it.
    assert_eq!(voussoir(&["run", &study, "--quiet", "--set", "output.path_proofs=false", "--out", &out]), 0);
    assert!(!folder.join("whole").join(PATH_PROOFS).exists());
    std::fs::remove_dir_all(&folder).expect("removed");
}
