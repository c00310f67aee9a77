//! Independent programs with which tests compare the paths of Voussoir. They take the scene of a case, and share no
//! mechanics, law or solver with it.
//!
//! They are a separate crate, because they do much arithmetic: `.ci/light.toml` compiles the tests with little
//! optimisation, and these programs with all of it.

pub mod energy;
pub mod integrator;
