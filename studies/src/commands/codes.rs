//! Exit codes, and the one way to print a line.

use crate::config::characters::escape;
use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::sync::Mutex;

/// Why standard output could not be written; `None` if it could.
static UNWRITTEN: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// All cases answered and certified.
pub const FINE: u8 = 0;
/// Some case stalled, failed its certificate, or was not confirmed.
pub const NOT_PROVEN: u8 = 1;
/// Wrong input.
pub const WRONG_INPUT: u8 = 2;
/// Cannot read or write.
pub const NO_ACCESS: u8 = 3;

/// Prints a line on standard output, with its invisible characters escaped.
pub fn say(text: impl Display) {
    say_data(&escape(&text.to_string()));
}

/// Prints a line that a program reads, unchanged.
pub fn say_data(line: &str) {
    keep(writeln!(std::io::stdout(), "{line}"));
}

/// Prints bytes on standard output, unchanged.
pub fn print(bytes: &[u8]) {
    keep(std::io::stdout().write_all(bytes));
}

/// Prints a line on standard error, with its invisible characters escaped. The exit code tells as much: an error here is
/// ignored.
pub fn complain(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{}", escape(&text.to_string()));
}

/// A reader that has gone away (`| head`) is no error: the command goes on in silence. Any other error is kept.
fn keep(written: std::io::Result<()>) {
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
        && let Ok(mut unwritten) = UNWRITTEN.lock()
    {
        unwritten.get_or_insert(error);
    }
}

/// The exit code of a program that printed a text by other means.
pub fn printed(written: std::io::Result<()>, code: u8) -> u8 {
    keep(written);
    ended(code)
}

/// The exit code of a command that is done: [`NO_ACCESS`] if some of its output could not be written.
pub fn ended(code: u8) -> u8 {
    keep(std::io::stdout().flush());
    match UNWRITTEN.lock().ok().and_then(|mut unwritten| unwritten.take()) {
        Some(error) => {
            complain(format_args!("voussoir: cannot write standard output: {error}"));
            NO_ACCESS
        }
        None => code,
    }
}
