//! A step along a piece, which ends at the first event if there is one in it.
//!
//! A step ends at the state at which the monitor that ends first by its rate is zero, if no other one is negative there.
//! Otherwise the values and rates of monitors are known at both ends of a step. A monitor that is negative at the end has
//! a root in the step. A monitor that is positive at both ends may have two roots if its Hermite cubic is negative between
//! them; the step then ends there. A root is bracketed, and located by the roots of cubics to the tolerance of the
//! monitor. A step also ends where an open point with dilatancy turns along its joint.

use super::corrector::correct;
use super::monitors::Reading;
use super::piece::Piece;
use crate::linear::{inner, largest};
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::{State, Tangent, moved};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::ahead::length_ahead;
use crate::path::newton::quantities::control_row::scaled_row;
use crate::path::newton::solve::iteration::first_state;
use crate::path::newton::solve::tangent::gap_rounding;
use crate::settings::SETTINGS;

/// Number of points between the ends of a step at which a cubic is evaluated.
const SAMPLES: usize = 16;
/// Greatest number of states that are computed to locate an event.
const MAX_TRIALS: usize = 100;

/// A state of a piece at the end of a step.
#[derive(Clone)]
pub(super) struct StepEnd {
    pub state: State,
    /// Its rate per unit of the step's length.
    pub rate: Tangent,
    pub length: f64,
    /// Distance from the predictor, relative to the length.
    pub error: f64,
    /// Error of the trapezoidal rule for the factor's change, from its rates at both ends, relative to that change. It
    /// reveals a factor that falls, rises and falls again within the step.
    pub unexplained: f64,
}

impl StepEnd {
    /// Returns the first state of a piece, where a step begins.
    pub fn first(start: &State, piece: &Piece) -> Self {
        StepEnd { state: start.clone(), rate: piece.tangent.clone(), length: 0.0, error: 0.0, unexplained: 0.0 }
    }
}

/// The end of a step.
pub(super) enum Advance {
    /// No event.
    Whole(StepEnd),
    /// The modes of some monitors end: their indices.
    Event(StepEnd, Vec<usize>),
    /// The factor turns.
    Turn(StepEnd),
    /// The target is reached.
    Target(StepEnd),
    /// Newton's method finds no state; a shorter step may succeed.
    Failed,
}

impl Advance {
    /// Returns the last state.
    pub fn end(&self) -> Option<&StepEnd> {
        match self {
            Advance::Whole(end) | Advance::Event(end, _) | Advance::Turn(end) | Advance::Target(end) => Some(end),
            Advance::Failed => None,
        }
    }
}

/// The other ends of a step that are located besides events.
#[derive(Clone, Copy)]
pub(super) struct Watched {
    /// Sign of the rate of the factor, if its change is located.
    pub sense: Option<f64>,
    /// A factor, and the sign in which it is approached.
    pub target: Option<(f64, f64)>,
}

/// A state on the piece with its readings: first the monitors, then the rate of the factor, then the target.
struct Trial {
    end: StepEnd,
    readings: Vec<Reading>,
}

struct Step<'a, 's> {
    system: &'a mut StepSystem<'s>,
    start: &'a State,
    piece: &'a Piece,
    watched: Watched,
}

impl Step<'_, '_> {
    fn readings(&self, state: &State, rate: &Tangent) -> Vec<Reading> {
        let mut all = self.piece.read(self.system, self.start, state, rate);
        let unit = self.system.units().factor;
        let never = Reading::NEVER;
        let at_start = (self.piece.tangent.factor / unit).abs();
        // Just beyond the turn the load is the same to rounding, and no rate of the piece raises it.
        all.push(self.watched.sense.map_or(never, |sense| Reading {
            value: sense * rate.factor / unit + SETTINGS.same_rate() * at_start,
            tolerance: (SETTINGS.active * at_start).max(SETTINGS.rounding),
            ..never
        }));
        all.push(self.watched.target.map_or(never, |(target, direction)| Reading {
            value: (target - state.factor) * direction / unit,
            rate: Some(-rate.factor * direction / unit),
            tolerance: 1e-14 * (target / unit).abs().max(1e-3),
            ..never
        }));
        all
    }

    /// Returns the length at which the first branch of a law of tractions ends if its rate is constant.
    fn branch_crossing(&self, readings: &[Reading]) -> f64 {
        readings.iter().filter(|reading| reading.of_branch).map(|reading| reading.value).fold(f64::INFINITY, f64::min)
    }

    /// Computes the state at a length, from a state nearer to the start.
    fn trial(&mut self, from: &StepEnd, length: f64) -> Option<Trial> {
        self.controlled(from, length, &self.piece.control(length))
    }

    /// Computes the state of a control, about `length` away.
    fn controlled(&mut self, from: &StepEnd, length: f64, control: &Control) -> Option<Trial> {
        let guess = moved(&from.state, &from.rate, length - from.length);
        let state = correct(self.system, self.start, guess, control)?;
        let rate = self.piece.rate_at(self.system, &state)?;
        let step = chord(self.start, &state);
        let moved = scaled_row(self.system, &step);
        let length = inner(&moved, &self.piece.row);
        let away: f64 = moved.iter().zip(self.piece.row.iter()).map(|(x, t)| (x - length * t).powi(2)).sum();
        let error = away.sqrt() / length.abs().max(1e-300);
        if error > self.system.limits.branch + SETTINGS.inequality() / length.abs().max(1e-300) {
            return None;
        }
        let unexplained = self.unexplained(&state, &rate, length);
        let readings = self.readings(&state, &rate);
        Some(Trial { end: StepEnd { state, rate, length, error, unexplained }, readings })
    }

    /// Returns the distance of two states over the scaled unknowns.
    fn distance(&self, low: &Trial, high: &Trial) -> f64 {
        let row = scaled_row(self.system, &chord(&low.end.state, &high.end.state));
        inner(&row, &row).sqrt()
    }

    /// Returns the error of the trapezoidal rule for the factor.
    fn unexplained(&self, end: &State, rate: &Tangent, length: f64) -> f64 {
        let [before, after] = [self.piece.tangent.factor, rate.factor].map(|slope| slope * length);
        let gained = end.factor - self.start.factor;
        let size =
            before.abs().max(after.abs()).max(SETTINGS.same_rate() * end.factor.abs().max(self.system.units().factor));
        (gained - 0.5 * (before + after)).abs() / size
    }

    /// Computes the state at which a monitor is zero: the one that ends first by the rates, about `length` away.
    fn landing(&mut self, low: &Trial, first: usize, length: f64) -> Option<Trial> {
        let control = self.piece.monitors.0.get(first)?.control(self.system, self.start, &self.piece.tangent)?;
        let found = self.controlled(&low.end, length, &control)?;
        (found.end.length > 0.0 && found.end.error <= SETTINGS.most_error).then_some(found)
    }

    /// Computes the state at the target, if a step of a length reaches it by its rate and all modes hold there.
    fn reaching_target(&mut self, low: &StepEnd, length: f64) -> Option<StepEnd> {
        let (target, _) = self.watched.target?;
        let reach = (target - low.state.factor) / low.rate.factor;
        if !(reach > 0.0 && reach <= length.max(SETTINGS.same_rate())) {
            return None;
        }
        let found = self.controlled(low, reach, &Control::Factor(target))?;
        let monitors = found.readings.len() - 1;
        let holds = !found.readings[..monitors].iter().any(Reading::is_violated);
        (holds && found.end.error <= SETTINGS.most_error + SETTINGS.same_rate() / reach).then_some(found.end)
    }
}

/// Returns the change from one state to another.
pub(super) fn chord(from: &State, to: &State) -> Tangent {
    let pairs = |a: &[[f64; 2]], b: &[[f64; 2]]| a.iter().zip(b).map(|(a, b)| [a[0] - b[0], a[1] - b[1]]).collect();
    Tangent {
        force: pairs(&to.force, &from.force),
        gap: pairs(&to.gap, &from.gap),
        motion: to.motion.iter().zip(&from.motion).map(|(a, b)| [0, 1, 2].map(|k| a[k] - b[k])).collect(),
        factor: to.factor - from.factor,
    }
}

/// Computes the state at a length along a piece `from` the first of some states that leads there, whatever its readings.
pub(super) fn state_at(
    system: &mut StepSystem,
    (start, piece): (&State, &Piece),
    from: &[&StepEnd],
    length: f64,
) -> Option<StepEnd> {
    let mut step = Step { system, start, piece, watched: Watched { sense: None, target: None } };
    from.iter().find_map(|from| step.trial(from, length)).map(|trial| trial.end)
}

/// Returns the state at a share of the way between two states of a piece, by the Hermite cubics of its unknowns. Their errors are of
/// fourth order in the distance. `None` if the states do not lie on one smooth curve.
pub(super) fn between(
    system: &mut StepSystem,
    (start, piece): (&State, &Piece),
    [low, high]: [&StepEnd; 2],
    share: f64,
) -> Option<StepEnd> {
    let (width, rest) = (high.length - low.length, 1.0 - share);
    let chord = chord(&low.state, &high.state);
    let [moved_by, before, after] = [&chord, &low.rate, &high.rate].map(|rate| scaled_row(system, rate));
    let off = moved_by.iter().zip(before.iter().zip(&after)).map(|(x, (a, b))| (x - 0.5 * width * (a + b)).powi(2));
    if off.sum::<f64>().sqrt() > SETTINGS.wanted_error * inner(&moved_by, &moved_by).sqrt() {
        return None;
    }
    let parts = [
        (&chord, share * share * (3.0 - 2.0 * share)),
        (&low.rate, width * share * rest * rest),
        (&high.rate, -width * share * share * rest),
    ];
    let guess = parts.into_iter().fold(low.state.clone(), |state, (rate, by)| moved(&state, rate, by));
    let length = low.length + share * width;
    let (state, _) = first_state(system, start, guess, &piece.control(length)).ok()?;
    Some(StepEnd { state, length, ..high.clone() })
}

/// Moves a length along a piece from one of its states.
pub(super) fn advance(
    system: &mut StepSystem,
    (start, piece): (&State, &Piece),
    length: f64,
    watched: Watched,
) -> Advance {
    let mut found = to_first_event(system, (start, piece), length, watched);
    for _ in 0..MAX_TRIALS {
        let turn = found.end().and_then(|end| turn_of_open_points(system, (start, piece), end));
        let before = turn.and_then(|at| state_at(system, (start, piece), &[&StepEnd::first(start, piece)], at));
        match before {
            Some(end) => found = Advance::Whole(end),
            None => break,
        }
    }
    found
}

/// Returns the first length at which an open point with dilatancy changes the sense of its motion along the joint. The irreversible gap
/// of such a point grows in both senses.
fn turn_of_open_points(system: &StepSystem, (start, piece): (&State, &Piece), end: &StepEnd) -> Option<f64> {
    // A shorter motion before the turn is below the accuracy of gaps.
    let least = gap_rounding(system, &end.state).max(SETTINGS.admissible * largest(end.state.gap.as_flattened()));
    let turn = |c: usize| {
        let law = system.law(c).filter(|law| law.opens(start.mode[c]))?;
        law.facets.iter().find(|facet| facet.flow[0] * facet.flow[1] != 0.0)?;
        let slid = end.state.gap[c][1] - start.gap[c][1];
        let rates = [&piece.tangent, &end.rate].map(|rate| rate.gap[c][1] * end.length);
        let at = |k: usize| k as f64 / SAMPLES as f64;
        let turns = |k: usize| {
            let [a, b] = [k - 1, k].map(|k| slope(slid, rates, at(k)));
            (a * b < 0.0).then(|| at(k - 1) + a / (a - b) * at(1))
        };
        let inside =
            |share: &f64| share.min(1.0 - share) > SETTINGS.small && share * rates[0].abs().max(rates[1].abs()) > least;
        (1..=SAMPLES).filter_map(turns).find(inside).map(|share| share * end.length)
    };
    (0..start.mode.len()).filter_map(turn).reduce(f64::min)
}

/// Moves a length along a piece from one of its states, at most to the first event.
fn to_first_event(system: &mut StepSystem, (start, piece): (&State, &Piece), length: f64, watched: Watched) -> Advance {
    let mut step = Step { system, start, piece, watched };
    let readings = step.readings(start, &piece.tangent);
    let low = Trial { end: StepEnd::first(start, piece), readings };
    let (first, crossing) = first_crossing(&low.readings);
    // Beyond the end of a branch of a law of tractions a state along the present tangent may not exist.
    let of_branch = step.branch_crossing(&low.readings);
    let lands = crossing < of_branch && SETTINGS.beyond * crossing <= length;
    let length = length.min(if of_branch <= crossing { of_branch } else { SETTINGS.beyond * crossing });
    if let Some(end) = step.reaching_target(&low.end, length) {
        return Advance::Target(end);
    }
    let violated = |trial: &Trial| trial.readings.iter().any(Reading::is_violated);
    if lands && let Some(found) = step.landing(&low, first, crossing) {
        if violated(&found) {
            return locate(&mut step, low, found);
        }
        let monitors = found.readings.len() - 2;
        let hits: Vec<usize> = (0..monitors).filter(|i| found.readings[*i].leaves()).collect();
        if hits.contains(&first) && hidden_root(&low, &found, step.watched.sense.is_some()).is_none() {
            return Advance::Event(found.end, hits);
        }
    }
    let Some(high) = step.trial(&low.end, length) else { return Advance::Failed };
    if violated(&high) {
        return locate(&mut step, low, high);
    }
    match hidden_root(&low, &high, step.watched.sense.is_some()) {
        Some(share) => match step.trial(&low.end, share * length) {
            Some(middle) if violated(&middle) => locate(&mut step, low, middle),
            Some(middle) => Advance::Whole(middle.end),
            None => Advance::Failed,
        },
        None if length == of_branch => at_branch_end(&mut step, low, high),
        None => Advance::Whole(high.end),
    }
}

/// Moves from a state next to the end of a law's branch to this end.
fn at_branch_end(step: &mut Step, low: Trial, mut high: Trial) -> Advance {
    for _ in 0..MAX_TRIALS {
        let left = step.branch_crossing(&high.readings);
        if high.readings.iter().any(|own| own.of_branch && own.value <= own.tolerance) {
            let monitors = high.readings.len() - 2;
            let hits = (0..monitors).filter(|i| high.readings[*i].is_active()).collect();
            return Advance::Event(high.end, hits);
        }
        if left > SETTINGS.wanted_error * high.end.length {
            break;
        }
        let Some(next) = step.trial(&high.end, high.end.length + left) else { return Advance::Failed };
        if next.readings.iter().any(Reading::is_violated) {
            return locate(step, low, next);
        }
        high = next;
    }
    Advance::Whole(high.end)
}

/// Returns the first monitor that would be zero with constant rates, and the length up to there.
pub(super) fn first_crossing(readings: &[Reading]) -> (usize, f64) {
    let crossing = |(i, reading): (usize, &Reading)| {
        let rate = reading.rate.filter(|rate| *rate < 0.0 && reading.value > reading.tolerance)?;
        Some((i, reading.value / -rate))
    };
    let first = readings.iter().enumerate().filter_map(crossing).min_by(|a, b| a.1.total_cmp(&b.1));
    first.unwrap_or((readings.len(), f64::INFINITY))
}

/// Locates the first event between a state at which all modes hold and one at which some do not.
fn locate(step: &mut Step, mut low: Trial, mut high: Trial) -> Advance {
    let whole = high.end.length;
    let mut last = f64::INFINITY;
    for _ in 0..MAX_TRIALS {
        let width = high.end.length - low.end.length;
        if width <= SETTINGS.rounding * whole {
            break;
        }
        // If the root of a cubic has not halved the bracket, bisect: rates may jump if a material yields.
        let share = if width > 0.5 * last { 0.5 } else { first_root(&low, &high).clamp(1e-6, 1.0 - 1e-6) };
        last = width;
        let at = low.end.length + share * width;
        let Some(middle) = step.trial(&low.end, at) else { return Advance::Failed };
        if middle.readings.iter().any(Reading::is_violated) {
            high = middle;
            continue;
        }
        // A monitor that stays at zero is violated beyond a corner of the path: only the bracket locates it.
        let arrives = |i: usize| {
            let here = &middle.readings[i];
            let falls =
                low.readings[i].value > here.tolerance || here.rate.is_some_and(|rate| rate < -here.rate_tolerance);
            high.readings[i].is_violated() && here.value <= here.tolerance && falls
        };
        let arrived = (0..middle.readings.len()).any(arrives);
        low = middle;
        if arrived {
            return ended(polished(step, low), &high);
        }
    }
    // Slacks and openings are continuous along a path: a jump over the bracket leads to another branch.
    let jumps = |(a, b): (&Reading, &Reading)| a.rate.is_some() && !a.is_active() && b.is_violated();
    let far = SETTINGS.cancels * (high.end.length - low.end.length) + length_ahead(step.system, step.start);
    match step.distance(&low, &high) > far || low.readings.iter().zip(&high.readings).any(jumps) {
        true if low.end.length > 0.0 => Advance::Whole(low.end),
        true => Advance::Failed,
        false => ended(low, &high),
    }
}

/// Returns the state at which the first monitor of an event is zero to 1 % of its tolerance. A force that is left there
/// moves the point at once in its next mode, in a soft structure by more than the tolerance of openings.
fn polished(step: &mut Step, arrived: Trial) -> Trial {
    let crossing = |reading: &Reading| {
        let rate = reading.rate.filter(|rate| reading.is_active() && *rate < -reading.rate_tolerance)?;
        Some((reading.value / -rate, reading.value > 0.01 * reading.tolerance))
    };
    let first = arrived.readings.iter().filter_map(crossing).min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((left, true)) = first else { return arrived };
    let next = step.trial(&arrived.end, arrived.end.length + left);
    next.filter(|next| !next.readings.iter().any(Reading::is_violated)).unwrap_or(arrived)
}

/// Returns the end of a step at `low`; `high` beyond it violates a monitor.
fn ended(low: Trial, high: &Trial) -> Advance {
    let monitors = low.readings.len() - 2;
    let ends = |i: usize| {
        let (here, beyond) = (&low.readings[i], &high.readings[i]);
        let falls = beyond.value < here.value || here.rate.is_some_and(|rate| rate < 0.0);
        here.is_active() && (beyond.is_violated() || falls)
    };
    let hits: Vec<usize> = (0..monitors).filter(|i| ends(*i)).collect();
    let (turn, target) = (monitors, monitors + 1);
    let at = |i: usize| high.readings[i].is_violated() && low.readings[i].is_active();
    // Monitors that stay at zero are no events of a turn.
    let none_ends = !hits.iter().any(|i| high.readings[*i].is_violated());
    match (hits.is_empty(), at(target), at(turn) && none_ends) {
        (_, true, _) => Advance::Target(low.end),
        (_, _, true) => Advance::Turn(low.end),
        (false, ..) => Advance::Event(low.end, hits),
        // The bracket is narrower than rounding: all monitors that end in it end here.
        _ => {
            let hits: Vec<usize> = (0..monitors).filter(|i| high.readings[*i].is_violated()).collect();
            match (hits.is_empty(), high.readings[target].is_violated()) {
                (false, _) => Advance::Event(low.end, hits),
                (true, true) => Advance::Target(low.end),
                (true, false) => Advance::Turn(low.end),
            }
        }
    }
}

/// Returns the share of the way from one trial to another at which the first violated reading is zero.
fn first_root(low: &Trial, high: &Trial) -> f64 {
    let width = high.end.length - low.end.length;
    let root = |(a, b): (&Reading, &Reading)| {
        let [from, to] = [a.value.max(0.0), b.value];
        if from <= a.tolerance {
            return 0.5;
        }
        let linear = from / (from - to);
        match (a.rate, b.rate) {
            (Some(da), Some(db)) => cubic_root([from, da * width, to, db * width]).unwrap_or(linear),
            _ => linear,
        }
    };
    let pairs = low.readings.iter().zip(&high.readings).filter(|(_, b)| b.is_violated());
    pairs.map(root).fold(1.0, f64::min)
}

/// Evaluates the Hermite cubic with these values and derivatives at 0 and 1.
fn cubic([a, da, b, db]: [f64; 4], x: f64) -> f64 {
    let y = 1.0 - x;
    a * y * y * (1.0 + 2.0 * x) + da * x * y * y + b * x * x * (3.0 - 2.0 * x) - db * x * x * y
}

/// Evaluates the derivative of the Hermite cubic with these derivatives at 0 and 1 that gains a value between them.
fn slope(gained: f64, [da, db]: [f64; 2], x: f64) -> f64 {
    6.0 * gained * x * (1.0 - x) + da * (1.0 - x) * (1.0 - 3.0 * x) + db * x * (3.0 * x - 2.0)
}

/// Returns the first root of a cubic that is positive at 0.
fn cubic_root(of: [f64; 4]) -> Option<f64> {
    let at = |k: usize| k as f64 / SAMPLES as f64;
    let k = (1..=SAMPLES).find(|k| cubic(of, at(*k)) < 0.0)?;
    let (mut low, mut high) = (at(k - 1), at(k));
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if cubic(of, middle) < 0.0 { high = middle } else { low = middle }
    }
    Some(0.5 * (low + high))
}

/// Returns the share of a step at which a monitor positive at both ends may be negative, or a `watched` factor turn.
fn hidden_root(low: &Trial, high: &Trial, watched: bool) -> Option<f64> {
    let width = high.end.length;
    let hidden = |(a, b): (&Reading, &Reading)| {
        let (da, db) = (a.rate?, b.rate?);
        let of = [a.value, da * width, b.value, db * width];
        // Only a monitor that turns inside the step has its minimum there.
        if a.value <= a.tolerance || da >= 0.0 || db <= 0.0 {
            return None;
        }
        let below = (1..SAMPLES).any(|k| cubic(of, k as f64 / SAMPLES as f64) < -a.tolerance);
        below.then(|| cubic_root(of)).flatten()
    };
    let monitors = low.readings.iter().zip(&high.readings).filter_map(hidden);
    let turn = if watched { hidden_turn(low, high) } else { None };
    monitors.chain(turn).reduce(f64::min)
}

/// Returns the share of a step at which the factor may turn if it has the same sense at both ends.
fn hidden_turn(low: &Trial, high: &Trial) -> Option<f64> {
    let width = high.end.length;
    let [da, db] = [low, high].map(|trial| trial.end.rate.factor * width);
    if da * db <= 0.0 {
        return None;
    }
    let gained = high.end.state.factor - low.end.state.factor;
    (1..SAMPLES).map(|k| k as f64 / SAMPLES as f64).find(|x| slope(gained, [da, db], *x) * da.signum() < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cubic has the given values and derivatives.
    #[test]
    fn a_cubic_takes_its_values_and_derivatives() {
        let of = [2.0, -3.0, 0.5, 4.0];
        let slope = |x: f64| (cubic(of, x + 1e-6) - cubic(of, x - 1e-6)) / 2e-6;
        for (found, right) in [(cubic(of, 0.0), 2.0), (cubic(of, 1.0), 0.5), (slope(0.0), -3.0), (slope(1.0), 4.0)] {
            assert!((found - right).abs() < 1e-8, "{found} {right}");
        }
    }

    /// A monitor that is positive at both ends of a step and negative between them has a root in it.
    #[test]
    fn the_first_of_two_roots_is_found() {
        // 1 − 5 x + 5 x²
        let root = cubic_root([1.0, -5.0, 1.0, 5.0]).expect("a root");
        assert!((root - (5.0 - 5f64.sqrt()) / 10.0).abs() < 1e-12, "{root}");
    }
}
