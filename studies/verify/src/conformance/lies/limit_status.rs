//! Limit solvers that return a false status or no answer.

use super::limit_lie::LimitLie;
use voussoir_core::limit::{LimitAnswer, LimitQuestion, Status};

/// Reports a collapse as `stands`.
fn stands(answer: &mut LimitAnswer) {
    answer.status = Status::Stands;
    (answer.factor, answer.motion, answer.unique) = (None, None, None);
}

/// False statuses and missing answers.
pub const LIES: &[LimitLie] = &[
    LimitLie::new("stands_for_collapse", |asked| {
        let mut answer = asked.collapse()?;
        stands(&mut answer);
        Some(answer)
    }),
    LimitLie::new("stands_with_a_field_before_the_target", |asked| {
        let mut answer = asked.collapse()?;
        let half = asked.field_at(answer.factor? / 2.0)?;
        stands(&mut answer);
        (answer.field, answer.field_factor) = (half.field, half.field_factor);
        Some(answer)
    }),
    LimitLie::new("stands_at_the_target_by_name", |asked| {
        let mut answer = asked.collapse()?;
        let LimitQuestion::Collapse { max, .. } = asked.question else { return None };
        stands(&mut answer);
        answer.field_factor = max;
        Some(answer)
    }),
    LimitLie::new("stands_at_a_million", |asked| {
        let mut answer = asked.collapse()?;
        stands(&mut answer);
        (answer.field_factor, answer.factor) = (1e6, Some(1e6));
        Some(answer)
    }),
    LimitLie::new("stands_without_a_field", |asked| {
        let mut answer = asked.collapse()?;
        stands(&mut answer);
        answer.field = None;
        Some(answer)
    }),
    LimitLie::new("collapse_for_stands", |asked| {
        let mut answer = asked.ending(Status::Stands)?;
        let LimitQuestion::Collapse { max, .. } = asked.question else { return None };
        let collapse = asked.collapse_of(asked.problem)?;
        answer.status = Status::Collapse;
        (answer.factor, answer.motion) = (Some(max), collapse.motion);
        Some(answer)
    }),
    LimitLie::new("collapse_beyond_the_target", |asked| {
        asked.ending(Status::Stands)?;
        asked.collapse_of(asked.problem)
    }),
    LimitLie::new("limit_point", |asked| {
        let mut answer = asked.collapse()?;
        answer.status = Status::LimitPoint;
        answer.factor = answer.factor.map(|factor| 0.8 * factor);
        Some(answer)
    }),
    LimitLie::new("unbounded_for_collapse", |asked| {
        let mut answer = asked.collapse()?;
        answer.status = Status::Unbounded;
        (answer.ray, answer.factor, answer.motion) = (answer.field.clone(), None, None);
        Some(answer)
    }),
    LimitLie::new("unbounded_by_a_difference_of_fields", |asked| {
        let mut answer = asked.collapse()?;
        let half = asked.field_at(answer.factor? / 2.0)?;
        let mut ray = answer.field.clone()?;
        for (ray, half) in ray.iter_mut().zip(half.field?) {
            ray.normal = [ray.normal[0] - half.normal[0], ray.normal[1] - half.normal[1]];
            ray.shear -= half.shear;
        }
        let share = 2.0 / answer.factor?;
        ray.iter_mut().for_each(|force| {
            force.normal = force.normal.map(|n| n * share);
            force.shear *= share;
        });
        answer.status = Status::Unbounded;
        (answer.ray, answer.factor, answer.motion) = (Some(ray), None, None);
        Some(answer)
    }),
    LimitLie::new("unbounded_without_a_ray", |asked| {
        let mut answer = asked.collapse()?;
        answer.status = Status::Unbounded;
        (answer.factor, answer.motion) = (None, None);
        Some(answer)
    }),
    LimitLie::new("no_equilibrium_for_collapse", |asked| {
        let mut answer = asked.collapse()?;
        answer.status = Status::NoEquilibrium;
        (answer.factor, answer.field) = (None, None);
        Some(answer)
    }),
    LimitLie::new("no_equilibrium_by_a_motion_backwards", |asked| {
        let mut answer = asked.collapse()?;
        answer.status = Status::NoEquilibrium;
        answer.motion.iter_mut().flatten().flatten().for_each(|v| *v = -*v);
        (answer.factor, answer.field) = (None, None);
        Some(answer)
    }),
    LimitLie::new("no_equilibrium_by_falling_through_the_ground", |asked| {
        let mut answer = asked.answer();
        answer.status = Status::NoEquilibrium;
        answer.motion = Some(asked.problem.fixed.iter().map(|w| [w[0], w[1], 0.0]).collect());
        (answer.factor, answer.field) = (None, None);
        Some(answer)
    }),
    LimitLie::new("collapse_for_no_equilibrium", |asked| {
        let mut answer = asked.ending(Status::NoEquilibrium)?;
        answer.status = Status::Collapse;
        (answer.factor, answer.feasible_interval) = (Some(1.0), None);
        Some(answer)
    }),
    LimitLie::new("stands_for_no_equilibrium", |asked| {
        let mut answer = asked.ending(Status::NoEquilibrium)?;
        stands(&mut answer);
        answer.feasible_interval = None;
        Some(answer)
    }),
    LimitLie::new("stands_for_unbounded", |asked| {
        let mut answer = asked.ending(Status::Unbounded)?;
        stands(&mut answer);
        answer.ray = None;
        Some(answer)
    }),
    LimitLie::new("forged_feasible_interval", |asked| {
        let mut answer = asked.collapse()?;
        answer.feasible_interval = Some([0.1, answer.factor?]);
        Some(answer)
    }),
    LimitLie::new("wider_feasible_interval", |asked| {
        let mut answer = asked.ending(Status::NoEquilibrium)?;
        let [low, high] = answer.feasible_interval?;
        answer.feasible_interval = Some([low - 0.1 * low.abs(), high + 0.1 * high.abs()]);
        Some(answer)
    }),
    LimitLie::new("no_answer", |asked| {
        let mut answer = asked.collapse()?;
        (answer.field, answer.motion, answer.factor) = (None, None, None);
        Some(answer)
    }),
    LimitLie::new("panic", |_| panic!("a dishonest solver panics")),
];
