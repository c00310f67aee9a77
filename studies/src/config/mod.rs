//! The study file: from TOML text to checked values, each with the place it was written at.
//!
//! [`document`] reads the text, [`overlay`] sets single keys in it, [`expand`] makes the cases of
//! variants and sweeps, [`check`] compares a case with the schema, [`checked_keys`] what its cases share once, [`diagnostic`] says what is wrong
//! and [`origin`] where, [`json_schema`] hands the same schema to editors. What the keys mean is not
//! known here: that is [`crate::study`].

pub mod characters;
pub mod check;
pub mod checked_keys;
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
