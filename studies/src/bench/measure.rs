//! One measurement of a bench, and the options of all.

use super::measured::{Measurement, Refinement};
use voussoir_study::cases::solve_case;
use voussoir_study::study::Case;

/// Least duration of a timed measurement \[s\].
const TICKS: f64 = 0.05;
/// Greatest number of repetitions in a timed measurement.
const MOST_OFTEN: u32 = 1 << 12;

/// Options of a bench.
pub struct BenchOptions<'a> {
    /// Runs of each contestant; the fastest run counts.
    pub runs: usize,
    /// Reference of the errors.
    pub reference: Option<Reference>,
    /// Returns the time \[s\]; the difference of two readings is a duration.
    pub clock: &'a dyn Fn() -> f64,
    /// Receives each measurement; returns false to stop the bench.
    pub told: &'a dyn Fn(&Measurement) -> bool,
}

/// The reference of errors.
#[derive(Debug, Clone, PartialEq)]
pub enum Reference {
    /// The results of this variant or contestant.
    Named(String),
    /// A known load factor.
    Known(f64),
}

/// Returns the scene and the swept values of a case.
pub(super) fn name_of(case: &Case) -> String {
    let value = |(key, value): (&String, &serde_json::Value)| format!("{key} = {value}");
    case.scene.iter().cloned().chain(case.parameters.iter().map(value)).collect::<Vec<_>>().join(", ")
}

/// Solves a case and measures the time.
pub(super) fn measure(
    problem: usize,
    (contestant, rung): (String, Option<Refinement>),
    case: &Case,
    options: &BenchOptions,
) -> Measurement {
    let result = solve_case(case);
    // The resolution of clocks is a few milliseconds: short work is repeated until the clock shows it.
    let (mut seconds, mut often) = (f64::INFINITY, 1u32);
    let mut left = options.runs.max(1);
    while left > 0 {
        let start = (options.clock)();
        (0..often).for_each(|_| drop(std::hint::black_box(solve_case(case))));
        let spent = (options.clock)() - start;
        if spent < TICKS && often < MOST_OFTEN {
            often *= 2;
            continue;
        }
        seconds = seconds.min(spent / f64::from(often));
        left -= 1;
    }
    Measurement { problem, contestant, rung, error: None, seconds, result }
}
