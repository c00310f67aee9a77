//! Runs that are killed, whose study is edited, whose disk is full, or that run at the same time. Run these tests by
//! hand: `cargo test --release -p voussoir --test interruptions -- --ignored`. Their results are in
//! docs/theory/verifying.md.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;
use voussoir::core::random::Random;

const CASES: usize = 600;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("interruptions_{name}"));
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn study(friction: f64) -> String {
    format!(
        "name = \"ring\"\n[scene]\nscene = \"arch\"\nprofile = {{ shape = \"segmental\", span = 9.42, rise = 2.99 }}\n\
         thickness = 0.6\nwidth = 5.81\nvoussoirs = 41\nends = \"jointed\"\nmaterial = \"stone\"\njoint = \"dry\"\n\
         [materials.stone]\nlaw = \"rigid\"\ndensity = 2200.0\n[joints.dry]\nlaw = \"coulomb_associated\"\n\
         friction = {friction:?}\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\n\
         until = \"collapse\"\nloads = [{{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }}]\n\
         [sweep]\n\"scene.profile.rise\" = {{ from = 2.6, to = 3.3, count = {CASES} }}\n[output]\nfigures = false\n"
    )
}

fn start(at: &Path, out: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_voussoir"))
        .args(["run", "a.toml", "--out", out, "--quiet", "--resume"])
        .current_dir(at)
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts")
}

fn ended(mut run: Child) -> Option<i32> {
    run.wait().expect("it ends").code()
}

/// Results without running times; checks that all ids occur once, in order.
fn timeless(dir: &Path) -> Value {
    let text = std::fs::read_to_string(dir.join("results.json")).expect("results");
    let mut results: Value = serde_json::from_str(&text).expect("JSON");
    let cases = results["cases"].as_array_mut().expect("cases");
    assert_eq!(cases.len(), CASES);
    for (id, case) in cases.iter_mut().enumerate() {
        assert_eq!(case["id"], id);
        case["seconds"] = 0.0.into();
    }
    results
}

/// Returns the number of cases in the journal.
fn stored(at: &Path) -> usize {
    std::fs::read_to_string(at.join("out/unfinished.jsonl")).unwrap_or_default().lines().count()
}

/// Returns when the journal has this number of cases, or all runs have ended.
fn until_stored(at: &Path, cases: usize, runs: &mut [&mut Child]) {
    while stored(at) < cases && runs.iter_mut().any(|run| run.try_wait().expect("a state").is_none()) {
        sleep(Duration::from_millis(1));
    }
}

fn reference(at: &Path, friction: f64, out: &str) -> Value {
    std::fs::write(at.join("a.toml"), study(friction)).expect("written");
    assert_eq!(ended(start(at, out)), Some(0));
    timeless(&at.join(out))
}

/// A sweep is killed twenty times at random, and the study is edited between some of the kills: the results are those
/// of the last version of the study.
#[test]
#[ignore = "by hand: twenty kills of a run"]
fn killed_twenty_times_with_the_study_edited_in_between() {
    let at = folder("killed");
    let (one, other) = (reference(&at, 0.6, "one"), reference(&at, 0.45, "other"));
    let mut random = Random::new(14);
    for round in 0..20 {
        let friction = if round % 5 == 3 { 0.45 } else { 0.6 };
        std::fs::write(at.join("a.toml"), study(friction)).expect("written");
        let mut run = start(&at, "out");
        let target = random.whole(0, CASES - 1);
        // Waits at least for the first case of this run, because stored cases are there from the start.
        let before = stored(&at);
        until_stored(&at, target.max(before + 1), &mut [&mut run]);
        drop(run.kill());
        let code = run.wait().expect("it ends").code();
        println!("round {round}: friction {friction}, ended {code:?}, {before}, then {} cases stored", stored(&at));
    }
    for (friction, expected) in [(0.6, &one), (0.45, &other)] {
        std::fs::write(at.join("a.toml"), study(friction)).expect("written");
        assert_eq!(ended(start(&at, "out")), Some(0));
        assert_eq!(&timeless(&at.join("out")), expected, "{friction}");
    }
}

/// Two runs start at the same time, and one or both are killed, many times: one writes, the other is refused, and
/// results are never mixed.
#[test]
#[ignore = "by hand: pairs of runs"]
fn two_runs_at_once() {
    let at = folder("two");
    let expected = reference(&at, 0.6, "whole");
    let mut random = Random::new(18);
    for round in 0..10 {
        let (mut a, mut b) = (start(&at, "out"), start(&at, "out"));
        until_stored(&at, random.whole(0, CASES - 1), &mut [&mut a, &mut b]);
        drop(if round % 2 == 0 { a.kill() } else { b.kill() });
        if round % 3 == 0 {
            drop(a.kill());
            drop(b.kill());
        }
        let codes = (ended(a), ended(b));
        println!("round {round}: {codes:?}");
        assert!([codes.0, codes.1].iter().all(|code| matches!(code, None | Some(0 | 3))), "{codes:?}");
    }
    assert_eq!(ended(start(&at, "out")), Some(0));
    assert_eq!(timeless(&at.join("out")), expected);
}

/// The disk is full (a small file system at `VOUSSOIR_SMALL_DISK`): exit code 3, no file is incomplete, and the run
/// continues when there is space.
#[test]
#[ignore = "by hand: needs a small file system"]
fn a_full_disk() {
    let small = std::env::var("VOUSSOIR_SMALL_DISK").expect("the folder of a small file system");
    let at = folder("full");
    let expected = reference(&at, 0.6, "whole");
    let out = Path::new(&small).join("out");
    let name = out.to_str().expect("a path");
    let ballast = Path::new(&small).join("ballast");
    std::fs::write(&ballast, vec![0; 128 * 1024]).expect("room for the ballast");
    for round in 0..3 {
        let code = ended(start(&at, name));
        println!("round {round}: {code:?}, results: {}", out.join("results.json").exists());
        assert_eq!(code, Some(3));
        assert!(!out.join("results.json").exists(), "half a file");
    }
    std::fs::remove_file(&ballast).expect("removed");
    let left = ended(start(&at, name));
    println!("without the ballast: {left:?}");
    // The stored cases are valid: a run with enough space continues from them.
    let copy = at.join("copy");
    std::fs::create_dir_all(&copy).expect("a folder");
    for entry in std::fs::read_dir(&out).expect("a folder").flatten().filter(|entry| entry.path().is_file()) {
        std::fs::copy(entry.path(), copy.join(entry.file_name())).expect("copied");
    }
    assert_eq!(ended(start(&at, "copy")), Some(0));
    assert_eq!(timeless(&copy), expected);
}
