//! Looking on while a study is solved; libraries never print.

use crate::results::CaseResult;

/// Where the path of a case has come to.
#[derive(Debug, Clone, Copy)]
pub struct PathProgress<'a> {
    /// Id of the case.
    pub case: usize,
    /// Name of the stage.
    pub stage: &'a str,
    /// Whether the stage's change of gravity grows, not its loads.
    pub gravity: bool,
    /// Factor of what grows.
    pub factor: f64,
    /// States in equilibrium so far: events of an exact path, steps of others.
    pub states: u64,
}

/// Follows a study while it is worked on.
pub trait Observer: Sync {
    /// So many cases are going to be solved.
    fn begins(&self, cases: usize) {
        let _ = cases;
    }

    /// What is done from now on, in a word or two, after the cases are solved.
    fn phase(&self, what: &str) {
        let _ = what;
    }

    /// A case is answered.
    fn answered(&self, case: &CaseResult);

    /// A path has reached its next state; called often. Changes nothing.
    fn on_path(&self, at: &PathProgress) {
        let _ = at;
    }
}

/// Nobody looks on.
#[derive(Debug, Clone, Copy)]
pub struct Unobserved;

impl Observer for Unobserved {
    fn answered(&self, _: &CaseResult) {}
}
