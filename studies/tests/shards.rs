//! Studies that are solved in parts and merged, and studies with too many cases to hold in memory.

use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use voussoir::results::sealed_line::sealed_text;

fn voussoir(arguments: &[&str], at: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_voussoir")).args(arguments).current_dir(at).output().expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("it ends by itself")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&[&output.stdout[..], &output.stderr[..]].concat()).into_owned()
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// An arch with two variants and several rises.
fn study(rises: usize) -> String {
    format!(
        "name = \"ring\"\n[scene]\nscene = \"arch\"\nprofile = {{ shape = \"segmental\", span = 9.42, rise = 2.99 }}\n\
         thickness = 0.6\nwidth = 5.81\nvoussoirs = 7\nends = \"jointed\"\nmaterial = \"stone\"\njoint = \"dry\"\n\
         [materials.stone]\nlaw = \"rigid\"\ndensity = 2200.0\n[joints.dry]\nlaw = \"coulomb_associated\"\n\
         friction = 0.6\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\n\
         until = \"collapse\"\nloads = [{{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }}]\n\
         [sweep]\n\"scene.profile.rise\" = {{ from = 2.6, to = 3.3, count = {rises} }}\n\
         [[variants]]\nname = \"a\"\n[[variants]]\nname = \"b\"\nset = {{ \"joints.dry.friction\" = 0.5 }}\n\
         [output]\nfigures = false\n"
    )
}

/// Ids of cases in lines of JSON: of labels or of a part.
fn ids(text: &str) -> Vec<u64> {
    let lines = text.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    lines.filter_map(|line| line["id"].as_u64().or(line["case"]["id"].as_u64())).collect()
}

/// A folder for one test, with a study of eight cases.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("shards_{name}"));
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("a.toml"), study(4)).expect("written");
    folder
}

/// The text of results.json without running times.
fn timeless(path: &Path) -> String {
    let seconds = |line: &&str| !line.trim_start().starts_with("\"seconds\"");
    text(path).lines().filter(seconds).collect::<Vec<_>>().join("\n")
}

fn solve_parts(at: &Path, out: &str, more: &[&str]) {
    for shard in ["1/3", "2/3", "3/3"] {
        let arguments = [&["run", "a.toml", "--out", out, "--quiet", "--shard", shard], more].concat();
        let output = voussoir(&arguments, at);
        assert_eq!(code(&output), 0, "{}", said(&output));
    }
}

/// Three merged parts equal the whole run, byte by byte except for seconds.
#[test]
fn parts_make_the_whole() {
    let at = folder("whole");
    solve_parts(&at, "parts", &[]);
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "whole", "--quiet"], &at)), 0);
    let merged = voussoir(&["merge", "parts"], &at);
    assert!(code(&merged) == 0 && said(&merged).contains("3 parts confirmed"), "{}", said(&merged));
    assert_eq!(timeless(&at.join("parts/results.json")), timeless(&at.join("whole/results.json")));
    for file in ["resolved.toml", "report.html"] {
        assert!(at.join("parts").join(file).is_file(), "{file}");
    }
    assert_eq!(text(&at.join("parts/resolved.toml")), text(&at.join("whole/resolved.toml")));
    assert_eq!(code(&voussoir(&["verify", "parts"], &at)), 0);
    // `--list` of a part gives its cases, each case is in one part, and a part stays the same if others are added.
    let mut all = Vec::new();
    for number in 1..=3 {
        let list = voussoir(&["run", "a.toml", "--list", "--shard", &format!("{number}/3")], &at);
        let listed = ids(&said(&list));
        assert_eq!(listed, ids(&text(&at.join(format!("parts/shard-{number}-of-3/cases.jsonl")))));
        all.extend(listed);
    }
    all.sort_unstable();
    assert_eq!(all, (0..8).collect::<Vec<_>>());
    assert_eq!(ids(&said(&voussoir(&["run", "a.toml", "--list"], &at))), all);
}

/// Missing, duplicate, foreign, truncated and changed parts are named, and nothing is written.
#[test]
fn parts_that_do_not_fit_are_refused() {
    let at = folder("refused");
    // Cases are assigned to parts by their hashes, which depend on the program. With 24 cases no part is empty.
    std::fs::write(at.join("a.toml"), study(12)).expect("written");
    solve_parts(&at, "parts", &[]);
    let refused = |arguments: &[&str], words: &[&str]| {
        let output = voussoir(arguments, &at);
        let text = said(&output);
        assert!(code(&output) == 2 && text.contains("nothing was written"), "{arguments:?}: {text}");
        assert!(words.iter().all(|word| text.contains(word)), "{words:?}: {text}");
        assert!(!at.join("parts/results.json").exists() && !at.join("out").exists());
    };
    let part = |number: usize| format!("parts/shard-{number}-of-3");
    refused(&["merge", &part(1), &part(3), "--out", "out"], &["are missing", "the part 2/3 is not there"]);
    refused(&["merge", &part(1), "parts", "--out", "out"], &["stand in two parts"]);
    refused(&["merge", &part(1), &part(2), &part(3)], &["--out DIR"]);
    refused(&["merge", "."], &["holds no part"]);
    // Another study, other friction, another number of parts.
    std::fs::write(at.join("b.toml"), study(12).replace("friction = 0.6", "friction = 0.7")).expect("written");
    std::fs::write(at.join("c.toml"), study(12).replace("\"ring\"", "\"other\"")).expect("written");
    for (file, shard, out, words) in [
        ("b.toml", "2/3", "b", "different versions of the study file"),
        ("c.toml", "2/3", "c", "the study \"ring\""),
        ("a.toml", "2/2", "d", "parts of"),
    ] {
        assert_eq!(code(&voussoir(&["run", file, "--shard", shard, "--out", out, "--quiet"], &at)), 0);
        let folder = format!("{out}/shard-{}", shard.replace('/', "-of-"));
        refused(&["merge", &part(1), &folder, &part(3), "--out", "out"], &[words]);
    }
    let path = at.join(part(2)).join("cases.jsonl");
    let whole = text(&path);
    let change = |text: &str| std::fs::write(&path, text).expect("written");
    change(&whole[..whole.len() - 30]);
    refused(&["merge", "parts"], &["is cut short"]);
    change(&whole.replacen("\"version\":\"", "\"version\":\"9", 1));
    refused(&["merge", "parts"], &["solved by version 9"]);
    let lines: Vec<&str> = whole.lines().collect();
    change(&format!("{}\n{}\n", lines[0], lines[lines.len() - 1]));
    refused(&["merge", "parts"], &["holds 0 cases and says"]);
    // A changed case counts as damaged; with a new checksum, its fields still do not prove it.
    change(&whole.replacen("\"collapse\"", "\"stalled\"", 1));
    refused(&["merge", "parts"], &["1 lines of", "are damaged"]);
    let mut case = serde_json::from_str::<Value>(lines[1]).expect("a line")["case"].take();
    let factor = case["load_factor"].as_f64().expect("a factor");
    case["load_factor"] = (factor * 1.01).into();
    let sealed = |case: &Value| String::from_utf8(sealed_text(case.to_string().as_bytes())).expect("text");
    change(&whole.replacen(lines[1], sealed(&case).trim_end(), 1));
    refused(&["merge", "parts"], &["finding(s)"]);
    case["load_factor"] = factor.into();
    case["case_hash"] = "0".repeat(32).into();
    change(&whole.replacen(lines[1], sealed(&case).trim_end(), 1));
    refused(&["merge", "parts"], &["differs from the hash of this case"]);
    let mut case = serde_json::from_str::<Value>(lines[1]).expect("a line")["case"].take();
    case["stored_path"] = serde_json::json!({ "states": 7 });
    change(&whole.replacen(lines[1], sealed(&case).trim_end(), 1));
    refused(&["merge", "parts"], &["stored path"]);
    change(&whole);
    std::fs::rename(&path, at.join(part(2)).join("unfinished.jsonl")).expect("renamed");
    refused(&["merge", "parts"], &["is not finished: run it again with --resume"]);
    // `--resume` completes a damaged part; it solves one case again.
    change(&whole.replacen("\"collapse\"", "\"stalled\"", 1));
    std::fs::remove_file(at.join(part(2)).join("unfinished.jsonl")).expect("removed");
    let again = voussoir(&["run", "a.toml", "--shard", "2/3", "--out", "parts", "--resume"], &at);
    assert!(code(&again) == 0 && said(&again).contains("1 lines of the journal are damaged"), "{}", said(&again));
    assert_eq!(ids(&text(&path)), ids(&whole));
    let merged = voussoir(&["merge", "parts"], &at);
    assert!(code(&merged) == 0 && said(&merged).contains("24 cases: 24 proved"), "{}", said(&merged));
    for shard in ["0/3", "4/3", "1", "a/b", "1/0"] {
        assert_eq!(code(&voussoir(&["run", "a.toml", "--shard", shard], &at)), 2, "{shard}");
    }
}

/// Parts that are killed at different places and resumed equal the parts of one run.
#[test]
fn killed_parts_are_resumed() {
    let at = folder("killed");
    std::fs::write(at.join("a.toml"), study(150)).expect("written");
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "whole", "--quiet"], &at)), 0);
    for round in 0..4 {
        // Each line on standard output is a finished case.
        let mut run = Command::new(env!("CARGO_BIN_EXE_voussoir"))
            .args(["run", "a.toml", "--out", "parts", "--json", "--resume", "--shard", "1/3"])
            .current_dir(&at)
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let said = BufReader::new(run.stdout.take().expect("its output"));
        drop(said.lines().take(1 + 10 * round).collect::<Vec<_>>());
        drop(run.kill());
        run.wait().expect("it has ended");
    }
    solve_parts(&at, "parts", &["--resume"]);
    assert_eq!(code(&voussoir(&["merge", "parts", "--quiet"], &at)), 0);
    assert_eq!(timeless(&at.join("parts/results.json")), timeless(&at.join("whole/results.json")));
}

/// The bytes are the same except for seconds, for any number of jobs and after any kill.
#[test]
fn results_depend_neither_on_jobs_nor_on_kills() {
    let at = folder("jobs");
    std::fs::write(at.join("a.toml"), study(300)).expect("written");
    let run = |out: &str, jobs: &str, more: &[&str]| {
        let arguments = [&["run", "a.toml", "--out", out, "--quiet", "--jobs", jobs], more].concat();
        Command::new(env!("CARGO_BIN_EXE_voussoir"))
            .args(arguments)
            .current_dir(&at)
            .spawn()
            .expect("the program starts")
    };
    for (out, jobs) in [("one", "1"), ("two", "2")] {
        assert!(run(out, jobs, &[]).wait().expect("it ends").success());
    }
    let expected = timeless(&at.join("one/results.json"));
    assert!(expected == timeless(&at.join("two/results.json")));
    for (round, jobs) in ["2", "1", "2", "2"].iter().enumerate() {
        let mut killed = run("killed", jobs, &["--resume"]);
        let journal = || std::fs::metadata(at.join("killed/unfinished.jsonl")).map_or(0, |file| file.len());
        // At the first case of this run, then later and later.
        let before = journal();
        while journal() <= before + 200_000 * round as u64 && killed.try_wait().expect("a state").is_none() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        drop(killed.kill());
        killed.wait().expect("it has ended");
    }
    assert!(run("killed", "2", &["--resume"]).wait().expect("it ends").success());
    assert!(expected == timeless(&at.join("killed/results.json")));
}

/// Lines of JSON are the entries of results.json, and nothing else is on standard output; also for a kind that creates
/// cases itself.
#[test]
fn lines_of_json() {
    let at = folder("lines");
    let envelope = study(1).replace("\"ring\"", "\"ring\"\nkind = \"envelope\"")
        + "[envelope]\nparameter = \"stages.1.loads.0.span_fraction\"\nfrom = 0.2\nto = 0.4\nscan = 3\n";
    std::fs::write(at.join("e.toml"), envelope).expect("written");
    for file in ["a.toml", "e.toml"] {
        let output = voussoir(&["run", file, "--json", "--out", file.trim_end_matches(".toml")], &at);
        assert_eq!(code(&output), 0, "{}", said(&output));
        let lines = String::from_utf8(output.stdout).expect("text");
        let mut cases: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
        cases.sort_by_key(|case| case["id"].as_u64());
        let results: Value =
            serde_json::from_str(&text(&at.join(file.trim_end_matches(".toml")).join("results.json"))).expect("JSON");
        assert_eq!(Value::Array(cases), results["cases"], "{file}");
    }
}

/// Ctrl-C keeps the finished cases and prints the command that continues.
#[cfg(unix)]
#[test]
fn interrupted_runs_say_how_to_go_on() {
    let at = folder("interrupted");
    std::fs::write(at.join("a.toml"), study(1500)).expect("written");
    let run = Command::new(env!("CARGO_BIN_EXE_voussoir"))
        .args(["run", "a.toml", "--out", "my results", "--json"])
        .current_dir(&at)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let journal = at.join("my results/unfinished.jsonl");
    while std::fs::metadata(&journal).map_or(0, |file| file.len()) < 10_000 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let killed = Command::new("kill").args(["-INT", &run.id().to_string()]).status().expect("kill runs");
    assert!(killed.success());
    let output = run.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(
        said.contains("of 3000 cases are finished") && said.contains("--out 'my results' --json --resume"),
        "{said}"
    );
    assert!(text(&journal).lines().count() > 1);
}

/// Studies with more cases than tables show have the same files as small ones, if they are solved in one run, in parts
/// merged in any order, or case by case.
#[test]
fn very_many_cases_have_the_same_files() {
    let at = folder("many");
    std::fs::write(
        at.join("a.toml"),
        study(501).replace("figures = false", "writers = [\"results_csv\", \"figures\", \"report\"]"),
    )
    .expect("written");
    let output = voussoir(&["run", "a.toml", "--out", "whole"], &at);
    assert!(
        code(&output) == 0 && said(&output).contains("1002 cases: 1002 collapse; 1002 certified"),
        "{}",
        said(&output)
    );
    for file in ["results.csv", "report.html", "figures/sweep.svg"] {
        assert!(at.join("whole").join(file).is_file(), "{file}");
    }
    assert_eq!(text(&at.join("whole/results.csv")).lines().count(), 1003);
    assert!(text(&at.join("whole/report.html")).contains("of 1002 cases"));
    solve_parts(&at, "parts", &["--jobs", "2"]);
    let part = |number: usize| format!("parts/shard-{number}-of-3");
    let merged = ["merge", &part(3), &part(1), &part(2), "--out", "merged", "--quiet"];
    assert_eq!(code(&voussoir(&merged, &at)), 0);
    let whole = timeless(&at.join("whole/results.json"));
    assert_eq!(timeless(&at.join("merged/results.json")), whole);
    assert_eq!(code(&voussoir(&["run", "a.toml", "--out", "two", "--quiet", "--jobs", "2"], &at)), 0);
    assert!(timeless(&at.join("two/results.json")) == whole);
    assert_eq!(code(&voussoir(&["verify", "whole", "--jobs", "2"], &at)), 0);
    // One case is solved again; the others are kept.
    let output = voussoir(&["run", "a.toml", "--out", "whole", "--case", "3"], &at);
    assert!(code(&output) == 0 && said(&output).contains("1001 other(s) are kept"), "{}", said(&output));
    assert!(timeless(&at.join("whole/results.json")) == whole);
    let output = voussoir(&["run", "a.toml", "--out", "whole", "--resume"], &at);
    assert!(code(&output) == 0 && said(&output).contains("1002 finished cases are kept"), "{}", said(&output));
}
