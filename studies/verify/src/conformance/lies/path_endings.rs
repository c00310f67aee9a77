//! Path solvers that end a path falsely: early, retraced, with a false status.

use super::path_lie::{PathAsked, PathLie, Story};
use voussoir_core::limit::Status;
use voussoir_core::path::{LoadStepEnd, PathState, ProvenPeak};

/// Ends the path at a share of its greatest factor, with a status.
fn ends_early(asked: &PathAsked, story: &mut Story, status: Status) -> Option<()> {
    story.falls()?;
    let index = story.below(0.6)?;
    let rate = asked.rate(&story.states[index], &story.states[index + 1]);
    story.stop_at(index);
    story.answer.status = status;
    story.answer.motion = Some(rate);
    Some(())
}

/// Returns a peak at a state.
fn peak(state: &PathState, lowest: f64) -> ProvenPeak {
    ProvenPeak { load_step: state.load_step, factor: state.factor, displacement: state.displacement, lowest }
}

/// The path rises to a share of its greatest factor and then returns along the same states.
fn retrace(asked: &PathAsked, story: &mut Story, status: Status) -> Option<()> {
    story.falls()?;
    let index = story.below(0.7)?;
    let rate = asked.rate(&story.states[index], &story.states[index + 1]);
    story.stop_at(index);
    let step = story.states[index].load_step;
    let back: Vec<_> = story.states[..index].iter().rev().filter(|state| state.load_step == step).cloned().collect();
    story.states.extend(back);
    let turn = story.states[index].clone();
    let last = story.states.last()?.clone();
    story.answer.status = status;
    story.answer.limit_points = vec![peak(&turn, last.factor)];
    (story.answer.last, story.answer.motion) = (Some(last), Some(rate));
    Some(())
}

/// Ends the path early and claims that its last state has reached the target.
fn claim_target(asked: &PathAsked, story: &mut Story, keep: f64) -> Option<()> {
    story.falls()?;
    let index = story.below(keep)?;
    story.stop_at(index);
    let step = &asked.problem.load_steps[story.states[index].load_step];
    let (LoadStepEnd::Factor(target) | LoadStepEnd::Collapse(target)) = step.end;
    let target = if target.is_finite() { target } else { 1e6 };
    story.states[index].factor = target;
    story.answer.state = story.states[index].clone();
    (story.answer.status, story.answer.factor) = (Status::Stands, None);
    Some(())
}

/// False endings.
pub const LIES: &[PathLie] = &[
    PathLie::new("stands_early", |asked, story| {
        ends_early(asked, story, Status::Stands)?;
        (story.answer.factor, story.answer.motion) = (None, None);
        Some(())
    }),
    PathLie::new("collapse_early", |asked, story| ends_early(asked, story, Status::Collapse)),
    PathLie::new("limit_point_early", |asked, story| {
        ends_early(asked, story, Status::LimitPoint)?;
        story.answer.limit_points = vec![peak(&story.answer.state, 0.4 * story.answer.state.factor)];
        Some(())
    }),
    PathLie::new("limit_point_early_without_a_peak", |asked, story| {
        ends_early(asked, story, Status::LimitPoint)?;
        story.answer.motion = None;
        Some(())
    }),
    PathLie::new("unbounded_early", |asked, story| {
        ends_early(asked, story, Status::Unbounded)?;
        (story.answer.ray, story.answer.factor) = (Some(story.answer.state.force.clone()), None);
        Some(())
    }),
    PathLie::new("unbounded_without_a_ray", |asked, story| {
        ends_early(asked, story, Status::Unbounded)?;
        story.answer.factor = None;
        Some(())
    }),
    PathLie::new("no_equilibrium_early", |asked, story| {
        ends_early(asked, story, Status::NoEquilibrium)?;
        story.answer.factor = None;
        Some(())
    }),
    PathLie::new("stands_after_the_peak", |_, story| {
        story.falls()?;
        (story.answer.status, story.answer.factor, story.answer.motion) = (Status::Stands, None, None);
        story.answer.limit_points.clear();
        Some(())
    }),
    PathLie::new("stands_at_the_target_by_name", |asked, story| claim_target(asked, story, 0.6)),
    PathLie::new("stands_before_the_stage", |_, story| {
        story.falls()?;
        let first = *story.last_step().first()?;
        story.stop_at(first.saturating_sub(1));
        story.answer.load_step += 1;
        (story.answer.status, story.answer.factor, story.answer.motion) = (Status::Stands, None, None);
        Some(())
    }),
    PathLie::new("collapse_of_a_structure_that_stands", |asked, story| {
        if story.answer.status != Status::Stands || story.states.len() < 2 {
            return None;
        }
        let index = story.states.len() - 1;
        let rate = asked.rate(&story.states[index - 1], &story.states[index]);
        story.stop_at(index);
        (story.answer.status, story.answer.motion) = (Status::Collapse, Some(rate));
        Some(())
    }),
    PathLie::new("retraced_as_collapse", |asked, story| retrace(asked, story, Status::Collapse)),
    PathLie::new("retraced_as_limit_point", |asked, story| retrace(asked, story, Status::LimitPoint)),
    PathLie::new("falls_without_states", |asked, story| {
        ends_early(asked, story, Status::Collapse)?;
        let turn = story.answer.state.clone();
        let mut fallen = turn.clone();
        fallen.factor *= 0.4;
        story.states.push(fallen.clone());
        story.answer.limit_points = vec![peak(&turn, fallen.factor)];
        story.answer.last = Some(fallen);
        Some(())
    }),
    PathLie::new("falling_state_as_the_peak", |_, story| {
        story.falls()?;
        let greatest = story.answer.factor?;
        let fallen = story.last_step().into_iter().rev().map(|index| story.states[index].clone());
        let fallen = fallen.take_while(|state| state.factor < greatest).find(|state| state.factor < 0.95 * greatest)?;
        let lowest = story.states.last()?.factor;
        story.answer.limit_points = vec![peak(&fallen, lowest)];
        (story.answer.factor, story.answer.state) = (Some(fallen.factor), fallen);
        Some(())
    }),
    PathLie::new("peak_before_its_last_rise", |_, story| {
        story.falls()?;
        let index = story.below(0.9)?;
        let early = story.states[index].clone();
        story.answer.limit_points = vec![peak(&early, 0.4 * early.factor)];
        (story.answer.factor, story.answer.state) = (Some(early.factor), early);
        Some(())
    }),
    PathLie::new("panic", |_, _| panic!("a dishonest solver panics")),
];
