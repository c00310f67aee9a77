//! The names that a program needs to run a study and to read its results: `use voussoir::prelude::*;`.

pub use crate::kinds::RunOptions;
pub use crate::results::{CaseResult, StudyResults};
pub use crate::solve::{Observer, PathProgress, RunEvent, Watch, solve_case};
pub use crate::study::{Case, Study, StudyBuilder, StudyError};
pub use crate::verify::verify;
pub use serde_json::json;
pub use voussoir_core::limit::Status;
