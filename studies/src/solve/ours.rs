//! The solvers and strategies that belong to this project.
//!
//! The proof of a limit point still rests on the path solver: a check that shares nothing with it does not exist yet. So a
//! path of a solver or strategy from elsewhere is `open` at best, unless a static field proves that the structure stands.

use voussoir_core::path::PathSettings;

/// Returns true if a solver or strategy with this tag is one of `voussoir-solvers`.
pub fn is_ours(tag: &str) -> bool {
    voussoir_solvers::TAGS.contains(&tag)
}

/// Returns true if the solver of a path and all strategies of its settings belong to `voussoir-solvers`.
pub fn path_is_ours(solver: &str, settings: &PathSettings) -> bool {
    is_ours(solver) && settings.strategies().all(|strategy| is_ours(strategy.typetag_name()))
}
