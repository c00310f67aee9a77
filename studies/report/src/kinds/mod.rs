//! Study kinds: each defines how the cases of a study are used. One file each; file = tag.

mod case_study;
pub mod compare;
pub mod envelope;
pub mod json_schema;
pub mod map;
pub mod optimise;
mod outputs;
pub mod point;
mod read;
pub mod report;
pub mod run;
mod same_bytes;
mod search;
pub mod seismic;
mod stored_cases;
mod stored_results;
mod verify_study;

pub use case_study::{SceneStudy, one_case};
pub use outputs::{Made, write_files};
pub use read::{read_source, read_source_beside, read_study};
pub use stored_cases::{read_head, read_stored_cases};
pub use stored_results::altered;
