//! Run time against error: the variants of a study, or every compatible solver with several settings of its accuracy.
//!
//! All contestants get the same question. A case that is not a certified collapse or limit point counts as failed. The error
//! is |λ/λ* − 1| with one reference λ* for each problem. Time is the least of several runs on one thread.

mod contestants;
mod measured;
mod output;

pub use measured::{Bench, Measurement, Problem};
pub use output::{csv, error_chart, profile_chart, table};

use contestants::{Contestant, contestants, of_variants};
use voussoir_core::plugin::{PluginKind, card};
use voussoir_study::cases::solve_case;
use voussoir_study::solve::accuracy::ends_at_limit_load;
use voussoir_study::study::{Case, Study};

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

/// Measures the variants of a study. If a study has no variants, every compatible solver is measured.
pub fn bench(study: &Study, options: &BenchOptions) -> Bench {
    let variants = study.outline.variants.len();
    let count = study.cases.len() / variants.max(1);
    let mut bench = Bench::default();
    for problem in 0..count {
        let first = &study.cases[problem];
        bench.problems.push(Problem { name: name_of(first), reference: None });
        let entered = if variants > 0 {
            of_variants((0..variants).map(|variant| &study.cases[variant * count + problem]))
        } else {
            contestants(first)
        };
        for Contestant { name, case } in entered {
            match case {
                Ok(case) => {
                    let measured = measure(problem, name, &case, options);
                    let go_on = (options.told)(&measured);
                    bench.measurements.push(measured);
                    if !go_on {
                        bench.cut_short = true;
                        break;
                    }
                }
                Err(why) => bench.refused.push((problem, name, why)),
            }
        }
        let named = study.outline.table.get("reference").and_then(|name| name.as_str());
        refer(&mut bench, problem, (options.reference.as_ref(), named), ends_at_limit_load(first));
        if bench.cut_short {
            break;
        }
    }
    bench
}

/// Returns the names of the contestants of the first problem.
pub fn names(study: &Study) -> Vec<String> {
    match (study.outline.variants.is_empty(), study.cases.first()) {
        (true, Some(case)) => {
            contestants(case).into_iter().filter(|own| own.case.is_ok()).map(|own| own.name).collect()
        }
        _ => study.outline.variants.clone(),
    }
}

fn name_of(case: &Case) -> String {
    let value = |(key, value): (&String, &serde_json::Value)| format!("{key} = {value}");
    case.scene.iter().cloned().chain(case.parameters.iter().map(value)).collect::<Vec<_>>().join(", ")
}

fn measure(problem: usize, contestant: String, case: &Case, options: &BenchOptions) -> Measurement {
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
    Measurement { problem, contestant, error: None, seconds, result }
}

/// Sets the errors of a problem's measurements. The reference is, in this order: the requested one; the variant that the
/// study names; limit analysis, if it answers the `same` question; the last contestant with a load factor, usually the finest
/// mesh of a path solver.
fn refer(bench: &mut Bench, problem: usize, (asked, named): (Option<&Reference>, Option<&str>), same: bool) {
    let own = || bench.measurements.iter().filter(|own| own.problem == problem);
    let of = |found: Option<&Measurement>| found.and_then(|own| Some((own.factor()?, own.contestant.clone())));
    let by_name = |name: &str| of(own().find(|own| own.contestant == name));
    let limit = |own: &&Measurement| card(PluginKind::LimitSolver, &own.result.solver).is_some();
    let found = match (asked, named) {
        (Some(Reference::Known(factor)), _) => Some((*factor, "given".to_string())),
        (Some(Reference::Named(name)), _) => by_name(name),
        (None, Some(name)) => by_name(name),
        (None, None) => {
            of(own().filter(|_| same).find(limit)).or_else(|| of(own().rfind(|own| own.factor().is_some())))
        }
    };
    let Some((factor, from)) = found else { return };
    for own in bench.measurements.iter_mut().filter(|own| own.problem == problem && own.contestant != from) {
        own.error = own.factor().map(|own| if factor == 0.0 { own.abs() } else { (own / factor - 1.0).abs() });
    }
    bench.problems[problem].reference = Some((factor, from));
}
