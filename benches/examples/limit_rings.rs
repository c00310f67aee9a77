//! Limit analysis of rings of n voussoirs: processor time of the solution alone and of the certified case, and
//! counters.
//!
//! `cargo run --release -p voussoir-benches --example limit_rings -- 13 1000 5000`. For a profiler, `--once 13 100`
//! only solves the ring of 13 a hundred times, and `--certified 13 100` its case.

use voussoir::core::limit::{LimitProblem, LimitQuestion, LimitSolver};
use voussoir::core::model::stage_loads;
use voussoir::solve_case;
use voussoir::solvers::limit::chain::LimitChain;
use voussoir_benches::{least_processor_time, ring};

const QUESTION: LimitQuestion = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };

fn problem(voussoirs: usize) -> LimitProblem {
    let case = ring(voussoirs, "limit_chain");
    let loads = stage_loads(&case.assembly, &case.stages);
    LimitProblem::new(&case.assembly, &loads[1]).expect("an arch")
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let numbers: Vec<usize> = words.iter().filter_map(|word| word.parse().ok()).collect();
    match (words.first().map(String::as_str), numbers.as_slice()) {
        (Some("--once"), &[voussoirs, times]) => {
            let problem = problem(voussoirs);
            (0..times).for_each(|_| drop(std::hint::black_box(LimitChain {}.solve(&problem, QUESTION))));
        }
        (Some("--certified"), &[voussoirs, times]) => {
            let case = ring(voussoirs, "limit_chain");
            (0..times).for_each(|_| drop(std::hint::black_box(solve_case(&case))));
        }
        _ => numbers.into_iter().for_each(measure),
    }
}

fn measure(voussoirs: usize) {
    let (case, problem) = (ring(voussoirs, "limit_chain"), problem(voussoirs));
    let alone = least(voussoirs, || LimitChain {}.solve(&problem, QUESTION));
    let made = least(voussoirs, || {
        let loads = stage_loads(&case.assembly, &case.stages);
        LimitProblem::new(&case.assembly, &loads[1])
    });
    let certified = least(voussoirs, || solve_case(&case));
    let result = solve_case(&case);
    println!(
        "{voussoirs}: {:?} in {:.1} µs alone, {:.1} µs with its problem and certificate (the problem {:.1}); {:?}",
        result.load_factor,
        1e6 * alone,
        1e6 * certified,
        1e6 * made,
        result.counters
    );
}

/// Seconds of one of many runs, the least of five batches: the system may count processor time in hundredths of a
/// second.
fn least<T>(voussoirs: usize, work: impl Fn() -> T) -> f64 {
    let times = (300_000 / voussoirs).max(20);
    let batch = || (0..times).for_each(|_| drop(std::hint::black_box(work())));
    least_processor_time(5, batch) / times as f64
}
