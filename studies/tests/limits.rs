//! Extreme inputs: each ends within seconds with an exit code from 0 to 3 and a message.

use std::path::{Path, PathBuf};
#[cfg(target_os = "linux")]
use std::process::Stdio;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// Longest time of a command, on a machine that is also used for other work.
const MAX_TIME: Duration = Duration::from_secs(60);

fn voussoir(arguments: &[&str]) -> Output {
    let started = Instant::now();
    let output = Command::new(env!("CARGO_BIN_EXE_voussoir")).args(arguments).output().expect("the program starts");
    assert!(started.elapsed() < MAX_TIME, "{:?}", started.elapsed());
    output
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("it ends by itself")
}

fn messages(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases")
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Checks the text of a study and returns the messages.
fn refused(folder: &Path, text: &str) -> String {
    let file = folder.join("study.toml");
    std::fs::write(&file, text).expect("a file");
    let output = voussoir(&["check", &file.display().to_string()]);
    let messages = messages(&output);
    let start: String = messages.chars().take(600).collect();
    assert_eq!(code(&output), 2, "{start}");
    assert!(messages.len() < 20_000, "{} bytes: {start}", messages.len());
    assert!(start.contains("study.toml:"), "{start}");
    messages
}

#[test]
fn depth_has_a_limit() {
    let folder = folder("depth_has_a_limit");
    let study = cases().join("strathmashie_rise.toml").display().to_string();
    let set = |value: String| {
        let output = voussoir(&["check", &study, "--set", &value]);
        (code(&output), messages(&output))
    };
    let (code, why) = set(format!("{}x=1", "x.".repeat(20_000)));
    assert!(code == 2 && why.contains("has 20001 segments; a key has at most 64"), "{why}");
    let (code, _) = set(format!("scene.x={}{}", "[".repeat(50_000), "]".repeat(50_000)));
    assert_eq!(code, 2);
    let dotted = vec!["a"; 79].join(".");
    let inline = (0..78).fold("1".to_string(), |inner, _| format!("{{ {dotted} = {inner} }}"));
    for text in [
        format!("a = {}", "[".repeat(100_000)),
        format!("a = {}1{}", "{ b = ".repeat(100_000), " }".repeat(100_000)),
        format!("{} = 1", vec!["a"; 100_000].join(".")),
        format!("[{}]\nx = 1", vec!["a"; 100_000].join(".")),
        format!("[{dotted}]\n{dotted} = {inline}"),
    ] {
        let why = refused(&folder, &text);
        assert!(why.contains("is nested more than 64 deep"), "{why}");
    }
}

fn report(claim: &str) -> String {
    let study = cases().join("strathmashie_rise.toml").display().to_string();
    format!(
        "name = \"r\"\nkind = \"report\"\n[report]\nstudies = [{study:?}]\n[report.series.load]\npoints = [[0, 1], [1, 2]]\n\
         [[report.claims]]\nid = \"1\"\nclaim = \"c\"\n[[report.claims.tests]]\nof = \"t\"\n{claim}\n"
    )
}

#[test]
fn expressions_of_claims_have_limits_and_types() {
    let folder = folder("expressions_of_claims_have_limits_and_types");
    for (value, holds, why) in [
        (format!("1{}", "+1".repeat(100_000)), "value > 0", "it has more than 250 terms"),
        (format!("{}1{}", "(".repeat(100_000), ")".repeat(100_000)), "value > 0", "it is nested too deeply"),
        (format!("{}1", "-".repeat(100_000)), "value > 0", "it is nested too deeply"),
        (format!("1 {}", "x".repeat(100_000)), "value > 0", "is left over"),
        ("max(load)".into(), "value", "must be true or false, but is a number"),
        ("max(load)".into(), "value == 'two'", "\"==\" compares a number with a word"),
        ("load and 1".into(), "value", "\"and\" needs true or false, but this is a number"),
    ] {
        let found = refused(&folder, &report(&format!("value = \"{value}\"\nholds = \"{holds}\"")));
        assert!(found.contains(why), "{found}");
    }
    for (claim, why) in
        [("value = 3\nholds = \"value > 0\"", "must be a text"), ("value = \"1\"\nholds = true", "must be a text")]
    {
        let found = refused(&folder, &report(claim));
        assert!(found.contains(why), "{found}");
    }
}

/// No message passes a control character of the input to the terminal.
#[test]
fn invisible_characters_are_refused_and_escaped() {
    let folder = folder("invisible_characters_are_refused_and_escaped");
    let text = std::fs::read_to_string(cases().join("strathmashie_rise.toml")).expect("a study");
    let named = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        refused(&folder, &text.replace(from, to))
    };
    for why in [
        named("name = \"dead\"", "name = \"de\\u001b[31mad\""),
        named("name = \"dead\"", "name = \"de\\u202ead\""),
        named("name = \"strathmashie_rise\"", "name = \"a\\u0007\""),
        named("[materials.stone]", "[materials.\"sto\\u200bne\"]"),
        named("material = \"stone\"", "material = \"\\u001b]0;x\\u0007\""),
    ] {
        let plain = |c: char| c == '\n' || !(c.is_control() || ('\u{200b}'..='\u{206f}').contains(&c));
        assert!(why.chars().all(plain), "{why:?}");
        assert!(why.contains("which cannot be seen"), "{why}");
    }
    let output = voussoir(&["check", "no\u{1b}[31m.toml", "--set", "x\u{202e}"]);
    assert_eq!(code(&output), 2);
    assert!(messages(&output).contains("\\u{202e}") && !messages(&output).contains('\u{202e}'));
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_an_error() {
    let folder = folder("output_that_cannot_be_written_is_an_error").display().to_string();
    let study = cases().join("strathmashie_rise.toml").display().to_string();
    let full = || Stdio::from(std::fs::File::options().write(true).open("/dev/full").expect("a full device"));
    for arguments in [
        &["run", &study, "--out", &folder, "--json"][..],
        &["run", &study, "--out", &folder],
        &["run", &study, "--list"],
        &["check", &study],
        &["list"],
        &["explain", "arch"],
        &["schema"],
        &["man"],
        &["--help"],
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_voussoir")).args(arguments).stdout(full()).output();
        let output = output.expect("the program starts");
        assert_eq!(code(&output), 3, "{arguments:?}");
        assert!(messages(&output).contains("cannot write standard output"), "{arguments:?}: {}", messages(&output));
    }
    // Messages that cannot be written do not change the exit code.
    let output = Command::new(env!("CARGO_BIN_EXE_voussoir")).args(["check", "none.toml"]).stderr(full()).status();
    assert_eq!(output.expect("the program starts").code(), Some(3));
    // A reader that closes the pipe early does not cause an error.
    let mut child = Command::new(env!("CARGO_BIN_EXE_voussoir"))
        .args(["run", &study, "--out", &folder, "--json"])
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    assert_eq!(child.wait().expect("it ends").code(), Some(0));
}

/// Sizes far beyond any structure are refused before memory is allocated for them.
#[test]
fn sizes_have_limits() {
    let study = cases().join("strathmashie_rise.toml").display().to_string();
    for set in [
        "scene.voussoirs=1000000000",
        "scene.mesh.elements=[1000000, 1000000]",
        "scene.mesh.elements=[5, 1000]",
        "scene.mesh.elements=[1, 1000]",
        "scene.profile={ shape = \"segmental\", span = 1e300, rise = 1e-300 }",
        "sweep.\"scene.thickness\".count=1000000000000",
        "sweep.\"scene.thickness\"={ from = 0.1, to = 1e300, step = 1e-300 }",
        "sweep={ \"scene.thickness\" = { from = 0.1, to = 1, count = 999999 }, \"scene.width\" = { from = 1, to = 2, count = 999999 } }",
    ] {
        let output = voussoir(&["check", &study, "--set", set]);
        assert_eq!(code(&output), 2, "{set}: {}", messages(&output));
    }
    let output = voussoir(&["check", "/dev/zero"]);
    assert_eq!(code(&output), 3, "{}", messages(&output));
}
