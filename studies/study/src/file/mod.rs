//! Reads study files with a scene. All mistakes of a file are reported at once.

mod builder;
mod load;
mod study_file;

pub use builder::StudyBuilder;
pub use load::load;
pub use study_file::{HELD, StudyFile};
