//! Random scenes: solvers that share no numerical method against each other, and against other programs.

mod bridges;
mod cap;
mod limit;
mod nonassociated;
mod path;
mod settlements;
mod strategies;
mod uniqueness;
