//! Follows the path from load step to load step and from event to event, up to its end.

use super::direction::{Continued, Next, next_direction};
use super::joint_chain::JointChain;
use super::next_event::{advance, begin_without_end, next_event};
use super::piece::rates::Direction;
use super::stability::stage_stability;
use super::trace::Trace;
use super::unique::unique;
use super::witness::{none_continues, none_rises, rate_witness};
use crate::path::outcome::Outcome;
use crate::path::stability::regains_limit_point;
use crate::path::system::Load;
use crate::rate::proof::NoRate;
use crate::settings::SETTINGS;
use voussoir_core::certificate::flow_residual;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::path::{
    LimitPointEnd, LoadStepEnd, PathAnswer, PathObserver, PathProblem, PathSettings, PathState, ProvenPeak, Witness,
};

/// Number of events of a chain that are recorded first, and then each time their number grows e-fold.
const RECORDED: u64 = 512;

/// The end of a path.
enum End {
    /// The loads are carried.
    Stands,
    /// A limit point.
    LimitPoint,
    /// A limit point from which no rate, rising or falling, continues.
    NoRate,
    /// Not followed further, with the reason.
    Stalled(String),
    /// A direction without an end under a load.
    Ray(Box<Ray>),
}

/// A direction without an end under a load, and the proof that no rate raises the load, if there is one.
struct Ray {
    direction: Direction,
    load: Load,
    proof: Option<NoRate>,
}

/// The present load step.
struct Run {
    load: Load,
    /// Sense of λ: 1 or −1.
    sense: f64,
    start: f64,
    target: f64,
    events: usize,
    most_events: usize,
    unrecorded: Unrecorded,
}

/// Changes since the last record.
#[derive(Default)]
struct Unrecorded {
    events: u64,
    /// Work by the trapezoidal rule and displacement at the load, in scaled units.
    work: f64,
    moved: f64,
    /// λ at the last record.
    factor: f64,
}

impl Unrecorded {
    /// Adds a step along a direction from a factor to the present one.
    fn add(&mut self, trace: &Trace, direction: &Direction, load: &Load, (step, before, sense): (f64, f64, f64)) {
        if self.events == 0 {
            *self = Unrecorded { factor: before, ..Unrecorded::default() };
        }
        let forces = 2 * trace.system.contacts;
        let dot = |own: &mut dyn Iterator<Item = &f64>, rates: &[f64]| -> f64 {
            own.zip(rates).map(|(own, rate)| own * rate).sum()
        };
        // Reciprocity: the work of contact forces on the gaps of the load gives its displacement.
        let rate = dot(&mut load.wrench.iter().flatten(), &direction.x[forces..])
            + dot(&mut load.gap.iter().flatten(), &direction.x[..forces]);
        let moved = sense * rate * step;
        self.events += 1;
        self.work += 0.5 * (before + trace.state.factor) * moved;
        self.moved += moved;
    }

    /// Records the present state.
    fn record(&mut self, trace: &mut Trace) -> bool {
        let trapezoid = 0.5 * (self.factor + trace.state.factor) * self.moved;
        if self.events > 1 {
            trace.state.energy.work += (self.work - trapezoid) * trace.system.units.energy();
        }
        self.events = 0;
        trace.record()
    }
}

/// A path with the data that only its end needs.
struct Follower<'a> {
    trace: Trace<'a>,
    limits: LimitPoints,
    /// Proofs at states of the path.
    witnesses: Vec<Witness>,
}

/// The limit points of a load step.
#[derive(Default)]
struct LimitPoints {
    /// The greatest limit point.
    greatest: Option<PathState>,
    /// Displacement of the load at the last limit point \[m\].
    last: f64,
    /// True if λ has not grown since.
    falling: bool,
    /// All limit points, in order.
    proven: Vec<ProvenPeak>,
}

impl LimitPoints {
    /// Adds a limit point.
    fn add(&mut self, state: PathState, sense: f64) {
        (self.last, self.falling) = (state.displacement, true);
        self.proven.push(proven(&state));
        if self.greatest.as_ref().is_none_or(|greatest| (state.factor - greatest.factor) * sense > 0.0) {
            self.greatest = Some(state);
        }
    }

    /// Records the decrease of λ after the last limit point.
    fn falls_to(&mut self, factor: f64, sense: f64) {
        if let Some(last) = self.proven.last_mut().filter(|last| (last.lowest - factor) * sense > 0.0) {
            last.lowest = factor;
        }
    }

    /// Returns true if all limit points are below a factor.
    fn below(&self, factor: f64, sense: f64) -> bool {
        let above =
            |greatest: &PathState| (factor - greatest.factor) * sense > SETTINGS.inequality() * greatest.factor.abs();
        self.greatest.as_ref().is_none_or(above)
    }
}

/// Returns the limit point at a state.
fn proven(state: &PathState) -> ProvenPeak {
    let PathState { load_step, factor, displacement, .. } = *state;
    ProvenPeak { load_step, factor, displacement, lowest: factor }
}

/// Follows all load steps of a problem.
pub fn follow(problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
    let mut trace = Trace::new(problem, settings, observer);
    trace.factors.chain = JointChain::new(&trace.system, problem);
    let mut follower = Follower { trace, limits: LimitPoints::default(), witnesses: Vec::new() };
    for load_step in 0..problem.load_steps.len() {
        let mut run = begin(&mut follower, load_step);
        if follower.trace.log.last.is_none() && !follower.trace.record() {
            return finish(follower, End::Stalled("stopped by its observer".into()), run.sense);
        }
        let ended = loop {
            match step(&mut follower, &mut run) {
                Ok(true) => {}
                Ok(false) => break None,
                Err(end) => break Some(end),
            }
        };
        if run.unrecorded.events > 0 && !run.unrecorded.record(&mut follower.trace) {
            return finish(follower, End::Stalled("stopped by its observer".into()), run.sense);
        }
        if let Some(end) = ended {
            return finish(follower, end, run.sense);
        }
        let next = problem.load_steps.get(load_step + 1);
        if next.is_none_or(|next| next.stage != problem.load_steps[load_step].stage) {
            let found = stage_stability(&follower.trace, &run.load);
            follower.trace.log.stability.push(found);
        }
        if follower.limits.greatest.is_some() {
            let factor = follower.trace.state.factor;
            follower.trace.log.notes.push(format!("beyond the limit point λ rose again to {factor}"));
            return finish(follower, End::LimitPoint, run.sense);
        }
    }
    finish(follower, End::Stands, 1.0)
}

fn begin(follower: &mut Follower, load_step: usize) -> Run {
    let trace = &mut follower.trace;
    let present = &trace.problem.load_steps[load_step];
    (trace.state.load_step, trace.state.factor, trace.state.sense) = (load_step, present.start, 1.0);
    let (LoadStepEnd::Factor(target) | LoadStepEnd::Collapse(target)) = present.end;
    let sense = match present.end {
        LoadStepEnd::Factor(f) if f < present.start => -1.0,
        _ => 1.0,
    };
    let load = Load::new(&trace.system, trace.problem, &present.loading).reversed_if(sense < 0.0);
    if let Some(factors) = &mut trace.factors.present {
        factors.forget_load();
    }
    if let Some(chain) = &mut trace.factors.chain {
        chain.forget_load();
    }
    trace.factors.refine_columns = false;
    let most_events = 400 + 40 * trace.system.contacts;
    let unrecorded = Unrecorded::default();
    Run { load, sense, start: present.start, target, events: 0, most_events, unrecorded }
}

/// Continues to the next event. Returns true if the load step continues; an error is the end of the path.
fn step(follower: &mut Follower, run: &mut Run) -> Result<bool, End> {
    if (run.target - follower.trace.state.factor) * run.sense <= 0.0 {
        return Ok(false);
    }
    run.events += 1;
    if run.events > run.most_events {
        return Err(End::Stalled(format!(
            "{} events without an end: the path turns in small loops, as friction without dilatancy can; newton_path steps over them",
            run.most_events
        )));
    }
    let (direction, proof, by_chain) = direction(follower, run)?;
    let trace = &mut follower.trace;
    let left = (run.target - trace.state.factor) * run.sense;
    let fallen = (trace.state.factor - run.start) * run.sense;
    let bound = match direction.factor {
        f if f > 0.0 => left / f,
        f if f < 0.0 => fallen.max(0.0) / -f,
        _ => f64::INFINITY,
    };
    let (step, hits) = next_event(trace, &direction, if by_chain { SETTINGS.shift() } else { SETTINGS.residual() });
    let whole = bound <= step;
    let step = step.min(bound);
    if step.is_infinite() {
        begin_without_end(trace, &direction);
        return Err(End::Ray(Box::new(Ray { direction, load: run.load.clone(), proof })));
    }
    let before = trace.state.factor;
    advance(trace, &direction, step, run.sense, if whole { &[] } else { &hits });
    run.unrecorded.add(trace, &direction, &run.load, (step, before, run.sense));
    if whole && direction.factor > 0.0 {
        trace.state.factor = run.target;
    }
    let factors = [before, trace.state.factor];
    trace.state.stable_under_load = regains_limit_point(&follower.limits.proven, trace.state.load_step, factors)
        .then(|| stage_stability(trace, &run.load).under_load)
        .flatten();
    // A chain has many events; only some of them are recorded.
    let all = !by_chain || whole || follower.limits.greatest.is_some();
    if (all || run.unrecorded.events * RECORDED >= trace.log.counts.rate_problems) && !run.unrecorded.record(trace) {
        return Err(End::Stalled("stopped by its observer".into()));
    }
    follower.limits.falls_to(trace.state.factor, run.sense);
    if whole && direction.factor < 0.0 {
        trace.log.notes.push("beyond the limit point λ fell back to where the loads began".into());
        return Err(End::LimitPoint);
    }
    stops(follower, run)
}

/// Returns true if a load step continues; it ends at the requested distance beyond its last limit point.
fn stops(follower: &Follower, run: &Run) -> Result<bool, End> {
    let (trace, limits) = (&follower.trace, &follower.limits);
    if limits.greatest.is_none() {
        return Ok(true);
    }
    let stage = trace.problem.load_steps[trace.state.load_step].stage;
    if trace.settings.ends_at_first_limit_point(stage) {
        return Err(End::LimitPoint);
    }
    let [displacement, factor] = trace.settings.stop(stage);
    let moved = displacement.is_some_and(|most| (trace.displacement() - limits.last).abs() > most);
    let fallen = factor.is_some_and(|least| limits.falling && (trace.state.factor - least) * run.sense <= 0.0);
    match moved || fallen {
        true if limits.below(trace.state.factor, run.sense) => Err(End::Stalled(format!(
            "still rising: where the load has moved on by stop.displacement its factor {} is above all limit points",
            trace.state.factor
        ))),
        true => Err(End::LimitPoint),
        false => Ok(true),
    }
}

/// Returns the direction of the path, a proof that no rate raises the load, and true if the chain gave the direction.
/// If λ begins to fall, the limit point is recorded.
fn direction(follower: &mut Follower, run: &mut Run) -> Result<(Direction, Option<NoRate>, bool), End> {
    let factor = follower.trace.state.factor;
    let Continued { next, none_rises: proof, by_chain } = next_direction(&mut follower.trace, &run.load);
    let mut undecided = false;
    let (direction, note) = match next {
        Next::Go(direction) => {
            follower.limits.falling &= direction.factor <= 0.0;
            return Ok((direction, proof, by_chain));
        }
        Next::Falling(direction) => (
            Some(direction),
            format!("at λ = {factor:.12} it is proved that no rate has λ rising; the path goes on with λ falling"),
        ),
        Next::Nothing => (
            None,
            format!(
                "at λ = {factor:.12} it is proved that no rate goes on, rising or falling; the further motion is dynamic"
            ),
        ),
        Next::NoneRises(why) => {
            undecided = true;
            let note = format!(
                "at λ = {factor:.12} it is proved that no rate has λ rising; it is not decided whether a rate stands still or falls: {why}"
            );
            (None, note)
        }
        Next::Lost(why) => return Err(End::Stalled(why)),
    };
    if run.unrecorded.events > 0 && !run.unrecorded.record(&mut follower.trace) {
        return Err(End::Stalled("stopped by its observer".into()));
    }
    if direction.is_none() || follower.limits.greatest.is_none() {
        follower.trace.log.notes.push(note);
    }
    if !follower.limits.falling {
        follower.limits.add(follower.trace.present(), run.sense);
        let witness = none_rises(&mut follower.trace, &run.load, proof.as_ref());
        follower.witnesses.extend(witness);
    }
    match direction {
        Some(direction) => Ok((direction, None, by_chain)),
        None if undecided => Err(End::Stalled("the path was not followed beyond its limit point".into())),
        None => {
            let witness = none_continues(&mut follower.trace, &run.load, run.sense);
            follower.witnesses.extend(witness);
            Err(End::NoRate)
        }
    }
}

fn finish(mut follower: Follower, end: End, sense: f64) -> PathAnswer {
    let outcome = match end {
        End::Stands => Outcome::at(Status::Stands, Some(follower.trace.state.factor)),
        End::LimitPoint => Outcome::at(Status::LimitPoint, None),
        End::NoRate => Outcome { limit_point_end: Some(LimitPointEnd::None), ..Outcome::at(Status::LimitPoint, None) },
        End::Stalled(why) => {
            follower.trace.log.notes.push(why);
            Outcome::at(Status::Stalled, None)
        }
        End::Ray(ray) => ray_outcome(&mut follower, &ray, sense),
    };
    answer(follower, outcome)
}

/// Returns the outcome of a direction without an end: a mechanism if λ is constant, otherwise a ray.
fn ray_outcome(follower: &mut Follower, Ray { direction, load, proof }: &Ray, sense: f64) -> Outcome {
    let trace = &mut follower.trace;
    let (contacts, force_unit) = (trace.system.contacts, trace.system.units.force);
    if direction.factor > 0.0 {
        let of = |c: usize| [0, 1].map(|i| direction.x[2 * c + i] * force_unit / direction.factor * sense);
        let ray = (0..contacts).map(of).collect();
        let witness = rate_witness(trace, direction, sense);
        follower.witnesses.push(witness);
        return Outcome::at(Status::Unbounded, None).carried_by(Some(ray));
    }
    if direction.factor < 0.0 {
        trace.log.notes.push("beyond the limit point λ falls without end".into());
        return Outcome::at(Status::LimitPoint, None);
    }
    let q = &direction.x[2 * contacts..];
    let power: f64 = load.wrench.iter().flatten().zip(q).map(|(w, q)| w * q).sum();
    // p·q̇ = 1 in physical units.
    let physical = power * trace.system.units.energy() * sense;
    let scale = if physical.abs() > 0.0 { 1.0 / physical.abs() } else { 1.0 };
    let motion: Vec<[f64; 3]> = trace.system.motions(q).into_iter().map(|b| b.map(|v| v * scale)).collect();
    let gravity = trace.problem.load_steps[trace.state.load_step].gravity;
    let greatest = follower.limits.below(trace.state.factor, sense);
    let outcome = match (&follower.limits.greatest, gravity) {
        (None, true) => Outcome::at(Status::NoEquilibrium, None),
        (None, false) => Outcome::at(Status::Collapse, Some(trace.state.factor)),
        (Some(_), false) if greatest => {
            trace
                .log
                .notes
                .push(format!("the load rose above all limit points again ({} of them)", follower.limits.proven.len()));
            Outcome::at(Status::Collapse, Some(trace.state.factor))
        }
        (Some(_), _) => {
            trace.log.notes.push("beyond the limit point the path ends in a mechanism".into());
            Outcome::at(Status::LimitPoint, None)
        }
    };
    // With associated flow the mechanism is itself the proof.
    if matches!(outcome.status, Status::Collapse | Status::NoEquilibrium) {
        let witness = if trace.associated { None } else { none_rises(trace, load, proof.as_ref()) };
        follower.witnesses.extend(witness);
    }
    let trace = &mut follower.trace;
    let unique = unique(&trace.system, &trace.state.points, load, &direction.x, &direction.gaps);
    // The mechanism belongs to the last state; the state at the limit point may not allow it.
    let allowed = |state: &PathState| flow_residual(trace.problem, &state.force, &motion) <= SETTINGS.distinct();
    let limit = follower.limits.greatest.as_ref().filter(|_| outcome.status == Status::LimitPoint);
    let allowed = limit.is_none_or(allowed);
    Outcome { unique, ..outcome.moving(allowed.then_some(motion)) }
}

/// Returns the answer at the present state, or at the limit point with the present state as its last one.
fn answer(follower: Follower, mut outcome: Outcome) -> PathAnswer {
    let Follower { trace, mut limits, witnesses, .. } = follower;
    let present = trace.present();
    let problem = trace.problem;
    let log = trace.log;
    let mut counters = Counters::new();
    for (name, count) in [
        ("factorisations", log.counts.factorisations),
        ("solves", log.counts.solves),
        ("rate_problems", log.counts.rate_problems),
        ("rate_trials", log.counts.rates.trials),
        ("bifurcations", log.branchings.len() as u64),
        ("rate_problems_by_redundants", log.counts.by_chain),
        ("events", log.events.len() as u64),
    ] {
        counters.insert(name.into(), count);
    }
    counters.extend(log.counts.rates.decided.iter().map(|(by, count)| (by.name().to_string(), *count)));
    counters.extend(problem.counters.iter().map(|(name, count)| (name.clone(), *count)));
    let (state, last) = match (outcome.status, limits.greatest) {
        (Status::LimitPoint, Some(limit)) => (limit, Some(present)),
        _ => (present, None),
    };
    if outcome.status == Status::LimitPoint {
        outcome.factor = Some(state.factor);
    }
    if outcome.status == Status::LimitPoint && limits.proven.is_empty() {
        limits.proven.push(proven(&state));
    }
    let (load_step, limit_points) = (state.load_step, limits.proven);
    let (stability, branchings, events, notes) = (log.stability, log.branchings, log.events, log.notes);
    let record = PathAnswer {
        load_step,
        state,
        last,
        limit_points,
        stability,
        branchings,
        events,
        witnesses,
        counters,
        notes,
        ..PathAnswer::default()
    };
    outcome.unconfirmed(record)
}
