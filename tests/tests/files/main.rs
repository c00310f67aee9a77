//! Studies and results as files: read back unchanged, and every changed number found.

mod figures;
mod forgery;
mod labels;
mod lower_bound;
mod pages;
mod report;
mod round_trip;
mod survey;
mod tampering;
