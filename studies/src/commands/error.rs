//! The errors of the command line: values that a command returns and that `main` prints.

use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::limits::MAX_MISTAKES_PRINTED;
use crate::study::StudyError;
use std::fmt::{self, Display};
use std::path::Path;

/// The kind of an error, which decides the exit code of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ErrorKind {
    /// The arguments, a study file or a results folder are wrong.
    WrongInput,
    /// A file cannot be read or written, or the program itself is at fault.
    NoAccess,
}

/// The reasons why a command could not do its work.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CliError {
    /// Decides the exit code.
    pub kind: ErrorKind,
    /// Lines for the reader, in order.
    pub diagnostics: Vec<String>,
}

impl CliError {
    /// An error about the input.
    pub fn wrong_input(line: impl Display) -> Self {
        CliError { kind: ErrorKind::WrongInput, diagnostics: vec![line.to_string()] }
    }

    /// An error about access to files.
    pub fn no_access(line: impl Display) -> Self {
        CliError { kind: ErrorKind::NoAccess, diagnostics: vec![line.to_string()] }
    }

    /// A file that cannot be used.
    pub fn of_file(path: &Path, why: impl Display) -> Self {
        Self::no_access(format_args!("voussoir: {}: {why}", path.display()))
    }

    /// An error of a file that names the file.
    pub fn of_io(error: std::io::Error) -> Self {
        Self::no_access(format_args!("voussoir: {error}"))
    }

    /// A file that cannot be written.
    pub fn unwritten(path: &Path, why: impl Display) -> Self {
        Self::no_access(format_args!("voussoir: cannot write {}: {why}", path.display()))
    }

    /// The mistakes in a study file, and their number.
    pub fn of_study(path: &Path, mistakes: &StudyError) -> Self {
        let mistakes: &[LocatedDiagnostic] = mistakes.mistakes();
        let count = mistakes.len();
        let mut diagnostics: Vec<String> =
            mistakes.iter().take(MAX_MISTAKES_PRINTED).map(ToString::to_string).collect();
        if count > MAX_MISTAKES_PRINTED {
            diagnostics.push(format!(
                "{}: {} more mistakes are not printed",
                path.display(),
                count - MAX_MISTAKES_PRINTED
            ));
        }
        let ending = if count == 1 { "" } else { "s" };
        diagnostics.push(format!("{}: {count} mistake{ending}; nothing was computed", path.display()));
        CliError { kind: ErrorKind::WrongInput, diagnostics }
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

/// The verdict of a command that did its work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// All cases are answered and certified.
    Proved,
    /// Some case is open, stalled, not certified or not confirmed.
    NotProved,
}

impl Verdict {
    /// [`Verdict::Proved`] if the condition holds.
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

/// The end of a command.
pub type Outcome = Result<Verdict, CliError>;

/// The outcomes of commands that were done one after another: the worst verdict, or all errors.
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
