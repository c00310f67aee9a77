//! Study kinds: each defines how the cases of a study are used. One file each; file = tag.

mod backing;
mod by_case;
mod case_study;
pub mod compare;
pub mod envelope;
pub mod json_schema;
mod kind;
pub mod map;
pub mod optimise;
mod outputs;
pub mod point;
mod read;
pub mod report;
pub mod run;
mod run_study;
mod same_bytes;
mod search;
mod stored_cases;
mod stored_results;
mod verify_study;

pub use backing::{Backing, BackingCount, resumed};
pub use case_study::one_case;
pub use kind::{
    KindEntry, LoadedStudy, OwnResults, Part, Piece, RunOutput, RunRequest, StudyKind, Verification, kind, kinds,
};
pub use outputs::Made;
pub use read::{read_source, read_source_beside, read_study};
pub use run_study::RunOptions;
pub use stored_cases::{read_head, read_stored_cases};
pub use stored_results::StoredResults;
