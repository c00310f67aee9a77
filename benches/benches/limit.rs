//! Limit analysis: both solvers on the 14-joint arch, the chain solver against the number of joints, the conic solver
//! on walls. Times include the certificate.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use voussoir::core::limit::{LimitProblem, LimitQuestion, LimitSolver};
use voussoir::core::model::stage_loads;
use voussoir::solve_case;
use voussoir::solvers::limit::chain::LimitChain;
use voussoir::solvers::limit::conic::LimitConic;
use voussoir_benches::{ring, wall};

fn solvers_on_the_arch(c: &mut Criterion) {
    let case = ring(13, "auto");
    let loads = stage_loads(&case.assembly, &case.stages);
    let problem = LimitProblem::new(&case.assembly, &loads[1]).expect("an arch");
    let question = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };
    let mut group = c.benchmark_group("arch of 14 joints, solver alone");
    group.bench_function("limit_chain", |b| b.iter(|| LimitChain {}.solve(black_box(&problem), question)));
    group.bench_function("limit_conic", |b| b.iter(|| LimitConic {}.solve(black_box(&problem), question)));
    group.finish();
    let mut group = c.benchmark_group("arch of 14 joints, with certificate and mechanism");
    for solver in ["limit_chain", "limit_conic"] {
        let case = ring(13, solver);
        group.bench_function(solver, |b| b.iter(|| solve_case(black_box(&case))));
    }
    group.finish();
}

fn cost_against_joints(c: &mut Criterion) {
    let mut group = c.benchmark_group("limit_chain against the number of voussoirs");
    group.sample_size(20);
    for voussoirs in [100, 1000, 10_000] {
        let case = ring(voussoirs, "limit_chain");
        let loads = stage_loads(&case.assembly, &case.stages);
        let problem = LimitProblem::new(&case.assembly, &loads[1]).expect("an arch");
        let question = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };
        group.throughput(Throughput::Elements(voussoirs as u64));
        group.bench_with_input(BenchmarkId::from_parameter(voussoirs), &problem, |b, problem| {
            b.iter(|| LimitChain {}.solve(black_box(problem), question));
        });
    }
    group.finish();
}

fn walls(c: &mut Criterion) {
    let mut group = c.benchmark_group("limit_conic on walls, with certificate");
    group.sample_size(10);
    for side in [5, 10, 20] {
        let case = wall(side, side);
        group.bench_function(format!("{side} courses of {side} bricks"), |b| b.iter(|| solve_case(black_box(&case))));
    }
    group.finish();
}

criterion_group!(benches, solvers_on_the_arch, cost_against_joints, walls);
criterion_main!(benches);
