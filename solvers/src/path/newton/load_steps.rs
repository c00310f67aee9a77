//! The load steps in order, and the answer.

use super::load_to_factor::load_to_factor;
use super::{pieces, time_steps};
use crate::path::continuation::arc_length::ArcLength;
use crate::path::energy::{EnergyBalance, StageBalance};
use crate::path::newton::model::loads::StagedLoads;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::monitors::resolve;
use crate::path::newton::quantities::recorded::{recorded, work_state};
use crate::path::newton::quantities::response::at_once;
use crate::path::newton::solve::second_order::{StateStability, second_order_work, stability};
use crate::path::newton::tracing::stable_branch::{Departure, leave_unstable};
use crate::path::newton::tracing::tracer::{Ending, InForce, LimitPoint, LoadStepEnding, Record, Tracer, end_path};
use crate::path::outcome::Outcome;
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{LoadStep, LoadStepEnd, PathAnswer, PathObserver, PathProblem, PathSettings, StageStability};

/// Follows all load steps.
pub(super) fn trace(problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
    let mut system = match StepSystem::new(problem, settings.finite) {
        Ok(system) => system,
        Err(why) => return PathAnswer::stalled(why),
    };
    system.tolerance = settings.tolerance;
    let state = system.undeformed();
    let gradient = system.gradient(&state);
    let energy = EnergyBalance::default();
    let seen = recorded(&energy, &system, 0, &state, &gradient);
    let work = work_state(&system, &state, &gradient);
    let mut tracer = Tracer {
        system,
        settings,
        observer,
        in_force: InForce { load_step: 0, strategy: Arc::new(ArcLength::default()) },
        state,
        record: Record {
            energy,
            balance: StageBalance::default(),
            work,
            state: seen,
            events: Vec::new(),
            notes: Vec::new(),
            stability: Vec::new(),
            branchings: Vec::new(),
            witnesses: Vec::new(),
        },
        ending: Ending { status: Status::Stalled, motion: None, ray: None, limit_point_end: None },
        limit: LimitPoint::default(),
    };
    run(&mut tracer, problem);
    answer(tracer)
}

/// Follows the load steps in order.
fn run<'a>(tracer: &mut Tracer<'a, '_>, problem: &'a PathProblem) {
    let mut earlier = Vec::new();
    for (index, load_step) in problem.load_steps.iter().enumerate() {
        tracer.in_force.load_step = index;
        tracer.state.factor = load_step.start;
        tracer.in_force.strategy =
            tracer.settings.strategy(load_step.stage).cloned().unwrap_or_else(|| Arc::new(ArcLength::default()));
        // Missing monitors were refused before the start of the path.
        tracer.system.monitors = resolve(problem, &tracer.in_force.strategy.monitors()).unwrap_or_default();
        tracer.system.load(index, StagedLoads::new(earlier.clone(), &load_step.loading, load_step.start));
        if index > 0 && problem.load_steps[index - 1].period.passes() {
            at_once(&tracer.system, &mut tracer.state);
        }
        let gradient = tracer.system.gradient(&tracer.state);
        tracer.record.work = work_state(&tracer.system, &tracer.state, &gradient);
        let mut outcome = match load_step.end {
            LoadStepEnd::Collapse(most) => pieces::driver::follow(tracer, load_step, most),
            LoadStepEnd::Factor(factor) if load_step.period.passes() => time_steps::follow(tracer, load_step, factor),
            LoadStepEnd::Factor(factor) => load_to_factor(tracer, load_step, factor),
        };
        let ends = problem.load_steps.get(index + 1).is_none_or(|next| next.stage != load_step.stage);
        if ends && matches!(outcome, LoadStepEnding::Reached) {
            outcome = end_stage(tracer, load_step);
        }
        match outcome {
            LoadStepEnding::Reached => earlier.push((tracer.state.factor - load_step.start, &load_step.loading)),
            LoadStepEnding::Ended => {
                if load_step.gravity && tracer.ending.status == Status::Collapse {
                    end_under_gravity(tracer);
                }
                return;
            }
        }
    }
    tracer.ending.status = Status::Stands;
}

/// Ends a path that moves on under a constant share of gravity: without equilibrium if a mechanism proves it. A limit
/// point of gravity stays one: on another path the structure may carry more, and behind it, it may stand again.
fn end_under_gravity(tracer: &mut Tracer) {
    let peak = tracer.limit.peak.as_ref();
    let moves = tracer.ending.motion.is_some() || peak.is_some_and(|peak| peak.motion.is_some());
    tracer.ending.status = if moves { Status::NoEquilibrium } else { Status::LimitPoint };
    let carried = peak.map_or(tracer.state.factor, |peak| peak.factor);
    tracer.record.notes.push(format!("the change of gravity is carried up to {carried:.9} of its value only"));
}

/// Examines the stability of the state at the end of a stage. From an unstable state damped descent leads to a stable
/// one; if no stable state is found, the stage does not stand.
fn end_stage(tracer: &mut Tracer, load_step: &LoadStep) -> LoadStepEnding {
    let settles = tracer.system.settles();
    let state = tracer.state.clone();
    let mut found = stability(&mut tracer.system, &state, settles);
    if tracer.system.finite()
        && found.under_load == Some(false)
        && let Some(work) = second_order_work(&mut tracer.system, &state).filter(|work| work.turned > 0)
    {
        match leave_unstable(tracer, &state, &work, false) {
            Departure::Stopped => return LoadStepEnding::Ended,
            Departure::Falls => {
                let why = "the stage ends in an unstable equilibrium, from which damped descent reaches no stable one";
                record_stability(tracer, load_step.stage, found);
                return end_path(tracer, Status::Stalled, why.into());
            }
            Departure::Stable => {
                let state = tracer.state.clone();
                found = stability(&mut tracer.system, &state, settles);
            }
        }
    }
    record_stability(tracer, load_step.stage, found);
    LoadStepEnding::Reached
}

/// Records the stability of the last state of a stage.
fn record_stability(tracer: &mut Tracer, stage: usize, found: StateStability) {
    let StateStability { under_load, under_control, sufficient_only } = found;
    tracer.record.stability.push(StageStability { stage, under_load, under_control, sufficient_only });
}

/// Returns the answer of a finished trace.
fn answer(mut tracer: Tracer) -> PathAnswer {
    let claims = matches!(tracer.ending.status, Status::LimitPoint | Status::Collapse) && tracer.limit.peak.is_some();
    if let (true, Some(why)) = (claims, tracer.limit.unproven.take()) {
        tracer.limit.peak = None;
        end_path(&mut tracer, Status::Stalled, format!("the limit point on the path is not proven: {why}"));
    }
    if let (Status::LimitPoint | Status::Stalled, Some(factor)) = (tracer.ending.status, tracer.limit.proven) {
        tracer.record.notes.push(format!(
            "at factor {factor} no rate of solution has a factor that grows: all modes of the active contact points are excluded"
        ));
    }
    let mut counters = tracer.system.report.counters.clone();
    for name in ["newton_iterations", "factorisations", "law_evaluations", "steps", "cutbacks"] {
        counters.entry(name.into()).or_default();
    }
    let mut notes = tracer.record.notes;
    if tracer.ending.status != Status::NoEquilibrium
        && let (Some(peak), Some(trough)) = (&tracer.limit.peak, &tracer.limit.trough)
    {
        notes.push(format!(
            "after the peak the load falls to the factor {} at a displacement of {} m and rises again: snap-through",
            trough.factor,
            trough.state.displacement - peak.state.displacement
        ));
    }
    let (state, last, factor, motion) = match tracer.limit.peak {
        Some(peak) => {
            // If bonds soften, every joint moves at a peak: only the end of the path shows the hinges.
            let softens = !tracer.system.laws.responses.is_empty();
            let motion =
                if softens { tracer.ending.motion.or(peak.motion) } else { peak.motion.or(tracer.ending.motion) };
            (peak.state, Some(tracer.record.state), Some(peak.factor), motion)
        }
        None => {
            let factor = matches!(
                tracer.ending.status,
                Status::Collapse | Status::LimitPoint | Status::Stands | Status::NoEquilibrium
            )
            .then_some(tracer.state.factor);
            (tracer.record.state, None, factor, tracer.ending.motion)
        }
    };
    let record = PathAnswer {
        load_step: tracer.in_force.load_step,
        state,
        last,
        events: tracer.record.events,
        limit_points: tracer.limit.proven_peaks,
        stability: tracer.record.stability,
        branchings: tracer.record.branchings,
        witnesses: tracer.record.witnesses,
        counters,
        notes,
        ..PathAnswer::default()
    };
    let outcome =
        Outcome { limit_point_end: tracer.ending.limit_point_end, ..Outcome::at(tracer.ending.status, factor) };
    outcome.moving(motion).carried_by(tracer.ending.ray).answer(tracer.system.problem, tracer.settings.finite, record)
}
