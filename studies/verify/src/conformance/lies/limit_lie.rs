//! A dishonest limit solver as data: it begins with the answer of an honest one.

use voussoir_core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, Status};

/// A question to a limit solver, with the honest solver that a lie is made from.
#[derive(Debug, Clone, Copy)]
pub struct LimitAsked<'a> {
    /// The honest solver.
    pub honest: &'a dyn LimitSolver,
    /// The problem.
    pub problem: &'a LimitProblem,
    /// The question.
    pub question: LimitQuestion,
}

impl LimitAsked<'_> {
    /// Returns the honest answer.
    pub fn answer(&self) -> LimitAnswer {
        self.honest.solve(self.problem, self.question)
    }

    /// Returns the honest answer if it has this status.
    pub fn ending(&self, status: Status) -> Option<LimitAnswer> {
        Some(self.answer()).filter(|answer| answer.status == status)
    }

    /// Returns the honest answer if it is a collapse.
    pub fn collapse(&self) -> Option<LimitAnswer> {
        self.ending(Status::Collapse)
    }

    /// Returns the collapse of another problem, without a greatest factor.
    pub fn collapse_of(&self, problem: &LimitProblem) -> Option<LimitAnswer> {
        let start = match self.question {
            LimitQuestion::Collapse { start, .. } => start,
            LimitQuestion::Admissible(_) => return None,
        };
        let answer = self.honest.solve(problem, LimitQuestion::Collapse { start, max: f64::INFINITY });
        Some(answer).filter(|answer| answer.status == Status::Collapse)
    }

    /// Returns the field of the honest solver at a factor.
    pub fn field_at(&self, factor: f64) -> Option<LimitAnswer> {
        let answer = self.honest.solve(self.problem, LimitQuestion::Admissible(factor));
        Some(answer).filter(|answer| answer.status == Status::Stands)
    }
}

/// A dishonest limit solver.
#[derive(Debug, Clone, Copy)]
pub struct LimitLie {
    /// Its name.
    pub name: &'static str,
    /// The false answer; `None` if the lie does not apply to this question.
    pub tell: fn(&LimitAsked) -> Option<LimitAnswer>,
}

impl LimitLie {
    /// A lie with a name.
    pub const fn new(name: &'static str, tell: fn(&LimitAsked) -> Option<LimitAnswer>) -> Self {
        LimitLie { name, tell }
    }
}
