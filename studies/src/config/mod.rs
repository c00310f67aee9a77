//! The study file: from TOML text to checked values, each with the place it was written at.
//!
//! [`document`] reads the text, [`overlay`] sets single keys in it, [`expand`] makes the cases of
//! variants and sweeps, [`check`] compares a case with the schema, [`report`] says what is wrong
//! and where, [`json_schema`] hands the same schema to editors. What the keys mean is not known
//! here: that is [`crate::study`].

pub mod check;
pub mod document;
pub mod expand;
pub mod json_schema;
pub mod overlay;
pub mod report;
