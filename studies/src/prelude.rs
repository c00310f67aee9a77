//! The names that a program needs to run a study and to read its results: `use voussoir::prelude::*;`.

pub use serde_json::json;
pub use voussoir_core::limit::Status;
pub use voussoir_study::cases::{Observer, PathProgress, RunEvent, Watch, solve_case};
pub use voussoir_study::file::StudyBuilder;
pub use voussoir_study::kind::RunOptions;
pub use voussoir_study::results::{CaseResult, StudyResults};
pub use voussoir_study::study::{Case, Study, StudyError};
pub use voussoir_verify::verify;
