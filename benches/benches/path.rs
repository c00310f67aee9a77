//! Newton path and exact path: dead and live load of the 14-joint arch, with rigid voussoirs on compliant joints and
//! with elastic voussoirs, condensation included; cost against the number of voussoirs.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use voussoir::core::path::{PathProblem, PathSettings, PathSolver, Unobserved};
use voussoir::solvers::path::event::EventPath;
use voussoir::solvers::path::newton::NewtonPath;
use voussoir::study::Case;
use voussoir_benches::{compliant_ring, elastic_ring};

fn settings(finite: bool) -> PathSettings {
    PathSettings {
        finite,
        tolerance: 1e-9,
        stop_displacement: None,
        stop_factor: None,
        continuation: None,
        stages: Vec::new(),
    }
}

fn traced(solver: &dyn PathSolver, case: &Case, finite: bool) -> Option<f64> {
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    solver.trace(&problem, &settings(finite), &mut Unobserved).factor
}

fn path(case: &Case, finite: bool) -> Option<f64> {
    traced(&NewtonPath {}, case, finite)
}

fn events(case: &Case) -> Option<f64> {
    traced(&EventPath {}, case, false)
}

fn the_arch(c: &mut Criterion) {
    let mut group = c.benchmark_group("newton_path, arch of 14 joints, condensation included");
    group.sample_size(10);
    let (rigid, elastic) = (compliant_ring(13), elastic_ring(13));
    group.bench_function("rigid, compliant joints, small", |b| b.iter(|| path(black_box(&rigid), false)));
    group.bench_function("elastic 4 x 6 quadratic, small", |b| b.iter(|| path(black_box(&elastic), false)));
    group.bench_function("elastic 4 x 6 quadratic, finite", |b| b.iter(|| path(black_box(&elastic), true)));
    group.finish();
}

fn cost_against_voussoirs(c: &mut Criterion) {
    let mut group = c.benchmark_group("newton_path against the number of voussoirs, one load step");
    group.sample_size(10);
    for voussoirs in [13, 130, 1300] {
        let mut case = compliant_ring(voussoirs);
        case.stages.truncate(1);
        group.throughput(Throughput::Elements(voussoirs as u64));
        group.bench_with_input(BenchmarkId::from_parameter(voussoirs), &case, |b, case| b.iter(|| path(case, false)));
    }
    group.finish();
}

fn exact_arch(c: &mut Criterion) {
    let mut group = c.benchmark_group("event_path, arch of 14 joints, condensation included");
    group.sample_size(10);
    let (rigid, elastic) = (compliant_ring(13), elastic_ring(13));
    group.bench_function("rigid, compliant joints", |b| b.iter(|| events(black_box(&rigid))));
    group.bench_function("elastic 4 x 6 quadratic", |b| b.iter(|| events(black_box(&elastic))));
    let problem = || PathProblem::new(&elastic.assembly, &elastic.stages).map(|p| p.contacts.len());
    group.bench_function("elastic 4 x 6 quadratic, condensation alone", |b| b.iter(|| black_box(problem())));
    group.finish();
}

/// Whole paths to collapse. The number of events grows with the number of voussoirs. On rigid voussoirs an event
/// involves few joints, on elastic voussoirs every contact point.
fn to_collapse(c: &mut Criterion) {
    let (newton, events) = (&NewtonPath {} as &dyn PathSolver, &EventPath {} as &dyn PathSolver);
    for (name, solver, elastic, sizes) in [
        ("newton_path to collapse against voussoirs, rigid", newton, false, vec![13, 130, 400, 1300]),
        ("newton_path to collapse against voussoirs, elastic", newton, true, vec![13, 40, 130]),
        ("event_path to collapse against voussoirs, rigid", events, false, vec![13, 130, 400, 1300]),
        ("event_path to collapse against voussoirs, elastic", events, true, vec![13, 40, 130]),
    ] {
        let mut group = c.benchmark_group(name);
        group.sample_size(10);
        for voussoirs in sizes {
            let case = if elastic { elastic_ring(voussoirs) } else { compliant_ring(voussoirs) };
            group.throughput(Throughput::Elements(voussoirs as u64));
            group.bench_with_input(BenchmarkId::from_parameter(voussoirs), &case, |b, case| {
                b.iter(|| traced(solver, case, false));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, the_arch, cost_against_voussoirs, exact_arch, to_collapse);
criterion_main!(benches);
