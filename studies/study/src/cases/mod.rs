//! Solves cases: each result is certified and checked before it is returned.

mod observer;
mod solve;

pub use observer::{Observer, PathProgress, RunEvent, Unobserved, Watch};
pub use solve::{label_of, proved_case, solve_case, solve_cases, solve_followed, solve_input, solve_unless_cancelled};
