//! Results of cases and studies, as they are written to files, and the conversion of forces and motions to entries.

pub mod carried;
mod case_result;
pub mod case_with_path;
mod comparison;
pub mod convert;
mod entries;
mod finished;
pub mod format;
pub mod inelastic_state;
mod kind_entries;
mod limit_points;
mod load_factor_error;
mod origin;
mod output_entry;
pub mod path_state;
mod proof_fields;
mod rank;
pub mod sealed_line;
mod seismic_entry;
mod sensitivity;
pub mod stage_start;
mod stored_entry;
pub mod stored_path;
mod study_results;
pub mod thrust_line;
mod totals;

pub use case_result::{
    CaseLabel, CaseResult, EndProof, NonAssociatedAnswer, PathRecord, Proof, StageResult, other_limit_point,
};
pub use comparison::{Comparison, ComparisonCell, ComparisonRow, MapAxes};
pub use entries::{
    DisplacementEntry, EventEntry, FieldEntry, FillEntry, LoadEntry, LoadOrigin, MotionEntry, StateEntry, YieldedEntry,
};
pub use finished::{FinishedCases, TakeCases};
pub use kind_entries::{FiniteEntry, IntervalEntry, KindEntries, OptimumEntry, PlaceEntry, WorstEntry, best_of};
pub use limit_points::{BranchEntry, FollowedTo, LimitPointEntry, NextState, StabilityEntry};
pub use load_factor_error::LoadFactorError;
pub use origin::{Build, FORMAT, HEAD, Origin, PluginCrate, head, this_program, without_origin, words};
pub use output_entry::{OutputColumn, OutputEntry, kind_name};
pub use proof_fields::{ProofFields, SpaceFieldEntry, SpaceMotionEntry, SpaceProof};
pub use rank::{least_of, load_rank};
pub use seismic_entry::{
    CheckedQuantity, DisplacementCapacity, Oscillator, PushDirection, SeismicCheck, SeismicEntry, acceleration_at,
    governing,
};
pub use sensitivity::SensitivityEntry;
pub use stored_entry::{StoredEntry, StoredOutline};
pub use study_results::StudyResults;
pub use totals::{MAX_SHOWN, Totals};

/// The JSON Schema of results.json. A field that is added to a result is added there too.
pub const RESULTS_SCHEMA: &str = include_str!("results.schema.json");

/// Returns a certified result without numbers.
#[cfg(test)]
fn blank(id: usize, status: voussoir_core::limit::Status) -> CaseResult {
    let mut result = CaseResult { status, ..CaseResult::empty() };
    result.label.id = id;
    result.certificate.passed = true;
    result
}
