//! The house itself: which file may import which, and how large things may grow.

mod arrows;
mod graph;
mod house;
mod links;
mod measures;
mod packages;
mod source;
mod wording;
