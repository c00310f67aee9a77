//! Path solvers that show false states.

use super::path_lie::{PathAsked, PathLie, Story};
use voussoir_core::limit::Status;
use voussoir_core::path::PathProblem;

/// Replaces the story by the story of another problem.
fn other(asked: &PathAsked, story: &mut Story, change: impl FnOnce(&mut PathProblem)) -> Option<()> {
    story.falls()?;
    let mut problem = asked.problem.clone();
    change(&mut problem);
    *story = asked.story_of(&problem, asked.settings);
    story.falls()
}

/// Replaces the story by the story with displacements read as finite or small.
fn otherwise_finite(asked: &PathAsked, story: &mut Story, finite: bool) -> Option<()> {
    if asked.settings.finite == finite {
        return None;
    }
    let mut settings = asked.settings.clone();
    settings.finite = finite;
    asked.honest.refuses(asked.problem, &settings).is_none().then_some(())?;
    *story = asked.story_of(asked.problem, &settings);
    story.falls()
}

/// A lie that changes all states.
macro_rules! states {
    ($name:literal, $change:expr) => {
        PathLie::new($name, |_, story| {
            story.change($change);
            Some(())
        })
    };
}

/// False states.
pub const LIES: &[PathLie] = &[
    PathLie::new("factors_scaled", |_, story| {
        story.falls()?;
        story.change(|state| state.factor *= 1.05);
        story.answer.factor = story.answer.factor.map(|factor| 1.05 * factor);
        story.answer.limit_points.iter_mut().for_each(|peak| peak.factor *= 1.05);
        Some(())
    }),
    PathLie::new("all_scaled", |_, story| {
        story.falls()?;
        story.change(|state| {
            state.factor *= 1.05;
            state.force.iter_mut().flatten().for_each(|force| *force *= 1.05);
            state.gap.iter_mut().flatten().for_each(|gap| *gap *= 1.05);
            state.motion.iter_mut().flatten().for_each(|motion| *motion *= 1.05);
            state.work *= 1.05 * 1.05;
            state.stored *= 1.05 * 1.05;
            state.dissipated *= 1.05 * 1.05;
        });
        story.answer.factor = story.answer.factor.map(|factor| 1.05 * factor);
        story.answer.limit_points.iter_mut().for_each(|peak| peak.factor *= 1.05);
        Some(())
    }),
    states!("half_the_forces", |state| state.force.truncate(state.force.len() / 2)),
    states!("half_the_motions", |state| state.motion.truncate(state.motion.len() / 2)),
    states!("no_gaps", |state| state.gap.clear()),
    states!("too_many_forces", |state| state.force.push([0.0; 2])),
    states!("zero_forces", |state| state.force.fill([0.0; 2])),
    states!("nan_in_a_force", |state| state.force[0][0] = f64::NAN),
    states!("infinity_in_a_motion", |state| state.motion[0][2] = f64::INFINITY),
    PathLie::new("nan_in_the_last_factor", |_, story| {
        story.states.last_mut()?.factor = f64::NAN;
        Some(())
    }),
    states!("nan_in_the_energies", |state| (state.work, state.stored, state.dissipated) =
        (f64::NAN, f64::NAN, f64::NAN)),
    states!("gaps_scaled", |state| state.gap.iter_mut().flatten().for_each(|gap| *gap *= 1.01)),
    states!("motions_scaled", |state| state.motion.iter_mut().flatten().for_each(|motion| *motion *= 1.01)),
    PathLie::new("displacement_doubled", |_, story| {
        story.falls()?;
        story.change(|state| state.displacement *= 2.0);
        story.answer.limit_points.iter_mut().for_each(|peak| peak.displacement *= 2.0);
        Some(())
    }),
    PathLie::new("negative_dissipation", |_, story| {
        story.falls()?;
        story.change(|state| {
            state.dissipated -= 0.1 * state.work.abs();
            state.stored += 0.1 * state.work.abs();
        });
        Some(())
    }),
    PathLie::new("work_doubled", |_, story| {
        story.falls()?;
        story.change(|state| state.work *= 2.0);
        Some(())
    }),
    PathLie::new("energies_all_doubled", |_, story| {
        story.falls()?;
        story.change(|state| {
            (state.work, state.stored, state.dissipated) =
                (2.0 * state.work, 2.0 * state.stored, 2.0 * state.dissipated)
        });
        Some(())
    }),
    PathLie::new("not_in_order", |_, story| {
        story.falls()?;
        let steps = story.last_step();
        let middle = steps.len() / 2;
        if steps.len() < 4 {
            return None;
        }
        story.states.swap(steps[middle], steps[middle - 1]);
        Some(())
    }),
    PathLie::new("load_steps_not_in_order", |_, story| {
        let step = story.states.last()?.load_step;
        if step == 0 {
            return None;
        }
        story.states.reverse();
        Some(())
    }),
    PathLie::new("load_step_out_of_range", |asked, story| {
        story.change(|state| state.load_step = asked_steps(state.load_step));
        story.answer.load_step = asked.problem.load_steps.len() + 3;
        Some(())
    }),
    PathLie::new("answer_load_step_out_of_range", |_, story| {
        story.answer.load_step = usize::MAX;
        Some(())
    }),
    PathLie::new("answer_of_the_first_load_step", |_, story| {
        story.falls()?;
        if story.answer.load_step == 0 {
            return None;
        }
        story.answer.load_step = 0;
        Some(())
    }),
    PathLie::new("a_load_step_is_left_out", |_, story| {
        story.falls()?;
        let last = story.answer.load_step;
        if last == 0 {
            return None;
        }
        story.states.retain(|state| state.load_step == last);
        Some(())
    }),
    PathLie::new("no_states", |_, story| {
        story.states.clear();
        Some(())
    }),
    PathLie::new("the_last_state_alone", |_, story| {
        story.falls()?;
        let keep = story.states.len() - 1;
        story.states.drain(..keep);
        Some(())
    }),
    PathLie::new("the_first_and_last_state_alone", |_, story| {
        story.falls()?;
        let keep = story.states.len() - 1;
        story.states.drain(1..keep);
        Some(())
    }),
    PathLie::new("an_empty_state", |_, story| {
        story.answer.state = Default::default();
        story.answer.last = None;
        Some(())
    }),
    PathLie::new("small_displacements_as_finite", |asked, story| {
        asked.settings.finite.then_some(())?;
        otherwise_finite(asked, story, false)
    }),
    PathLie::new("finite_displacements_as_small", |asked, story| {
        (!asked.settings.finite).then_some(())?;
        otherwise_finite(asked, story, true)
    }),
    PathLie::new("of_heavier_blocks", |asked, story| {
        other(asked, story, |problem| problem.bodies.iter_mut().for_each(|body| body.mass *= 1.2))
    }),
    PathLie::new("of_a_smaller_load", |asked, story| {
        other(asked, story, |problem| {
            if let Some(step) = problem.load_steps.last_mut() {
                step.loading.forces.iter_mut().for_each(|force| force.3 /= 1.2);
            }
        })
    }),
    PathLie::new("of_stiffer_joints", |asked, story| {
        other(asked, story, |problem| {
            problem.contacts.iter_mut().for_each(|contact| contact.compliance = contact.compliance.map(|c| 0.8 * c));
        })
    }),
    PathLie::new("of_an_open_joint", |asked, story| {
        other(asked, story, |problem| problem.contacts.iter_mut().for_each(|contact| contact.gap += 1e-4))
    }),
    PathLie::new("states_of_heavier_blocks_after_the_dead_load", |asked, story| {
        let (dead, last) = (story.states.clone(), story.answer.load_step);
        other(asked, story, |problem| problem.bodies.iter_mut().for_each(|body| body.mass *= 1.2))?;
        story.states.retain(|state| state.load_step == last);
        let before = dead.into_iter().filter(|state| state.load_step < last);
        story.states.splice(0..0, before);
        Some(())
    }),
    PathLie::new("mirrored", |_, story| {
        story.falls()?;
        story.change(|state| {
            state.motion.iter_mut().for_each(|[x, _, turn]| (*x, *turn) = (-*x, -*turn));
            state.force.iter_mut().for_each(|force| force[1] = -force[1]);
            state.gap.iter_mut().for_each(|gap| gap[1] = -gap[1]);
        });
        Some(())
    }),
    PathLie::new("jump_to_the_peak", |_, story| {
        story.falls()?;
        let index = story.below(0.3)?;
        let (peak, last) = (story.answer.state.clone(), story.answer.last.clone());
        story.states.truncate(index + 1);
        story.states.push(peak);
        story.states.extend(last);
        Some(())
    }),
    PathLie::new("stands_at_a_state_that_was_not_reached", |asked, story| {
        story.falls()?;
        let index = story.below(0.6)?;
        let mut state = story.states[index].clone();
        let before = &story.states[index - 1];
        let share = (1.5 * story.answer.factor? - state.factor) / (state.factor - before.factor);
        let extend = |now: &mut [f64; 2], then: &[f64; 2]| (0..2).for_each(|i| now[i] += share * (now[i] - then[i]));
        state.force.iter_mut().zip(&before.force).for_each(|(now, then)| extend(now, then));
        state.gap.iter_mut().zip(&before.gap).for_each(|(now, then)| extend(now, then));
        for (now, then) in state.motion.iter_mut().zip(&before.motion) {
            (0..3).for_each(|i| now[i] += share * (now[i] - then[i]));
        }
        state.factor = 1.5 * story.answer.factor?;
        story.stop_at(index);
        story.states.push(state.clone());
        (story.answer.state, story.answer.factor, story.answer.motion) = (state, None, None);
        story.answer.status = Status::Stands;
        (asked.problem.contacts.len() == story.answer.state.force.len()).then_some(())
    }),
];

fn asked_steps(step: usize) -> usize {
    step + 1000
}
