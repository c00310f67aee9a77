//! Updates of laws at a point by region and size of the batch. Throughput is in updates per second on one core,
//! consistent tangent included. The stone is that of Drosopoulos et al. (2008).

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use voussoir::core::law::{
    BulkMaterial, InterfaceLaw, PlanarPoint, PlanarUpdate, Plane, PointContext, StressPoint, TractionPoint,
    UpdateContext,
};
use voussoir_benches::boundary::{FRICTION, STIFFNESS, gaps, through_the_registry, written_out};
use voussoir_benches::point::{cohesive, paper_stone, states, strains};

fn stress_updates(c: &mut Criterion) {
    let update = paper_stone().stress_update().expect("it deforms");
    let mut group = c.benchmark_group("drucker_prager_cap in space");
    for region in ["elastic", "cap", "transition", "shear", "apex"] {
        for count in [1, 16, 256] {
            let strains = strains(&*update, region, count);
            let old = states(&*update, count);
            let (mut new, mut points) = (old.clone(), vec![StressPoint::ZERO; count]);
            let contexts = vec![UpdateContext::of_length(1.0); count];
            group.throughput(Throughput::Elements(count as u64));
            group.bench_with_input(BenchmarkId::new(region, count), &strains, |b, strains| {
                b.iter(|| update.update(black_box(strains), &contexts, &old, &mut new, &mut points));
            });
        }
    }
    group.finish();
}

fn in_a_plane(c: &mut Criterion) {
    let update = paper_stone().stress_update().expect("it deforms");
    let mut group = c.benchmark_group("drucker_prager_cap in a plane, batches of 256");
    group.throughput(Throughput::Elements(256));
    for (name, plane) in [("plane strain", Plane::Strain), ("plane stress", Plane::Stress)] {
        let planar = PlanarUpdate::new(update.clone(), plane).expect("it deforms");
        for (region, size) in [("elastic", -1e-4), ("cap", -0.02)] {
            let strains = vec![[size, 0.1 * size, 0.05 * size]; 256];
            let mut one = vec![0.0; planar.state_size()];
            planar.initial_state(&mut one);
            let old: Vec<f64> = one.iter().copied().cycle().take(256 * planar.state_size()).collect();
            let (mut new, mut points) = (old.clone(), vec![PlanarPoint::ZERO; 256]);
            group.bench_function(format!("{name}, {region}"), |b| {
                b.iter(|| {
                    planar.update(
                        black_box(&strains),
                        &[UpdateContext::of_length(1.0); 256],
                        &old,
                        &mut new,
                        &mut points,
                    )
                });
            });
        }
    }
    group.finish();
}

fn joints(c: &mut Criterion) {
    let Some(response) = cohesive().response() else { return };
    let mut group = c.benchmark_group("cohesive, batches of 256");
    group.throughput(Throughput::Elements(256));
    for (name, gap) in [("elastic", [-1e-6, 1e-6]), ("softening", [1e-5, 1e-4]), ("sliding", [-1e-5, 1e-3])] {
        let (gaps, contexts) = (vec![gap; 256], vec![PointContext::default(); 256]);
        let old = vec![0.0; 512];
        let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; 256]);
        group.bench_function(name, |b| {
            b.iter(|| response.respond(black_box(&gaps), &contexts, &old, &mut new, &mut points))
        });
    }
    group.finish();
}

/// The same law from a study's table through the registry, and written out, per batch of 64. A facet law without its
/// own formula is measured too.
fn boundary(c: &mut Criterion) {
    let gaps = gaps();
    let contexts = vec![PointContext::default(); 64];
    let mut group = c.benchmark_group("plug-in boundary, batches of 64");
    group.throughput(Throughput::Elements(64));
    for (name, tag) in [("facets through the registry", "coulomb"), ("response through the registry", "bench_friction")]
    {
        let response = through_the_registry(tag);
        let old = vec![0.0; 64 * response.state_size()];
        let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; 64]);
        group.bench_function(name, |b| {
            b.iter(|| response.respond(black_box(&gaps), &contexts, &old, &mut new, &mut points))
        });
    }
    let (old, mut new, mut points) = (vec![0.0; 64], vec![0.0; 64], vec![TractionPoint::ZERO; 64]);
    group.bench_function("written out", |b| {
        b.iter(|| written_out(black_box(STIFFNESS), black_box(FRICTION), black_box(&gaps), &old, &mut new, &mut points))
    });
    group.finish();
}

criterion_group!(benches, stress_updates, in_a_plane, joints, boundary);
criterion_main!(benches);
