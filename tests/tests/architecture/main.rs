//! The house itself: which file may import which, and how large things may grow.

mod arrows;
mod graph;
mod house;
mod measures;
mod source;
