//! Studies: the meaning of the keys of a study file, and its cases.
//!
//! [`study_keys`] is the schema of the file; [`load`](load()) converts text into a [`Study`]. All mistakes of the file are
//! reported at once. Cases are solved elsewhere, in [`crate::solve`].

mod assemble;
mod builder;
mod case;
mod diagnostics;
pub mod drawing;
mod dxf;
mod error;
mod export;
mod file;
mod keys;
mod load;
mod model;
mod numeric_keys;
mod outline;
mod partial_factors;
mod plausibility;
mod resolved;
mod solver;
mod source;
mod stages;
mod survey;
mod swept_keys;
mod tables;

pub(crate) use assemble::read_plugin;
pub use builder::StudyBuilder;
pub use diagnostics::DiagnosticList;
pub use error::StudyError;
pub use export::as_blocks;
pub use file::{HELD, StudyFile};
pub use keys::study_keys;
pub use load::load;
pub use model::{Case, Drawn, Output, SelectedSolver, SolverChoice, Study, ZoneOfThrust};
pub use numeric_keys::{NumberKind, NumericKey, PluginTable, numeric_keys, plugin_tables};
pub use outline::Outline;
pub use partial_factors::design;
pub use resolved::{CheckedValue, Resolved};
pub(crate) use source::value_of;
pub use source::{StudySource, kind_of};
pub(crate) use survey::read_bounded;
pub use survey::{ReadFile, beside, no_files};
pub use swept_keys::{SweptKeys, meaning_in};
pub(crate) use tables::stage_tables;
pub use tables::{OutputKeys, RecordTable, VariantTable};
