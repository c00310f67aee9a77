//! The trait of a study kind, and studies that are solved as their kind requires.

mod by_case;
mod run_study;
mod stored_results;
mod study_kind;
mod whole_results;

pub use run_study::RunOptions;
pub use stored_results::{RESULTS, StoredResults};
pub use study_kind::{
    KindEntry, LoadedStudy, OwnResults, Part, Piece, RunOutput, RunRequest, StudyKind, Verification, kind, kinds,
};
