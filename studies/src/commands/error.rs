//! The errors of the command line. A command returns them as values, and `main` prints them.

use std::fmt::{self, Display};
use std::io::IsTerminal;
use std::path::Path;
use voussoir_study::config::characters::escape;
use voussoir_study::config::diagnostic::LocatedDiagnostic;
use voussoir_study::config::limits::MAX_MISTAKES_PRINTED;
use voussoir_study::config::source_line::with_source;
use voussoir_study::study::{StudyError, beside};

/// The kind of an error. It decides the exit code of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ErrorKind {
    /// The arguments, a study file or a results folder are wrong.
    WrongInput,
    /// A file cannot be read or written, or the program has a defect.
    NoAccess,
}

/// The reasons why a command failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CliError {
    /// Decides the exit code.
    pub kind: ErrorKind,
    /// Messages, one per line, in order. Invisible characters of the input are escaped; the only escape sequences are
    /// colours for a terminal.
    pub diagnostics: Vec<String>,
}

impl CliError {
    /// An error about the input.
    pub fn wrong_input(line: impl Display) -> Self {
        Self::of_lines(ErrorKind::WrongInput, [line.to_string()])
    }

    /// An error about access to files.
    pub fn no_access(line: impl Display) -> Self {
        Self::of_lines(ErrorKind::NoAccess, [line.to_string()])
    }

    /// An error with several lines.
    pub fn of_lines(kind: ErrorKind, lines: impl IntoIterator<Item = String>) -> Self {
        CliError { kind, diagnostics: lines.into_iter().map(|line| escape(&line).into_owned()).collect() }
    }

    /// An error about a file that cannot be used.
    pub fn of_file(path: &Path, why: impl Display) -> Self {
        Self::no_access(format_args!("voussoir: {}: {why}", path.display()))
    }

    /// An error of reading or writing whose text names the file.
    pub fn of_io(error: std::io::Error) -> Self {
        Self::no_access(format_args!("voussoir: {error}"))
    }

    /// An error about a file that cannot be written.
    pub fn unwritten(path: &Path, why: impl Display) -> Self {
        Self::no_access(format_args!("voussoir: cannot write {}: {why}", path.display()))
    }

    /// The mistakes in a study file, each with its line in this text, and their number.
    pub fn of_study(path: &Path, text: &str, mistakes: &StudyError) -> Self {
        let mistakes: &[LocatedDiagnostic] = mistakes.mistakes();
        let (count, own, colour) = (mistakes.len(), path.display().to_string(), has_colours());
        let text_of = |file: &str| match file {
            file if file == own => Some(text.to_string()),
            file => beside(Path::new(""))(file).ok(),
        };
        let shown = mistakes.iter().take(MAX_MISTAKES_PRINTED);
        let diagnostics = shown.map(|mistake| with_source(mistake, &text_of, colour)).collect();
        let more = count.saturating_sub(MAX_MISTAKES_PRINTED);
        let more = (more > 0).then(|| format!("{own}: {more} more mistakes are not printed"));
        let ending = if count == 1 { "" } else { "s" };
        let last = format!("{own}: {count} mistake{ending}; nothing was computed");
        let mut error = CliError { kind: ErrorKind::WrongInput, diagnostics };
        error.diagnostics.extend(Self::of_lines(error.kind, more.into_iter().chain([last])).diagnostics);
        error
    }

    /// The exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            ErrorKind::WrongInput => 2,
            ErrorKind::NoAccess => 3,
        }
    }
}

impl Display for CliError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.diagnostics.join("\n"))
    }
}

impl std::error::Error for CliError {}

/// Returns true if standard error is a terminal and the variable NO_COLOR is empty (no-color.org).
fn has_colours() -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    std::io::stderr().is_terminal() && !refused && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// The verdict of a command that was completed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// All cases are solved and certified.
    Proved,
    /// Some case is open, stalled, not certified or not confirmed.
    NotProved,
}

impl Verdict {
    /// Returns [`Verdict::Proved`] if the condition is true.
    pub fn of(proved: bool) -> Self {
        if proved { Verdict::Proved } else { Verdict::NotProved }
    }

    /// The exit code of the program.
    pub fn exit_code(self) -> u8 {
        match self {
            Verdict::Proved => 0,
            Verdict::NotProved => 1,
        }
    }
}

/// The outcome of a command.
pub type Outcome = Result<Verdict, CliError>;

/// Joins the outcomes of several commands: the worst verdict, or all errors.
pub fn joined(outcomes: impl IntoIterator<Item = Outcome>) -> Outcome {
    let mut all = Ok(Verdict::Proved);
    for outcome in outcomes {
        all = match (all, outcome) {
            (Ok(a), Ok(b)) => Ok(a.max(b)),
            (Err(mut a), Err(b)) => {
                a.kind = a.kind.max(b.kind);
                a.diagnostics.extend(b.diagnostics);
                Err(a)
            }
            (Err(error), Ok(_)) | (Ok(_), Err(error)) => Err(error),
        };
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_error_decides_the_exit_code_and_no_line_is_lost() {
        let [wrong, access] = [CliError::wrong_input("a"), CliError::no_access("b")];
        assert_eq!(joined([Ok(Verdict::Proved), Ok(Verdict::NotProved), Ok(Verdict::Proved)]), Ok(Verdict::NotProved));
        let both = joined([Err(wrong), Ok(Verdict::NotProved), Err(access)]).expect_err("an error");
        assert_eq!((both.exit_code(), both.to_string().as_str()), (3, "a\nb"));
    }
}
