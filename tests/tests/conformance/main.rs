//! Every plug-in, found by its card, keeps what its trait promises.

mod cards;
mod laws;
mod state;
