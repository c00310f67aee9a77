//! Dishonest solvers and strategies, and scenes with known answers: no certificate may accept a false statement.
//!
//! A lie is made from the answer of an honest plug-in, so the suite runs with any solver. [`Truth::contradictions`] is the
//! criterion: it lists the false claims of a result. True statements are allowed, for any origin.

mod check;
mod last_answer;
mod limit_fields;
mod limit_liar;
mod limit_lie;
mod limit_status;
mod limit_substitutes;
mod own_answer;
mod path_answers;
mod path_endings;
mod path_liar;
mod path_lie;
mod path_states;
mod path_witnesses;
mod scenes;
mod strategy_lies;
mod suite;
mod truth;

pub(super) use check::check;
pub use last_answer::LastAnswer;
pub use limit_liar::{DishonestLimit, limit_lies};
pub use limit_lie::{LimitAsked, LimitLie};
pub use path_liar::{DishonestPath, path_lies};
pub use path_lie::{PathAsked, PathLie, Story};
pub use scenes::{KnownScene, LIMIT_SCENES, PATH_SCENES};
pub use strategy_lies::{DishonestStrategy, STRATEGY_LIES, StrategyLie};
pub use suite::{Lie, answered_within, reference, scenes, solver_keys};
pub use truth::Truth;
