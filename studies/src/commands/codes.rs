//! Exit codes, and the one way to print a line.

/// All cases answered and certified.
pub const FINE: u8 = 0;
/// Some case stalled, failed its certificate, or was not confirmed.
pub const NOT_PROVEN: u8 = 1;
/// Wrong input.
pub const WRONG_INPUT: u8 = 2;
/// Cannot read or write.
pub const NO_ACCESS: u8 = 3;

/// Prints a line; a reader that has gone away (`| head`) is no error.
pub fn say(text: impl std::fmt::Display) {
    use std::io::Write;
    let _ = writeln!(std::io::stdout(), "{text}");
}
