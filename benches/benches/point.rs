//! Updates of laws at a point by region and size of the batch: throughput is updates per second on one
//! core, consistent tangent included. The stone is that of Drosopoulos et al. (2008).

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::hint::black_box;
use std::sync::Arc;
use voussoir::core::law::{
    BulkMaterial, Effect, InterfaceLaw, InterfaceResponse, PlanarPoint, PlanarUpdate, Plane, StressPoint,
    TractionPoint, UpdateBranch, UpdateContext, UpdateFailure,
};
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
        let gaps = vec![gap; 256];
        let old = vec![0.0; 512];
        let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; 256]);
        group.bench_function(name, |b| b.iter(|| response.respond(black_box(&gaps), &old, &mut new, &mut points)));
    }
    group.finish();
}

/// Dry friction at a point, written out where it is called: what the plug-in boundary is measured against. The same
/// operations, in the same order, as the law gives; tractions, tangent, energies and state.
#[inline(always)]
fn inlined(
    [k_n, k_t]: [f64; 2],
    friction: f64,
    gap: [f64; 2],
    old: f64,
) -> Result<(TractionPoint, f64), UpdateFailure> {
    if !gap.iter().chain([&old]).all(|x| x.is_finite()) {
        return Err(UpdateFailure::NotFinite);
    }
    let trial = [-k_n * gap[0], -k_t * (gap[1] - old)];
    if trial[0] < 0.0 {
        return Ok((TractionPoint::ZERO, gap[1]));
    }
    let limit = friction * trial[0];
    let stored = |t: [f64; 2]| 0.5 * (t[0] * t[0] / k_n + t[1] * t[1] / k_t);
    if trial[1].abs() <= limit {
        let tangent = [[-k_n, 0.0], [0.0, -k_t]];
        let branch = UpdateBranch::ELASTIC;
        return Ok((TractionPoint { traction: trial, tangent, branch, stored: stored(trial), dissipated: 0.0 }, old));
    }
    let sense = trial[1].signum();
    let traction = [trial[0], sense * limit];
    let slip = (trial[1] - traction[1]) / k_t;
    let tangent = [[-k_n, 0.0], [-sense * friction * k_n, 0.0]];
    let branch = UpdateBranch::new("sliding", Effect::Sliding);
    let dissipated = limit * slip.abs();
    Ok((TractionPoint { traction, tangent, branch, stored: stored(traction), dissipated }, old - slip))
}

/// The same law, from a study's table through the registry and written out, per batch of 64: half of the points stick, a
/// quarter slides, a quarter is open. Facets, which know no formula, are measured beside it.
fn boundary(c: &mut Criterion) {
    let (stiffness, friction) = ([1e10, 5e9], 0.6);
    let gaps: Vec<[f64; 2]> = (0..64)
        .map(|i| match i % 4 {
            0 | 2 => [-1e-5, 1e-6 * f64::from(i)],
            1 => [-1e-5, 1e-4 + 1e-6 * f64::from(i)],
            _ => [1e-5, 1e-5],
        })
        .collect();
    let mut group = c.benchmark_group("plug-in boundary, batches of 64");
    group.throughput(Throughput::Elements(64));
    let laws = [
        ("facets through the registry", json!({ "law": "coulomb" })),
        ("response through the registry", json!({ "law": "bench_friction" })),
    ];
    for (name, mut table) in laws {
        for (key, value) in
            [("friction", friction), ("normal_stiffness", stiffness[0]), ("shear_stiffness", stiffness[1])]
        {
            table[key] = json!(value);
        }
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(table).expect("a registered law");
        let response = law.response().expect("tractions from gaps");
        let old = vec![0.0; 64 * response.state_size()];
        let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; 64]);
        response.respond(&gaps, &old, &mut new, &mut points).expect("answers");
        for (gap, point) in gaps.iter().zip(&points) {
            let (own, _) = inlined(stiffness, friction, *gap, 0.0).expect("an answer");
            assert!(
                (0..2).all(|i| (own.traction[i] - point.traction[i]).abs() <= 1e-9 * 1e5),
                "{name}: {point:?} {own:?}"
            );
        }
        group.bench_function(name, |b| b.iter(|| response.respond(black_box(&gaps), &old, &mut new, &mut points)));
    }
    let old = vec![0.0; 64];
    let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; 64]);
    group.bench_function("written out", |b| {
        b.iter(|| -> Result<(), UpdateFailure> {
            for (i, gap) in black_box(&gaps).iter().enumerate() {
                (points[i], new[i]) = inlined(black_box(stiffness), black_box(friction), *gap, old[i])?;
            }
            black_box((&points, &new));
            Ok(())
        });
    });
    group.finish();
}

/// [`inlined`] as a plug-in, so that the same formula is on both sides of the boundary.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct BenchFriction {
    friction: f64,
    normal_stiffness: f64,
    shear_stiffness: f64,
}

#[typetag::serde(name = "bench_friction")]
impl InterfaceLaw for BenchFriction {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(self.clone()))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        Some([self.normal_stiffness, self.shear_stiffness])
    }
}

impl InterfaceResponse for BenchFriction {
    fn state_size(&self) -> usize {
        1
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["slip [m]"]
    }

    fn respond_point(&self, gap: [f64; 2], old: &[f64], new: &mut [f64]) -> Result<TractionPoint, UpdateFailure> {
        let (point, slip) = inlined([self.normal_stiffness, self.shear_stiffness], self.friction, gap, old[0])?;
        new[0] = slip;
        Ok(point)
    }
}

criterion_group!(benches, stress_updates, in_a_plane, joints, boundary);
criterion_main!(benches);
