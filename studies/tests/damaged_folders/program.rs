//! Runs the program under test with a time limit.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The end of a program.
pub struct Ended {
    /// Exit code; `None` if it was stopped, or ended by a signal.
    pub code: Option<i32>,
    /// Its whole output.
    pub text: String,
    /// Its running time.
    pub time: Duration,
}

/// Runs the program without a time limit.
pub fn voussoir(arguments: &[&str], at: &Path) -> Ended {
    ended(arguments, at, Duration::from_secs(600))
}

/// Runs the program and stops it at the time limit.
pub fn ended(arguments: &[&str], at: &Path, limit: Duration) -> Ended {
    let printed =
        std::env::temp_dir().join(format!("voussoir-said-{}-{:?}", std::process::id(), std::thread::current().id()));
    let file = std::fs::File::create(&printed).expect("a file");
    let started = Instant::now();
    let mut program = Command::new(env!("CARGO_BIN_EXE_voussoir"))
        .args(arguments)
        .current_dir(at)
        .stdin(Stdio::null())
        .stdout(file.try_clone().expect("a file"))
        .stderr(file)
        .spawn()
        .expect("the program starts");
    let code = loop {
        match program.try_wait().expect("it is ours") {
            Some(status) => break status.code(),
            None if started.elapsed() > limit => {
                program.kill().expect("it is ours");
                program.wait().expect("it has ended");
                break None;
            }
            None => std::thread::sleep(Duration::from_millis(3)),
        }
    };
    let text = String::from_utf8_lossy(&std::fs::read(&printed).unwrap_or_default()).into_owned();
    drop(std::fs::remove_file(&printed));
    Ended { code, text, time: started.elapsed() }
}
