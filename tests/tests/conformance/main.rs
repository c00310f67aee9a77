//! Every plug-in, found by its card, satisfies the contract of its trait.

mod added_law;
mod capped_friction;
mod cards;
mod laws;
mod mutants;
