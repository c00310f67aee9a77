//! Path solvers that claim the end at an earlier state, with forged witnesses.

use super::path_lie::{PathAsked, PathLie, Story};
use voussoir_core::limit::Status;
use voussoir_core::path::{
    FarkasVector, LimitPointEnd, ModeTree, NoneContinues, PathRate, PathState, ProvenPeak, RateClaim, Witness,
};

/// Ends the path at a share of its greatest factor, with witnesses that `forge` makes from the true ones.
fn witnessed_early(
    asked: &PathAsked,
    story: &mut Story,
    status: Status,
    forge: impl Fn(ModeTree) -> ModeTree,
) -> Option<()> {
    story.falls()?;
    let index = story.below(0.7)?;
    let state = story.states[index].clone();
    let rate = asked.rate(&state, &story.states[index + 1]);
    let witnesses = std::mem::take(&mut story.answer.witnesses);
    story.stop_at(index);
    story.answer.status = status;
    story.answer.motion = Some(story.answer.motion.take().unwrap_or(rate));
    let trees = witnesses.into_iter().filter_map(|witness| match witness.claim {
        RateClaim::NoneRises(tree) => Some(forge(tree)),
        _ => None,
    });
    let by_motion = ModeTree::Leaf(FarkasVector {
        equilibrium: story.answer.motion.iter().flatten().map(|own| own.map(|v| -v)).collect(),
        gap: vec![[0.0; 2]; asked.problem.contacts.len()],
        work: 0.0,
    });
    let trees: Vec<ModeTree> = trees.chain([forge(by_motion)]).collect();
    let claim = |tree| Witness { state: state.clone(), claim: RateClaim::NoneRises(tree) };
    story.answer.witnesses = trees.into_iter().map(claim).collect();
    let peak = ProvenPeak {
        load_step: state.load_step,
        factor: state.factor,
        displacement: state.displacement,
        lowest: state.factor,
    };
    story.answer.limit_points = vec![peak];
    Some(())
}

/// Returns the same tree with changed numbers in its leaves.
fn with_leaves(tree: ModeTree, change: fn(f64) -> f64) -> ModeTree {
    match tree {
        ModeTree::Leaf(mut vector) => {
            let numbers = vector.equilibrium.as_flattened_mut().iter_mut().chain(vector.gap.as_flattened_mut());
            numbers.for_each(|number| *number = change(*number));
            ModeTree::Leaf(vector)
        }
        ModeTree::Split { contact, branches } => {
            let branches = branches.into_iter().map(|(mode, tree)| (mode, with_leaves(tree, change))).collect();
            ModeTree::Split { contact, branches }
        }
        ModeTree::Before => ModeTree::Before,
    }
}

/// Returns a tree whose first decision has no branch.
fn without_branches(_: ModeTree) -> ModeTree {
    ModeTree::Split { contact: 0, branches: Vec::new() }
}

/// Ends the path at a share of its greatest factor for a reason that the question does not give, with these statements.
fn ends_for_another_reason(
    asked: &PathAsked,
    story: &mut Story,
    end: LimitPointEnd,
    claims: impl Fn(&PathAsked, &Story, usize) -> Vec<RateClaim>,
) -> Option<()> {
    story.falls()?;
    let index = story.below(0.7)?;
    let claims = claims(asked, story, index);
    story.stop_at(index);
    let state = story.answer.state.clone();
    (story.answer.status, story.answer.limit_point_end) = (Status::LimitPoint, Some(end));
    story.answer.motion = None;
    story.answer.witnesses = claims.into_iter().map(|claim| Witness { state: state.clone(), claim }).collect();
    Some(())
}

/// Returns the rate from one state to another, times a factor.
fn rate_between(from: &PathState, to: &PathState, by: f64) -> RateClaim {
    let pairs = |to: &[[f64; 2]], from: &[[f64; 2]]| {
        to.iter().zip(from).map(|(to, from)| [0, 1].map(|i| by * (to[i] - from[i]))).collect()
    };
    let motion = to.motion.iter().zip(&from.motion).map(|(to, from)| [0, 1, 2].map(|i| by * (to[i] - from[i])));
    RateClaim::Rate(PathRate {
        factor: by * (to.factor - from.factor),
        force: pairs(&to.force, &from.force),
        gap: pairs(&to.gap, &from.gap),
        motion: motion.collect(),
    })
}

/// Uses the load on the bodies alone as multipliers: the remainder κ p can be carried only by forces.
fn nothing_carries(asked: &PathAsked) -> ModeTree {
    ModeTree::Leaf(FarkasVector {
        equilibrium: vec![[0.0; 3]; asked.problem.bodies.len()],
        gap: vec![[0.0; 2]; asked.problem.contacts.len()],
        work: 1.0,
    })
}

/// Returns proofs that no rate continues: from the true proof at the end, from earlier modes, or empty.
fn none_continues(asked: &PathAsked, story: &Story, _: usize) -> Vec<RateClaim> {
    let rising = story.answer.witnesses.iter().filter_map(|witness| match &witness.claim {
        RateClaim::NoneRises(tree) => Some(tree.clone()),
        RateClaim::NoneContinues(trees) => Some(trees.rises.clone()),
        RateClaim::Rate(_) => None,
    });
    let trees = rising.chain([ModeTree::Before, nothing_carries(asked)]);
    let claim = |rises| NoneContinues { rises, stands: nothing_carries(asked), falls: ModeTree::Before };
    trees.map(claim).map(RateClaim::NoneContinues).collect()
}

/// Ends the path early at its first limit point, with the rates to other states as witnesses.
fn rate_as_a_limit_point(_: &PathAsked, story: &mut Story, by: f64) -> Option<()> {
    story.falls()?;
    let index = story.below(0.7)?;
    let (state, next) = (story.states[index].clone(), story.states[index + 1].clone());
    let claims = [rate_between(&state, &next, by), rate_between(&state, &story.answer.state, by)];
    story.stop_at(index);
    (story.answer.status, story.answer.motion) = (Status::LimitPoint, None);
    story.answer.witnesses = claims.map(|claim| Witness { state: state.clone(), claim }).into();
    Some(())
}

/// Forged witnesses.
pub const LIES: &[PathLie] = &[
    PathLie::new("witness_of_a_later_state", |asked, story| {
        witnessed_early(asked, story, Status::Collapse, |tree| tree)
    }),
    PathLie::new("witness_of_a_later_limit_point", |asked, story| {
        witnessed_early(asked, story, Status::LimitPoint, |tree| tree)
    }),
    PathLie::new("witness_of_nothing", |asked, story| {
        witnessed_early(asked, story, Status::Collapse, |tree| with_leaves(tree, |_| 0.0))
    }),
    PathLie::new("witness_turned", |asked, story| {
        witnessed_early(asked, story, Status::Collapse, |tree| with_leaves(tree, |number| -number))
    }),
    PathLie::new("witness_nan", |asked, story| {
        witnessed_early(asked, story, Status::Collapse, |tree| with_leaves(tree, |_| f64::NAN))
    }),
    PathLie::new("witness_without_branches", |asked, story| {
        witnessed_early(asked, story, Status::Collapse, without_branches)
    }),
    PathLie::new("unloads_behind_its_limit_point", |_, story| {
        story.falls()?;
        let peak = *story.answer.limit_points.first()?;
        let at_peak = |state: &PathState| state.load_step == peak.load_step && state.factor == peak.factor;
        let index = story.states.iter().position(at_peak)?;
        let motion = story.answer.motion.take();
        story.stop_at(index);
        let of_step = story.states[..index].iter().rev().filter(|state| state.load_step == peak.load_step);
        let back: Vec<PathState> = of_step.cloned().collect();
        story.answer.last = back.last().cloned();
        story.states.extend(back);
        (story.answer.status, story.answer.motion) = (Status::Collapse, motion);
        story.answer.limit_points = vec![ProvenPeak { lowest: story.answer.last.as_ref()?.factor, ..peak }];
        Some(())
    }),
    PathLie::new("no_rate_continues_early", |asked, story| {
        ends_for_another_reason(asked, story, LimitPointEnd::None, none_continues)
    }),
    PathLie::new("joint_lost_early", |asked, story| {
        ends_for_another_reason(asked, story, LimitPointEnd::JointLost, |_, _, _| Vec::new())
    }),
    PathLie::new("joint_lost_at_the_limit_point", |_, story| {
        story.falls()?;
        let peak = story.answer.limit_points.first()?.factor;
        let index = story.states.iter().position(|state| state.factor == peak)?;
        story.stop_at(index);
        (story.answer.status, story.answer.motion) = (Status::LimitPoint, None);
        story.answer.limit_point_end = Some(LimitPointEnd::JointLost);
        Some(())
    }),
    PathLie::new("rate_ahead_as_a_limit_point", |asked, story| rate_as_a_limit_point(asked, story, 1.0)),
    PathLie::new("rate_back_as_a_limit_point", |asked, story| rate_as_a_limit_point(asked, story, -1.0)),
    PathLie::new("states_left_out_before_the_witness", |_, story| {
        story.falls()?;
        let index = story.below(0.3)?;
        let end = story.below(0.9)?;
        story.states.drain(index + 1..=end);
        Some(())
    }),
];
