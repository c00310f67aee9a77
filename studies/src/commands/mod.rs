//! The commands: their input, output and messages. No other module of this crate prints. Errors are values;
//! [`crate::cli::main`] prints them.

pub mod bench;
mod by_case;
mod case_lines;
pub mod check;
pub mod clock;
pub mod conform;
pub mod diff;
mod error;
pub mod explain;
pub mod files;
mod folder;
mod http;
mod interrupt;
mod journal;
pub mod merge;
pub mod new;
pub mod new_law;
mod open;
pub mod options;
mod outputs;
pub mod pages;
mod print;
mod progress;
pub mod run;
pub mod serve;
pub mod shard;
mod today;
mod topics;
pub mod verify;

pub use error::{CliError, ErrorKind, Outcome, Verdict};
pub use print::{ended, keep};
