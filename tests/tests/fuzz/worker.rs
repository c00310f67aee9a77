//! The child process: tries inputs one after the other and says on standard output what it is about to do.

use super::{folders, studies, surveys};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// One input.
pub struct Input {
    /// What is read.
    pub text: String,
    /// The file that it stands for, beside which others may be.
    pub beside: PathBuf,
}

/// A kind of input: how it is made from a seed, and what is done with it.
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

/// What the child is asked: target, first seed, seed after the last.
pub const ASKED: &str = "VOUSSOIR_FUZZ_WORKER";
/// The beginning of a line for the parent; others are those of the commands.
pub const MARK: &str = "@@ ";

/// Where and why a thread panicked last.
static PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Tells the parent what is done from now on.
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

/// Does what the parent asks; nothing if there is no parent.
pub fn work() {
    let Ok(asked) = std::env::var(ASKED) else { return };
    let words: Vec<&str> = asked.split(' ').collect();
    let target = TARGETS.iter().find(|target| target.name == words[0]).expect("a target");
    let [from, to] = [words[1], words[2]].map(|word| word.parse::<u64>().expect("a seed"));
    std::panic::set_hook(Box::new(|info| {
        let place = info.location().map_or(String::new(), |place| format!("{}:{}", place.file(), place.line()));
        let why = info.payload_as_str().unwrap_or("a panic");
        *PANIC.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(format!("panic at {place}: {why}"));
    }));
    for seed in from..to {
        println!("\n{MARK}seed {seed}");
        let attempt = || (target.attempt)(&(target.input)(seed));
        let found = match std::panic::catch_unwind(attempt) {
            Ok(Ok(())) => continue,
            Ok(Err(why)) => why,
            Err(_) => PANIC.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take().unwrap_or_default(),
        };
        println!("\n{MARK}found {}", found.replace('\n', " | "));
    }
    println!("\n{MARK}done");
    drop(std::fs::remove_dir_all(own_folder()));
}
