//! Checks that the certificate can read the states and answers of path solvers: lengths of lists, indices, finite
//! numbers.

use super::problem::PathProblem;
use super::solver::PathAnswer;
use super::state::PathState;
use crate::form::{check_finite, check_index, check_length};
use crate::limit::Status;

impl PathState {
    /// Checks the length of all lists and that all numbers are finite.
    ///
    /// # Errors
    /// Names the first malformed part of the state.
    pub fn check_form(&self, problem: &PathProblem) -> Result<(), String> {
        check_index("load step", self.load_step, problem.load_steps.len())?;
        check_length("contact forces", self.force.len(), problem.contacts.len())?;
        check_length("gaps", self.gap.len(), problem.contacts.len())?;
        check_length("motions", self.motion.len(), problem.bodies.len())?;
        check_length("memory", self.memory.len(), problem.memory_size())?;
        check_finite("contact forces", self.force.iter().flatten())?;
        check_finite("gaps", self.gap.iter().flatten())?;
        check_finite("motions", self.motion.iter().flatten())?;
        check_finite("memory", &self.memory)?;
        check_finite("gaps at the start of the step", self.step_gap.iter().flatten())?;
        check_finite("duration of the step", [&self.time_step])?;
        check_finite("factor", [&self.factor])?;
        check_finite("energies", [&self.stored, &self.dissipated, &self.work])?;
        check_finite("displacement", [&self.displacement])
    }
}

impl PathAnswer {
    /// Checks the length of all lists, the indices, and that all numbers are finite. The states of a stalled path may be
    /// empty.
    ///
    /// # Errors
    /// Names the first malformed part of the answer.
    pub fn check_form(&self, problem: &PathProblem) -> Result<(), String> {
        let steps = problem.load_steps.len();
        if self.status != Status::Stalled {
            check_index("load step", self.load_step, steps)?;
            self.state.check_form(problem)?;
            self.last.as_ref().map_or(Ok(()), |last| last.check_form(problem))?;
        }
        check_finite("factor", &self.factor)?;
        if let Some(motion) = &self.motion {
            check_length("motion", motion.len(), problem.bodies.len())?;
            check_finite("motion", motion.iter().flatten())?;
        }
        if let Some(ray) = &self.ray {
            check_length("ray", ray.len(), problem.contacts.len())?;
            check_finite("ray", ray.iter().flatten())?;
        }
        for peak in &self.limit_points {
            check_index("load step of a limit point", peak.load_step, steps)?;
            check_finite("limit point", [&peak.factor, &peak.displacement, &peak.lowest])?;
        }
        for branch in &self.branchings {
            check_index("load step of a branch", branch.load_step, steps)?;
            check_finite("branch", [&branch.factor, &branch.released])?;
        }
        for event in &self.events {
            check_index("load step of an event", event.load_step, steps)?;
            check_index("contact point of an event", event.contact, problem.contacts.len())?;
            check_finite("event", [&event.factor])?;
        }
        let stages = problem.load_steps.iter().map(|step| step.stage + 1).max().unwrap_or(0);
        self.stability.iter().try_for_each(|claim| check_index("stage of a stability", claim.stage, stages))
    }
}
