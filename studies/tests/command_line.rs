//! The command line: exit codes, written files, and no files overwritten by mistake.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use voussoir::results::sealed_line::sealed_text;

fn voussoir(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_voussoir")).args(arguments).output().expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("it ends by itself")
}

/// An empty folder for a test, in Cargo's folder for temporary files.
fn empty_folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn study() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/strathmashie_rise.toml")
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Results without running times.
fn timeless(dir: &Path) -> serde_json::Value {
    let mut results: serde_json::Value = serde_json::from_str(&text(&dir.join("results.json"))).expect("JSON");
    for case in results["cases"].as_array_mut().expect("cases") {
        case["seconds"] = 0.0.into();
    }
    results
}

/// `run` solves the study, `verify` confirms it and finds a changed factor; `--jobs` and `--resume` do not change
/// results.
#[test]
fn run_verify_tamper_and_resume() {
    let folder = empty_folder("run_verify_tamper_and_resume");
    let (one, two) = (folder.join("one"), folder.join("two"));
    let study = study();
    let (study, out_one, out_two) =
        (study.to_str().expect("a path"), one.to_str().expect("a path"), two.to_str().expect("a path"));
    let output = voussoir(&["run", study, "--out", out_one]);
    assert_eq!(code(&output), 0, "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(table.contains("unbounded") && table.contains("698.0227") && table.contains("7165.277"), "{table}");
    for file in ["results.json", "results.csv", "resolved.toml", "report.html", "figures/sweep.svg"] {
        assert!(one.join(file).is_file(), "{file}");
    }
    assert_eq!(code(&voussoir(&["verify", out_one])), 0);
    assert_eq!(code(&voussoir(&["run", study, "--out", out_two, "--jobs", "2", "--quiet"])), 0);
    assert_eq!(timeless(&one), timeless(&two));

    // A run was killed after some cases: the next run solves the rest and keeps the finished cases.
    let whole = text(&one.join("results.json"));
    let results: serde_json::Value = serde_json::from_str(&whole).expect("JSON");
    let cases = &results["cases"].as_array().expect("cases")[..5];
    let lines = cases.iter().flat_map(|case| sealed_text(case.to_string().as_bytes()));
    let journal: Vec<u8> = lines.chain(*b"{ \"id\": 5, \"var").collect();
    std::fs::remove_file(two.join("results.json")).expect("removed");
    std::fs::write(two.join("unfinished.jsonl"), journal).expect("written");
    assert_eq!(code(&voussoir(&["run", study, "--out", out_two, "--resume", "--quiet"])), 0);
    assert_eq!(timeless(&one), timeless(&two));
    assert!(!two.join("unfinished.jsonl").exists());

    let factor = results["cases"][9]["load_factor"].to_string();
    std::fs::write(one.join("results.json"), whole.replace(&factor, "700.0")).expect("written");
    let output = voussoir(&["verify", out_one]);
    assert_eq!(code(&output), 1);
    assert!(String::from_utf8_lossy(&output.stdout).contains("case 9"));
}

/// Wrong input gives exit code 2 and a message on standard error; the results of the previous run are not changed.
#[test]
fn wrong_input_overwrites_nothing() {
    let folder = empty_folder("wrong_input_overwrites_nothing");
    let out = folder.join("out");
    std::fs::create_dir(&out).expect("a folder");
    std::fs::write(out.join("results.json"), "precious").expect("written");
    let wrong = folder.join("wrong.toml");
    std::fs::write(&wrong, text(&study()).replace("friction", "fricton")).expect("written");
    let output = voussoir(&["run", wrong.to_str().expect("a path"), "--out", out.to_str().expect("a path")]);
    assert_eq!(code(&output), 2);
    assert!(String::from_utf8_lossy(&output.stderr).contains("did you mean \"friction\"?"));
    assert_eq!(text(&out.join("results.json")), "precious");
    assert_eq!(std::fs::read_dir(&out).expect("a folder").count(), 1);
    assert_eq!(code(&voussoir(&["check", wrong.to_str().expect("a path")])), 2);
    // An unknown solver or solver key is a mistake too; no other solver is used instead.
    for (set, right) in [("solver.solver=limit_chian", "limit_chain"), ("solver.tolerence=1e-6", "tolerance")] {
        let study = study();
        let output =
            voussoir(&["run", study.to_str().expect("a path"), "--out", out.to_str().expect("a path"), "--set", set]);
        assert_eq!(code(&output), 2, "{set}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains(&format!("did you mean \"{right}\"?")), "{said}");
        assert_eq!(std::fs::read_dir(&out).expect("a folder").count(), 1);
    }
    assert_eq!(code(&voussoir(&["run", "no_such_file.toml"])), 3);
    assert_eq!(code(&voussoir(&["run", study().to_str().expect("a path"), "--set", "friction"])), 2);
    assert_eq!(code(&voussoir(&["run", study().to_str().expect("a path"), "--case", "99"])), 2);
}

/// `list`, `explain`, `schema` and `check` work.
#[test]
fn the_program_explains_itself() {
    let output = voussoir(&["list"]);
    assert_eq!(code(&output), 0);
    let listed = String::from_utf8_lossy(&output.stdout).into_owned();
    for tag in [
        "unilateral",
        "coulomb_associated",
        "mohr_coulomb",
        "elastic",
        "arch",
        "wall",
        "limit_chain",
        "limit_conic",
        "limit_least",
        "limit_sequential",
    ] {
        assert!(listed.contains(tag), "{tag}");
        assert_eq!(code(&voussoir(&["explain", tag])), 0, "{tag}");
    }
    assert_eq!(code(&voussoir(&["list", "walls"])), 2);
    let output = voussoir(&["explain", "coulom"]);
    assert_eq!(code(&output), 2);
    assert!(String::from_utf8_lossy(&output.stderr).contains("did you mean \"coulomb\"?"));
    let plan = voussoir(&["explain", study().to_str().expect("a path")]);
    assert!(String::from_utf8_lossy(&plan.stdout).contains("limit_chain"));
    let path = voussoir(&["explain", study().with_file_name("strathmashie_elastic.toml").to_str().expect("a path")]);
    let path = String::from_utf8_lossy(&path.stdout).into_owned();
    assert!(path.contains("event_path, small displacements") && path.contains("1 factorisation"), "{path}");
    let schema = voussoir(&["schema"]);
    assert!(serde_json::from_slice::<serde_json::Value>(&schema.stdout).expect("JSON").is_object());
    assert_eq!(schema.stdout, voussoir(&["schema", "studies"]).stdout);
    assert_eq!(code(&voussoir(&["schema", "report"])), 2);
    assert_eq!(code(&voussoir(&["check", study().to_str().expect("a path")])), 0);
}

/// The names of an object; none of a value that is no object.
fn names(value: &serde_json::Value) -> Vec<&str> {
    value.as_object().into_iter().flat_map(|object| object.keys().map(String::as_str)).collect()
}

/// The schema of results describes every property in a sentence, has a definition for every reference, and has exactly the
/// keys that results have.
#[test]
fn the_schema_of_results_is_complete() {
    let printed = String::from_utf8(voussoir(&["schema", "results"]).stdout).expect("UTF-8");
    let schema: serde_json::Value = serde_json::from_str(&printed).expect("JSON");
    for target in printed.split("\"#/$defs/").skip(1).filter_map(|rest| rest.split('"').next()) {
        assert!(schema["$defs"].get(target).is_some(), "{target}");
    }
    let definitions = names(&schema["$defs"]).into_iter().map(|name| (name, &schema["$defs"][name]));
    let objects: Vec<_> = definitions.chain([("results", &schema)]).collect();
    for (name, object) in &objects {
        assert!(object["description"].as_str().is_some_and(|text| text.ends_with('.')), "{name}");
        for key in names(&object["properties"]) {
            let text = object["properties"][key]["description"].as_str().unwrap_or_default();
            assert!(text.len() > 8 && text.ends_with('.'), "{name}.{key}: {text}");
        }
        for key in object["required"].as_array().into_iter().flatten().filter_map(|key| key.as_str()) {
            assert!(object["properties"].get(key).is_some(), "{name}.{key} is required and has no description");
        }
    }
    let folder = empty_folder("schema_of_results");
    assert_eq!(
        code(&voussoir(&[
            "run",
            study().to_str().expect("a path"),
            "--out",
            folder.to_str().expect("a path"),
            "--quiet"
        ])),
        0
    );
    let results = timeless(&folder);
    let cases = results["cases"].as_array().expect("cases").iter().map(|case| (&schema["$defs"]["case"], case));
    for (object, value) in cases.chain([(&schema, &results)]) {
        let (known, written) = (names(&object["properties"]), names(value));
        assert!(written.len() > 10 && written.iter().all(|key| known.contains(key)), "{written:?}");
        let required = object["required"].as_array().expect("a list");
        assert!(required.iter().all(|key| written.contains(&key.as_str().expect("a key"))), "{written:?}");
    }
}

/// `run` solves every point study, writes a row for each step, and reports a stress that cannot be reached. `verify`
/// repeats it. `point` is another name of `run`.
#[test]
fn points_are_driven() {
    let folder = empty_folder("points_are_driven");
    let out = folder.join("out");
    let out_text = out.to_str().expect("a path");
    let case = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(name).display().to_string();
    let names = ["cap_uniaxial", "cap_triaxial", "cap_compaction"].map(|name| format!("point_{name}.toml"));
    for name in
        names.iter().map(String::as_str).chain(["point_softening.toml", "point_cohesive.toml", "point_wearing.toml"])
    {
        let output = voussoir(&["run", &case(name), "--out", out_text, "--quiet"]);
        assert_eq!(code(&output), 0, "{name}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(code(&voussoir(&["check", &case(name)])), 0, "{name}");
        let results: serde_json::Value = serde_json::from_str(&text(&out.join("results.json"))).expect("JSON");
        let rows: usize =
            results["cases"].as_array().expect("cases").iter().map(|c| c["rows"].as_array().expect("rows").len()).sum();
        assert_eq!(text(&out.join("results.csv")).lines().count(), rows + 1, "{name}");
        assert!(out.join("figures/path.svg").is_file() && out.join("resolved.toml").is_file());
    }
    let uniaxial = case("point_cap_uniaxial.toml");
    assert_eq!(code(&voussoir(&["point", &uniaxial, "--out", out_text, "--quiet"])), 0);
    assert_eq!(code(&voussoir(&["verify", out_text])), 0);
    let plan = voussoir(&["explain", &uniaxial]);
    assert!(String::from_utf8_lossy(&plan.stdout).contains("at one point"));
    // A uniaxial stress of 40 MPa is greater than the strength.
    let set = "point.path.0={ steps = 4, stress = { xx = \"-40 MPa\", yy = 0.0, zz = 0.0 } }";
    let output = voussoir(&["run", &uniaxial, "--out", out_text, "--set", set]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(code(&output), 1, "{said}{}", String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("cannot be reached"), "{said}");
}

/// `explain` knows the words that a user may enter, and suggests the nearest word for a misspelt one. Completions and
/// the manual page contain every command.
#[test]
fn words_completions_and_manual() {
    let said = |arguments: &[&str]| {
        let output = voussoir(arguments);
        assert_eq!(code(&output), 0, "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    for (word, known) in [
        ("profiles", "three_centred"),
        ("segmental", "rise [m]"),
        ("loads", "span_fraction"),
        ("stages", "until"),
        ("settlement", "rotation"),
        ("sweep", "zip"),
        ("variants", "outermost"),
        ("units", "kN/m3"),
        ("results", "resolved.toml"),
        ("status", "no_equilibrium"),
        ("auto", "limit_chain"),
        ("thickness", "[m]"),
    ] {
        let text = said(&["explain", word]);
        assert!(text.contains(known), "{word}: {text}");
    }
    let wrong = voussoir(&["explain", "setlement"]);
    assert!(code(&wrong) == 2 && String::from_utf8_lossy(&wrong.stderr).contains("did you mean \"settlement\"?"));
    let manual = said(&["man"]);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(said(&["completions", shell]).contains("merge"), "{shell}");
    }
    for command in ["run", "merge", "new", "explain", "verify", "schema"] {
        assert!(manual.contains(&format!("COMMAND {}", command.to_uppercase())), "{command}");
    }
    let folder = empty_folder("new_study");
    let new = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_voussoir")).args(arguments).current_dir(&folder).output().expect("it starts")
    };
    assert_eq!(code(&new(&["new", "wall", "my wall"])), 0);
    assert!(text(&folder.join("my wall.toml")).starts_with("name = \"my wall\""));
    assert_eq!(code(&new(&["new", "wall", "my wall"])), 2);
    assert_eq!(code(&new(&["new", "wall", "../x"])), 2);
}

/// `conform` returns 0 for a law that conforms, and 2 for an unknown tag with the nearest known one. `new law` writes
/// into a crate, but only once.
#[test]
fn a_law_is_checked_and_a_new_one_is_written() {
    let output = voussoir(&["conform", "coulomb", "elastic"]);
    assert_eq!(code(&output), 0);
    assert!(String::from_utf8_lossy(&output.stdout).contains("2 plug-in(s) conform"));
    let output = voussoir(&["conform", "coulom"]);
    assert_eq!(code(&output), 2);
    assert!(String::from_utf8_lossy(&output.stderr).contains("did you mean \"coulomb\"?"));
    let krate = std::env::temp_dir().join(format!("voussoir-new-law-{}", std::process::id()));
    std::fs::create_dir_all(&krate).expect("a folder");
    std::fs::write(krate.join("Cargo.toml"), "[package]\nname = \"own-laws\"\n").expect("a file");
    let into = krate.to_str().expect("a path");
    assert_eq!(code(&voussoir(&["new", "law", "shear_pins", "--out", into])), 0);
    let law = std::fs::read_to_string(krate.join("src/shear_pins.rs")).expect("the law");
    assert!(law.contains("pub struct ShearPins") && law.contains("tag: \"shear_pins\"") && !law.contains("eyed"));
    let test = std::fs::read_to_string(krate.join("tests/shear_pins.rs")).expect("its test");
    assert!(test.contains("use own_laws as _;"));
    assert_eq!(code(&voussoir(&["new", "law", "shear_pins", "--out", into])), 2, "nothing is overwritten");
    assert_eq!(code(&voussoir(&["new", "law", "coulomb", "--out", into])), 2, "there is one");
    assert_eq!(code(&voussoir(&["new", "law", "Shear-Pins", "--out", into])), 2, "no name of a file");
    std::fs::remove_dir_all(&krate).expect("removed");
}

/// `new crate` writes a crate once. It has a law, a program, a study and tests, and depends on published versions or on a copy of
/// the repository.
#[test]
fn a_new_crate_is_written() {
    let folder = empty_folder("new_crate");
    let into = folder.to_str().expect("a path");
    assert_eq!(code(&voussoir(&["new", "crate", "pin-laws", "--law", "shear_pins", "--out", into])), 0);
    let read = |file: &str| std::fs::read_to_string(folder.join("pin-laws").join(file)).expect("a file");
    assert!(read("Cargo.toml").contains("voussoir-plug = \"") && read("src/lib.rs").contains("pub mod shear_pins;"));
    assert!(
        read("src/main.rs").contains("use pin_laws as _;") && read("shear_pins.toml").contains("law = \"shear_pins\"")
    );
    assert!(
        read("src/shear_pins.rs").contains("voussoir_plug::package!()") && read("pyproject.toml").contains("maturin")
    );
    assert_eq!(code(&voussoir(&["new", "crate", "pin-laws", "--law", "shear_pins", "--out", into])), 2, "it is there");
    assert_eq!(code(&voussoir(&["new", "crate", "Pins", "--out", into])), 2, "no name of a crate");
    assert_eq!(code(&voussoir(&["new", "crate", "coulomb", "--out", into])), 2, "there is such a law");
    assert_eq!(code(&voussoir(&["new", "crate", "pins", "--out", into, "--repository", into])), 2, "no repository");
}

/// `diff` ends with 0 if two folders have the same results and with 1 if they differ. The table begins with the largest
/// change. A folder without results is wrong input, and the nearest name of a missing folder is suggested.
#[test]
fn two_runs_are_compared() {
    let folder = empty_folder("two_runs_are_compared");
    let study = study();
    let study = study.to_str().expect("a path");
    let run = |name: &str, more: &[&str]| {
        let out = folder.join(name).to_str().expect("a path").to_string();
        let output =
            voussoir(&[&["run", study, "--quiet", "--out", &out, "--set", "output.figures=false"], more].concat());
        assert_eq!(code(&output), 0, "{}", String::from_utf8_lossy(&output.stderr));
        out
    };
    let diff = |arguments: &[&str]| {
        let output = voussoir(&[&["diff"], arguments].concat());
        let all = [&output.stdout[..], &output.stderr].concat();
        (code(&output), String::from_utf8_lossy(&all).into_owned())
    };
    let (one, two) = (run("before", &[]), run("after", &["--set", "scene.thickness=0.61"]));
    let (exit, said) = diff(&[&one, &one]);
    assert!(exit == 0 && said.contains("38 cases: equal within 1e-6"), "{said}");
    let (exit, said) = diff(&[&one, &two]);
    assert_eq!(exit, 1);
    for part in ["scene.thickness", "0.61", "load factor", "scene.profile.rise = 2.99", "4 cases equal, 34 differ"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // A file is as good as its folder, and a large tolerance allows everything but a change of status.
    let file = format!("{one}/results.json");
    assert_eq!(diff(&[&file, &one, "--tolerance", "0"]).0, 0);
    let (exit, line) = diff(&[&one, &two, "--json"]);
    let json: serde_json::Value = serde_json::from_str(&line).expect("one line of JSON");
    assert!(exit == 1 && json["equal"] == false && json["inputs"][0]["key"] == "scene.thickness", "{line}");
    assert!(json["cases"].as_array().is_some_and(|cases| cases.len() == 34));
    // A case that only one run has.
    let part = run("part", &["--case", "3"]);
    let (exit, said) = diff(&[&one, &part]);
    assert!(exit == 1 && said.contains("cases that only A has") && said.contains("1 case equal"), "{said}");
    for (arguments, expected, words) in [
        ([format!("{one}r"), two.clone()], 3, "did you mean"),
        ([folder.display().to_string(), two.clone()], 2, "has no results.json"),
        ([study.to_string(), two.clone()], 2, "not a results file"),
    ] {
        let (exit, said) = diff(&[&arguments[0], &arguments[1]]);
        assert!(exit == expected && said.contains(words), "{exit}: {said}");
    }
    let (exit, said) = diff(&[&one, &two, "--tolerance", "5%"]);
    assert!(exit == 2 && said.contains("0.01 for 1 %"), "{said}");
}

/// Names of the commands below a command.
fn commands(path: &[&str]) -> Vec<String> {
    let help = voussoir(&[path, &["--help"]].concat());
    let text = String::from_utf8_lossy(&help.stdout).into_owned();
    let listed = text.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = listed.filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(ToString::to_string).collect()
}

/// Help texts have no signs of other formats and no line over 120 characters.
#[test]
fn help_is_plain_text() {
    let mut left: Vec<Vec<String>> = vec![vec![], vec!["point".into()]];
    let mut seen = 0;
    while let Some(path) = left.pop() {
        let words: Vec<&str> = path.iter().map(String::as_str).collect();
        for flag in ["-h", "--help"] {
            let output = voussoir(&[&words[..], &[flag]].concat());
            assert_eq!(code(&output), 0, "{words:?}");
            for line in String::from_utf8_lossy(&output.stdout).lines() {
                let plain =
                    line.chars().count() <= 120 && !line.contains('\\') && !line.contains("](") && !line.contains("[`");
                assert!(plain, "{words:?} {flag}: {line}");
            }
        }
        seen += 1;
        left.extend(commands(&words).into_iter().map(|name| [path.clone(), vec![name]].concat()));
    }
    assert!(seen > 20, "{seen} commands");
}
