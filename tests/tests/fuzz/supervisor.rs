//! The parent process: starts children, ends children that hang, and collects their findings.

use super::worker::{ASKED, MARK, TARGETS};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// Time after which a phase counts as hanging.
const LONGEST: Duration = Duration::from_secs(30);
/// Time after which a run that does not end when it is cancelled is cut short. Such runs are counted separately.
const CUT_SHORT: Duration = Duration::from_secs(8);
/// Address space of a child \[KiB\].
const MEMORY: u64 = 6 << 20;
/// Number of findings that are listed.
const LISTED: usize = 20;

/// Tries inputs of a target and fails if there are findings.
pub fn hold(name: &str, short: u64) {
    let number = |variable: &str| std::env::var(variable).ok().map(|text| text.parse::<u64>().expect("a whole number"));
    let count = number("VOUSSOIR_FUZZ_CASES").unwrap_or(short);
    let from = number("VOUSSOIR_FUZZ_FROM").unwrap_or(0);
    // Two children side by side have half of the inputs each.
    let half = from + count / 2;
    let [mut first, second] = std::thread::scope(|scope| {
        let halves = [(from, half), (half, from + count)];
        halves.map(|half| scope.spawn(move || all_of(name, half))).map(|tried| tried.join().expect("a tally"))
    });
    first.findings.extend(second.findings);
    first.slow.extend(second.slow);
    let Tally { findings, slow } = first;
    println!("{name}: {count} inputs, {} findings, {} runs cut short", findings.len(), slow.len());
    findings.iter().map(|(seed, _)| seed).chain(&slow).for_each(|seed| keep(name, *seed));
    if count == 1 {
        keep(name, from);
    }
    let lines: Vec<String> = findings.iter().take(LISTED).map(|(seed, why)| format!("seed {seed}: {why}")).collect();
    assert!(findings.is_empty(), "{name}: {} of {count} inputs\n{}", findings.len(), lines.join("\n"));
}

/// The findings so far.
#[derive(Default)]
struct Tally {
    findings: Vec<(u64, String)>,
    /// Seeds whose solver did not end in time.
    slow: Vec<u64>,
}

/// Writes the input of a seed to a file for later inspection. Children write inputs of folders themselves.
fn keep(name: &str, seed: u64) {
    let target = TARGETS.iter().find(|target| target.name == name).expect("a target");
    if !["folders", "merge"].contains(&name) {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{name}-{seed}"));
        drop(std::fs::write(file, (target.input)(seed).text));
    }
}

/// Tries all seeds of a range, with a new child after each that ends or hangs.
fn all_of(name: &str, (mut next, to): (u64, u64)) -> Tally {
    let mut tally = Tally::default();
    while next < to {
        next = one_child(name, next, to, &mut tally);
    }
    tally
}

/// Tries seeds until all are done or one ends the process; returns the next seed.
fn one_child(name: &str, from: u64, to: u64, tally: &mut Tally) -> u64 {
    let mut child = start(name, from, to);
    let lines = lines_of(&mut child);
    let (mut seed, mut phase) = (from, String::from("start"));
    loop {
        match lines.recv_timeout(if phase == "run" { CUT_SHORT } else { LONGEST }) {
            Ok(line) => match line.split_once(' ').unwrap_or((&line, "")) {
                ("seed", number) => (seed, phase) = (number.parse().expect("a seed"), "input".into()),
                ("phase", what) => phase = what.into(),
                ("found", why) => tally.findings.push((seed, why.into())),
                _ => {
                    drop(child.wait());
                    return to;
                }
            },
            Err(RecvTimeoutError::Timeout) => {
                drop(child.kill());
                drop(child.wait());
                match phase.as_str() {
                    "run" => tally.slow.push(seed),
                    other => tally.findings.push((seed, format!("{other} takes longer than {LONGEST:?}"))),
                }
                return seed + 1;
            }
            Err(RecvTimeoutError::Disconnected) => {
                let status = child.wait().map_or("lost".into(), |status| status.to_string());
                tally.findings.push((seed, format!("{phase} ended its process: {status}")));
                return seed + 1;
            }
        }
    }
}

fn start(name: &str, from: u64, to: u64) -> Child {
    let own = std::env::current_exe().expect("this program");
    let arguments = ["--exact", "worker", "--nocapture", "--test-threads", "1"];
    let mut command = if cfg!(unix) {
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\"")]).arg(own);
        shell
    } else {
        Command::new(own)
    };
    command
        .args(arguments)
        .env(ASKED, format!("{name} {from} {to}"))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("a child process")
}

/// Receives the marked lines of a child.
fn lines_of(child: &mut Child) -> Receiver<String> {
    let (sender, receiver) = channel();
    let output = child.stdout.take().expect("its output is a pipe");
    std::thread::spawn(move || {
        let lines = BufReader::new(output).split(b'\n').map_while(Result::ok);
        for line in lines {
            let line = String::from_utf8_lossy(&line).into_owned();
            if let Some(line) = line.strip_prefix(MARK)
                && sender.send(line.into()).is_err()
            {
                return;
            }
        }
    });
    receiver
}
