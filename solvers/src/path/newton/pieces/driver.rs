//! Follows pieces from the start of a load step to its end.

use super::advance::{Advance, StepEnd, Watched, advance, chord};
use super::begin::begin;
use super::bifurcation::{OtherBranch, Unstable, first_unstable, other_branch};
use super::corner::corner;
use super::corrector::correct;
use super::end::end_of_range;
use super::loading_set::{LoadingRate, bond_rate, loading_rate};
use super::monitors::{Monitor, What};
use super::other_branches::note_other_branches;
use super::piece::Piece;
use super::plateau::{Plateau, plateau, stands_still, stood_still};
use super::ray::ray;
use super::switch::{NextPiece, after_event, is_admissible};
use crate::contact::mode::ContactMode;
use crate::linear::inner;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::{State, Tangent, moved};
use crate::path::newton::quantities::ahead::{facing_ahead, length_ahead};
use crate::path::newton::quantities::events::events;
use crate::path::newton::quantities::measure::{increment_along, motion_size};
use crate::path::newton::solve::nearby::Accuracy;
use crate::path::newton::solve::second_order::{is_unstable_at_rest, second_order_work};
use crate::path::newton::solve::step::solve_step;
use crate::path::newton::solve::tangent::tangent_at;
use crate::path::newton::tracing::commit::{commit, end_at_lost_joint, lost_joint};
use crate::path::newton::tracing::peak::{note_peak, peak_at, scaled_motion};
use crate::path::newton::tracing::stable_branch::{Departure, leave_unstable};
use crate::path::newton::tracing::step_energy::step_energy;
use crate::path::newton::tracing::tracer::{LoadStepEnding, Tracer, direction, end_path};
use crate::path::newton::tracing::witness::none_continues;
use crate::path::stability::SecondOrderWork;
use crate::path::twins;
use crate::settings::SETTINGS;
use voussoir_core::limit::Status;
use voussoir_core::path::{Branching, LimitPointEnd, LoadStep, LoadStepEnd, ProvenPeak};

/// Greatest number of pieces and steps of a load step.
const MAX_STEPS: u64 = 6000;
/// Greatest number of iterations of Newton's method of a load step.
const MAX_ITERATIONS: u64 = 20_000;
/// Lengths of steps across a corner, relative to the first step.
const CORNER_STEPS: [f64; 4] = [1e-4, 1e-3, 1e-5, 1e-6];
/// Greatest number of successive pieces of almost zero length.
const MAX_SHORT_PIECES: u32 = 50;

type Ending = Option<LoadStepEnding>;

/// A load step that is followed.
struct Run<'d> {
    range: Range<'d>,
    piece: Piece,
    length: Lengths,
    /// True if the factor changes in its sense.
    rises: bool,
    cluster: Cluster,
    standing: Standing,
}

/// Start and end of a load step.
struct Range<'d> {
    load_step: &'d LoadStep,
    target: f64,
    /// Sense of λ.
    direction: f64,
    /// Displacement of the load at the start.
    from: f64,
}

/// Lengths of steps along the tangent.
struct Lengths {
    next: f64,
    /// Greatest length of the strategy.
    longest: f64,
    /// Length of the first step.
    first: f64,
}

/// Findings about the present state.
#[derive(Default)]
struct Standing {
    /// True if the path continues under a constant load.
    on_plateau: bool,
    /// True if blocks flowed in the last step.
    flows: bool,
}

/// Events at one place: the path has hardly moved since the first of them.
#[derive(Default)]
struct Cluster {
    /// Monitors that have ended.
    hits: Vec<Monitor>,
    /// Modes, piece and sense before the first event.
    arrival: Option<(Vec<ContactMode>, Piece, bool)>,
    /// Number of pieces of almost zero length.
    pieces: u32,
}

/// Follows a load step with the strategy, up to a factor or the end of the path.
pub fn follow(tracer: &mut Tracer, load_step: &LoadStep, target: f64) -> LoadStepEnding {
    let direction = direction(tracer);
    if target == tracer.state.factor {
        let here = tracer.state.clone();
        return if commit(tracer, here) { LoadStepEnding::Reached } else { LoadStepEnding::Ended };
    }
    let mut run = match Run::begin(tracer, load_step, target, direction) {
        Ok(run) => run,
        Err(ending) => return ending,
    };
    let before = tracer.system.report.iterations;
    for _ in 0..MAX_STEPS {
        if let Some(ending) = run.step(tracer) {
            return ending;
        }
        if tracer.system.report.iterations - before > MAX_ITERATIONS {
            break;
        }
    }
    let why = format!("the budget of steps is used up; the last state is at factor {}", tracer.state.factor);
    end_path(tracer, Status::Stalled, why)
}

/// Returns the greatest length of a step along the tangent.
fn greatest_step(tracer: &Tracer) -> f64 {
    let u = tracer.system.units();
    let most = match tracer.in_force.strategy.largest_step() {
        step if step.is_finite() => step,
        // The flow of friction turns with the blocks: its error accumulates over the steps of a path.
        _ => SETTINGS.largest_finite_step,
    };
    most * u.length / u.displacement
}

impl<'d> Run<'d> {
    fn begin(
        tracer: &mut Tracer,
        load_step: &'d LoadStep,
        target: f64,
        direction: f64,
    ) -> Result<Self, LoadStepEnding> {
        let piece = begin(tracer, target, direction)?;
        let mut run = Run {
            range: Range { load_step, target, direction, from: tracer.record.state.displacement },
            piece,
            length: Lengths { next: 0.0, longest: greatest_step(tracer), first: 0.0 },
            rises: true,
            cluster: Cluster::default(),
            standing: Standing::default(),
        };
        run.length.first = run.by_strategy(tracer);
        run.length.next = run.length.first;
        Ok(run)
    }

    /// Returns the length along the tangent of a first step of the strategy.
    fn by_strategy(&self, tracer: &Tracer) -> f64 {
        let along = increment_along(&tracer.system, &tracer.state, &self.piece.tangent);
        let measured = tracer.in_force.strategy.constraint(&along, None).value.abs();
        let length = tracer.in_force.strategy.first_step() / measured.max(1e-3 * along.motion.max(along.factor.abs()));
        let whole = (self.range.target - self.range.load_step.start).abs() / 16.0;
        let share = self.piece.tangent.factor.abs();
        match self.range.load_step.end {
            LoadStepEnd::Factor(_) if share > 0.0 => length.min(whole / share),
            _ => length,
        }
    }

    /// Makes one step. Returns the ending if the load step ends in it.
    fn step(&mut self, tracer: &mut Tracer) -> Option<LoadStepEnding> {
        let moves = increment_along(&tracer.system, &tracer.state, &self.piece.tangent).motion;
        let length = self.length.next.min(self.length.longest / moves.max(1e-300));
        // The factor may also turn beyond a state at which it does not change.
        let sense = if self.rises { self.range.direction } else { -self.range.direction };
        let watched = Watched {
            sense: Some(sense),
            target: self.range.target.is_finite().then_some((self.range.target, self.range.direction)),
        };
        let start = tracer.state.clone();
        let advance = advance(&mut tracer.system, (&start, &self.piece), length, watched);
        if advance.end().is_none_or(|end| end.error > SETTINGS.most_error)
            && let Some(ending) = self.end_at_corner(tracer, length)
        {
            return ending;
        }
        if let Some(end) = advance.end()
            && self.rises
            && let Some(Unstable { first, work, far }) =
                first_unstable(tracer, (&start, &self.piece), end, self.range.direction)
        {
            let again = far && end.length > SETTINGS.distinct() * self.length.first;
            return if again { self.shorten(tracer, 0.5 * end.length) } else { self.leave(tracer, first, &work) };
        }
        match advance {
            Advance::Failed => self.shorten(tracer, 0.3 * length),
            Advance::Whole(end) => self.whole(tracer, end),
            Advance::Turn(end) => self.turn(tracer, end),
            Advance::Target(end) => self.arrive(tracer, end),
            Advance::Event(end, hits) => {
                let hits: Vec<Monitor> = hits.into_iter().map(|i| self.piece.monitors.0[i]).collect();
                self.event(tracer, end, hits)
            }
        }
    }

    /// Ends a step that leaves its tangent at the corner where blocks begin to yield, and continues beyond it. `None`
    /// if the step has no such corner.
    fn end_at_corner(&mut self, tracer: &mut Tracer, length: f64) -> Option<Ending> {
        let start = tracer.state.clone();
        let at = corner(&mut tracer.system, &start, &self.piece.tangent, length)?;
        if at > length_ahead(&tracer.system, &start) {
            self.length.next = at;
            return (at < SETTINGS.nearly() * length).then_some(None);
        }
        let found = self.around_corner(tracer)?;
        let modes = found.state.mode.clone();
        if is_admissible(&tracer.system, &found.state, &modes, &found.rate) {
            self.length.next = 0.1 * self.length.first;
            return Some(self.go_on(tracer, found, modes, None));
        }
        let piece = Piece::new(&tracer.system, &found.state, &found.rate)?;
        self.across(tracer, &found.state, &piece)
    }

    fn shorten(&mut self, tracer: &mut Tracer, length: f64) -> Option<LoadStepEnding> {
        tracer.system.count("cutbacks", 1);
        self.length.next = length;
        if length >= SETTINGS.inequality() * self.length.first {
            return None;
        }
        // Steps become too short at a corner of a law that is not an event.
        if let Some(found) = self.around_corner(tracer) {
            self.length.next = 0.1 * self.length.first;
            tracer.state.blocks.clone_from(&found.state.blocks);
            let modes = found.state.mode.clone();
            return self.go_on(tracer, found, modes, None);
        }
        if let Some(ending) = self.over_corner(tracer) {
            return ending;
        }
        let failure = tracer.system.report.failure.take().map_or(String::new(), |why| format!(": {why}"));
        let why = format!("no state of the piece was found beyond factor {}{failure}", tracer.state.factor);
        Some(end_path(tracer, Status::Stalled, why))
    }

    /// Returns the rate that continues if the piece ends because blocks or bonds begin to yield.
    fn around_corner(&mut self, tracer: &mut Tracer) -> Option<LoadingRate> {
        if !tracer.system.limits.remembers || self.crowded() {
            return None;
        }
        let here = tracer.state.clone();
        let found = loading_rate(&mut tracer.system, &here, &self.piece)?;
        let piece = Piece::new(&tracer.system, &found.state, &found.rate)?;
        let cosine = inner(&piece.row, &self.piece.row);
        (cosine < 1.0 - SETTINGS.distinct()).then_some(found)
    }

    /// Makes a short step from a corner of laws with memory along the present piece or, if that fails, along the arrival: the rate
    /// of an event may be rounding if many points are at their bounds. `None` if there is no such step.
    fn over_corner(&mut self, tracer: &mut Tracer) -> Option<Ending> {
        if !tracer.system.limits.remembers {
            return None;
        }
        let arrival = self.cluster.arrival.as_ref().map(|(modes, piece, _)| (modes.clone(), piece.clone()));
        let own = (tracer.state.mode.clone(), self.piece.clone());
        std::iter::once(own).chain(arrival).find_map(|(modes, piece)| {
            let facing = State { mode: modes, ..tracer.state.clone() };
            self.across(tracer, &facing, &piece)
        })
    }

    /// Makes a short step from a corner, approximately along a piece, by Newton's method on the laws themselves: modes
    /// and branches may change in it. The next corner may follow at once, where points that slip and blocks that yield
    /// decide about each other. A turn is passed by a short step. `None` if there is no such step.
    fn across(&mut self, tracer: &mut Tracer, facing: &State, piece: &Piece) -> Option<Ending> {
        let here = tracer.state.clone();
        let (share, next, rate) = CORNER_STEPS.into_iter().find_map(|share| {
            let control = piece.control(share * self.length.first);
            let guess = moved(facing, &piece.tangent, share * self.length.first);
            let (next, _) = solve_step(&mut tracer.system, &here, guess, &control).ok()?;
            // Blocks have another solution, in which all of them unload.
            if facing.yields() && !next.yields() {
                return None;
            }
            let rate = tangent_at(&mut tracer.system, &next, &control, Accuracy::Fine)?;
            let turns = self.goes_up(tracer, &rate) != self.rises;
            let short = share <= CORNER_STEPS[1] || !turns;
            (short && step_energy(tracer, &next).holds).then_some((share, next, rate))
        })?;
        let was = self.rises;
        self.piece = Piece::new(&tracer.system, &next, &rate)?;
        self.length.next = share * self.length.first;
        self.rises = self.goes_up(tracer, &self.piece.tangent.clone());
        self.cluster = Cluster::default();
        if was != self.rises
            && let Some(ending) = self.at_turn(tracer, was)
        {
            return Some(Some(ending));
        }
        Some((!commit(tracer, next)).then_some(LoadStepEnding::Ended))
    }

    /// Counts a piece of almost zero length; returns true if there are too many of them.
    fn crowded(&mut self) -> bool {
        self.cluster.pieces += 1;
        self.cluster.pieces > MAX_SHORT_PIECES
    }

    /// Accepts a state of the piece. `None` if the step must be repeated or the path ends.
    fn take(&mut self, tracer: &mut Tracer, end: StepEnd) -> Result<(), Option<LoadStepEnding>> {
        // The tangent of a shorter step is rounding.
        let tells = end.length > length_ahead(&tracer.system, &tracer.state);
        if end.error > SETTINGS.most_error && tells {
            return Err(self.shorten(tracer, end.length * (SETTINGS.wanted_error / end.error).clamp(0.1, 0.5)));
        }
        if end.unexplained > SETTINGS.most_error && tells {
            return Err(self.shorten(tracer, 0.5 * end.length));
        }
        let energy = step_energy(tracer, &end.state);
        if !energy.holds && end.length > 1e-3 * self.length.first {
            return Err(self.shorten(tracer, end.length * energy.growth.clamp(0.25, 0.7)));
        }
        // A step shortened by an event gives no information about the next length: its error is rounding.
        if end.length >= SETTINGS.telling * self.length.next {
            let by_error = (SETTINGS.wanted_error / end.error.max(1e-300)).max(0.3) * end.length;
            let by_energy = energy.growth.max(0.25) * end.length;
            // The error is of second order in the length.
            let by_factor = (0.5 * SETTINGS.most_error / end.unexplained.max(1e-300)).sqrt().max(0.5) * end.length;
            self.length.next = by_error.min(by_energy).min(by_factor).min(2.0 * self.length.next.max(end.length));
        }
        let Some(piece) = self.piece.turned(&tracer.system, &end.rate) else {
            return Err(self.shorten(tracer, 0.3 * end.length));
        };
        self.standing.flows = stood_still(tracer, &end.state);
        if !commit(tracer, end.state) {
            return Err(Some(LoadStepEnding::Ended));
        }
        self.piece = piece;
        Ok(())
    }

    fn whole(&mut self, tracer: &mut Tracer, end: StepEnd) -> Option<LoadStepEnding> {
        let far = end.length > 1e-9 * self.length.first;
        if let Err(ending) = self.take(tracer, end) {
            return ending;
        }
        if far {
            self.cluster = Cluster::default();
        }
        if let Some(ending) = self.plateau(tracer) {
            return Some(ending);
        }
        self.after(tracer)
    }

    /// Returns the ending at a mechanism under a constant load, if there is one at the present state. If the stage
    /// requests a displacement beyond its limit point, the path continues.
    fn plateau(&mut self, tracer: &mut Tracer) -> Option<LoadStepEnding> {
        if self.standing.on_plateau || !(self.standing.flows || stands_still(tracer, &self.piece)) {
            return None;
        }
        let found = plateau(tracer, &self.piece.clone(), self.range.direction, self.standing.flows)?;
        let goes_on = tracer.settings.stop(self.range.load_step.stage)[0].is_some() && !self.standing.flows;
        if found.unproved.is_none() && goes_on {
            note_peak(tracer, Some(&self.piece.tangent), self.range.direction);
            self.standing.on_plateau = true;
            return None;
        }
        Some(self.end_at_plateau(tracer, found))
    }

    /// Returns the ending if the range or the path ends after a step.
    fn after(&mut self, tracer: &mut Tracer) -> Option<LoadStepEnding> {
        // A mechanism under a constant load may close a gap: the path ends only where the load falls.
        let falls = |peak: &&ProvenPeak| {
            let fallen = (peak.factor - peak.lowest) * self.range.direction > SETTINGS.residual() * peak.factor.abs();
            let own = peak.load_step == tracer.in_force.load_step;
            own && (fallen || !self.rises && !stands_still(tracer, &self.piece))
        };
        if let Some(factor) = tracer.limit.proven_peaks.last().filter(falls).map(|peak| peak.factor)
            && let Some(ending) = self.end_at_limit_point(tracer, factor)
        {
            return Some(ending);
        }
        if self.range.target.is_infinite()
            && let Some(ending) = ray(tracer, &self.piece, self.range.direction)
        {
            return Some(ending);
        }
        let ending = end_of_range(tracer, self.range.load_step, self.range.direction, self.range.from);
        if ending.is_some() {
            tracer.ending.motion = scaled_motion(tracer, &tracer.state, &self.piece.tangent);
        }
        ending
    }

    /// Accepts the state at the target.
    fn arrive(&mut self, tracer: &mut Tracer, mut end: StepEnd) -> Option<LoadStepEnding> {
        let control = Control::Factor(self.range.target);
        let start = tracer.state.clone();
        if let Some(state) = correct(&mut tracer.system, &start, end.state.clone(), &control) {
            end.state = state;
        }
        match self.take(tracer, end) {
            Ok(()) => Some(LoadStepEnding::Reached),
            Err(ending) => ending,
        }
    }

    /// Passes a state at which the factor turns.
    fn turn(&mut self, tracer: &mut Tracer, end: StepEnd) -> Option<LoadStepEnding> {
        let was = self.rises;
        let length = end.length;
        // At the turn other rates may be singular too, such as the tilt of a softening block; the chord is not.
        let chord = (length > SETTINGS.distinct() * self.length.first).then(|| chord(&tracer.state, &end.state));
        if let Err(ending) = self.take(tracer, end) {
            return ending;
        }
        self.length.next = self.length.next.max(length);
        if let Some(piece) = chord.and_then(|chord| self.piece.turned(&tracer.system, &chord)) {
            self.piece = piece;
        }
        // Beyond the turn the rate has the opposite sense; at the turn it is rounding.
        self.rises = !was;
        let slope = SETTINGS.rounding * tracer.system.units().factor;
        self.piece.tangent.factor = if self.rises { slope } else { -slope } * self.range.direction;
        self.at_turn(tracer, was)
    }

    /// Records a peak or a trough at the present state, from which the piece continues.
    fn at_turn(&mut self, tracer: &mut Tracer, was: bool) -> Option<LoadStepEnding> {
        if was && !self.rises {
            return self.peak(tracer);
        }
        if !was && self.rises {
            self.forget_still_peak(tracer);
            let state = tracer.state.clone();
            let lower =
                tracer.limit.trough.as_ref().is_none_or(|t| (t.factor - state.factor) * self.range.direction > 0.0);
            if tracer.limit.peak.is_some() && lower {
                let beyond = self.piece.tangent.clone();
                tracer.limit.trough = Some(peak_at(tracer, state, &beyond));
            }
        }
        self.after(tracer)
    }

    /// Removes the limit points since which the load has been constant: a mechanism may have closed a gap.
    fn forget_still_peak(&self, tracer: &mut Tracer) {
        let (load_step, here) = (tracer.in_force.load_step, tracer.state.factor);
        let same =
            |peak: &ProvenPeak, other: f64| (peak.factor - other).abs() <= SETTINGS.residual() * peak.factor.abs();
        let still = |peak: &mut ProvenPeak| peak.load_step == load_step && same(peak, peak.lowest) && same(peak, here);
        while let Some(last) = tracer.limit.proven_peaks.pop_if(still) {
            tracer.limit.peak.take_if(|peak| peak.factor == last.factor);
        }
    }

    /// Handles a limit point.
    fn peak(&mut self, tracer: &mut Tracer) -> Option<LoadStepEnding> {
        if tracer.system.settles() && matches!(self.range.load_step.end, LoadStepEnd::Factor(_)) {
            return self.snap(tracer);
        }
        note_peak(tracer, Some(&self.piece.tangent), self.range.direction);
        note_other_branches(tracer, &self.piece.tangent);
        self.after(tracer)
    }

    /// Returns the ending at a limit point that the stage or its strategy does not pass.
    fn end_at_limit_point(&self, tracer: &mut Tracer, factor: f64) -> Option<LoadStepEnding> {
        if matches!(self.range.load_step.end, LoadStepEnd::Factor(_)) {
            tracer.ending.limit_point_end = Some(LimitPointEnd::Target);
            let (target, load_step) = (self.range.target, self.range.load_step);
            let of = if load_step.gravity { "gravity" } else { "its stage" };
            let why = format!("the path has a limit point at factor {factor}, before the factor {target} of {of}");
            return Some(end_path(tracer, Status::LimitPoint, why));
        }
        if !tracer.in_force.strategy.passes_limit_points() {
            let why = "behind this limit point the load does not grow, and the strategy goes no further";
            return Some(end_path(tracer, Status::LimitPoint, why.into()));
        }
        let ends = tracer.settings.ends_at_first_limit_point(self.range.load_step.stage);
        ends.then(|| end_path(tracer, Status::LimitPoint, String::new()))
    }

    /// Beyond a limit point of a settlement, continues from the equilibrium that damped descent reaches.
    fn snap(&mut self, tracer: &mut Tracer) -> Option<LoadStepEnding> {
        let mut pushed = tracer.state.clone();
        let work = second_order_work(&mut tracer.system, &pushed);
        pushed.factor += SETTINGS.same_rate() * (self.range.target - self.range.load_step.start);
        let departure = match &work {
            Some(work) => leave_unstable(tracer, &pushed, work, true),
            None => Departure::Falls,
        };
        match departure {
            Departure::Stopped => Some(LoadStepEnding::Ended),
            Departure::Stable => self.anew(tracer),
            Departure::Falls => {
                note_peak(tracer, Some(&self.piece.tangent), self.range.direction);
                let why = format!(
                    "at factor {} no equilibrium follows as the settlement goes on, and damped descent reaches none",
                    tracer.state.factor
                );
                Some(end_path(tracer, Status::LimitPoint, why))
            }
        }
    }

    /// Continues from a state that is not the last one of the piece.
    fn anew(&mut self, tracer: &mut Tracer) -> Option<LoadStepEnding> {
        match Run::begin(tracer, self.range.load_step, self.range.target, self.range.direction) {
            Ok(run) => {
                *self = Run { range: Range { from: self.range.from, ..run.range }, ..run };
                None
            }
            Err(ending) => Some(ending),
        }
    }

    /// Leaves an equilibrium that has become unstable under its loads.
    fn leave(&mut self, tracer: &mut Tracer, end: StepEnd, work: &SecondOrderWork) -> Option<LoadStepEnding> {
        // At a bifurcation the rate is any combination of those of both branches.
        let (present, length) = (self.piece.clone(), self.length.next.max(end.length));
        if let Err(ending) = self.take(tracer, end) {
            return ending;
        }
        if let Some(other) = other_branch(tracer, &present, work, (self.range.direction, length)) {
            return self.divide(tracer, other);
        }
        let here = tracer.state.clone();
        let departure = match is_unstable_at_rest(&mut tracer.system, &here) {
            true => leave_unstable(tracer, &here, work, false),
            false => Departure::Falls,
        };
        match departure {
            Departure::Stopped => Some(LoadStepEnding::Ended),
            Departure::Stable => self.anew(tracer),
            Departure::Falls => {
                let why = format!(
                    "at factor {} the equilibrium becomes unstable under its loads, and no other branch was found: a bifurcation",
                    here.factor
                );
                Some(end_path(tracer, Status::Stalled, why))
            }
        }
    }

    /// Continues on the other branch of a bifurcation at the present state.
    fn divide(&mut self, tracer: &mut Tracer, other: OtherBranch) -> Option<LoadStepEnding> {
        let OtherBranch { piece, modes, next, twins } = other;
        let what = if twins { "follows one of two branches that carry the same load" } else { "leaves its branch" };
        let (load_step, factor) = (tracer.in_force.load_step, tracer.state.factor);
        tracer.record.branchings.push(Branching { load_step, factor, snaps: false, released: 0.0, twins });
        let unstable = "the equilibrium becomes unstable under its loads, and the path";
        tracer.record.notes.push(format!("at factor {factor} {unstable} {what}"));
        let was = self.rises;
        self.rises = self.goes_up(tracer, &next.rate);
        let facing = State { mode: modes, ..tracer.state.clone() };
        self.enter(tracer, piece, &facing);
        if let Some(ending) = self.at_turn(tracer, was) {
            return Some(ending);
        }
        self.length.next = next.length;
        match self.piece.turned(&tracer.system, &next.rate) {
            Some(piece) => self.piece = piece,
            None => return None,
        }
        (!commit(tracer, next.state)).then_some(LoadStepEnding::Ended)
    }

    /// Handles an event: finds the next piece or the ending.
    fn event(&mut self, tracer: &mut Tracer, mut end: StepEnd, hits: Vec<Monitor>) -> Option<LoadStepEnding> {
        tracer.system.count("events", 1);
        if hits.iter().any(|hit| matches!(hit.what, What::Branch(_))) {
            // Next to the end of a branch a tangent by differences mixes both sides: its rate is unusable.
            end.unexplained = 0.0;
        }
        let moved = end.length > 1e-9 * self.length.first;
        let length = self.length.next;
        if end.length > 0.0
            && let Err(ending) = self.take(tracer, end)
        {
            return ending;
        }
        self.length.next = self.length.next.max(0.1 * length);
        let ahead = length_ahead(&tracer.system, &tracer.state);
        if let Some(ending) = self.end_at_corner(tracer, ahead) {
            return ending;
        }
        if let Some(lost) = hits.iter().find(|hit| matches!(hit.what, What::Face { .. })) {
            return Some(self.lose_joint(tracer, lost.contact));
        }
        if moved {
            self.cluster = Cluster::default();
        } else if self.crowded() {
            if let Some(ending) = self.over_corner(tracer) {
                return ending;
            }
            let why = format!("at factor {} events follow each other without end", tracer.state.factor);
            return Some(end_path(tracer, Status::Stalled, why));
        }
        let hits = self.all_hits(tracer, hits);
        let points: Vec<Monitor> = hits.iter().filter(|hit| !matches!(hit.what, What::Branch(_))).copied().collect();
        let here = tracer.state.clone();
        let state = facing_ahead(&mut tracer.system, &here, &self.piece.tangent).unwrap_or(here);
        if points.is_empty() {
            let rate = self.piece.tangent.clone();
            let modes = state.mode.clone();
            return self.go_on(tracer, LoadingRate { state, rate }, modes, None);
        }
        match after_event(&mut tracer.system, &state, &self.piece, &points, (self.range.direction, self.rises)) {
            NextPiece::Goes { rate, modes, twins, open } => {
                self.note_twins(tracer, twins);
                self.go_on(tracer, LoadingRate { state, rate }, modes, open)
            }
            NextPiece::Nothing { why, none_rises, proved } => Some(self.end_at_event(tracer, &why, none_rises, proved)),
        }
    }

    /// Continues along a rate from the present state; blocks and bonds yield as the rate requires.
    fn go_on(
        &mut self,
        tracer: &mut Tracer,
        found: LoadingRate,
        modes: Vec<ContactMode>,
        open: Option<String>,
    ) -> Option<LoadStepEnding> {
        let was = self.rises;
        let LoadingRate { mut state, rate } = found;
        state.mode = modes;
        let Some(mut piece) = Piece::new(&tracer.system, &state, &rate) else {
            return Some(self.end_at_event(tracer, "the rate that leads on does not move", false, false));
        };
        let here = State { mode: state.mode.clone(), ..tracer.state.clone() };
        if let Some(found) = bond_rate(&mut tracer.system, &here, &piece) {
            state = found.state;
            piece = Piece::new(&tracer.system, &state, &found.rate)?;
        }
        self.enter(tracer, piece, &state);
        self.rises = self.goes_up(tracer, &self.piece.tangent.clone());
        if let Some(ending) = self.plateau(tracer) {
            return Some(ending);
        }
        if was == self.rises {
            return self.after(tracer);
        }
        if was {
            tracer.limit.unproven = open.or(tracer.limit.unproven.take());
        }
        self.at_turn(tracer, was)
    }

    /// Returns the monitors that end at the present state. A piece of zero length shows that the event lacked a point:
    /// the path returns to its arrival, and all of these points are examined together.
    fn all_hits(&mut self, tracer: &mut Tracer, hits: Vec<Monitor>) -> Vec<Monitor> {
        let known = self.cluster.hits.len();
        for hit in hits {
            if !self.cluster.hits.iter().any(|known| known.contact == hit.contact) {
                self.cluster.hits.push(hit);
            }
        }
        let more = self.cluster.hits.len() > known;
        match &self.cluster.arrival {
            Some((modes, piece, rises)) if more => {
                tracer.state.mode.clone_from(modes);
                (self.piece, self.rises) = (piece.clone(), *rises);
            }
            Some(_) => {}
            None => self.cluster.arrival = Some((tracer.state.mode.clone(), self.piece.clone(), self.rises)),
        }
        self.cluster.hits.clone()
    }

    /// Returns the ending if a contact point leaves the face that it slides on.
    fn lose_joint(&mut self, tracer: &mut Tracer, contact: usize) -> LoadStepEnding {
        let slip = tracer.state.gap[contact][1];
        let (apart, why) = lost_joint(&tracer.system.problem.contacts[contact], slip, tracer.state.factor);
        end_at_lost_joint(tracer, apart, Some(&self.piece.tangent), why)
    }

    /// Records other rates at an event that the rule does not distinguish from the chosen one.
    fn note_twins(&self, tracer: &mut Tracer, others: usize) {
        if others > 0 {
            let (branching, note) = twins::record(tracer.in_force.load_step, tracer.state.factor, others);
            tracer.record.branchings.push(branching);
            tracer.record.notes.push(note);
        }
    }

    /// Returns the ending at an event from which no rate continues.
    fn end_at_event(&mut self, tracer: &mut Tracer, why: &str, none_rises: bool, proved: bool) -> LoadStepEnding {
        let factor = tracer.state.factor;
        if self.rises && none_rises {
            tracer.limit.proven = Some(factor);
            note_peak(tracer, Some(&self.piece.tangent), self.range.direction);
        }
        let proved = proved && tracer.limit.peak.is_some();
        if proved {
            let Tracer { system, state, record, .. } = tracer;
            record.witnesses.extend(none_continues(system, (state, &record.state), self.range.direction));
        }
        tracer.ending.limit_point_end = proved.then_some(LimitPointEnd::None);
        let why = format!("at factor {factor} {why}");
        end_path(tracer, if proved { Status::LimitPoint } else { Status::Stalled }, why)
    }

    /// Accepts the modes of the next piece and the tangents of its bonds.
    fn enter(&mut self, tracer: &mut Tracer, piece: Piece, next: &State) {
        let before = tracer.state.clone();
        tracer.state.mode.clone_from(&next.mode);
        for (own, next) in tracer.state.updates.points.iter_mut().zip(&next.updates.points) {
            (own.tangent, own.branch) = (next.tangent, next.branch);
        }
        tracer.record.events.extend(events(&tracer.system, tracer.in_force.load_step, &before, &tracer.state));
        self.piece = piece;
    }

    fn goes_up(&self, tracer: &Tracer, rate: &Tangent) -> bool {
        rate.factor * self.range.direction
            > SETTINGS.rounding * tracer.system.units().factor * motion_size(&tracer.system, rate)
    }

    /// Returns the ending at a mechanism under a constant load. Limit points since which the load has been constant are
    /// the same one: the load of a sliding block changes slightly if contact points reach a corner.
    fn end_at_plateau(&mut self, tracer: &mut Tracer, found: Plateau) -> LoadStepEnding {
        let (load_step, factor) = (tracer.in_force.load_step, tracer.state.factor);
        let same = |other: f64| (other - factor).abs() <= SETTINGS.distinct() * factor.abs();
        let own = |peak: &ProvenPeak| peak.load_step == load_step && same(peak.factor) && same(peak.lowest);
        while tracer.limit.proven_peaks.last().is_some_and(own) {
            tracer.limit.proven_peaks.pop();
        }
        tracer.limit.peak.take_if(|peak| same(peak.factor));
        note_peak(tracer, Some(&self.piece.tangent), self.range.direction);
        if let Some(why) = found.unproved {
            tracer.limit.unproven = Some(why);
            let why = "the load stands still, which is not proved to be its greatest".to_string();
            return end_path(tracer, Status::Stalled, why);
        }
        if !found.moved.into_iter().all(|state| commit(tracer, state)) {
            return LoadStepEnding::Ended;
        }
        end_path(tracer, Status::Collapse, "the structure moves on under a constant load".into())
    }
}
