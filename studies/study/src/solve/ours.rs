//! The solvers and strategies that belong to this project.
//!
//! Some ends of paths are not proved by states and witnesses. They are accepted if solver and strategy belong to this
//! project. The same end of a path by another solver is reported as `open`.

use voussoir_core::path::PathSettings;

/// Returns true if a solver or strategy with this tag is one of `voussoir-solvers`.
pub fn is_ours(tag: &str) -> bool {
    voussoir_solvers::TAGS.contains(&tag)
}

/// Returns true if the solver of a path and all strategies of its settings belong to `voussoir-solvers`.
pub fn path_is_ours(solver: &str, settings: &PathSettings) -> bool {
    is_ours(solver) && settings.strategies().all(|strategy| is_ours(strategy.typetag_name()))
}
