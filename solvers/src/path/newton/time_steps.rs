//! Load steps in which time passes or fields change: steps in time whose error is bounded by halving.
//!
//! Time and fields are linear in the factor of the load step, so a step in time is a step to a given factor. Each step is
//! solved once as a whole and once in two halves. The difference is the error of the whole step; the halves are
//! accepted. Contact points may change their modes in a step: modes are found by Newton's method, not as located events.

use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::solve::step::solve_step;
use crate::path::newton::tracing::commit::commit;
use crate::path::newton::tracing::step_energy::step_energy;
use crate::path::newton::tracing::tracer::{LoadStepEnding, Tracer, end_path};
use crate::settings::SETTINGS;
use voussoir_core::limit::Status;
use voussoir_core::path::LoadStep;

/// Greatest number of attempted steps of a load step.
const MAX_STEPS: u64 = 20_000;
/// Bounds on the change of length from one step to the next.
const SHORTEN: f64 = 0.2;
const LENGTHEN: f64 = 3.0;

/// Follows a load step to a factor in steps of time.
pub(super) fn follow(tracer: &mut Tracer, load_step: &LoadStep, target: f64) -> LoadStepEnding {
    let range = target - load_step.start;
    let mut length = SETTINGS.first_time_step;
    for _ in 0..MAX_STEPS {
        let left = (target - tracer.state.factor) / range;
        if left <= 0.0 {
            return LoadStepEnding::Reached;
        }
        // The last step reaches the target exactly, and no step before leaves a short rest.
        let share = if left < 1.5 * length { left } else { length };
        let end = if share == left { target } else { tracer.state.factor + share * range };
        let growth = match halves(tracer, end) {
            Ok((states, error)) if error <= SETTINGS.time_error => {
                let growth = (0.5 * SETTINGS.time_error / error.max(1e-300)).cbrt().clamp(SHORTEN, LENGTHEN);
                match accept(tracer, states, share) {
                    Accepted::Stopped => return LoadStepEnding::Ended,
                    Accepted::Whole(by_energy) => growth.min(by_energy),
                    Accepted::Less(by_energy) => by_energy,
                }
            }
            Ok((_, error)) => (0.5 * SETTINGS.time_error / error).cbrt().clamp(SHORTEN, 0.7),
            Err(why) => {
                tracer.system.report.failure = Some(why);
                SHORTEN
            }
        };
        if growth <= 0.7 {
            tracer.system.count("cutbacks", 1);
        }
        length = share.min(length) * growth;
        if length < SETTINGS.least_time_step {
            let failure = tracer.system.report.failure.take().map_or(String::new(), |why| format!(": {why}"));
            let why = format!("no equilibrium follows in time beyond factor {}{failure}", tracer.state.factor);
            return end_path(tracer, Status::Stalled, why);
        }
    }
    let why = format!("the budget of time steps is used up; the last state is at factor {}", tracer.state.factor);
    end_path(tracer, Status::Stalled, why)
}

/// Solves a step to a factor in two halves. Returns both states, and their difference from one whole step.
fn halves(tracer: &mut Tracer, end: f64) -> Result<([State; 2], f64), String> {
    let start = tracer.state.clone();
    let system = &mut tracer.system;
    let to = |system: &mut StepSystem, from: &State, guess: &State, factor: f64| {
        solve_step(system, from, guess.clone(), &Control::Factor(factor)).map(|(state, _)| state)
    };
    let whole = to(system, &start, &start, end)?;
    let half = to(system, &start, &start, 0.5 * (start.factor + end))?;
    let mut kept = half.clone();
    system.keep(&start, &mut kept);
    let last = to(system, &kept, &whole, end)?;
    let error = difference(&whole.gap, &last.gap).max(difference(&whole.force, &last.force));
    Ok(([half, last], error))
}

/// Returns the greatest difference of two lists, relative to their greatest number.
fn difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let pairs = || a.as_flattened().iter().zip(b.as_flattened());
    let size = pairs().fold(f64::MIN_POSITIVE, |size, (a, b)| size.max(a.abs()).max(b.abs()));
    pairs().fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs())) / size
}

/// The result of two halves.
enum Accepted {
    /// The path ends.
    Stopped,
    /// Both halves are accepted; the factor on the length of the next step by their energies.
    Whole(f64),
    /// The balance of energy requires shorter steps; at most the first half is accepted.
    Less(f64),
}

/// Accepts the halves of a step if their energies are in balance.
fn accept(tracer: &mut Tracer, states: [State; 2], share: f64) -> Accepted {
    let mut growth = f64::INFINITY;
    for state in states {
        let energy = step_energy(tracer, &state);
        if !energy.holds && share > SETTINGS.least_time_step.sqrt() {
            return Accepted::Less(energy.growth.clamp(SHORTEN, 0.7));
        }
        growth = growth.min(energy.growth.max(0.5));
        if !commit(tracer, state) {
            return Accepted::Stopped;
        }
    }
    Accepted::Whole(growth)
}
