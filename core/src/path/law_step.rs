//! The steps of laws of tractions from gaps along a path: previous gaps, duration and fields.

use super::problem::PathProblem;
use super::state::PathState;
use crate::law::{Fields, PointContext};

/// A step as laws of tractions from gaps see it, besides the gaps at its end.
#[derive(Debug, Clone)]
pub struct LawStep<'a> {
    /// Gaps (g_n, g_t) at its start \[m\], by contact point.
    pub previous_gap: &'a [[f64; 2]],
    /// Its duration \[s\].
    pub time_step: f64,
    /// Fields at its end, by name.
    pub fields: Vec<(&'a str, f64)>,
    /// Fields at its start, by name.
    pub previous_fields: Vec<(&'a str, f64)>,
}

impl<'a> LawStep<'a> {
    /// Creates a step without duration, with constant fields.
    pub fn instant(previous_gap: &'a [[f64; 2]], fields: Vec<(&'a str, f64)>) -> Self {
        LawStep { previous_gap, time_step: 0.0, previous_fields: fields.clone(), fields }
    }

    /// Creates a step without duration from a state.
    pub fn from(problem: &'a PathProblem, state: &'a PathState) -> Self {
        LawStep::instant(&state.gap, problem.fields_at(state.load_step, state.factor))
    }

    /// Creates the step that ends in a state, as the state records it, with constant fields.
    pub fn to(problem: &'a PathProblem, state: &'a PathState) -> Self {
        let recorded = state.step_gap.len() == state.gap.len();
        let previous_gap = if recorded { &state.step_gap } else { &state.gap };
        LawStep { previous_gap, time_step: state.time_step, ..LawStep::from(problem, state) }
    }

    /// Creates the step from one state to another.
    pub fn between(problem: &'a PathProblem, last: &'a PathState, state: &PathState) -> Self {
        LawStep {
            previous_gap: &last.gap,
            time_step: problem.time_between((last.load_step, last.factor), (state.load_step, state.factor)),
            fields: problem.fields_at(state.load_step, state.factor),
            previous_fields: problem.fields_at(last.load_step, last.factor),
        }
    }

    /// Returns the fields at the start and the end.
    pub fn both_fields(&self) -> [Fields<'_>; 2] {
        [Fields::new(&self.previous_fields), Fields::new(&self.fields)]
    }

    /// Returns the context of a contact point of a problem in this step.
    pub fn context(&self, problem: &PathProblem, contact: usize) -> PointContext<'_> {
        let point = &problem.contacts[contact];
        let place = PointContext::at(point.position.into(), point.area / problem.width, problem.width);
        place.during(self.previous_gap[contact], self.time_step, self.both_fields())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Stage, Target};
    use crate::path::{LoadStep, LoadStepEnd, Loading, Period};

    fn stage(duration: f64, fields: &[(&str, f64)]) -> Stage {
        Stage {
            name: String::new(),
            gravity: None,
            forces: Vec::new(),
            accelerations: Vec::new(),
            spreads: Vec::new(),
            settlements: Vec::new(),
            target: Target::Factor(2.0),
            factor_min: 0.0,
            factor_max: f64::INFINITY,
            duration,
            fields: fields.iter().map(|(name, value)| ((*name).into(), *value)).collect(),
        }
    }

    fn problem(stages: &[Stage]) -> PathProblem {
        let step = |stage| LoadStep {
            stage,
            gravity: false,
            loading: Loading::default(),
            start: 0.0,
            end: LoadStepEnd::Factor(2.0),
            period: Period::of_stage(stages, stage),
        };
        PathProblem {
            bodies: Vec::new(),
            body_of: Vec::new(),
            contacts: Vec::new(),
            load_steps: (0..stages.len()).map(step).collect(),
            length: 1.0,
            span: 1.0,
            width: 1.0,
            counters: crate::limit::Counters::new(),
        }
    }

    /// Fields go linearly from their values in the stage before to their new values, and stay if a stage does not set them.
    #[test]
    fn fields_are_linear_within_a_stage_and_constant_if_it_does_not_set_them() {
        let stages = [
            stage(0.0, &[("water_level", 1.0), ("temperature", 280.0)]),
            stage(10.0, &[("water_level", 3.0)]),
            stage(0.0, &[]),
        ];
        let problem = problem(&stages);
        assert_eq!(problem.fields_at(0, 1.0), [("water_level", 1.0), ("temperature", 280.0)]);
        assert_eq!(problem.fields_at(1, 0.5), [("water_level", 1.5), ("temperature", 280.0)]);
        assert_eq!(problem.fields_at(2, 0.5), [("water_level", 3.0), ("temperature", 280.0)]);
        let passing: Vec<bool> = problem.load_steps.iter().map(|step| step.period.passes()).collect();
        assert_eq!(passing, [false, true, false]);
        assert!(!problem.load_steps[1].period.start().passes());
    }

    /// Time is linear in the factor of a load step, and the times of load steps are added.
    #[test]
    fn the_time_between_two_places_is_the_sum_over_load_steps() {
        let problem = problem(&[stage(8.0, &[]), stage(0.0, &[]), stage(100.0, &[])]);
        assert_eq!(problem.time_between((0, 0.5), (0, 1.5)), 4.0);
        assert_eq!(problem.time_between((0, 2.0), (1, 2.0)), 0.0);
        assert_eq!(problem.time_between((0, 1.0), (2, 0.5)), 29.0);
    }
}
