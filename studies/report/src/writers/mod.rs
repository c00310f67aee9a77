//! Result files: each writer converts a study's results to named files. No writer accesses the disk.
//!
//! A writer is one file here: a type with [`Writer`], its card, and a [`WriterEntry`] that is submitted to the
//! registry.

mod assembly_json;
mod assumptions;
pub mod comparison;
pub mod csv;
pub mod csv_table;
pub mod curve_csv;
#[cfg(test)]
mod figure_tests;
pub mod figures;
pub mod files;
pub mod joints_csv;
mod limit_points;
mod links;
pub mod live;
mod live_space;
pub mod markdown;
pub mod optima_csv;
pub mod outputs_csv;
pub mod page;
pub mod parquet;
#[cfg(test)]
mod parquet_bytes;
pub mod path_proofs;
#[cfg(feature = "png")]
pub mod png;
pub mod record;
mod register;
pub mod report;
pub mod results_json;
pub mod results_parquet;
pub mod results_text;
pub mod seismic;
pub mod sensitivities_csv;
pub mod table;
pub(crate) mod title_block;
pub mod vtu;
mod vtu_space;
mod vtu_text;
mod writer;

pub use writer::{CaseTable, Writer, WriterEntry, tables, use_fields, writers, written};
