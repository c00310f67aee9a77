//! Random scenes: solvers that share no numerical method against each other, and against other programs.

mod abutments;
mod bridges;
mod cap;
mod conic;
mod energy;
mod extremes;
mod families;
mod imperfections;
mod integrator;
mod limit;
mod limit_scenes;
mod nonassociated;
mod path;
mod programs;
mod settlements;
mod shorter_steps;
mod strategies;
mod uniqueness;
