//! A step along a piece, which ends at the first event if there is one in it.
//!
//! Monitors are known with their rates at both ends of a step. One that is negative at the end has a root in it. One that is
//! positive at both ends, but whose cubic of Hermite is negative between them, may have two: the step is cut there. A
//! root is bracketed, and located by the roots of cubics to the tolerance of the monitor.

use super::super::control::Control;
use super::super::state::{State, Tangent};
use super::super::system::StepSystem;
use super::super::tracer::moved;
use super::corrector::correct;
use super::monitors::Reading;
use super::piece::{Piece, scaled_row};

/// Length of a step, relative to that at which the first event would be if all rates stayed: the event is then in it.
const BEYOND: f64 = 1.02;
/// Distance from the predictor, relative to the step, up to which a step goes straight to the target.
const STRAIGHT: f64 = 0.1;
/// Length, in units, that is rounding of a state.
const ROUNDING: f64 = 1e-7;
/// Points between the ends of a step at which a cubic is looked at.
const SAMPLES: usize = 16;
/// States that are computed to locate an event.
const MOST_TRIALS: usize = 100;
/// Width of a bracket, relative to the step, at which an event is located whatever its monitor reads.
const NARROW: f64 = 1e-13;
/// Change of the factor in a step, relative to it, below which it is not looked at.
const FLAT: f64 = 1e-7;
/// Rate of the factor, relative to that at the start, at which it turns.
const TURNS: f64 = 1e-8;

/// A state of a piece at the end of a step.
pub(super) struct StepEnd {
    pub state: State,
    /// Its rate per unit of the step's length.
    pub rate: Tangent,
    pub length: f64,
    /// Distance from the predictor, relative to the length.
    pub error: f64,
    /// Error of the trapezoidal rule for the factor's change by its rates at both ends, relative to that change.
    /// Without it a factor that falls, rises and falls again within the step would not be noticed.
    pub unexplained: f64,
}

/// How a step ends.
pub(super) enum Advance {
    /// Without an event.
    Whole(StepEnd),
    /// The modes of some monitors end: their numbers.
    Event(StepEnd, Vec<usize>),
    /// The factor turns.
    Turn(StepEnd),
    /// The target.
    Target(StepEnd),
    /// Newton's method finds no state. A shorter step may.
    Failed,
}

impl Advance {
    /// The last state.
    pub fn end(&self) -> Option<&StepEnd> {
        match self {
            Advance::Whole(end) | Advance::Event(end, _) | Advance::Turn(end) | Advance::Target(end) => Some(end),
            Advance::Failed => None,
        }
    }
}

/// What is looked for besides events.
#[derive(Clone, Copy)]
pub(super) struct Watched {
    /// Sign of the rate of the factor, if its change is looked for.
    pub sense: Option<f64>,
    /// A factor, and the sign in which it is approached.
    pub target: Option<(f64, f64)>,
}

/// A state on the piece with its readings: those of the monitors, then of the factor's rate, then of the target.
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
        let mut all = self.piece.read(self.system, state, rate);
        let unit = self.system.units().factor;
        let never = Reading { value: 1.0, rate: None, tolerance: 0.0, rate_tolerance: 0.0 };
        let at_start = (self.piece.tangent.factor / unit).abs();
        all.push(self.watched.sense.map_or(never, |sense| Reading {
            value: sense * rate.factor / unit,
            tolerance: TURNS * at_start,
            ..never
        }));
        all.push(self.watched.target.map_or(never, |(target, direction)| Reading {
            value: (target - state.factor) * direction / unit,
            rate: Some(-rate.factor * direction / unit),
            tolerance: 1e-14 * (target / unit).abs().max(1e-3),
            rate_tolerance: 0.0,
        }));
        all
    }

    /// The state at a length, from one nearer to the start.
    fn trial(&mut self, from: &StepEnd, length: f64) -> Option<Trial> {
        self.controlled(from, length, &self.piece.control(length))
    }

    /// The state of a control, about a length away.
    fn controlled(&mut self, from: &StepEnd, length: f64, control: &Control) -> Option<Trial> {
        let guess = moved(&from.state, &from.rate, length - from.length);
        let state = correct(self.system, self.start, guess, control)?;
        let rate = self.piece.rate_at(self.system, self.start, &state)?;
        let step = Tangent {
            force: Vec::new(),
            gap: Vec::new(),
            motion: differences(&state.motion, &self.start.motion),
            factor: state.factor - self.start.factor,
        };
        let moved = scaled_row(self.system, &step);
        let away: f64 = moved.iter().zip(self.piece.row.iter()).map(|(x, t)| (x - length * t).powi(2)).sum();
        let error = away.sqrt() / length.abs().max(1e-300);
        let unexplained = self.unexplained(&state, &rate, length);
        let readings = self.readings(&state, &rate);
        Some(Trial { end: StepEnd { state, rate, length, error, unexplained }, readings })
    }

    /// Error of the trapezoidal rule for the factor.
    fn unexplained(&self, end: &State, rate: &Tangent, length: f64) -> f64 {
        let [before, after] = [self.piece.tangent.factor, rate.factor].map(|slope| slope * length);
        let gained = end.factor - self.start.factor;
        let size = before.abs().max(after.abs()).max(FLAT * end.factor.abs().max(self.system.units().factor));
        (gained - 0.5 * (before + after)).abs() / size
    }

    /// The state at the target, if a step of a length reaches it by its rate and all modes hold there.
    fn reaching_target(&mut self, low: &StepEnd, length: f64) -> Option<StepEnd> {
        let (target, _) = self.watched.target?;
        let reach = (target - low.state.factor) / low.rate.factor;
        if !(reach > 0.0 && reach <= length.max(ROUNDING)) {
            return None;
        }
        let found = self.controlled(low, reach, &Control::Factor(target))?;
        let monitors = found.readings.len() - 1;
        let holds = !found.readings[..monitors].iter().any(Reading::is_violated);
        (holds && found.end.error <= STRAIGHT + ROUNDING / reach).then_some(found.end)
    }
}

/// Differences of motions.
fn differences(after: &[[f64; 3]], before: &[[f64; 3]]) -> Vec<[f64; 3]> {
    after.iter().zip(before).map(|(a, b)| [0, 1, 2].map(|k| a[k] - b[k])).collect()
}

/// The state at a length along a piece from one of its states, whatever its monitors read.
pub(super) fn state_at(system: &mut StepSystem, start: &State, piece: &Piece, length: f64) -> Option<StepEnd> {
    let low = StepEnd { state: start.clone(), rate: piece.tangent.clone(), length: 0.0, error: 0.0, unexplained: 0.0 };
    let mut step = Step { system, start, piece, watched: Watched { sense: None, target: None } };
    step.trial(&low, length).map(|trial| trial.end)
}

/// Goes a length along a piece from one of its states.
pub(super) fn advance(system: &mut StepSystem, start: &State, piece: &Piece, length: f64, watched: Watched) -> Advance {
    let mut step = Step { system, start, piece, watched };
    let readings = step.readings(start, &piece.tangent);
    let end = StepEnd { state: start.clone(), rate: piece.tangent.clone(), length: 0.0, error: 0.0, unexplained: 0.0 };
    let low = Trial { end, readings };
    let length = length.min(BEYOND * first_crossing(&low.readings));
    if let Some(end) = step.reaching_target(&low.end, length) {
        return Advance::Target(end);
    }
    let Some(high) = step.trial(&low.end, length) else { return Advance::Failed };
    let violated = |trial: &Trial| trial.readings.iter().any(Reading::is_violated);
    if violated(&high) {
        return locate(&mut step, low, high);
    }
    match hidden_root(&low, &high) {
        Some(share) => match step.trial(&low.end, share * length) {
            Some(middle) if violated(&middle) => locate(&mut step, low, middle),
            Some(middle) => Advance::Whole(middle.end),
            None => Advance::Failed,
        },
        None => Advance::Whole(high.end),
    }
}

/// Length at which the first monitor would be zero if all rates stayed.
pub(super) fn first_crossing(readings: &[Reading]) -> f64 {
    let crossing = |reading: &Reading| {
        let rate = reading.rate.filter(|rate| *rate < 0.0 && reading.value > reading.tolerance)?;
        Some(reading.value / -rate)
    };
    readings.iter().filter_map(crossing).fold(f64::INFINITY, f64::min)
}

/// Locates the first event between a state at which all modes hold and one at which some do not.
fn locate(step: &mut Step, mut low: Trial, mut high: Trial) -> Advance {
    let whole = high.end.length;
    let mut last = f64::INFINITY;
    for _ in 0..MOST_TRIALS {
        let width = high.end.length - low.end.length;
        if width <= NARROW * whole {
            break;
        }
        // If the root of a cubic has not halved the bracket, a half does: a rate may jump where a material yields.
        let share = if width > 0.5 * last { 0.5 } else { first_root(&low, &high).clamp(1e-6, 1.0 - 1e-6) };
        last = width;
        let at = low.end.length + share * width;
        let Some(middle) = step.trial(&low.end, at) else { return Advance::Failed };
        if middle.readings.iter().any(Reading::is_violated) {
            high = middle;
            continue;
        }
        let was = |i: usize| high.readings[i].is_violated();
        let arrived =
            (0..middle.readings.len()).any(|i| was(i) && middle.readings[i].value <= middle.readings[i].tolerance);
        low = middle;
        if arrived {
            break;
        }
    }
    ended(low, &high)
}

/// What ends a step at `low`, behind which `high` violates something.
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
    match (hits.is_empty(), at(target), at(turn)) {
        (_, true, _) => Advance::Target(low.end),
        (false, ..) => Advance::Event(low.end, hits),
        (true, _, true) => Advance::Turn(low.end),
        // The bracket is narrower than rounding: all that end in it end here.
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

/// Share of the way from one trial to another at which the first violated reading is zero.
fn first_root(low: &Trial, high: &Trial) -> f64 {
    let width = high.end.length - low.end.length;
    let root = |(a, b): (&Reading, &Reading)| {
        let [from, to] = [a.value.max(0.0), b.value];
        if from == 0.0 {
            return 0.0;
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

/// The cubic of Hermite by values and derivatives at 0 and 1.
fn cubic([a, da, b, db]: [f64; 4], x: f64) -> f64 {
    let y = 1.0 - x;
    a * y * y * (1.0 + 2.0 * x) + da * x * y * y + b * x * x * (3.0 - 2.0 * x) - db * x * x * y
}

/// The first root of a cubic that is positive at 0.
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

/// Share of a step at which a monitor that is positive at both ends may be negative.
fn hidden_root(low: &Trial, high: &Trial) -> Option<f64> {
    let width = high.end.length;
    let hidden = |(a, b): (&Reading, &Reading)| {
        let (da, db) = (a.rate?, b.rate?);
        let of = [a.value, da * width, b.value, db * width];
        // Only one that turns inside has a least value there.
        if a.value <= a.tolerance || da >= 0.0 || db <= 0.0 {
            return None;
        }
        let below = (1..SAMPLES).any(|k| cubic(of, k as f64 / SAMPLES as f64) < -a.tolerance);
        below.then(|| cubic_root(of)).flatten()
    };
    let monitors = low.readings.iter().zip(&high.readings).filter_map(hidden);
    monitors.chain(hidden_turn(low, high)).reduce(f64::min)
}

/// Share of a step at which the factor may turn if it goes in one sense at both ends.
fn hidden_turn(low: &Trial, high: &Trial) -> Option<f64> {
    let width = high.end.length;
    let [da, db] = [low, high].map(|trial| trial.end.rate.factor * width);
    if da * db <= 0.0 {
        return None;
    }
    let gained = high.end.state.factor - low.end.state.factor;
    // The derivative of the cubic of the factor, in the sense at the ends.
    let slope = |x: f64| {
        (6.0 * gained * x * (1.0 - x) + da * (1.0 - x) * (1.0 - 3.0 * x) + db * x * (3.0 * x - 2.0)) * da.signum()
    };
    (1..SAMPLES).map(|k| k as f64 / SAMPLES as f64).find(|x| slope(*x) < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cubic has the values and derivatives that it is made from.
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
