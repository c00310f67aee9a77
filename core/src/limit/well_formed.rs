//! Checks that the certificate can read a limit solver's answer: lengths of lists, finite numbers.

use super::problem::{JointForce, LimitProblem, Velocity};
use super::solver::{LimitAnswer, SettlementAnswer};
use crate::form::{check_finite, check_length};

fn check_forces(what: &str, forces: Option<&Vec<JointForce>>, problem: &LimitProblem) -> Result<(), String> {
    let Some(forces) = forces else { return Ok(()) };
    check_length(what, forces.len(), problem.joints.len())?;
    check_finite(what, forces.iter().flat_map(|force| force.normal.iter().chain([&force.shear])))
}

fn check_motion(what: &str, motion: Option<&Vec<Velocity>>, problem: &LimitProblem) -> Result<(), String> {
    let Some(motion) = motion else { return Ok(()) };
    check_length(what, motion.len(), problem.groups)?;
    check_finite(what, motion.iter().flatten())
}

impl LimitAnswer {
    /// Checks the length of all lists and that all numbers are finite.
    ///
    /// # Errors
    /// Names the first malformed part of the answer.
    pub fn check_form(&self, problem: &LimitProblem) -> Result<(), String> {
        check_finite("factor", &self.factor)?;
        check_finite("factor of the field", self.field.as_ref().map(|_| &self.field_factor))?;
        check_forces("field", self.field.as_ref(), problem)?;
        check_forces("field at the start", self.start_field.as_ref(), problem)?;
        check_forces("ray", self.ray.as_ref(), problem)?;
        check_motion("motion", self.motion.as_ref(), problem)?;
        if self.feasible_interval.iter().flatten().any(|end| end.is_nan()) {
            return Err("feasible interval: an end is not a number".into());
        }
        let Some(own) = &self.non_associated else { return Ok(()) };
        check_finite("lower bound", &own.proved_lower)?;
        check_finite("associated factor", &own.associated_factor)?;
        check_forces("associated field", own.associated_field.as_ref(), problem)?;
        check_motion("associated motion", own.associated_motion.as_ref(), problem)?;
        let points = own.bracket.iter().flat_map(|point| [&point.work, &point.lower].into_iter().chain(&point.found));
        check_finite("bracket", points)
    }
}

impl SettlementAnswer {
    /// Checks the length of all lists and that all numbers are finite.
    ///
    /// # Errors
    /// Names the first malformed part of the answer.
    pub fn check_form(&self, problem: &LimitProblem) -> Result<(), String> {
        match self {
            SettlementAnswer::Follows { field, motion, .. } => {
                check_forces("field", Some(field), problem)?;
                check_motion("motion", Some(motion), problem)
            }
            SettlementAnswer::Blocked(ray) => check_forces("ray", Some(ray), problem),
            SettlementAnswer::Refused(_) => Ok(()),
        }
    }
}
