//! What each command prints, reads and writes, and its exit code. Nothing else in this crate prints.

pub mod check;
mod codes;
pub mod conform;
pub mod explain;
pub mod files;
mod folder;
pub mod new;
mod progress;
pub mod run;
pub mod verify;

pub use codes::NO_ACCESS;
