//! Changes that must not change an answer: units, scale, rotation, reflection, numbering.

mod limit;
mod path;
