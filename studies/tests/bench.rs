//! `voussoir bench`: the compared solvers, the reference of errors, and the written files.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Five bonded, elastic voussoirs that crush: limit analysis and paths compute the same load.
const STUDY: &str = r#"
name = "small"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 6.0, rise = 2.0 }
thickness = 0.5
width = 1.0
voussoirs = 5
ends = "bonded"
material = "stone"
joint = "dry"
mesh = { elements = [1, 1] }
[materials.stone]
law = "elastic"
young_modulus = "5 GPa"
poisson_ratio = 0.2
density = 2000.0
[joints.dry]
law = "mohr_coulomb"
friction = 0.6
compressive_strength = "2 MPa"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.3, force = [0.0, -1000.0] }]
"#;

const VARIANTS: &str = r#"
[[variants]]
name = "limit analysis"
set = { "solver.solver" = "limit_chain" }
[[variants]]
name = "path"
set = { "solver.solver" = "event_path" }
[sweep]
"scene.profile.rise" = { list = [2.0, 2.4] }
"#;

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("voussoir_bench_{name}_{}", std::process::id()));
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn bench(folder: &Path, text: &str, more: &[&str]) -> Output {
    std::fs::write(folder.join("small.toml"), text).expect("a study");
    let voussoir = env!("CARGO_BIN_EXE_voussoir");
    let arguments = ["bench", "small.toml", "--runs", "1", "--out", "out"];
    Command::new(voussoir).current_dir(folder).args(arguments).args(more).output().expect("the program")
}

/// The columns of one solver in bench.csv. No name in these studies contains both a comma and a quote.
fn rows(folder: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(folder.join("out/bench.csv")).expect("bench.csv");
    let cells = |line: &str| {
        let mut quoted = false;
        let split = line.split(move |c: char| {
            quoted ^= c == '"';
            c == ',' && !quoted
        });
        split.map(|cell| cell.trim_matches('"').to_string()).collect()
    };
    text.lines().skip(1).map(cells).collect()
}

#[test]
fn solvers_that_take_a_study_are_measured_against_limit_analysis() {
    let folder = folder("solvers");
    let output = bench(&folder, STUDY, &[]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("errors from limit_chain") && said.contains("limit_chain "), "{said}");
    let rows = rows(&folder);
    let of = |name: &str| rows.iter().find(|row| row[1] == name).unwrap_or_else(|| panic!("no {name}: {rows:?}"));
    let number = |name: &str, column: usize| of(name)[column].parse::<f64>().expect("a number");
    // The reference has no error; another program of limit analysis has almost none; paths with one element have some.
    assert_eq!(of("limit_chain")[9], "");
    assert!(number("limit_conic", 9) < 1e-9);
    let error = (number("event_path", 5) / number("limit_chain", 5) - 1.0).abs();
    assert!((number("event_path", 9) - error).abs() < 1e-12 && error > 1e-3, "{error}");
    assert!(number("newton_path, mesh × 2", 10) > 0.0 && number("limit_chain", 10) > 0.0);
    assert!(of("event_path")[11].contains("events "), "counters");
    let chart = std::fs::read_to_string(folder.join("out/bench.svg")).expect("a chart");
    assert!(chart.contains("event_path, order") && chart.contains("relative error"));
    assert!(!folder.join("out/profile.svg").exists(), "one problem has no profile");
    drop(std::fs::remove_dir_all(folder));
}

#[test]
fn variants_are_measured_side_by_side_from_what_is_asked_for() {
    let folder = folder("variants");
    let text = format!("{STUDY}{VARIANTS}");
    let output = bench(&folder, &text, &["--reference", "path", "--within", "0.5", "--quiet"]);
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty());
    let found = rows(&folder);
    assert_eq!(found.len(), 4);
    assert!(found.iter().all(|row| row[7] == "path" && row[9].is_empty() == (row[1] == "path")), "{found:?}");
    let profile = std::fs::read_to_string(folder.join("out/profile.svg")).expect("a profile");
    assert!(profile.contains("share of problems answered"));
    // A known load factor.
    let output = bench(&folder, &text, &["--reference", "100.0", "--quiet"]);
    assert!(output.status.success());
    assert!(rows(&folder).iter().all(|row| row[6] == "100.0" && row[7] == "given" && !row[9].is_empty()));
    // An unknown name, and a kind of study without cases.
    let output = bench(&folder, &text, &["--reference", "paht"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && said.contains("did you mean \"path\""), "{said}");
    drop(std::fs::remove_dir_all(folder));
}

/// Measurements of other programs are shown beside the contestants. Each study is a class: it has one panel, and a profile if it
/// has several cases.
#[test]
fn other_programs_take_their_places_in_each_class() {
    let folder = folder("others");
    let second = STUDY.replace("name = \"small\"", "name = \"single\"");
    std::fs::write(folder.join("single.toml"), second).expect("a study");
    let row = |problem: &str| {
        format!("problem,program,load_factor [-],seconds [s]\n\"{problem}\",another program,20.0,1e-3\n")
    };
    std::fs::write(folder.join("others.csv"), row("small, scene.profile.rise = 2.4")).expect("a file");
    let text = format!("{STUDY}{VARIANTS}").replace("event_path", "limit_conic");
    let more = ["single.toml", "--quiet", "--within", "10", "--set", "solver.solver=limit_chain"];
    let output = bench(&folder, &text, &[&more[..], &["--others", "others.csv"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found = rows(&folder);
    let other = found.iter().find(|row| row[1] == "another program").expect("a row");
    let same = found.iter().find(|row| row[0] == other[0] && row[1] == "limit analysis").expect("a row");
    let error = (20.0 / same[5].parse::<f64>().expect("a load factor") - 1.0).abs();
    assert!((other[9].parse::<f64>().expect("an error") - error).abs() < 1e-12, "{other:?}");
    let read = |name: &str| std::fs::read_to_string(folder.join("out").join(name)).expect("a chart");
    assert!(read("profile.svg").contains("another program") && read("profile.svg").contains("bench: small"));
    assert!(read("bench.svg").contains("rise = 2.0") && !read("bench.svg").contains("rise = 2.4"));
    // A problem that is not measured.
    std::fs::write(folder.join("others.csv"), row("small, scene.profile.rise = 2.5")).expect("a file");
    let output = bench(&folder, &text, &[&more[..], &["--others", "others.csv"]].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && said.contains("others.csv: line 2: no problem"), "{said}");
    drop(std::fs::remove_dir_all(folder));
}

/// `--sweep` measures ladders of five rungs, and prints the difference from the finest rung and the order of the mesh.
#[test]
fn ladders_of_settings_are_measured() {
    let folder = folder("sweep");
    std::fs::write(folder.join("small.toml"), STUDY).expect("a study");
    let run = |arguments: &[&str]| {
        let voussoir = env!("CARGO_BIN_EXE_voussoir");
        Command::new(voussoir)
            .current_dir(&folder)
            .arg("bench")
            .arg("small.toml")
            .args(arguments)
            .output()
            .expect("the program")
    };
    let path = "solver.solver=newton_path";
    let output =
        run(&["--runs", "1", "--set", path, "--sweep", "mesh,first_step,tolerance", "--output", "ladders.csv"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let table = std::fs::read_to_string(folder.join("ladders.csv")).expect("a table");
    for parameter in ["mesh", "first_step", "tolerance"] {
        let rows: Vec<&str> = table.lines().filter(|line| line.contains(&format!(",{parameter},"))).collect();
        assert_eq!(rows.len(), 5, "{table}");
        assert!(said.contains(parameter) && said.contains("finest"), "{said}");
    }
    // The finest rung has no difference. Before it, a finer mesh is nearer to it than the study's own.
    let differences: Vec<f64> = table
        .lines()
        .filter(|line| line.contains(",mesh,"))
        .filter_map(|line| line.rsplit(',').nth(3)?.parse().ok())
        .collect();
    assert!(differences.len() == 4 && differences[3] < 0.2 * differences[0], "{table}");
    // The table is not overwritten.
    let output = run(&["--set", path, "--sweep", "mesh", "--output", "ladders.csv"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && said.contains("the file exists"), "{said}");
    // A mistyped name, and settings that the solver does not have.
    let output = run(&["--sweep", "tolerence"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && said.contains("did you mean \"tolerance\""), "{said}");
    let output = run(&["--set", "solver.solver=limit_chain", "--sweep", "first_step"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && said.contains("the solver limit_chain does not use it"), "{said}");
    drop(std::fs::remove_dir_all(folder));
}

/// Several studies are measured together, and have one profile.
#[test]
fn several_studies_have_one_profile() {
    let folder = folder("several");
    std::fs::write(
        folder.join("large.toml"),
        STUDY.replace("small", "large").replace("voussoirs = 5", "voussoirs = 7"),
    )
    .expect("a study");
    let output = bench(&folder, STUDY, &["large.toml", "--quiet"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(folder.join("out/bench.csv")).expect("bench.csv");
    assert!(text.contains("small") && text.contains("large"), "{text}");
    assert!(folder.join("out/profile.svg").exists(), "two problems have a profile");
    drop(std::fs::remove_dir_all(folder));
}
