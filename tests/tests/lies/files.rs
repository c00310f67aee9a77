//! Results of dishonest solvers as files: `run` ends with exit code 1, and `verify` finds a result that is forged to
//! claim success.

use super::run::{liar, quiet};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};
use voussoir::cli::main_from;
use voussoir::conformance::lies::{KnownScene, Lie, scenes, solver_keys};
use voussoir::core::plugin::PluginKind;
use voussoir::kinds::{RunRequest, StoredResults, read_study};
use voussoir::results::stored_path::PATH_PROOFS;
use voussoir::results::{CaseResult, StudyResults};
use voussoir::solve::Unobserved;
use voussoir::solve_case;
use voussoir::study::load;
use voussoir::verify::{solve_again, verify_against};

/// Returns a scene by its name.
fn scene(kind: PluginKind, name: &str) -> &'static KnownScene {
    scenes(kind).iter().find(|scene| scene.name == name).expect("a scene")
}

/// Returns changes that make a result claim more than it proves.
fn forgeries(entry: &Value, honest: &Value) -> Vec<(&'static str, Value)> {
    let certified = |entry: &Value| {
        let mut entry = entry.clone();
        entry["certificate"]["passed"] = json!(true);
        entry["certificate"]["failures"] = json!([]);
        entry
    };
    let with_status = |status: &str| {
        let mut entry = certified(entry);
        entry["status"] = json!(status);
        if let Some(last) = entry["stages"].as_array_mut().and_then(|stages| stages.last_mut()) {
            last["status"] = json!(status);
        }
        entry
    };
    let mut scaled = honest.clone();
    let more = |number: &Value| json!(number.as_f64().map(|number| 1.05 * number));
    scaled["load_factor"] = more(&honest["load_factor"]);
    for (forged, true_value) in
        scaled["bounds"].as_array_mut().into_iter().flatten().zip(honest["bounds"].as_array().into_iter().flatten())
    {
        *forged = more(true_value);
    }
    if let Some(last) = scaled["stages"].as_array_mut().and_then(|stages| stages.last_mut()) {
        last["factor"] = more(&last["factor"].clone());
    }
    let mut stands = honest.clone();
    (stands["status"], stands["load_factor"], stands["bounds"]) = (json!("stands"), Value::Null, Value::Null);
    vec![
        ("certified", certified(entry)),
        ("stands", with_status("stands")),
        ("collapse", with_status("collapse")),
        ("limit_point", with_status("limit_point")),
        ("unbounded", with_status("unbounded")),
        ("no_equilibrium", with_status("no_equilibrium")),
        ("honest_scaled", scaled),
        ("honest_stands", stands),
    ]
}

/// Returns the forged results of dishonest solvers that `verify` confirms.
fn confirmed(kind: PluginKind, of: &str, names: &[&str]) -> Vec<String> {
    quiet();
    let mut confirmed = Vec::new();
    for scene in names.iter().map(|name| scene(kind, name)) {
        let honest = solve_case(&scene.case(&solver_keys(kind, of)).unwrap_or_else(|wrong| panic!("{wrong}")));
        for lie in Lie::of(kind) {
            let study = load(&scene.study(&liar(kind, of, lie.name())), "lie.toml", &[]).expect("a study");
            let result = solve_case(&study.cases[0]);
            let mut honest = honest.clone();
            honest.label = result.label.clone();
            let stored = study.results("test", vec![result]);
            let again = solve_again(&study, &stored, 1, &voussoir::solve::Unobserved);
            let stored = serde_json::to_value(&stored).expect("JSON");
            let honest = serde_json::to_value(&honest).expect("JSON");
            for (forgery, entry) in forgeries(&stored["cases"][0], &honest) {
                let mut forged = stored.clone();
                forged["cases"][0] = entry;
                if forged == stored {
                    continue;
                }
                let Ok(read) = serde_json::from_value::<StudyResults>(forged.clone()) else { continue };
                let false_claims = scene.truth.contradictions(&read.cases[0], None);
                let found = verify_against(&study, &forged, &again);
                if found.is_ok_and(|found| found.is_empty()) && !false_claims.is_empty() {
                    confirmed.push(format!(
                        "{} {} forged as {forgery}: {}",
                        scene.name,
                        lie.name(),
                        false_claims.join("; ")
                    ));
                }
            }
        }
    }
    confirmed
}

#[test]
fn no_forged_result_of_a_limit_solver_is_confirmed() {
    let scenes = ["block_tips", "block_stands_at_its_target", "block_is_pressed"];
    assert_eq!(confirmed(PluginKind::LimitSolver, "limit_conic", &scenes), Vec::<String>::new());
    assert_eq!(
        confirmed(PluginKind::LimitSolver, "limit_least", &["block_is_lifted_between_walls"]),
        Vec::<String>::new()
    );
}

#[test]
fn no_forged_result_of_a_path_solver_is_confirmed() {
    let scenes = ["block_tips", "block_stands_at_its_target"];
    assert_eq!(confirmed(PluginKind::PathSolver, "event_path", &scenes), Vec::<String>::new());
}

/// Runs the command line.
fn voussoir(arguments: &[&str]) -> u8 {
    main_from(arguments.iter().map(Into::into)).expect("arguments that are understood")
}

/// Runs a study with a dishonest solver into a folder. Returns the exit code, the folder and the result.
fn run(folder: &Path, kind: PluginKind, of: &str, name: &str, lie: &str) -> (u8, PathBuf, CaseResult) {
    let file = folder.join(format!("{name}_{lie}.toml"));
    std::fs::write(&file, scene(kind, name).study(&liar(kind, of, lie))).expect("written");
    let out = folder.join(format!("{name}_{lie}"));
    let code = voussoir(&["run", file.to_str().expect("text"), "--out", out.to_str().expect("text")]);
    let text = std::fs::read_to_string(out.join("results.json")).expect("results");
    let results: StudyResults = serde_json::from_str(&text).expect("results");
    (code, out, results.cases.into_iter().next().expect("a case"))
}

/// The command line ends with exit code 1 for `run`, and for `verify` if the stored result claims success.
#[test]
fn exit_codes_tell_a_lie() {
    quiet();
    let folder = std::env::temp_dir().join(format!("voussoir_lies_{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    for (kind, of, name, lie) in [
        (PluginKind::LimitSolver, "limit_conic", "block_tips", "stands_without_a_field"),
        (PluginKind::LimitSolver, "limit_conic", "block_tips", "factor_5_percent_high"),
        (PluginKind::LimitSolver, "limit_conic", "block_tips", "panic"),
        (PluginKind::LimitSolver, "limit_conic", "ring", "motion_mirrored"),
        (PluginKind::PathSolver, "event_path", "block_tips", "collapse_early"),
        (PluginKind::PathSolver, "event_path", "block_tips", "retraced_as_collapse"),
        (PluginKind::PathSolver, "event_path", "block_tips", "panic"),
    ] {
        let (code, out, result) = run(&folder, kind, of, name, lie);
        assert_eq!((code, result.certificate.passed), (1, false), "{name} {lie}: {:?}", result.status);
        assert!(voussoir(&["verify", out.to_str().expect("text")]) <= 1, "{name} {lie}");
        let place = out.join("results.json");
        let mut stored: Value = serde_json::from_str(&std::fs::read_to_string(&place).expect("read")).expect("JSON");
        let entry = &mut stored["cases"][0];
        entry["status"] = json!("stands");
        (entry["certificate"]["passed"], entry["certificate"]["failures"]) = (json!(true), json!([]));
        std::fs::write(&place, serde_json::to_string(&stored).expect("JSON")).expect("written");
        assert_eq!(voussoir(&["verify", out.to_str().expect("text")]), 1, "{name} {lie}, forged");
    }
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// The path of a solver from another project is verified by its stored states alone, without solving again.
#[test]
fn the_path_of_a_stranger_is_verified_without_its_solver() {
    let mut proved = 0;
    for scene in scenes(PluginKind::PathSolver) {
        let Ok(study) = read_study(&scene.study(&liar(PluginKind::PathSolver, "event_path", "no lie")), "a.toml", &[])
        else {
            continue;
        };
        let request = RunRequest { wanted: vec![0], jobs: 1, ..RunRequest::default() };
        let files: BTreeMap<String, Vec<u8>> = study.run(&request, &Unobserved).files.into_iter().collect();
        if !files.contains_key(PATH_PROOFS) {
            continue;
        }
        let file = |name: &str| files.get(name).map(|bytes| Box::new(Cursor::new(bytes.clone())) as Box<dyn Read>);
        let found = study.verify_stored(&StoredResults { jobs: 1, file: &file }, &Unobserved).expect("results");
        let results: StudyResults = serde_json::from_slice(&files["results.json"]).expect("results");
        // No state proves that a mechanism is the only one.
        let more = results.cases[0].mechanism.as_ref().is_some_and(|mechanism| mechanism.unique.is_some());
        let paths = [1, usize::from(!more)];
        assert_eq!((found.findings, found.files, found.paths), (vec![], vec![], paths), "{}", scene.name);
        proved += 1;
    }
    assert!(proved >= 5, "{proved} paths of a stranger");
}
