//! What each command prints, reads and writes, and its exit code. Nothing else in this crate prints.

pub mod bench;
mod by_case;
mod case_lines;
pub mod check;
pub mod clock;
mod codes;
pub mod conform;
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
pub mod pages;
mod progress;
mod refill;
pub mod run;
pub mod serve;
pub mod shard;
mod stream;
mod tables;
mod today;
mod topics;
pub mod verify;

pub use codes::{NO_ACCESS, WRONG_INPUT, complain, ended, printed};
