//! Following the drives: load steps, continuation, peaks, and what ends a path.

use super::kinematics::Slopes;
use super::law::Regime;
use super::ledger::{Ledger, events};
use super::model::{Control, Loaded, Model, Rate, Refusal, State, load_size};
use super::softening::MOST_REFINEMENTS;
use std::sync::Arc;
use voussoir_core::geometry::Vec2;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::path::certificate::flow_residual;
use voussoir_core::path::{
    Continuation, Drive, DriveEnd, Increment, PathAnswer, PathEvent, PathObserver, PathProblem, PathSettings, PathState,
};

/// Greatest number of steps of a drive.
const MOST_STEPS: u64 = 5000;

/// Movement in a step with finite displacements where the strategy sets no bound, as a share of the
/// scene's size.
const LARGEST_FINITE_STEP: f64 = 0.002;

/// Slip that the pairing of contact points bears with finite displacements, as a share of the joint.
const LARGEST_SLIP: f64 = 0.05;

/// Why there is no first state.
const NO_START: &str = "the first load has no state that Newton's method or pivoting found, and no proof that there is none: friction that is not associated may leave no state, or several; try event_path, smaller stages, or limit_least";

/// How a drive ended.
enum Outcome {
    /// At its factor.
    Reached,
    /// The path ends here.
    Ended,
}

/// A peak or limit point.
pub(super) struct Peak {
    pub state: PathState,
    pub factor: f64,
    pub motion: Option<Vec<[f64; 3]>>,
}

pub(super) struct Tracer<'a, 'o> {
    pub(super) model: Model<'a>,
    settings: &'a PathSettings,
    strategy: Arc<dyn Continuation>,
    observer: &'o mut dyn PathObserver,
    pub(super) ledger: Ledger,
    pub(super) slopes: Slopes,
    events: Vec<PathEvent>,
    pub(super) notes: Vec<String>,
    pub(super) state: State,
    pub(super) recorded: PathState,
    pub(super) drive: usize,
    status: Status,
    motion: Option<Vec<[f64; 3]>>,
    ray: Option<Vec<[f64; 2]>>,
    pub(super) peak: Option<Peak>,
    /// Why the first limit point is not proven to be one.
    doubt: Option<String>,
}

/// Follows all drives.
pub(super) fn trace(
    problem: &PathProblem,
    settings: &PathSettings,
    strategy: Arc<dyn Continuation>,
    observer: &mut dyn PathObserver,
) -> PathAnswer {
    let model = match Model::new(problem, settings.finite) {
        Ok(model) => model,
        Err(why) => return stalled(why),
    };
    let state = model.undeformed();
    let slopes = model.slopes(&state);
    let recorded = Ledger::default().recorded(&model, 0, &state, &slopes);
    let mut tracer = Tracer {
        model,
        settings,
        strategy,
        observer,
        ledger: Ledger::default(),
        slopes,
        events: Vec::new(),
        notes: Vec::new(),
        state,
        recorded,
        drive: 0,
        status: Status::Stalled,
        motion: None,
        ray: None,
        peak: None,
        doubt: None,
    };
    tracer.run(problem);
    tracer.answer()
}

/// An answer that says only why there is none.
pub(super) fn stalled(why: String) -> PathAnswer {
    PathAnswer {
        status: Status::Stalled,
        drive: 0,
        factor: None,
        state: PathState::default(),
        last: None,
        motion: None,
        unique: None,
        ray: None,
        events: Vec::new(),
        counters: Counters::new(),
        notes: vec![why],
    }
}

impl<'a> Tracer<'a, '_> {
    fn run(&mut self, problem: &'a PathProblem) {
        let mut earlier = Vec::new();
        for (index, drive) in problem.drives.iter().enumerate() {
            self.drive = index;
            self.state.factor = drive.start;
            self.model.load(Loaded { earlier: earlier.clone(), growing: &drive.loading, start: drive.start });
            self.slopes = self.model.slopes(&self.state);
            let outcome = match drive.end {
                DriveEnd::Factor(factor) => self.reach(drive, factor),
                DriveEnd::Collapse(most) => self.follow(drive, most),
            };
            match outcome {
                Outcome::Reached => earlier.push((self.state.factor - drive.start, &drive.loading)),
                Outcome::Ended => {
                    if drive.gravity && matches!(self.status, Status::Collapse | Status::LimitPoint) {
                        self.notes.push(format!(
                            "the change of gravity is carried up to {:.9} of its value only",
                            self.peak.as_ref().map_or(self.state.factor, |p| p.factor)
                        ));
                        self.status = Status::NoEquilibrium;
                    }
                    return;
                }
            }
        }
        self.status = if self.peak.is_some() { Status::LimitPoint } else { Status::Stands };
    }

    fn answer(mut self) -> PathAnswer {
        if let (Status::LimitPoint, Some(why)) = (self.status, self.doubt.take()) {
            self.peak = None;
            self.end(Status::Stalled, format!("the limit point on the path is not proven: {why}"));
        }
        let mut counters = self.model.counters.clone();
        for name in ["newton_iterations", "factorisations", "law_evaluations", "steps", "cutbacks"] {
            counters.entry(name.into()).or_default();
        }
        let mut notes = self.notes;
        let r = &self.recorded;
        let (balance, size) = (r.work - r.stored - r.dissipated, r.work.abs() + r.stored.abs() + r.dissipated.abs());
        if size > 1e-12 * self.model.units.force * self.model.units.displacement {
            notes.push(format!(
                "energy balance at the last state: work − stored − dissipated = {:.3e} of their sum (trapezoidal rule over the steps)",
                balance / size
            ));
        }
        let (state, last, factor, motion) = match self.peak {
            Some(peak) => {
                // Where bonds soften every joint moves at a peak: only the end shows which ones are hinges.
                let problem = self.model.problem;
                let softens = !self.model.responses.is_empty();
                // The mechanism of the last state may not be one at the peak.
                let fits = |motion: &Vec<[f64; 3]>| {
                    softens || self.model.finite() || flow_residual(problem, &peak.state.force, motion) <= 1e-6
                };
                let of_peak = peak.motion.filter(|_| self.model.finite() || !softens).filter(fits);
                let of_end = self.motion.filter(fits);
                let motion = if softens { of_end.or(of_peak) } else { of_peak.or(of_end) };
                (peak.state, Some(self.recorded), Some(peak.factor), motion)
            }
            None => {
                let factor = matches!(
                    self.status,
                    Status::Collapse | Status::LimitPoint | Status::Stands | Status::NoEquilibrium
                )
                .then_some(self.state.factor);
                (self.recorded, None, factor, self.motion)
            }
        };
        PathAnswer {
            status: self.status,
            drive: self.drive,
            factor,
            state,
            last,
            motion,
            unique: None,
            ray: self.ray,
            events: self.events,
            counters,
            notes,
        }
    }

    /// Takes a converged state as the next one. Whether to go on.
    fn commit(&mut self, mut next: State) -> bool {
        if !self.model.finite() {
            self.model.clean(&mut next, self.model.loaded.start);
        }
        let slopes = self.model.slopes(&next);
        self.events.extend(events(&self.model, self.drive, &self.state, &next));
        self.ledger.add(&self.model, &self.state, &next, [&self.slopes, &slopes]);
        let start = self.state.clone();
        self.model.keep(&start, &mut next);
        self.recorded = self.ledger.recorded(&self.model, self.drive, &next, &slopes);
        self.state = next;
        self.slopes = slopes;
        self.model.count("steps", 1);
        if !self.observer.state(self.model.problem, &self.recorded) {
            self.end(Status::Stalled, "stopped by the observer".into());
            return false;
        }
        if self.model.finite()
            && let Some(why) = self.left_its_pairing()
        {
            let status = if self.peak.is_some() { Status::Collapse } else { Status::Stalled };
            self.end(status, why);
            return false;
        }
        true
    }

    fn end(&mut self, status: Status, note: String) {
        self.status = status;
        if !note.is_empty() {
            self.notes.push(note);
        }
    }

    /// Slip that the fixed pairing of contact points does not bear.
    fn left_its_pairing(&self) -> Option<String> {
        let problem = self.model.problem;
        let mut heights: Vec<(usize, Vec2, Vec2)> = Vec::new();
        for c in &problem.contacts {
            match heights.last_mut() {
                Some((joint, _, end)) if *joint == c.joint => *end = c.position,
                _ => heights.push((c.joint, c.position, c.position)),
            }
        }
        let largest = self.state.force.iter().flatten().map(|r| r.abs()).fold(0.0, f64::max);
        let mut joints = heights.iter().peekable();
        for (index, c) in problem.contacts.iter().enumerate() {
            while joints.peek().is_some_and(|j| j.0 != c.joint) {
                joints.next();
            }
            let (_, from, to) = joints.peek()?;
            let (slip, height) = (self.state.gap[index][1].abs(), (to - from).norm());
            let pressed = self.state.force[index][0] > 1e-9 * largest;
            if pressed && height > 0.0 && slip > LARGEST_SLIP * height {
                return Some(format!(
                    "joint {} has slipped by {:.1} % of its height at factor {}: contact points are paired for less",
                    c.joint,
                    100.0 * slip / height,
                    self.state.factor
                ));
            }
        }
        None
    }

    /// To a factor: in one step where nothing irreversible happens in it, else in steps.
    fn reach(&mut self, drive: &Drive, factor: f64) -> Outcome {
        let control = Control::Factor(factor);
        let whole = self.model.newton(&self.state, self.state.clone(), &control);
        let small = !self.model.finite();
        if let Ok((next, iterations)) = whole {
            let slips = (0..next.gap.len()).any(|c| {
                let gap = self.model.step_gap(&self.state, &next, c);
                self.model.law(c).is_some_and(|law| {
                    !law.opens(next.regime[c]) && law.irreversible(next.regime[c], gap).0 != [0.0; 2]
                })
            });
            let slips = slips || next.blocks.iter().flatten().any(|inner| inner.linear.yielding > 0);
            let far = !small && iterations > 12;
            let straight = !slips && !far && !self.model.response_yields(&next);
            if straight || (small && self.proportional()) {
                return if self.commit(next) { Outcome::Reached } else { Outcome::Ended };
            }
            if small && self.model.monotone() {
                return self.stepped(drive, factor);
            }
        }
        if small && self.proportional() {
            return self.started(drive, factor);
        }
        self.follow(drive, factor)
    }

    /// The first drive where it is proportional and no state at its factor was found: by a spring, which
    /// has a solution whatever the load. If λ grows with it, that state in proportion is the one looked
    /// for. If λ stays at nothing, the motion is a mechanism. Where flow is not associated that proves
    /// something only if λ stays at nothing with associated flow too.
    fn started(&mut self, drive: &Drive, factor: f64) -> Outcome {
        let direction = if factor < drive.start { -1.0 } else { 1.0 };
        let control = Control::Spring { weight: self.spring(), length: direction };
        let nothing = 1e-9 * self.model.units.factor;
        if !self.model.monotone()
            && let Some(next) = self.model.turned(&self.state, factor)
        {
            return if self.commit(next) { Outcome::Reached } else { Outcome::Ended };
        }
        let own = self.model.pivoted(&self.state, &self.state.clone(), &control);
        let Ok((state, _)) = own else {
            self.end(Status::Stalled, NO_START.into());
            return Outcome::Ended;
        };
        if (state.factor - drive.start) * direction > nothing {
            let guess = self.model.in_proportion(&state, (factor - drive.start) / (state.factor - drive.start));
            return match self.model.iterate(&self.state, guess, &Control::Factor(factor), 8) {
                Ok((next, _)) if self.commit(next.clone()) => Outcome::Reached,
                Ok(_) => Outcome::Ended,
                Err(_) => self.follow(drive, factor),
            };
        }
        if !self.model.monotone() {
            let polygons = self.model.associated();
            let other = self.model.pivoted(&self.state, &self.state.clone(), &control);
            self.model.polygons = polygons;
            if !other.is_ok_and(|(other, _)| (other.factor - drive.start) * direction <= nothing) {
                self.end(Status::Stalled, NO_START.into());
                return Outcome::Ended;
            }
        }
        let mut rate = Rate {
            force: vec![[0.0; 2]; state.force.len()],
            motion: state.motion.clone(),
            factor: 0.0,
            gap: state.gap.clone(),
        };
        let size = self.model.motion_size(&rate).max(1e-300);
        rate = rate.scaled(1.0 / size);
        self.motion = self.scaled_motion(&self.state, &rate);
        self.end(Status::Collapse, String::new());
        Outcome::Ended
    }

    /// Whether the path to any factor is a straight line: nothing has happened yet, and neither gaps nor
    /// strengths give a load a size to be compared with.
    fn proportional(&self) -> bool {
        let problem = self.model.problem;
        let untouched = self.state.force.iter().flatten().chain(self.state.gap.iter().flatten()).all(|v| *v == 0.0);
        let linear = self.model.piecewise_linear();
        linear && untouched && problem.facets.iter().flatten().all(|f| f.bound == 0.0)
    }

    /// To a factor that is known to be carried, in equal steps of λ (associated flow: what carries a
    /// factor carries all between).
    fn stepped(&mut self, drive: &Drive, factor: f64) -> Outcome {
        let from = self.state.factor;
        let mut last: Option<State> = None;
        let mut at = 0.0;
        let mut share: f64 = 1.0 / 16.0;
        while at < 1.0 {
            let next_at = if at + share > 1.0 - 1e-9 { 1.0 } else { at + share };
            let target = if next_at < 1.0 { from + next_at * (factor - from) } else { factor };
            let mut guess = self.state.clone();
            if let Some(last) = &last {
                let ratio = (target - self.state.factor) / (self.state.factor - last.factor);
                for c in 0..guess.force.len() {
                    (0..2).for_each(|k| guess.force[c][k] += ratio * (guess.force[c][k] - last.force[c][k]));
                }
                for b in 0..guess.motion.len() {
                    (0..3).for_each(|k| guess.motion[b][k] += ratio * (guess.motion[b][k] - last.motion[b][k]));
                }
            }
            match self.model.newton(&self.state, guess, &Control::Factor(target)) {
                Ok((next, _)) => {
                    last = Some(self.state.clone());
                    if !self.commit(next) {
                        return Outcome::Ended;
                    }
                    at = next_at;
                }
                Err(_) => {
                    self.model.count("cutbacks", 1);
                    share *= 0.5;
                    if share < 1e-4 {
                        return self.follow(drive, factor);
                    }
                }
            }
        }
        Outcome::Reached
    }

    /// By the strategy, up to a factor or the end of the path.
    fn follow(&mut self, drive: &Drive, target: f64) -> Outcome {
        let direction = if target < drive.start { -1.0 } else { 1.0 };
        let strategy = self.strategy.clone();
        let unit = self.model.units.factor;
        if target == self.state.factor {
            return Outcome::Reached;
        }
        let to_factor = matches!(drive.end, DriveEnd::Factor(_));
        self.model.rest(&mut self.state);
        let Some(first) = self.model.rate(&self.state, &self.state, &Control::Factor(target)) else {
            self.end(
                Status::Stalled,
                format!("at factor {} there is no rate of equilibrium under the growing load", self.state.factor),
            );
            return Outcome::Ended;
        };
        // The rate is per unit Λ of the factor.
        let mut rate = first.scaled(direction);
        let mut previous: Option<Increment> = None;
        let measure = |model: &Model, state: &State, rate: &Rate, previous: Option<&Increment>| {
            strategy.constraint(&model.increment_of(state, rate), previous).value
        };
        let weight = self.spring();
        let one = measure(&self.model, &self.state, &rate, None);
        if one.is_nan() || one <= 1e-14 * self.model.rate_size(&rate) {
            self.end(Status::Stalled, "what the continuation strategy controls does not change under this load".into());
            return Outcome::Ended;
        }
        let mut length = strategy.first_step() * one;
        if to_factor {
            // A load history: never coarser than a sixteenth of it.
            length = length.min(one * (target - self.state.factor).abs() / unit / 16.0);
        }
        let initial = length;
        let largest = match strategy.largest_step() {
            step if step.is_finite() => step,
            _ if self.model.finite() => LARGEST_FINITE_STEP,
            step => step,
        } * self.model.units.length
            / self.model.units.displacement;
        let mut switched_at: Option<u64> = None;
        let mut yielding: Option<Vec<Regime>> = None;
        let mut inaccurate = 0;
        let mut before_peak_rate = rate.factor * direction;
        for _ in 0..MOST_STEPS {
            let per_rate = measure(&self.model, &self.state, &rate, previous.as_ref());
            if per_rate.is_nan() || per_rate <= 0.0 {
                previous = None;
                if measure(&self.model, &self.state, &rate, None) <= 0.0 {
                    self.end(Status::Stalled, "what the continuation strategy controls stopped changing".into());
                    return Outcome::Ended;
                }
                continue;
            }
            let mut share = length / per_rate;
            let moves = self.model.increment_of(&self.state, &rate).motion * share;
            if moves > largest {
                share *= largest / moves;
                length = share * per_rate;
            }
            if to_factor && rate.factor != 0.0 {
                let most = (target - drive.start).abs() / 16.0 / rate.factor.abs();
                if share > most {
                    share = most;
                    length = share * per_rate;
                }
            }
            if !strategy.passes_limit_points()
                && let Some(slip) = self.first_slip(&rate).filter(|slip| *slip < share)
            {
                share = slip.max(1e-6 * share) * (1.0 + 1e-9);
                length = share * per_rate;
            }
            let reaches = (self.state.factor + rate.factor * share - target) * direction >= -1e-12 * unit;
            let control = if reaches {
                Control::Factor(target)
            } else {
                Control::Strategy { strategy: &*strategy, previous, length }
            };
            let step = if reaches { (target - self.state.factor) / rate.factor } else { share };
            let mut guess = self.moved(&rate, step);
            if let Some(regimes) = &yielding {
                guess.regime = regimes.clone();
            }
            let mut control = control;
            let mut found = self.model.newton(&self.state, guess.clone(), &control);
            // Where flow is not associated pivoting may step over a limit point: the last resort.
            let last = strategy.passes_limit_points() && length < 1e-8 * initial;
            if found.is_err() && !self.model.finite() && !reaches && (self.model.monotone() || last) {
                if strategy.passes_limit_points() {
                    let along = weight * rate.factor / unit + self.model.work_along(&rate);
                    control = Control::Spring { weight, length: step * along };
                }
                found = self.model.pivoted(&self.state, &guess, &control);
            }
            let found = found.and_then(|(next, iterations)| {
                if yielding.is_some() && next.regime == self.state.regime {
                    return Err(Refusal { why: "the step went back the way it came".into(), restless: Vec::new() });
                }
                let judged = self.judge(&rate, step, &next, target, direction, reaches);
                judged.map(|()| (next, iterations))
            });
            let (found, local) = match found {
                Err(refusal) => match self.softened(&rate, step, target, direction) {
                    Some((next, iterations, local)) => (Ok((next, iterations)), Some(local)),
                    None => (Err(refusal), None),
                },
                found => (found, None),
            };
            let reaches = reaches && local.is_none();
            let control = local.as_ref().map_or(control, |local| local.control(step));
            let (next, iterations) = match found {
                Ok(found) => found,
                Err(refusal) => {
                    self.model.count("cutbacks", 1);
                    let slip = self.first_slip(&rate).unwrap_or(f64::INFINITY);
                    let steps = self.model.counters.get("steps").copied();
                    if length <= 1e-7 * initial
                        && switched_at != steps
                        && let Some(other) = self.beyond_yield(&rate, 1e-5 * initial / per_rate)
                    {
                        // A block at its strength softens: the path turns where it begins to yield.
                        switched_at = steps;
                        if other.factor * direction <= 0.0 {
                            if !strategy.passes_limit_points() {
                                self.no_step(&refusal, &other, direction);
                                return Outcome::Ended;
                            }
                            if self.peak.is_none() {
                                let motion = self.scaled_motion(&self.state, &other);
                                self.peak =
                                    Some(Peak { factor: self.state.factor, state: self.recorded.clone(), motion });
                            }
                        }
                        rate = other;
                        yielding = None;
                        before_peak_rate = rate.factor * direction;
                        previous = None;
                        length = 0.1 * initial;
                        continue;
                    }
                    // With finite displacements points that open together turn the path as sharply as slip does.
                    let at_corner = self.model.finite() && length <= 1e-7 * initial;
                    if (slip <= 1e-9 * share.max(initial / per_rate) || at_corner) && switched_at != steps {
                        // At the very event: another branch, on which the points at their limit yield.
                        switched_at = steps;
                        if let Some((other, regimes)) = self.yielding(&rate, initial / per_rate) {
                            let falls = other.factor * direction <= 0.0;
                            if falls && !strategy.passes_limit_points() {
                                self.no_step(&refusal, &other, direction);
                                return Outcome::Ended;
                            }
                            if falls && self.peak.is_none() {
                                let motion = self.scaled_motion(&self.state, &other);
                                self.doubt(&self.state.clone(), direction);
                                self.peak =
                                    Some(Peak { factor: self.state.factor, state: self.recorded.clone(), motion });
                            }
                            rate = other;
                            yielding = Some(regimes);
                            before_peak_rate = rate.factor * direction;
                            previous = None;
                            length = 0.1 * initial;
                            continue;
                        }
                    }
                    length = if slip > 1e-9 * share && slip < share { slip * per_rate } else { 0.3 * length };
                    if length < 1e-10 * initial {
                        self.no_step(&refusal, &rate, direction);
                        return Outcome::Ended;
                    }
                    continue;
                }
            };
            let accuracy = self.softening_accuracy(&next);
            if accuracy < 1.0 && inaccurate < MOST_REFINEMENTS {
                self.model.count("cutbacks", 1);
                inaccurate += 1;
                length *= accuracy.max(0.25);
                continue;
            }
            inaccurate = 0;
            let increment = self.model.increment(&self.state, &next);
            let next_rate = self.model.rate(&self.state, &next, &control);
            let Some(next_rate) = next_rate else {
                self.model.count("cutbacks", 1);
                length *= 0.3;
                if length < 1e-10 * initial {
                    let refusal = Refusal { why: "the state has no rate".into(), restless: Vec::new() };
                    self.no_step(&refusal, &rate, direction);
                    return Outcome::Ended;
                }
                continue;
            };
            let next_rate = match control {
                Control::Spring { length, .. } => next_rate.scaled(length.signum()),
                _ if reaches => next_rate.scaled(direction),
                _ => self.onwards(&next, next_rate),
            };
            let size = next.factor.abs().max(unit * 1e-3);
            let fell = (next.factor - self.state.factor) * direction < -1e-10 * size;
            let falls = next_rate.factor * direction < -1e-10 * unit * self.model.motion_size(&next_rate);
            if self.peak.is_none()
                && self.model.responses.is_empty()
                && (fell || (falls && before_peak_rate > 0.0))
                && !reaches
            {
                self.peak = self.locate_peak(&rate, previous, length, direction);
            }
            self.softening_peak(&next, fell || (falls && before_peak_rate > 0.0), direction);
            before_peak_rate = next_rate.factor * direction;
            let changes = (0..next.regime.len()).filter(|c| next.regime[*c] != self.state.regime[*c]).count();
            let softening = self.model.response_changes(&self.state, &next);
            if !self.commit(next) {
                return Outcome::Ended;
            }
            if reaches {
                if self.peak.is_some() {
                    self.notes.push(format!("after a limit point the path came back to the factor {target}"));
                }
                return Outcome::Reached;
            }
            rate = next_rate;
            yielding = None;
            if !self.model.finite() && !self.flows() && self.ray_ends(&rate, direction, target) {
                return Outcome::Ended;
            }
            if self.stops(drive, direction) {
                return Outcome::Ended;
            }
            previous = Some(increment);
            let growth = match (changes, iterations) {
                (0, 0..=5) if softening > 0 => 1.5,
                (0, 0..=6) => 2.0,
                (0..=2, 0..=6) => 1.5,
                (_, 0..=12) => 1.0,
                _ => 0.5,
            };
            let growth = accuracy.clamp(0.25, growth);
            length = growth * strategy.constraint(&increment, previous.as_ref()).value;
        }
        self.end(
            Status::Stalled,
            format!("{MOST_STEPS} steps were not enough; the last state is at factor {}: larger steps (continuation, first_step) or event_path may pass", self.state.factor),
        );
        Outcome::Ended
    }

    /// Weight of the factor in a control by a spring: with it every step of associated flow is a
    /// monotone problem. Between weight × λ + ∂Π/∂λ and λ there must be a growing relation even with
    /// all points stuck, where ∂Π/∂λ may fall (a settlement pulls at its reaction).
    fn spring(&mut self) -> f64 {
        let mut stuck = self.state.clone();
        stuck.regime.fill(Regime::Stuck);
        let factor = stuck.factor;
        let rate = self.model.rate(&self.state, &stuck, &Control::Factor(factor));
        let work = rate.map_or(0.0, |rate| self.model.work_along(&rate) * self.model.units.factor / rate.factor);
        (-2.0 * work).max(work).max(1e-3)
    }

    pub(super) fn moved(&self, rate: &Rate, share: f64) -> State {
        let mut guess = self.state.clone();
        for (r, dr) in guess.force.iter_mut().zip(&rate.force) {
            (0..2).for_each(|k| r[k] += share * dr[k]);
        }
        for (q, dq) in guess.motion.iter_mut().zip(&rate.motion) {
            (0..3).for_each(|k| q[k] += share * dq[k]);
        }
        guess.factor += share * rate.factor;
        guess
    }

    /// The rate on which the points at their limit yield, where a small share of `rate` asks for that.
    fn yielding(&mut self, rate: &Rate, share: f64) -> Option<(Rate, Vec<Regime>)> {
        let ahead = self.moved(rate, 1e-3 * share);
        let state = self.state.clone();
        let regimes = self.model.regimes_ahead(&state, &ahead);
        if regimes == state.regime {
            return None;
        }
        self.model.rate_of_yielding(&state, &regimes).map(|rate| (rate, regimes))
    }

    /// The rate on which blocks yield that a small share of `rate` takes beyond their strength, in the sense
    /// in which they dissipate. Their next predictor is that of the yielding tangent.
    fn beyond_yield(&mut self, rate: &Rate, share: f64) -> Option<Rate> {
        let mut ahead = self.moved(rate, share);
        self.model.deform(&mut ahead).ok()?;
        let mut turning = self.state.clone();
        turning.blocks = ahead.blocks;
        if !turning.blocks.iter().flatten().any(|inner| inner.linear.yielding > 0) {
            return None;
        }
        let other = self.model.rate(&self.state, &turning, &Control::Factor(self.state.factor))?;
        let power = self.model.plastic_power(&turning, &other);
        self.state.blocks = turning.blocks;
        Some(other.scaled(if power < 0.0 { -1.0 } else { 1.0 }))
    }

    /// Share of the rate after which the first stuck point whose slip is not associated would slide.
    fn first_slip(&self, rate: &Rate) -> Option<f64> {
        let mut first = f64::INFINITY;
        for c in 0..self.state.gap.len() {
            let (Regime::Stuck, Some(law)) = (self.state.regime[c], self.model.law(c)) else { continue };
            for f in law.facets.iter().filter(|f| f.flow != f.normal) {
                let (r, dr) = (self.state.force[c], rate.force[c]);
                let slack = f.bound * self.model.problem.contacts[c].area - f.normal[0] * r[0] - f.normal[1] * r[1];
                let speed = f.normal[0] * dr[0] + f.normal[1] * dr[1];
                if speed > 0.0 {
                    first = first.min(slack.max(0.0) / speed);
                }
            }
        }
        first.is_finite().then_some(first)
    }

    /// Whether a converged step is one along the path.
    fn judge(
        &mut self,
        rate: &Rate,
        share: f64,
        next: &State,
        target: f64,
        direction: f64,
        reaches: bool,
    ) -> Result<(), Refusal> {
        let no = |why: &str| Err(Refusal { why: why.into(), restless: Vec::new() });
        if !reaches && (next.factor - target) * direction > 0.0 {
            return no("the step went beyond the factor asked for");
        }
        let u = self.model.units;
        let (mut along, mut size) = (0.0, 0.0);
        let mut force_jump = 0.0;
        for c in 0..next.gap.len() {
            for k in 0..2 {
                let moved = (next.gap[c][k] - self.state.gap[c][k]) / u.displacement;
                along += moved * rate.gap[c][k] / u.displacement;
                size += moved * moved;
                force_jump += ((next.force[c][k] - self.state.force[c][k]) / u.force).powi(2);
            }
        }
        for b in 0..next.motion.len() {
            for k in 0..3 {
                let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
                let moved = (next.motion[b][k] - self.state.motion[b][k]) / unit;
                along += moved * rate.motion[b][k] / unit;
                size += moved * moved;
            }
        }
        along += (next.factor - self.state.factor) * rate.factor / (u.factor * u.factor);
        // Where a block softens the path may snap back sharply: what dissipates does not go back.
        if along <= 0.0 && self.model.plastic_work(&self.state, next) <= 1e-9 * size {
            return no("the step turned back");
        }
        // Friction that is not associated: several states may belong to one load. A state far from
        // what both ends' rates can reach is another branch.
        let slides = (0..next.regime.len()).any(|c| {
            next.regime[c] != self.state.regime[c] && self.model.law(c).is_some_and(|law| law.has_other_flow())
        });
        if slides && !self.strategy.passes_limit_points() {
            let after = self.model.rate(&self.state, next, &Control::Factor(next.factor));
            let Some(after) = after else { return no("the state has no rate under growing load") };
            let before = self.model.rate_size(rate) * share;
            let after = self.model.rate_size(&after) * (next.factor - self.state.factor).abs() / u.factor;
            let jump = (size + force_jump).sqrt();
            if jump > 2.0 * (before + after) {
                return no("the state jumps to another branch");
            }
        }
        Ok(())
    }

    /// No step is small enough: a limit point for strategies that cannot pass one, else a stall.
    fn no_step(&mut self, refusal: &Refusal, rate: &Rate, direction: f64) {
        let points: Vec<String> = refusal
            .restless
            .iter()
            .take(6)
            .map(|&c| format!("{c} of joint {}", self.model.problem.contacts[c].joint))
            .collect();
        let who = if points.is_empty() { String::new() } else { format!(" (contact points {})", points.join(", ")) };
        let why = format!("no step from factor {} converges: {}{who}", self.state.factor, refusal.why);
        let falls = rate.factor * direction <= 0.0;
        if !self.strategy.passes_limit_points() && (falls || self.turns_back(rate, direction)) {
            self.doubt(&self.state.clone(), direction);
            self.end(Status::LimitPoint, format!("{why}; the path goes on with a factor that does not grow"));
        } else {
            self.end(Status::Stalled, why);
        }
    }

    /// Whether the path goes on with a factor that does not grow.
    fn turns_back(&mut self, rate: &Rate, direction: f64) -> bool {
        let arc = super::super::continuation::arc_length::ArcLength::default();
        let size = arc.constraint(&self.model.increment_of(&self.state, rate), None).value;
        for exponent in [-2, -3, -4, -6] {
            let length = size * 10f64.powi(exponent);
            let control = Control::Strategy { strategy: &arc, previous: None, length };
            let guess = self.moved(rate, 10f64.powi(exponent));
            if let Ok((next, _)) = self.model.newton(&self.state, guess, &control) {
                let Some(after) = self.model.rate(&self.state, &next, &control) else { continue };
                if after.factor * direction <= 1e-9 * self.model.units.factor * self.model.motion_size(&after) {
                    return true;
                }
            }
        }
        false
    }

    /// Looks, with small displacements, for a rate with growing λ where there should be none.
    fn doubt(&mut self, state: &State, direction: f64) {
        if !self.model.finite() && self.model.responses.is_empty() {
            self.doubt = self.model.none_rises(state, direction).err();
        }
    }

    /// Bisects the step from the present state for the point where λ stops growing.
    fn locate_peak(&mut self, rate: &Rate, previous: Option<Increment>, length: f64, direction: f64) -> Option<Peak> {
        let strategy = self.strategy.clone();
        let (mut low, mut high) = (0.0, length);
        let mut best = (self.state.clone(), rate.clone());
        let mut behind = rate.clone();
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let control = Control::Strategy { strategy: &*strategy, previous, length: middle };
            let per_rate = strategy.constraint(&self.model.increment_of(&self.state, rate), previous.as_ref()).value;
            let guess = self.moved(rate, middle / per_rate);
            let Ok((state, _)) = self.model.newton(&self.state, guess, &control) else { break };
            let Some(here) = self.model.rate(&self.state, &state, &control) else { break };
            if here.factor * direction > 0.0 {
                low = middle;
                best = (state, here);
            } else {
                high = middle;
                behind = here;
            }
            let gain = best.1.factor.abs() * (high - low);
            if low > 0.0 && gain <= 1e-11 * best.0.factor.abs().max(1e-6 * self.model.units.factor) {
                break;
            }
        }
        Some(self.peak_at(best.0, &behind, direction))
    }

    /// A peak at a state between the last one and the next, with the rate just behind it.
    pub(super) fn peak_at(&mut self, mut state: State, behind: &Rate, direction: f64) -> Peak {
        let slopes = self.model.slopes(&state);
        let mut ledger = self.ledger;
        ledger.add(&self.model, &self.state, &state, [&self.slopes, &slopes]);
        let start = self.state.clone();
        self.model.keep(&start, &mut state);
        let recorded = ledger.recorded(&self.model, self.drive, &state, &slopes);
        let motion = self.scaled_motion(&state, behind);
        self.doubt(&state, direction);
        Peak { factor: state.factor, state: recorded, motion }
    }

    /// Velocities with p·q̇ = 1; of settlements with finite displacements, which do no work, with 1 m of
    /// the fastest body's speed. `None` where the load does next to no work on them: rates are checked
    /// to 1e-8 of their size, so less work than a hundred times that proves nothing.
    fn scaled_motion(&self, state: &State, rate: &Rate) -> Option<Vec<[f64; 3]>> {
        let u = self.model.units;
        let load = load_size(self.model.problem, self.model.loaded.growing);
        let power = self.model.increment_of(state, rate).displacement * u.displacement * load;
        let size = self.model.motion_size(rate) * u.displacement * u.force / u.factor;
        let by = if load == 0.0 && self.model.finite() {
            rate.motion.iter().map(|q| q[0].hypot(q[1]).max(q[2].abs() * u.length)).fold(0.0, f64::max)
        } else if power > 1e-6 * size {
            power
        } else {
            0.0
        };
        (by > 0.0).then(|| rate.motion.iter().map(|q| q.map(|x| x / by)).collect())
    }

    /// Whether the rate goes on for ever: collapse, or a ray that carries any load.
    fn ray_ends(&mut self, rate: &Rate, direction: f64, target: f64) -> bool {
        let u = self.model.units;
        let motion = self.model.motion_size(rate);
        let force = rate.force.iter().flatten().map(|r| (r / u.force).abs()).fold(0.0, f64::max);
        let factor = rate.factor / u.factor * direction;
        let still = force <= 1e-9 * motion && factor.abs() <= 1e-9 * motion;
        let force_unit = if still { f64::INFINITY } else { force.max(factor.abs()) * u.force };
        for c in 0..rate.gap.len() {
            let Some(law) = self.model.law(c) else { continue };
            let gap = rate.gap[c].map(|g| g / (u.displacement * motion));
            let r = rate.force[c].map(|r| r / force_unit);
            if law.ray_violation(self.state.regime[c], r, gap) > 1e-8 {
                return false;
            }
        }
        if !self.model.responses_go_on(&self.state, rate) {
            return false;
        }
        self.forget_lower_peak(direction);
        if still {
            self.motion = self.scaled_motion(&self.state, rate);
            if self.motion.is_none() {
                return false;
            }
            self.end(if self.peak.is_some() { Status::LimitPoint } else { Status::Collapse }, String::new());
            if self.peak.is_some() {
                self.notes.push(format!(
                    "behind the limit point the path ends in a mechanism at factor {}",
                    self.state.factor
                ));
            }
            return true;
        }
        // What strengths bound is no ray: the facets have been looked at above with the ray's forces, and no
        // block that may yield carries any load.
        if target.is_infinite() && !self.model.problem.yields() && factor > 1e-9 * (motion + force) {
            self.ray = Some(rate.force.iter().map(|r| r.map(|x| x / rate.factor)).collect());
            self.end(if self.peak.is_some() { Status::LimitPoint } else { Status::Unbounded }, String::new());
            if self.peak.is_some() {
                self.notes.push(format!(
                    "behind the limit point the load grows without bound from factor {}",
                    self.state.factor
                ));
            }
            return true;
        }
        false
    }

    /// Whether a block yields in the last step.
    fn flows(&self) -> bool {
        self.state.blocks.iter().flatten().any(|inner| inner.linear.yielding > 0)
    }

    /// Whether the path went as far behind its peak as was asked for.
    fn stops(&mut self, drive: &Drive, direction: f64) -> bool {
        let (factor, displacement) = (self.state.factor, self.recorded.displacement);
        let Some(peak) = &self.peak else {
            if self.model.finite() && displacement.abs() > self.model.units.length {
                self.end(Status::Stalled, format!("no peak up to a displacement of {displacement} m, factor {factor}"));
                return true;
            }
            return false;
        };
        if !self.model.responses.is_empty() && (factor - peak.factor) * direction > 0.0 {
            return false;
        }
        let behind = (displacement - peak.state.displacement).abs();
        let (stop_displacement, stop_factor) = (self.settings.stop_displacement, self.settings.stop_factor);
        let done = match (stop_displacement, stop_factor) {
            (None, None) => {
                let grown = (peak.factor - drive.start).abs();
                (peak.factor - factor) * direction >= 0.1 * grown || behind >= peak.state.displacement.abs()
            }
            (most, least) => {
                most.is_some_and(|most| behind >= most)
                    || least.is_some_and(|least| (factor - least) * direction <= 0.0)
            }
        };
        if done {
            self.end(if self.model.finite() { Status::Collapse } else { Status::LimitPoint }, String::new());
        }
        done
    }
}
