//! Every plug-in, found by its card, keeps what its trait promises.

mod added_law;
mod capped_friction;
mod cards;
mod laws;
mod mutants;
