//! The input of writers and figures: the results of a study with its scenes, and the columns of its tables.

pub mod columns;
mod study_output;

pub use study_output::{SceneOutput, StudyOutput, drawn};
