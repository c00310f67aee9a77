//! The study file: from TOML text to checked values, each with its place.
//!
//! [`document`] reads the text, [`overlay`] sets single keys in it, and [`expand`] makes the cases of variants and sweeps.
//! [`check`] compares a case with the schema; [`checked_keys`] stores the checks that cases share. [`diagnostic`] describes a
//! mistake and [`origin`] its place. [`json_schema`] exports the schema to editors. The meaning of the keys is defined in
//! [`crate::study`], not here.

pub mod characters;
pub mod check;
pub mod checked_keys;
pub mod checked_value;
pub mod common_keys;
pub mod default_table;
pub mod diagnostic;
pub mod document;
pub mod documented_vehicles;
pub mod dotted_key;
pub mod expand;
pub mod gravity;
pub mod json_schema;
pub mod key_meaning;
pub mod limits;
pub mod names;
pub mod nesting;
pub mod origin;
pub mod overlay;
pub mod shape_words;
pub mod source_line;
pub mod synonyms;
