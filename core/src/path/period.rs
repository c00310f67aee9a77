//! Time and fields along a path. Within a load step both are linear in its factor.

use super::problem::{LoadStepEnd, PathProblem};
use super::state::PathState;
use crate::law::{Fields, PointContext};
use crate::model::Stage;

/// A field in a load step.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldChange {
    /// Name of the field.
    pub name: String,
    /// Value at the start.
    pub from: f64,
    /// Value at the end.
    pub to: f64,
}

/// Duration and fields of a load step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Period {
    /// Duration \[s\]; 0 if no time passes.
    pub duration: f64,
    /// Fields with their values at both ends.
    pub fields: Vec<FieldChange>,
}

impl Period {
    /// Returns the period in which the loads of a stage act: its fields go from the values of the stage before to its
    /// own. Fields that the stage does not set are constant.
    pub fn of_stage(stages: &[Stage], stage: usize) -> Self {
        let mut fields: Vec<FieldChange> = Vec::new();
        for own in &stages[..=stage] {
            fields.iter_mut().for_each(|field| field.from = field.to);
            for (name, value) in &own.fields {
                match fields.iter_mut().find(|field| field.name == *name) {
                    Some(field) => field.to = *value,
                    None => fields.push(FieldChange { name: name.clone(), from: *value, to: *value }),
                }
            }
        }
        Period { duration: stages[stage].duration, fields }
    }

    /// Returns the start of this period: gravity changes in it without duration, with constant fields.
    pub fn start(&self) -> Self {
        let still = |field: &FieldChange| FieldChange { to: field.from, ..field.clone() };
        Period { duration: 0.0, fields: self.fields.iter().map(still).collect() }
    }

    /// Returns true if time passes or a field changes.
    pub fn passes(&self) -> bool {
        self.duration > 0.0 || self.fields.iter().any(|field| field.from != field.to)
    }
}

/// A step as laws of tractions from gaps see it, besides the gaps at its end.
#[derive(Debug, Clone)]
pub struct LawStep<'a> {
    /// Gaps (g_n, g_t) at its start \[m\], by contact point.
    pub previous_gap: &'a [[f64; 2]],
    /// Its duration \[s\].
    pub time_step: f64,
    /// Fields at its end, by name.
    pub fields: Vec<(&'a str, f64)>,
}

impl PathProblem {
    /// Returns the share of a load step at a factor: 0 at its start, 1 at its end. A load step without a finite end has
    /// no duration and constant fields; its share is 0.
    fn share(&self, load_step: usize, factor: f64) -> f64 {
        let step = &self.load_steps[load_step];
        let (LoadStepEnd::Factor(end) | LoadStepEnd::Collapse(end)) = step.end;
        let range = end - step.start;
        if range == 0.0 || !range.is_finite() { 0.0 } else { (factor - step.start) / range }
    }

    /// Returns the time that passes between two places of a path \[s\]: load steps with factors in them.
    pub fn time_between(&self, from: (usize, f64), to: (usize, f64)) -> f64 {
        let passed = |load_step: usize, share: f64| match self.load_steps[load_step].period.duration {
            duration if duration > 0.0 => duration * share,
            _ => 0.0,
        };
        if from.0 == to.0 {
            return passed(to.0, self.share(to.0, to.1) - self.share(from.0, from.1));
        }
        let between: f64 = (from.0 + 1..to.0).map(|load_step| passed(load_step, 1.0)).sum();
        passed(from.0, 1.0 - self.share(from.0, from.1)) + between + passed(to.0, self.share(to.0, to.1))
    }

    /// Returns the fields at a factor of a load step, by name.
    pub fn fields_at(&self, load_step: usize, factor: f64) -> Vec<(&str, f64)> {
        let share = self.share(load_step, factor);
        let fields = self.load_steps[load_step].period.fields.iter();
        fields.map(|field| (field.name.as_str(), field.from + share * (field.to - field.from))).collect()
    }

    /// Returns a step of laws without duration from a state.
    pub fn law_step_at<'a>(&'a self, state: &'a PathState) -> LawStep<'a> {
        LawStep { previous_gap: &state.gap, time_step: 0.0, fields: self.fields_at(state.load_step, state.factor) }
    }

    /// Returns the step of laws that ends in a state, as the state records it.
    pub fn law_step_to<'a>(&'a self, state: &'a PathState) -> LawStep<'a> {
        let recorded = state.step_gap.len() == state.gap.len();
        let previous_gap = if recorded { &state.step_gap } else { &state.gap };
        LawStep { previous_gap, time_step: state.time_step, ..self.law_step_at(state) }
    }

    /// Returns the step of laws from one state to another.
    pub fn law_step_between<'a>(&'a self, last: &'a PathState, state: &PathState) -> LawStep<'a> {
        LawStep {
            previous_gap: &last.gap,
            time_step: self.time_between((last.load_step, last.factor), (state.load_step, state.factor)),
            fields: self.fields_at(state.load_step, state.factor),
        }
    }

    /// Returns the context of a contact point in a step of laws.
    pub fn point_context<'a>(&self, contact: usize, step: &'a LawStep<'_>) -> PointContext<'a> {
        let point = &self.contacts[contact];
        let place = PointContext::at(point.position.into(), point.area / self.width, self.width);
        place.during(step.previous_gap[contact], step.time_step, Fields::new(&step.fields))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Target;
    use crate::path::{LoadStep, Loading};

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
