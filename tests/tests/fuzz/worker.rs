//! The child process: tries inputs one after the other and reports each phase on standard output.

use super::{folders, studies, surveys};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// One input.
pub struct Input {
    /// Its text.
    pub text: String,
    /// The file that it replaces; other files may be beside it.
    pub beside: PathBuf,
}

/// A kind of input, with its generator and its attempt.
pub struct Target {
    pub name: &'static str,
    pub input: fn(u64) -> Input,
    pub attempt: fn(&Input) -> Result<(), String>,
}

pub const TARGETS: [Target; 6] = [
    Target { name: "studies", input: studies::input, attempt: studies::attempt },
    Target { name: "folders", input: folders::folder, attempt: folders::attempt_folder },
    Target { name: "merge", input: folders::part, attempt: folders::attempt_part },
    Target { name: "surveys", input: surveys::survey, attempt: surveys::attempt_survey },
    Target { name: "drawings", input: surveys::drawing, attempt: surveys::attempt_drawing },
    Target { name: "claims", input: surveys::claim, attempt: surveys::attempt_claim },
];

/// The variable with the task of the child: target, first seed, seed after the last.
pub const ASKED: &str = "VOUSSOIR_FUZZ_WORKER";
/// The start of a line for the parent. Commands print other lines too.
pub const MARK: &str = "@@ ";

/// Place and message of the last panic.
static PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Reports the next phase to the parent.
pub fn phase(what: &str) {
    println!("\n{MARK}phase {what}");
}

/// A folder of this process.
pub fn own_folder() -> &'static Path {
    static FOLDER: std::sync::LazyLock<PathBuf> = std::sync::LazyLock::new(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        folder
    });
    &FOLDER
}

fn last_panic() -> Option<String> {
    PANIC.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take()
}

/// Works on the task of the parent; returns at once if there is no parent.
pub fn work() {
    let Ok(asked) = std::env::var(ASKED) else { return };
    let words: Vec<&str> = asked.split(' ').collect();
    let target = TARGETS.iter().find(|target| target.name == words[0]).expect("a target");
    let [from, to] = [words[1], words[2]].map(|word| word.parse::<u64>().expect("a seed"));
    std::panic::set_hook(Box::new(|info| {
        let place = info.location().map_or(String::new(), |place| format!("{}:{}", place.file(), place.line()));
        let payload = info.payload();
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let why = text.or(payload.downcast_ref::<&str>().copied()).unwrap_or("a panic");
        *PANIC.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(format!("panic at {place}: {why}"));
    }));
    for seed in from..to {
        println!("\n{MARK}seed {seed}");
        let attempt = || (target.attempt)(&(target.input)(seed));
        let found = match std::panic::catch_unwind(attempt) {
            // The program catches panics of solvers; here they are findings.
            Ok(Ok(())) => match last_panic() {
                Some(panic) => format!("caught {panic}"),
                None => continue,
            },
            Ok(Err(why)) => why,
            Err(_) => last_panic().unwrap_or_default(),
        };
        println!("\n{MARK}found {}", found.replace('\n', " | "));
    }
    println!("\n{MARK}done");
    drop(std::fs::remove_dir_all(own_folder()));
}
