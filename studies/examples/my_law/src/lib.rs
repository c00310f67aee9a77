//! The laws of this crate. The name of a file is the tag of its law.

pub mod keyed;
