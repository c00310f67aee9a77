//! Run time against error: the variants of a study, or every compatible solver with several settings of its accuracy.
//!
//! All contestants get the same question. A case that is not a certified collapse or limit point counts as failed. The error
//! is |λ/λ* − 1| with one reference λ* for each problem. Time is the least of several runs on one thread.

mod contestants;
mod measure;
mod measured;
mod others;
mod output;
mod panels;
mod reference;
mod sweep;

pub use measure::{BenchOptions, Reference};
pub use measured::{Bench, Measurement, Other, Problem, Refinement, Source};
pub use others::{Row, read_others};
pub use output::{csv, profile_chart, table};
pub use panels::{error_chart, error_panels, ladder};
pub use sweep::{PARAMETERS, Rung, Sweep, sweep, sweep_csv, sweep_table};

use contestants::{Contestant, contestants, of_variants};
use measure::{measure, name_of};
use reference::extrapolated;
use voussoir_core::plugin::{Capability, PluginKind, card};
use voussoir_study::solve::accuracy::ends_at_limit_load;
use voussoir_study::study::{Case, Study};

/// Greatest relative distance of bounds that meet.
const MEET: f64 = 1e-6;

/// Measures the variants of a study. If a study has no variants, every compatible solver is measured.
pub fn bench(study: &Study, options: &BenchOptions) -> Bench {
    let variants = study.outline.variants.len();
    let count = study.cases.len() / variants.max(1);
    let mut bench = Bench::default();
    for problem in 0..count {
        let first = &study.cases[problem];
        bench.problems.push(Problem { name: name_of(first), ..Problem::default() });
        let entered = if variants > 0 {
            of_variants((0..variants).map(|variant| &study.cases[variant * count + problem]))
        } else {
            contestants(first)
        };
        for Contestant { name, rung, case } in entered {
            match case {
                Ok(case) => {
                    let measured = measure(problem, (name, rung), &case, options);
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
        refer(&mut bench, problem, (options.reference.as_ref(), named), first);
        if bench.cut_short {
            break;
        }
    }
    bench
}

/// Returns the names of a study's problems, as they are if several studies are measured.
pub fn problems(study: &Study, several: bool) -> Vec<String> {
    let count = study.cases.len() / study.outline.variants.len().max(1);
    let names = study.cases.iter().take(count).map(name_of);
    names.map(|name| if several { measured::name_in(&study.name, &name) } else { name }).collect()
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

/// Sets the errors of a problem's measurements. The reference is, in this order: the requested one; the variant that the
/// study names; limit analysis, if it has the same collapse load; a value extrapolated from two meshes that are finer than all
/// contestants at the joints' ends; a load factor whose proved bounds meet; the last contestant with a load factor.
fn refer(bench: &mut Bench, problem: usize, (asked, named): (Option<&Reference>, Option<&str>), case: &Case) {
    let own = || bench.measurements.iter().filter(|own| own.problem == problem);
    let of = |found: Option<&Measurement>| {
        found.and_then(|own| Some(Source { factor: own.factor()?, from: own.contestant.clone(), band: None }))
    };
    let by_name = |name: &str| of(own().find(|own| own.contestant == name));
    let limit =
        |own: &&Measurement| own.factor().is_some() && card(PluginKind::LimitSolver, &own.result.solver).is_some();
    let offers = |own: &Measurement| {
        card(PluginKind::LimitSolver, &own.result.solver).is_some_and(|card| card.offers(Capability::NON_ASSOCIATED))
    };
    let proved = |own: &Measurement| {
        let [lower, upper] = own.result.bounds.filter(|_| offers(own))?;
        let band = (upper? - lower?).abs() / upper?.abs();
        Some(Source { factor: own.factor()?, from: own.contestant.clone(), band: Some(band) }).filter(|_| band <= MEET)
    };
    let found = match (asked, named) {
        (Some(Reference::Known(factor)), _) => Some(Source { factor: *factor, from: "given".into(), band: None }),
        (Some(Reference::Named(name)), _) => by_name(name),
        (None, Some(name)) => by_name(name),
        (None, None) => of(own().filter(|_| ends_at_limit_load(case)).find(limit))
            .or_else(|| extrapolated(case, own()))
            .or_else(|| own().find_map(proved))
            .or_else(|| of(own().rfind(|own| own.factor().is_some()))),
    };
    let Some(source) = &found else { return };
    for own in bench.measurements.iter_mut().filter(|own| own.problem == problem && own.contestant != source.from) {
        own.error = own.factor().map(|factor| source.error_of(factor));
    }
    bench.problems[problem].reference = found;
}
