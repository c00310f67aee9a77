//! Functions that print. All other code prints through them.

use super::error::{CliError, Outcome, Verdict};
use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::sync::Mutex;
use voussoir_study::config::characters::escape;

/// The error of writing to standard output; `None` if there was none.
static UNWRITTEN: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// Prints a line on standard output, with its invisible characters escaped.
pub fn say(text: impl Display) {
    say_data(&escape(&text.to_string()));
}

/// Prints a line for other programs on standard output, unchanged.
pub fn say_data(line: &str) {
    keep(writeln!(std::io::stdout(), "{line}"));
}

/// Prints bytes on standard output, unchanged.
pub fn print(bytes: &[u8]) {
    keep(std::io::stdout().write_all(bytes));
}

/// Prints a line on standard error, with its invisible characters escaped. An error of writing is ignored, because the
/// exit code has the same information.
pub fn complain(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{}", escape(&text.to_string()));
}

/// Stores an error of writing. A reader that has closed the pipe (`| head`) is not an error: the command continues.
pub fn keep(written: std::io::Result<()>) {
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
        && let Ok(mut unwritten) = UNWRITTEN.lock()
    {
        unwritten.get_or_insert(error);
    }
}

/// Prints the error of an outcome and returns the exit code. An error of standard output is an error of the command.
pub fn ended(outcome: Outcome) -> u8 {
    let lines = |error: &CliError| error.diagnostics.iter().for_each(|line| _ = writeln!(std::io::stderr(), "{line}"));
    let code = outcome.map_or_else(
        |error| {
            lines(&error);
            error.exit_code()
        },
        Verdict::exit_code,
    );
    keep(std::io::stdout().flush());
    match UNWRITTEN.lock().ok().and_then(|mut unwritten| unwritten.take()) {
        Some(error) => {
            let error = CliError::no_access(format_args!("voussoir: cannot write standard output: {error}"));
            lines(&error);
            error.exit_code()
        }
        None => code,
    }
}
