//! Laws of this crate; file = tag.

pub mod keyed;
