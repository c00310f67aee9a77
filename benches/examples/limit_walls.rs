//! Limit analysis of walls of n × n bricks: processor time of the solution alone and of the certified case, counters,
//! and the gap between the bounds.
//!
//! `cargo run --release -p voussoir-benches --example limit_walls -- 10 20 40`

use voussoir::core::limit::{LimitProblem, LimitQuestion, LimitSolver};
use voussoir::core::model::stage_loads;
use voussoir::solve_case;
use voussoir::solvers::limit::conic::LimitConic;
use voussoir_benches::{least_processor_time, wall};

fn main() {
    for side in std::env::args().skip(1).filter_map(|n| n.parse().ok()) {
        let case = wall(side, side);
        let loads = stage_loads(&case.assembly, &case.stages);
        let problem = LimitProblem::new(&case.assembly, &loads[1]).expect("a wall");
        let question = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };
        let runs = if side > 30 { 1 } else { 200 / side };
        let alone = least_processor_time(runs, || LimitConic {}.solve(&problem, question));
        let certified = least_processor_time(runs, || solve_case(&case));
        let result = solve_case(&case);
        println!(
            "{side}: {:.17} solved in {:.3} ms, certified in {:.3} ms, {:?}, unique {:?}, {:?}",
            result.load_factor.unwrap_or(f64::NAN),
            1e3 * alone,
            1e3 * certified,
            result.status,
            result.mechanism.and_then(|m| m.unique),
            result.certificate.residuals
        );
        println!("    {:?}", result.counters);
    }
}
