//! Opens a file or an address with the desktop's default program.

use super::print::complain;

/// Opens a file or an address. A failure is ignored.
pub fn open(what: impl AsRef<std::ffi::OsStr>) {
    let what = what.as_ref();
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let started = std::process::Command::new(program)
        .arg(what)
        .stdin(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn();
    if let Err(error) = started {
        complain(format_args!("voussoir: {} cannot be opened with {program}: {error}", what.to_string_lossy()));
    }
}
