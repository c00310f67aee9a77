//! The structure of the code: allowed imports, and limits on the size of its parts.

mod arrows;
mod graph;
mod house;
mod keys;
mod links;
mod measures;
mod packages;
mod source;
mod wording;
