//! Studies: the meaning of the keys of a study file, and its cases.
//!
//! [`study_keys`] is the schema of the file. [`crate::file`] reads it, and [`crate::cases`] solves its cases.

mod assemble;
pub(crate) mod case;
pub(crate) mod diagnostics;
pub mod drawing;
mod dxf;
mod error;
mod export;
pub(crate) mod keys;
mod made_cases;
mod model;
mod numeric_keys;
mod outline;
mod partial_factors;
mod plausibility;
mod resolved;
mod solver;
pub(crate) mod source;
mod space;
mod stages;
mod survey;
mod swept_keys;
pub(crate) mod tables;

pub use assemble::read_plugin;
pub use diagnostics::DiagnosticList;
pub use error::StudyError;
pub use export::as_blocks;
pub use keys::study_keys;
pub use model::{Case, Drawn, Output, SelectedSolver, SolverChoice, Study, ZoneOfThrust};
pub use numeric_keys::{NumberKind, NumericKey, PluginTable, numeric_keys, plugin_tables};
pub use outline::Outline;
pub use partial_factors::design;
pub use resolved::Resolved;
pub use source::{StudySource, kind_of, value_of};
pub use space::SpaceCase;
pub use survey::{ReadFile, beside, no_files, read_bounded};
pub use swept_keys::{SweptKeys, meaning_in};
pub use tables::{OutputKeys, RecordTable, VariantTable, stage_tables};
