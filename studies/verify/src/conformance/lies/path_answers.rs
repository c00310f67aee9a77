//! Path solvers that change one part of a true answer.

use super::path_lie::{PathAsked, PathLie, Story};
use voussoir_core::path::{Branching, ContactEvent, PathEvent, ProvenPeak, StageStability};

/// Changes the factor of a collapse or limit point.
fn factor(story: &mut Story, change: impl FnOnce(f64) -> f64) -> Option<()> {
    story.falls()?;
    story.answer.factor = Some(change(story.answer.factor?));
    Some(())
}

/// Changes the rate at the end of a collapse.
fn motion(story: &mut Story, change: impl FnOnce(&mut Vec<[f64; 3]>)) -> Option<()> {
    story.falls()?;
    change(story.answer.motion.as_mut()?);
    Some(())
}

/// Returns a limit point at a share of the greatest factor.
fn forged_peak(asked: &PathAsked, story: &mut Story, share: f64) -> Option<ProvenPeak> {
    story.falls()?;
    let load_step = asked.problem.load_steps.len() - 1;
    let displacement = share * story.answer.state.displacement;
    Some(ProvenPeak { load_step, factor: share * story.answer.factor?, displacement, lowest: 0.1 })
}

/// Claims that every stage is stable, or unstable.
fn stability(asked: &PathAsked, story: &mut Story, stable: bool) -> Option<()> {
    let stages = asked.problem.load_steps.last()?.stage + 1;
    let claim =
        |stage| StageStability { stage, under_load: Some(stable), under_control: Some(stable), sufficient_only: false };
    story.answer.stability = (0..stages).map(claim).collect();
    Some(())
}

/// Answers with one part changed.
pub const LIES: &[PathLie] = &[
    PathLie::new("factor_5_percent_high", |_, story| factor(story, |factor| 1.05 * factor)),
    PathLie::new("factor_5_percent_low", |_, story| factor(story, |factor| 0.95 * factor)),
    PathLie::new("factor_a_thousandth_high", |_, story| factor(story, |factor| 1.001 * factor)),
    PathLie::new("factor_nan", |_, story| factor(story, |_| f64::NAN)),
    PathLie::new("factor_infinite", |_, story| factor(story, |_| f64::INFINITY)),
    PathLie::new("no_factor", |_, story| {
        story.falls()?;
        story.answer.factor = None;
        Some(())
    }),
    PathLie::new("no_motion", |_, story| motion(story, |motion| motion.fill([0.0; 3]))),
    PathLie::new("empty_motion", |_, story| motion(story, Vec::clear)),
    PathLie::new("nan_in_the_motion", |_, story| motion(story, |motion| motion[1][0] = f64::NAN)),
    PathLie::new("motion_mirrored", |_, story| {
        motion(story, |motion| {
            let free = 1..motion.len();
            motion[free].reverse();
            motion.iter_mut().for_each(|[x, _, turn]| (*x, *turn) = (-*x, -*turn));
        })
    }),
    PathLie::new("motion_backwards", |_, story| {
        motion(story, |motion| motion.iter_mut().flatten().for_each(|v| *v = -*v))
    }),
    PathLie::new("motion_of_the_rise", |asked, story| {
        story.falls()?;
        let index = story.below(0.5)?;
        story.answer.motion = Some(asked.rate(&story.states[index], &story.states[index + 1]));
        Some(())
    }),
    PathLie::new("called_unique", |_, story| {
        story.falls()?;
        story.answer.unique = Some(true);
        Some(())
    }),
    PathLie::new("forged_limit_point", |asked, story| {
        let peak = forged_peak(asked, story, 0.5)?;
        story.answer.limit_points.insert(0, peak);
        Some(())
    }),
    PathLie::new("greater_limit_point", |asked, story| {
        let peak = forged_peak(asked, story, 1.2)?;
        story.answer.limit_points.push(peak);
        Some(())
    }),
    PathLie::new("limit_points_twice", |_, story| {
        let again = story.answer.limit_points.clone();
        story.answer.limit_points.extend(again.first().copied());
        (!again.is_empty()).then_some(())
    }),
    PathLie::new("limit_point_of_a_load_step_that_is_not_there", |asked, story| {
        let peak = forged_peak(asked, story, 0.5)?;
        story.answer.limit_points.push(ProvenPeak { load_step: usize::MAX, ..peak });
        Some(())
    }),
    PathLie::new("limit_point_nan", |asked, story| {
        let peak = forged_peak(asked, story, f64::NAN)?;
        story.answer.limit_points.push(peak);
        Some(())
    }),
    PathLie::new("limit_points_left_out", |_, story| {
        story.falls()?;
        if story.answer.limit_points.is_empty() {
            return None;
        }
        story.answer.limit_points.clear();
        Some(())
    }),
    PathLie::new("stable_everywhere", |asked, story| stability(asked, story, true)),
    PathLie::new("unstable_everywhere", |asked, story| stability(asked, story, false)),
    PathLie::new("stability_of_a_stage_that_is_not_there", |_, story| {
        let claim = StageStability {
            stage: usize::MAX,
            under_load: Some(true),
            under_control: Some(true),
            sufficient_only: false,
        };
        story.answer.stability.push(claim);
        Some(())
    }),
    PathLie::new("forged_events", |asked, story| {
        story.falls()?;
        let what = [ContactEvent::Crushes, ContactEvent::Softens, ContactEvent::SlipsBackward];
        let load_step = asked.problem.load_steps.len() - 1;
        let forged = what.map(|what| PathEvent { load_step, factor: 0.5, contact: 0, what });
        story.answer.events.extend(forged);
        Some(())
    }),
    PathLie::new("event_at_a_contact_that_is_not_there", |_, story| {
        let what = ContactEvent::Opens;
        story.answer.events.push(PathEvent { load_step: usize::MAX, factor: 0.5, contact: usize::MAX, what });
        Some(())
    }),
    PathLie::new("forged_branch", |asked, story| {
        story.falls()?;
        let load_step = asked.problem.load_steps.len() - 1;
        story.answer.branchings.push(Branching { load_step, factor: 0.5, snaps: true, released: 1e3, twins: true });
        Some(())
    }),
    PathLie::new("branch_of_a_load_step_that_is_not_there", |_, story| {
        let branch = Branching { load_step: usize::MAX, factor: f64::NAN, snaps: false, released: -1.0, twins: false };
        story.answer.branchings.push(branch);
        Some(())
    }),
    PathLie::new("ray_besides_a_collapse", |_, story| {
        story.falls()?;
        story.answer.ray = Some(story.answer.state.force.clone());
        Some(())
    }),
];
