//! Result folders: no case is lost, duplicated or foreign, and nothing is written elsewhere.

use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use voussoir::results::sealed_line::sealed_text;

fn voussoir(arguments: &[&str], at: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_voussoir")).args(arguments).current_dir(at).output().expect("the program starts")
}

/// Runs the program with `--json` and kills it after this number of lines on standard output. Each line is a finished
/// case.
fn killed_after(lines: usize, arguments: &[&str], at: &Path) {
    let mut run = Command::new(env!("CARGO_BIN_EXE_voussoir"))
        .args(arguments)
        .current_dir(at)
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let said = BufReader::new(run.stdout.take().expect("its output"));
    drop(said.lines().take(lines).collect::<Vec<_>>());
    drop(run.kill());
    run.wait().expect("it has ended");
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("it ends by itself")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&[&output.stdout[..], &output.stderr[..]].concat()).into_owned()
}

/// A line of a journal: a case with its checksum.
fn sealed(case: &str) -> String {
    String::from_utf8(sealed_text(case.as_bytes())).expect("text")
}

/// A folder for one test, with a study of eight cases.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("folders_{name}"));
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("a.toml"), study("ring", 0.6)).expect("written");
    folder
}

fn study(name: &str, friction: f64) -> String {
    format!(
        "name = \"{name}\"\n[scene]\nscene = \"arch\"\nprofile = {{ shape = \"segmental\", span = 9.42, rise = 2.99 }}\n\
         thickness = 0.6\nwidth = 5.81\nvoussoirs = 15\nends = \"jointed\"\nmaterial = \"stone\"\njoint = \"dry\"\n\
         [materials.stone]\nlaw = \"rigid\"\ndensity = 2200.0\n[joints.dry]\nlaw = \"coulomb_associated\"\n\
         friction = {friction:?}\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\n\
         until = \"collapse\"\nloads = [{{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }}]\n\
         [sweep]\n\"scene.profile.rise\" = {{ from = 2.6, to = 3.3, count = 8 }}\n"
    )
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Results without running times.
fn timeless(dir: &Path) -> Value {
    let mut results: Value = serde_json::from_str(&text(&dir.join("results.json"))).expect("JSON");
    for case in results["cases"].as_array_mut().expect("cases") {
        case["seconds"] = 0.0.into();
    }
    results
}

fn ids(dir: &Path) -> Vec<u64> {
    let results = timeless(dir);
    results["cases"].as_array().expect("cases").iter().map(|case| case["id"].as_u64().expect("an id")).collect()
}

/// Results that another study has left in the folder are computed again, from complete results and from a journal.
#[test]
fn resumed_cases_belong_to_the_study() {
    let at = folder("resume");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--quiet"], &at)), 0);
    let (out, fresh) = (at.join("out"), at.join("fresh"));
    let first: Value = timeless(&out);
    let lines = |results: &Value| {
        results["cases"].as_array().expect("cases")[..5]
            .iter()
            .map(|case| sealed(&case.to_string()))
            .collect::<String>()
    };
    // The study was edited, so its results differ. A run of it that was killed at once has written only its resolved
    // study.
    std::fs::write(at.join("a.toml"), study("ring", 0.35)).expect("written");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "fresh", "--quiet"], &at)), 0);
    assert_ne!(timeless(&fresh)["cases"][0]["load_factor"], first["cases"][0]["load_factor"]);
    std::fs::copy(fresh.join("resolved.toml"), out.join("resolved.toml")).expect("copied");
    std::fs::write(out.join("unfinished.jsonl"), lines(&first)).expect("written");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--resume", "--quiet"], &at)), 0);
    assert_eq!(timeless(&out), timeless(&fresh));
    // A journal with one forged case under a new checksum, and one damaged line.
    let (cases, whole) = (timeless(&fresh), lines(&timeless(&fresh)));
    let factor = cases["cases"][1]["load_factor"].to_string();
    let forged = cases["cases"][1].to_string().replacen(&factor, "9.5", 1);
    let damaged = whole.lines().nth(3).expect("a line").replacen("collapse", "stands", 1);
    let journal: String = whole
        .lines()
        .enumerate()
        .map(|(id, line)| match id {
            1 => sealed(&forged),
            3 => format!("{damaged}\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    std::fs::remove_dir_all(&out).expect("removed");
    std::fs::create_dir(&out).expect("a folder");
    std::fs::write(out.join("unfinished.jsonl"), journal).expect("written");
    let resumed = voussoir(&["run", "a.toml", "--out", "out", "--resume"], &at);
    let words =
        ["3 finished cases are kept: 3 proved", "1 finished cases do not hold", "1 lines of the journal are damaged"];
    assert!(words.iter().all(|word| said(&resumed).contains(word)), "{}", said(&resumed));
    assert_eq!(timeless(&out), timeless(&fresh));
    // A journal that was truncated at any place and then continued.
    let journal = lines(&timeless(&fresh));
    for cut in [1, journal.len() / 3, journal.len() / 2, journal.len() - 3] {
        std::fs::remove_dir_all(&out).expect("removed");
        std::fs::create_dir(&out).expect("a folder");
        let cut = (0..=cut).rev().find(|at| journal.is_char_boundary(*at)).expect("a boundary");
        let rest: String = journal.lines().last().into_iter().map(|line| format!("\n{line}\n")).collect();
        std::fs::write(out.join("unfinished.jsonl"), journal[..cut].to_string() + &rest).expect("written");
        assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--resume", "--quiet"], &at)), 0);
        assert_eq!(timeless(&out), timeless(&fresh));
        assert!(!out.join("unfinished.jsonl").exists());
    }
}

/// `--case` adds or replaces a case in the stored results and reports this; `verify` knows which cases were requested.
#[test]
fn one_case_joins_the_others() {
    let at = folder("case");
    let out = at.join("out");
    let one = voussoir(&["run", "a.toml", "--out", "out", "--case", "3"], &at);
    assert_eq!((code(&one), ids(&out)), (0, vec![3]), "{}", said(&one));
    let hidden = voussoir(&["verify", "out"], &at);
    assert!(code(&hidden) == 1 && said(&hidden).contains("1 of the study's 8 cases"), "{}", said(&hidden));
    let verified = voussoir(&["verify", "out", "a.toml", "--partial"], &at);
    assert!(
        code(&verified) == 0 && said(&verified).contains("1 case(s) of the study's 8 confirmed"),
        "{}",
        said(&verified)
    );
    let more = voussoir(&["run", "a.toml", "--out", "out", "--case", "1"], &at);
    assert_eq!((code(&more), ids(&out)), (0, vec![1, 3]));
    assert!(said(&more).contains("1 other(s) are kept"), "{}", said(&more));
    assert_eq!(code(&voussoir(&["verify", "out", "--partial"], &at)), 0);
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "whole", "--quiet"], &at)), 0);
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "whole", "--case", "2", "--quiet"], &at)), 0);
    assert_eq!(ids(&at.join("whole")), (0..8).collect::<Vec<_>>());
    assert!(timeless(&at.join("whole")).get("only_cases").is_none());
    assert_eq!(code(&voussoir(&["verify", "whole", "a.toml"], &at)), 0);
    let other = voussoir(&["verify", "whole", "a.toml", "--set", "joints.dry.friction=0.5"], &at);
    assert!(code(&other) == 1 && said(&other).contains("joints.dry.friction is 0.6 in the folder"), "{}", said(&other));
    // Deleted cases are found, also if the list of requested cases was forged to be empty.
    let whole = text(&at.join("whole/results.json"));
    let mut results: Value = serde_json::from_str(&whole).expect("JSON");
    results["cases"] = Value::Array(Vec::new());
    for only in [None, Some(Value::Array(Vec::new()))] {
        results["only_cases"] = only.unwrap_or(Value::Null);
        std::fs::write(at.join("whole/results.json"), results.to_string()).expect("written");
        assert_eq!(code(&voussoir(&["verify", "whole"], &at)), 1);
    }
    // No results of the study before the edit are kept.
    std::fs::write(at.join("a.toml"), study("ring", 0.35)).expect("written");
    let edited = voussoir(&["run", "a.toml", "--out", "out", "--case", "0"], &at);
    assert_eq!(ids(&out), vec![0], "{}", said(&edited));
    assert!(said(&edited).contains("no other case is there"), "{}", said(&edited));
}

/// A study's name must be a file name, wherever it is set.
#[test]
fn names_are_file_names() {
    let at = folder("names");
    for name in ["", "..", ".", "/tmp/elsewhere", "a/b", "a\\\\b", "../up", " a", ".hidden"] {
        std::fs::write(at.join("n.toml"), study(name, 0.6)).expect("written");
        let output = voussoir(&["run", "n.toml", "--quiet"], &at);
        assert_eq!(code(&output), 2, "{name:?}: {}", said(&output));
        assert!(said(&output).contains("n.toml:1:"), "{name:?}: {}", said(&output));
    }
    assert_eq!(code(&voussoir(&["run", "a.toml", "--set", "name=../up"], &at)), 2);
    let swept = text(&at.join("a.toml")) + "name = { list = [\"../up\"] }\n";
    std::fs::write(at.join("n.toml"), swept).expect("written");
    assert_eq!(code(&voussoir(&["run", "n.toml"], &at)), 2);
    assert!(!at.join("results").exists());
}

/// Two studies with the same name do not overwrite each other, in one run or in two.
#[test]
fn studies_of_one_name() {
    let at = folder("same");
    std::fs::write(at.join("b.toml"), study("ring", 0.35)).expect("written");
    let together = voussoir(&["run", "a.toml", "b.toml", "--quiet"], &at);
    assert!(code(&together) == 2 && said(&together).contains("a.toml"), "{}", said(&together));
    assert!(!at.join("results").exists());
    assert_eq!(code(&voussoir(&["run", "a.toml", "--quiet"], &at)), 0);
    let before = timeless(&at.join("results/ring"));
    let after = voussoir(&["run", "b.toml", "--quiet"], &at);
    assert!(code(&after) == 2 && said(&after).contains("a.toml"), "{}", said(&after));
    assert_eq!(timeless(&at.join("results/ring")), before);
    // The same study again, edited or not, and another folder with `--out`.
    assert_eq!(code(&voussoir(&["run", "./a.toml", "--quiet"], &at)), 0);
    assert_eq!(code(&voussoir(&["run", "b.toml", "--out", "other", "--quiet"], &at)), 0);
}

/// Figures and tables of the previous run are removed; files of the user stay. Changed files are found.
#[test]
fn files_are_those_of_the_results() {
    let at = folder("files");
    let out = at.join("out");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--quiet"], &at)), 0);
    std::fs::write(out.join("figures/mine.svg"), "mine").expect("written");
    for name in ["results.csv", "figures/sweep.svg", "figures/case-0003-scene.svg", "report.html"] {
        let original = text(&out.join(name));
        std::fs::write(out.join(name), original.replacen('7', "8", 1)).expect("written");
        let output = voussoir(&["verify", "out"], &at);
        assert!(code(&output) == 1 && said(&output).contains(name), "{name}: {}", said(&output));
        std::fs::write(out.join(name), original).expect("written");
    }
    assert_eq!(code(&voussoir(&["verify", "out", "--jobs", "2"], &at)), 0);
    // The list of files does not belong to the study.
    let whole = text(&out.join("results.json"));
    std::fs::write(out.join("results.json"), whole.replacen("\"report.html\"", "\"rapport.html\"", 1))
        .expect("written");
    let output = voussoir(&["verify", "out"], &at);
    assert!(code(&output) == 1 && said(&output).contains("the list of files"), "{}", said(&output));
    std::fs::write(out.join("results.json"), whole).expect("written");
    // Files that no run has written are kept, whatever their names.
    for name in ["figures/case-0099-mechanism.svg", "curve.csv"] {
        std::fs::write(out.join(name), "foreign").expect("written");
    }
    assert_eq!(code(&voussoir(&["verify", "out"], &at)), 0);
    let set = ["run", "a.toml", "--out", "out", "--quiet", "--set", "sweep.\"scene.profile.rise\".count=2"];
    assert_eq!(code(&voussoir(&set, &at)), 0);
    assert!(out.join("figures/case-0001-scene.svg").exists() && !out.join("figures/case-0003-scene.svg").exists());
    let set =
        ["run", "a.toml", "--out", "out", "--quiet", "--set", "output.figures=false", "--set", "output.writers=[]"];
    assert_eq!(code(&voussoir(&set, &at)), 0);
    assert!(!out.join("results.csv").exists() && !out.join("figures/sweep.svg").exists());
    assert_eq!(text(&out.join("figures/mine.svg")), "mine");
    for name in ["figures/case-0099-mechanism.svg", "curve.csv"] {
        assert_eq!(text(&out.join(name)), "foreign", "{name}");
    }
    // They are not overwritten either. Solved cases are kept until the user has moved these files.
    std::fs::write(out.join("results.csv"), "foreign").expect("written");
    let output = voussoir(&["run", "a.toml", "--out", "out"], &at);
    assert!(code(&output) == 3 && said(&output).contains("results.csv: no run has written"), "{}", said(&output));
    assert_eq!(text(&out.join("results.csv")), "foreign");
    std::fs::remove_file(out.join("results.csv")).expect("removed");
    let output = voussoir(&["run", "a.toml", "--out", "out", "--resume"], &at);
    assert!(code(&output) == 0 && said(&output).contains("8 finished cases are kept"), "{}", said(&output));
}

/// If the list of files names files outside the folder, or files that every run writes, nothing is removed.
#[test]
fn a_forged_list_of_files_removes_nothing_elsewhere() {
    let at = folder("forged_list");
    let out = at.join("out");
    std::fs::write(at.join("precious"), "precious").expect("written");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--quiet"], &at)), 0);
    let mut results: Value = serde_json::from_str(&text(&out.join("results.json"))).expect("JSON");
    let absolute = at.join("precious").display().to_string();
    results["files"] =
        serde_json::json!(["../precious", absolute, "figures/../../precious", "", ".", "resolved.toml", 7]);
    std::fs::write(out.join("results.json"), results.to_string()).expect("written");
    for name in ["results.csv", "report.html"] {
        std::fs::remove_file(out.join(name)).expect("removed");
    }
    std::fs::remove_dir_all(out.join("figures")).expect("removed");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--quiet"], &at)), 0);
    assert_eq!(text(&at.join("precious")), "precious");
}

/// A run is killed at each stage, from the first case to the last figure: no file is incomplete, and the run can be
/// continued.
#[test]
fn killed_at_every_stage() {
    let at = folder("stages");
    let out = at.join("out");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "whole", "--quiet"], &at)), 0);
    let stages = [
        "unfinished.jsonl",
        "results.json.tmp",
        "results.csv.tmp",
        "results.json",
        "resolved.toml",
        "results.csv",
        "figures",
        "figures/case-0003-scene.svg",
        "report.html",
    ];
    for stage in stages {
        drop(std::fs::remove_dir_all(&out));
        for round in 0..3 {
            let mut run = Command::new(env!("CARGO_BIN_EXE_voussoir"))
                .args(["run", "a.toml", "--out", "out", "--quiet", "--resume"])
                .current_dir(&at)
                .spawn()
                .expect("the program starts");
            while !out.join(stage).exists() && run.try_wait().expect("a state").is_none() {
                std::hint::spin_loop();
            }
            drop(run.kill());
            run.wait().expect("it has ended");
            if out.join("results.json").exists() {
                assert_eq!(timeless(&out), timeless(&at.join("whole")), "{stage}, {round}");
            }
        }
        assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--quiet", "--resume"], &at)), 0, "{stage}");
        assert_eq!(timeless(&out), timeless(&at.join("whole")), "{stage}");
        assert_eq!(code(&voussoir(&["verify", "out"], &at)), 0, "{stage}");
        let left: Vec<_> =
            std::fs::read_dir(&out).expect("a folder").flatten().map(|entry| entry.file_name()).collect();
        let half = |name: &std::ffi::OsString| name.to_string_lossy().ends_with(".tmp") || name == "unfinished.jsonl";
        assert!(!left.iter().any(half), "{stage}: {left:?}");
    }
}

/// Nothing is written through a symbolic link, neither the folder nor its contents.
#[cfg(unix)]
#[test]
fn links_are_not_followed() {
    use std::os::unix::fs::symlink;
    let at = folder("links");
    let elsewhere = at.join("elsewhere");
    std::fs::create_dir(&elsewhere).expect("a folder");
    std::fs::write(elsewhere.join("precious"), "precious").expect("written");
    for (index, name) in
        ["", "results.json", "figures", "unfinished.jsonl", "results.json.tmp", ".voussoir.lock"].iter().enumerate()
    {
        let out = at.join(format!("out{index}"));
        let target = if ["", "figures"].contains(name) { elsewhere.clone() } else { elsewhere.join("precious") };
        if name.is_empty() {
            symlink(&target, &out).expect("a link");
        } else {
            std::fs::create_dir(&out).expect("a folder");
            symlink(&target, out.join(name)).expect("a link");
        }
        let output = voussoir(&["run", "a.toml", "--quiet", "--out", out.to_str().expect("a path")], &at);
        assert!(code(&output) == 3 && said(&output).contains("symbolic link"), "{name}: {}", said(&output));
    }
    assert_eq!(std::fs::read_dir(&elsewhere).expect("a folder").count(), 1);
    assert_eq!(text(&elsewhere.join("precious")), "precious");
}

/// Two runs into one folder: the second is refused. The lock of a dead run is ignored. Any number of jobs is accepted.
#[test]
fn one_run_at_a_time() {
    let at = folder("lock");
    let out = at.join("out");
    std::fs::create_dir(&out).expect("a folder");
    let lock = std::fs::File::create(out.join(".voussoir.lock")).expect("a file");
    lock.try_lock().expect("a lock");
    let output = voussoir(&["run", "a.toml", "--out", "out", "--quiet"], &at);
    assert!(code(&output) == 3 && said(&output).contains("another run"), "{}", said(&output));
    drop(lock);
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--quiet", "--jobs", "999999"], &at)), 0);
    assert!(!out.join(".voussoir.lock").exists());
}

/// A run is killed at many places of a sweep and resumed each time: the results equal those of one run.
#[test]
fn killed_and_resumed() {
    let at = folder("killed");
    let many = study("ring", 0.6).replace("count = 8", "count = 400").replace("voussoirs = 15", "voussoirs = 41");
    std::fs::write(at.join("a.toml"), many + "[output]\nfigures = false\n").expect("written");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "whole", "--quiet"], &at)), 0);
    for round in 0..5 {
        killed_after(1 + 20 * round, &["run", "a.toml", "--out", "out", "--resume", "--json"], &at);
    }
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--quiet", "--resume"], &at)), 0);
    assert_eq!(timeless(&at.join("out")), timeless(&at.join("whole")));
}

/// A swept text with a unit is a number in every file, in the unit in the header of its column.
#[test]
fn swept_units_are_numbers() {
    let at = folder("units");
    let swept = study("ring", 0.6).replace("{ from = 2.6, to = 3.3, count = 8 }", "{ list = [\"2600 mm\", \"3 m\"] }")
        + "\"stages.live.loads.0.force.1\" = { list = [\"-1 kN\", \"-2 kN\"] }\n[output]\nfigures = false\n";
    std::fs::write(at.join("a.toml"), swept).expect("written");
    let run = voussoir(&["run", "a.toml", "--out", "out"], &at);
    assert_eq!(code(&run), 0, "{}", said(&run));
    let table = text(&at.join("out/results.csv"));
    let cells: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').skip(2).take(2).collect()).collect();
    assert_eq!(cells[0], ["scene.profile.rise [m]", "stages.live.loads.0.force.1 [N]"]);
    assert_eq!(cells[1..], [["2.6", "-1000"], ["2.6", "-2000"], ["3", "-1000"], ["3", "-2000"]]);
    let results = timeless(&at.join("out"));
    assert_eq!(results["cases"][3]["parameters"]["stages.live.loads.0.force.1"], -2000.0);
}

/// A cell of a table that a spreadsheet would read as a formula is text.
#[test]
fn cells_are_no_formulas() {
    let at = folder("formula");
    let text_of = study("ring", 0.6) + "[[variants]]\nname = \"=HYPERLINK(1)\"\n[[variants]]\nname = \"@b\"\n";
    std::fs::write(at.join("a.toml"), text_of).expect("written");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "out", "--quiet"], &at)), 0);
    let table = text(&at.join("out/results.csv"));
    assert!(table.contains("'=HYPERLINK") && table.contains("'@b") && !table.contains(",=") && !table.contains(",@"));
}
