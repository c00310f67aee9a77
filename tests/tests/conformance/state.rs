//! Every law with state walks through the samples of its card: purity, tangent against finite differences,
//! dissipation and the other claims, energy, batches, no allocation. A new law edits nothing here.

use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};
use std::collections::BTreeMap;
use std::sync::Arc;
use voussoir::core::law::{
    BulkMaterial, FacetMode, InterfaceLaw, InterfaceResponse, PlanarPoint, PlanarUpdate, Plane, StressPoint,
    StressUpdate, TractionPoint, UpdateContext,
};
use voussoir::core::plugin::{Capability, Card, PluginKind, Property, Sample};
use voussoir_tests::samples::samples;

fn uniform(rng: &mut TestRng, low: f64, high: f64) -> f64 {
    low + (high - low) * (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

fn rng() -> TestRng {
    TestRng::from_seed(RngAlgorithm::ChaCha, &[3; 32])
}

/// A law's card and sample, the law at a point, the same after a round trip, and its greatest stiffness.
struct Subject<T> {
    card: &'static Card,
    sample: &'static Sample,
    law: T,
    again: T,
    stiffness: f64,
}

fn materials() -> Vec<Subject<Arc<dyn StressUpdate>>> {
    let mut all = Vec::new();
    for (card, sample, table) in samples(PluginKind::BulkMaterial) {
        let material: Box<dyn BulkMaterial> = serde_json::from_value(table).unwrap();
        let again: Box<dyn BulkMaterial> = serde_json::from_value(serde_json::to_value(&material).unwrap()).unwrap();
        assert_eq!(material.stress_update().is_some(), card.offers(Capability::STRESS_UPDATE), "{}", card.tag);
        let Some((law, again)) = material.stress_update().zip(again.stress_update()) else { continue };
        let (old, mut new) = (untouched(&*law), untouched(&*law));
        let point = law.update_point(&[0.0; 6], &UpdateContext::of_length(length(&*law)), &old, &mut new).unwrap();
        let stiffness = point.tangent.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        all.push(Subject { card, sample, law, again, stiffness });
    }
    all
}

fn joints() -> Vec<Subject<Arc<dyn InterfaceResponse>>> {
    let mut all = Vec::new();
    for (card, sample, table) in samples(PluginKind::InterfaceLaw) {
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(table).unwrap();
        let again: Box<dyn InterfaceLaw> = serde_json::from_value(serde_json::to_value(&law).unwrap()).unwrap();
        assert_eq!(law.response().is_some(), card.offers(Capability::RESPONSE), "{}", card.tag);
        let Some((law, again)) = law.response().zip(again.response()) else { continue };
        let (mut old, mut new) = (vec![0.0; law.state_size()], vec![0.0; law.state_size()]);
        law.initial_state(&mut old);
        let point = law.respond_point([-1e-3 * sample.size, 0.0], &old, &mut new).unwrap();
        let stiffness = point.tangent.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        all.push(Subject { card, sample, law, again, stiffness });
    }
    all
}

fn untouched(law: &dyn StressUpdate) -> Vec<f64> {
    let mut state = vec![0.0; law.state_size()];
    law.initial_state(&mut state);
    state
}

fn length(update: &dyn StressUpdate) -> f64 {
    if update.largest_length().is_finite() { 0.3 * update.largest_length() } else { 1.0 }
}

/// How often a tangent was compared in each branch.
#[derive(Default)]
struct Compared(BTreeMap<&'static str, usize>);

impl Compared {
    fn enough(&self, card: &Card, sample: &Sample) {
        println!("{}: {:?}", card.tag, self.0);
        for wanted in sample.branches {
            let count = self.0.get(wanted).copied().unwrap_or(0);
            assert!(count >= 50, "{}: \"{wanted}\" was met {count} times by the walks of {sample:?}", card.tag);
        }
    }
}

/// Random walks through strain: equal calls give equal answers, the batch is the points, plastic work is
/// never negative, and the tangent is the derivative wherever ±h stays in one region.
#[test]
fn every_material_with_state_conforms() {
    let mut rng = rng();
    for Subject { card, sample, law, again, stiffness } in materials() {
        let (tag, size, length) = (card.tag, law.state_size(), length(&*law));
        let mut compared = Compared::default();
        assert_eq!(law.state_names().len(), size, "{tag}");
        for _ in 0..150 {
            let (mut old, mut strain) = (untouched(&*law), [0.0; 6]);
            for _ in 0..25 {
                let step = sample.size * 10f64.powf(uniform(&mut rng, -1.5, 0.5));
                strain.iter_mut().for_each(|e| *e += step * uniform(&mut rng, -1.0, 1.0));
                let (mut new, mut other) = (vec![0.0; size], vec![9.0; size]);
                let here = law
                    .update_point(&strain, &UpdateContext::of_length(length), &old, &mut new)
                    .unwrap_or_else(|f| panic!("{tag}: {f}"));
                assert_eq!(
                    here,
                    again.update_point(&strain, &UpdateContext::of_length(length), &old, &mut other).unwrap(),
                    "{tag} is not pure"
                );
                assert_eq!(new, other, "{tag} is not pure");
                let mut batch = [StressPoint::ZERO];
                law.update(&[strain], &[UpdateContext::of_length(length)], &old, &mut other, &mut batch).unwrap();
                assert_eq!((batch[0], &new), (here, &other), "{tag}");
                let work = stiffness * sample.size * sample.size;
                let creates = here.dissipated < -3e-14 * work && card.claims(Property::DISSIPATIVE);
                assert!(!creates, "{tag}: dissipation {:e}", here.dissipated);
                let skew = (0..36).map(|k| (here.tangent[k / 6][k % 6] - here.tangent[k % 6][k / 6]).abs());
                let skew = skew.fold(0.0, f64::max);
                assert!(skew <= 1e-12 * stiffness || !card.claims(Property::SYMMETRIC_TANGENT), "{tag}: {skew:e}");
                let direction: [f64; 6] = std::array::from_fn(|_| uniform(&mut rng, -1.0, 1.0));
                let h = 1e-6 * (sample.size + strain.iter().fold(0.0_f64, |a, b| a.max(b.abs())));
                let mut same = true;
                let mut at = |factor: f64| {
                    let moved: [f64; 6] = std::array::from_fn(|i| strain[i] + factor * h * direction[i]);
                    let point = law.update_point(&moved, &UpdateContext::of_length(length), &old, &mut other).unwrap();
                    same &= point.branch == here.branch;
                    point.stress
                };
                let (a, b, c, d) = (at(1.0), at(-1.0), at(0.5), at(-0.5));
                let worst = |f: &dyn Fn(usize) -> f64| (0..6).fold(0.0_f64, |m, i| m.max(f(i).abs())) / stiffness;
                let spread = worst(&|i| (a[i] - b[i]) / (2.0 * h) - (c[i] - d[i]) / h);
                if same && spread < 3e-6 {
                    let error =
                        worst(&|i| (0..6).map(|j| here.tangent[i][j] * direction[j]).sum::<f64>() - (c[i] - d[i]) / h);
                    assert!(error < 3e-6, "{tag}: tangent off by {error:e} in {:?}", here.branch);
                    *compared.0.entry(here.branch.name).or_default() += 1;
                }
                old = new;
            }
        }
        compared.enough(card, sample);
    }
}

/// The same for joints.
#[test]
fn every_joint_with_state_conforms() {
    let mut rng = rng();
    for Subject { card, sample, law, again, stiffness } in joints() {
        let (tag, size) = (card.tag, law.state_size());
        let mut compared = Compared::default();
        assert_eq!(law.state_names().len(), size, "{tag}");
        for _ in 0..200 {
            let mut old = vec![0.0; size];
            law.initial_state(&mut old);
            let mut gap = [0.0; 2];
            for _ in 0..25 {
                let step = sample.size * 10f64.powf(uniform(&mut rng, -1.5, 0.5));
                gap.iter_mut().for_each(|g| *g += step * uniform(&mut rng, -1.0, 1.0));
                let (mut new, mut other) = (vec![0.0; size], vec![9.0; size]);
                let here = law.respond_point(gap, &old, &mut new).unwrap_or_else(|f| panic!("{tag}: {f}"));
                assert_eq!(here, again.respond_point(gap, &old, &mut other).unwrap(), "{tag} is not pure");
                let mut batch = [TractionPoint::ZERO];
                law.respond(&[gap], &old, &mut other, &mut batch).unwrap();
                assert_eq!((batch[0], &new), (here, &other), "{tag}");
                let creates = here.dissipated < 0.0 && card.claims(Property::DISSIPATIVE);
                assert!(!creates && here.stored >= 0.0, "{tag}: {here:?}");
                let skew = (here.tangent[0][1] - here.tangent[1][0]).abs();
                assert!(skew <= 1e-12 * stiffness || !card.claims(Property::SYMMETRIC_TANGENT), "{tag}: {skew:e}");
                let direction: [f64; 2] = std::array::from_fn(|_| uniform(&mut rng, -1.0, 1.0));
                let h = 1e-6 * (sample.size + gap[0].abs().max(gap[1].abs()));
                let mut at = |factor: f64| {
                    let moved = [gap[0] + factor * h * direction[0], gap[1] + factor * h * direction[1]];
                    law.respond_point(moved, &old, &mut other).unwrap()
                };
                let (a, b, c, d) = (at(1.0), at(-1.0), at(0.5), at(-0.5));
                let same = [a, b, c, d].iter().all(|point| point.branch == here.branch);
                let worst = |f: &dyn Fn(usize) -> f64| f(0).abs().max(f(1).abs()) / stiffness;
                let spread =
                    worst(&|i| (a.traction[i] - b.traction[i]) / (2.0 * h) - (c.traction[i] - d.traction[i]) / h);
                if same && spread < 4e-6 {
                    let error = worst(&|i| {
                        here.tangent[i][0] * direction[0] + here.tangent[i][1] * direction[1]
                            - (c.traction[i] - d.traction[i]) / h
                    });
                    assert!(error < 4e-6, "{tag}: tangent off by {error:e} in {:?}", here.branch);
                    *compared.0.entry(here.branch.name).or_default() += 1;
                }
                old = new;
            }
        }
        compared.enough(card, sample);
    }
}

/// Whether v = Σ γ r with γ ≥ 0 over at most two of the rays.
fn in_cone(v: [f64; 2], rays: &[[f64; 2]], tolerance: f64) -> bool {
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let length = |a: [f64; 2]| a[0].hypot(a[1]);
    let alone = |r: &[f64; 2]| cross(v, *r).abs() <= tolerance * length(*r) && v[0] * r[0] + v[1] * r[1] >= 0.0;
    let pair = |r: &[f64; 2], s: &[f64; 2]| {
        let d = cross(*r, *s);
        d != 0.0 && cross(v, *s) / d >= 0.0 && cross(*r, v) / d >= 0.0
    };
    length(v) <= tolerance || rays.iter().any(|r| alone(r) || rays.iter().any(|s| pair(r, s)))
}

/// Where a law has both forms they say the same: tractions lie within the facets, and the gap that stiffness does
/// not explain grows along the flow of facets that are reached. A facet without tensile strength opens and closes.
#[test]
fn facets_and_tractions_from_gaps_agree() {
    let (mut rng, mut flows) = (rng(), 0);
    for (card, sample, table) in samples(PluginKind::InterfaceLaw) {
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(table).unwrap();
        let (Some(facets), Some(response), Some(k)) = (law.facets(), law.response(), law.stiffness()) else { continue };
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let tolerance = 1e-9 * sample.size;
        for _ in 0..200 {
            let (mut old, mut new) = (vec![0.0; response.state_size()], vec![0.0; response.state_size()]);
            response.initial_state(&mut old);
            let (mut gap, mut before) = ([0.0; 2], [0.0; 2]);
            for _ in 0..25 {
                let step = sample.size * 10f64.powf(uniform(&mut rng, -1.5, 0.5));
                gap.iter_mut().for_each(|g| *g += step * uniform(&mut rng, -1.0, 1.0));
                let t = response.respond_point(gap, &old, &mut new).unwrap().traction;
                let excess = |a: [f64; 2], b: f64| (dot(a, t) - b) / k[0].max(k[1]);
                assert!(
                    facets.iter().all(|f| excess(f.normal, f.bound) <= tolerance),
                    "{}: {t:?} at {gap:?}",
                    card.tag
                );
                let after = [gap[0] + t[0] / k[0], gap[1] + t[1] / k[1]];
                let mut rays = Vec::new();
                for facet in &facets {
                    let ray = facet.flow.map(|d| -d);
                    let reversible = facet.mode == FacetMode::Opening && facet.bound == 0.0;
                    rays.extend(reversible.then_some(facet.flow));
                    rays.extend((reversible || excess(facet.normal, facet.bound) >= -tolerance).then_some(ray));
                }
                let flow = [after[0] - before[0], after[1] - before[1]];
                assert!(in_cone(flow, &rays, tolerance), "{}: flow {flow:?} at {t:?}, not of {rays:?}", card.tag);
                flows += usize::from(flow[0].hypot(flow[1]) > tolerance);
                (before, old) = (after, new.clone());
            }
        }
    }
    assert!(flows >= 10_000, "only {flows} steps flowed");
}

/// Work = change of stored energy + dissipation, with an error that falls in proportion to the step.
#[test]
fn the_energy_of_a_joint_balances() {
    for Subject { card, sample, law, stiffness, .. } in joints() {
        let unit = sample.size;
        let path = |s: f64| [unit * (0.6 * (9.0 * s).sin() - 0.25), unit * (1.5 * (7.0 * s).sin() + 0.8 * s)];
        let mut errors = Vec::new();
        for steps in [2000, 4000, 8000] {
            let mut old = vec![0.0; law.state_size()];
            law.initial_state(&mut old);
            let mut new = old.clone();
            let start = path(0.0);
            let mut before = law.respond_point(start, &old, &mut new).unwrap();
            old.copy_from_slice(&new);
            let (mut work, mut dissipated, stored, mut gap) = (0.0, 0.0, before.stored, start);
            for step in 1..=steps {
                let to = path(f64::from(step) / f64::from(steps));
                let point = law.respond_point(to, &old, &mut new).unwrap();
                old.copy_from_slice(&new);
                for i in 0..2 {
                    work -= 0.5 * (before.traction[i] + point.traction[i]) * (to[i] - gap[i]);
                }
                dissipated += point.dissipated;
                (before, gap) = (point, to);
            }
            errors.push((work - (before.stored - stored) - dissipated).abs() / (stiffness * unit * unit));
        }
        println!("{}: {errors:?}", card.tag);
        assert!(errors[2] <= 0.6 * errors[0] + 4e-6 && errors[2] < 8e-3, "{}: {errors:?}", card.tag);
    }
}

/// The same for materials, through strains that yield and come back.
#[test]
fn the_energy_of_a_material_balances() {
    for Subject { card, sample, law, stiffness, .. } in materials() {
        let unit = sample.size;
        let path = |s: f64| -> [f64; 6] {
            std::array::from_fn(|i| {
                unit * (1.2 * (f64::from(i as u8 + 3) * s).sin() - if i < 3 { 0.8 * s } else { 0.0 })
            })
        };
        let context = UpdateContext::of_length(length(&*law));
        let mut errors = Vec::new();
        for steps in [1000, 2000, 4000] {
            let (mut old, mut new) = (untouched(&*law), untouched(&*law));
            let mut before = law.update_point(&[0.0; 6], &context, &old, &mut new).unwrap();
            let (mut work, mut dissipated, mut strain) = (0.0, 0.0, [0.0; 6]);
            for step in 1..=steps {
                let to = path(f64::from(step) / f64::from(steps));
                let point = law.update_point(&to, &context, &old, &mut new).unwrap();
                old.copy_from_slice(&new);
                for i in 0..6 {
                    work += 0.5 * (before.stress[i] + point.stress[i]) * (to[i] - strain[i]);
                }
                dissipated += point.dissipated;
                (before, strain) = (point, to);
            }
            errors.push((work - before.stored - dissipated).abs() / (stiffness * unit * unit));
        }
        println!("{}: {errors:?}", card.tag);
        assert!(errors[2] <= 0.6 * errors[0] + 1e-9 && errors[2] < 8e-3, "{}: {errors:?}", card.tag);
    }
}

/// Strains turned together with the block give turned stresses; with the block left where it is only where the
/// material has no axes.
#[test]
fn stresses_turn_with_the_block() {
    let mut rng = rng();
    for Subject { card, sample, law, stiffness, .. } in materials() {
        let mut turned_alone: f64 = 0.0;
        for _ in 0..100 {
            let (sine, cosine) = uniform(&mut rng, 0.1, 3.0).sin_cos();
            let axes = [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]];
            let strain: [f64; 6] = std::array::from_fn(|_| sample.size * uniform(&mut rng, -2.0, 2.0));
            let turned = |v: [f64; 6], shear: f64| {
                // Engineering shears count twice.
                let t = [
                    [v[0], v[3] * shear, v[5] * shear],
                    [v[3] * shear, v[1], v[4] * shear],
                    [v[5] * shear, v[4] * shear, v[2]],
                ];
                let entry =
                    |i: usize, j: usize| (0..9).map(|k| axes[k / 3][i] * t[k / 3][k % 3] * axes[k % 3][j]).sum::<f64>();
                [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1) / shear, entry(1, 2) / shear, entry(2, 0) / shear]
            };
            let length = length(&*law);
            let at = |strain: [f64; 6], axes: Option<&[[f64; 3]; 3]>| {
                let context = UpdateContext { axes, ..UpdateContext::of_length(length) };
                law.update_point(&strain, &context, &untouched(&*law), &mut untouched(&*law)).unwrap().stress
            };
            let expected = turned(at(strain, None), 1.0);
            let off = |found: [f64; 6]| {
                (0..6).map(|i| (found[i] - expected[i]).abs()).fold(0.0, f64::max) / (stiffness * sample.size)
            };
            assert!(off(at(turned(strain, 0.5), Some(&axes))) < 1e-9, "{}: {strain:?}", card.tag);
            turned_alone = turned_alone.max(off(at(turned(strain, 0.5), None)));
        }
        assert_eq!(turned_alone < 1e-9, card.claims(Property::ISOTROPIC), "{}: {turned_alone:e}", card.tag);
    }
}

/// No update allocates, whatever happens in it.
#[test]
fn no_law_call_allocates() {
    let mut rng = rng();
    let unit: Vec<[f64; 6]> = (0..64).map(|_| std::array::from_fn(|_| uniform(&mut rng, -3.0, 3.0))).collect();
    for Subject { card, sample, law, .. } in materials() {
        let strains: Vec<[f64; 6]> = unit.iter().map(|s| s.map(|x| x * sample.size)).collect();
        let planar: Vec<[f64; 3]> = strains.iter().map(|s| [s[0], s[1], s[3]]).collect();
        let old: Vec<f64> = std::iter::repeat_n(untouched(&*law), 64).flatten().collect();
        let (mut new, mut points) = (old.clone(), vec![StressPoint::ZERO; 64]);
        let contexts = [UpdateContext::of_length(length(&*law)); 64];
        let mut fine = false;
        let count = allocation_counter::measure(|| {
            fine = law.update(&strains, &contexts, &old, &mut new, &mut points).is_ok();
        });
        assert!(fine && count.count_total == 0, "{}: {count:?}", card.tag);
        for plane in [Plane::Strain, Plane::Stress] {
            let wrapped = PlanarUpdate::new(law.clone(), plane).unwrap();
            let mut one = vec![0.0; wrapped.state_size()];
            wrapped.initial_state(&mut one);
            let old: Vec<f64> = std::iter::repeat_n(one, 64).flatten().collect();
            let (mut new, mut points) = (old.clone(), vec![PlanarPoint::ZERO; 64]);
            let mut fine = Ok(());
            let count = allocation_counter::measure(|| {
                fine = wrapped.update(&planar, &contexts, &old, &mut new, &mut points);
            });
            assert!(fine.is_ok() && count.count_total == 0, "{}: {count:?} {fine:?}", card.tag);
        }
    }
    for Subject { card, sample, law, .. } in joints() {
        let gaps: Vec<[f64; 2]> = unit.iter().map(|s| [s[0] * sample.size, s[1] * sample.size]).collect();
        let old = vec![0.0; 64 * law.state_size()];
        let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; 64]);
        let mut fine = false;
        let count = allocation_counter::measure(|| fine = law.respond(&gaps, &old, &mut new, &mut points).is_ok());
        assert!(fine && count.count_total == 0, "{}: {count:?}", card.tag);
    }
}
