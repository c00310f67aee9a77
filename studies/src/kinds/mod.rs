//! Study kinds: what is done with the cases of a study. One file each; file = tag.

mod backing;
mod by_case;
mod case_study;
pub mod compare;
pub mod envelope;
pub mod json_schema;
mod kind;
pub mod map;
pub mod optimise;
pub mod point;
mod read;
pub mod report;
pub mod run;
mod run_study;
mod same_bytes;
mod search;
mod stored_cases;
mod streamed;
mod verify_streamed;

pub use backing::{Backing, BackingCount, resumed};
pub use kind::{
    CasesOf, KindEntry, LoadedStudy, OwnResults, Part, Piece, RunOutput, RunRequest, StoredResults, StudyKind,
    Verification, kind, kinds,
};
pub use read::{read_source, read_source_beside, read_study};
pub use run_study::RunOptions;
