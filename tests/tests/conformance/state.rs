//! Conformance of every law with state, found by its card: purity, tangent against finite differences,
//! dissipation, batches, serde, no allocation. Strengths and stiffnesses are of order one.

use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};
use std::collections::BTreeMap;
use std::sync::Arc;
use voussoir::core::law::{
    BulkMaterial, FacetResponse, Formulation, InterfaceLaw, InterfaceResponse, PlanarPoint, PlanarUpdate, Plane,
    StressPoint, StressUpdate, TractionPoint,
};
use voussoir::core::plugin::{Capability, Card, Need, PluginKind, Shape, cards};

fn uniform(rng: &mut TestRng, low: f64, high: f64) -> f64 {
    low + (high - low) * (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

fn rng() -> TestRng {
    TestRng::from_seed(RngAlgorithm::ChaCha, &[3; 32])
}

/// A configuration with a plausible number for every key that must be given, or one of a choice of keys.
fn sample(card: &Card) -> serde_json::Value {
    let chosen = ["friction", "uniaxial_strength", "crushing_fracture_energy", "normal_stiffness", "shear_stiffness"];
    let mut table = serde_json::Map::new();
    table.insert("law".into(), card.tag.into());
    for parameter in card.parameters {
        let optional = matches!(parameter.need, Need::Optional(_)) && !chosen.contains(&parameter.name);
        if let Shape::Choice(words) = &parameter.shape {
            table.insert(parameter.name.into(), serde_json::json!(words[words.len() - 1]));
        }
        if let (Shape::Number(_, range), false) = (&parameter.shape, optional) {
            // Poisson's ratio, transition and compaction are small.
            let small = ["transition", "initial_compaction", "residual_stress"].contains(&parameter.name);
            let value = if small { 0.02 } else { 0.25 };
            table.insert(
                parameter.name.into(),
                serde_json::json!(if range.contains(value) { value } else { range.min + 1.0 }),
            );
        }
    }
    serde_json::Value::Object(table)
}

/// Keys of one law that exclude each other.
const APART: [&str; 2] = ["crushing_fracture_energy", "initial_compaction"];

/// The sample, or one without each of the keys that exclude each other.
fn samples(card: &Card) -> Vec<serde_json::Value> {
    let table = sample(card);
    if !APART.iter().all(|key| table.get(key).is_some()) {
        return vec![table];
    }
    let without = |key: &str| {
        let mut table = table.clone();
        table.as_object_mut().unwrap().remove(key);
        table
    };
    APART.map(without).into()
}

/// Tag, law, and the law after a round trip.
type Twice = (&'static str, Arc<dyn StressUpdate>, Arc<dyn StressUpdate>);

fn materials() -> Vec<Twice> {
    let mut out = Vec::new();
    for card in cards().into_iter().filter(|card| card.kind == PluginKind::BulkMaterial) {
        let offers = card.provides.contains(&Capability::StressUpdate);
        for table in samples(card) {
            let mut own = table.clone();
            own.as_object_mut().unwrap().remove("law");
            assert_eq!((card.check)(&own), vec![], "{}", card.tag);
            let material: Box<dyn BulkMaterial> = serde_json::from_value(table).unwrap();
            let again: Box<dyn BulkMaterial> =
                serde_json::from_value(serde_json::to_value(&material).unwrap()).unwrap();
            assert_eq!(material.stress_update().is_some(), offers, "{}", card.tag);
            out.extend(material.stress_update().zip(again.stress_update()).map(|(one, two)| (card.tag, one, two)));
        }
    }
    out
}

fn joints() -> Vec<(&'static str, Arc<dyn InterfaceResponse>)> {
    let mut out: Vec<(&'static str, Arc<dyn InterfaceResponse>)> = Vec::new();
    for card in cards().into_iter().filter(|card| card.kind == PluginKind::InterfaceLaw) {
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(sample(card)).unwrap();
        let again: Box<dyn InterfaceLaw> = serde_json::from_value(serde_json::to_value(&law).unwrap()).unwrap();
        assert_eq!(format!("{:?}", law.formulation()), format!("{:?}", again.formulation()));
        match law.formulation() {
            Formulation::Response(response) => {
                assert!(card.provides.contains(&Capability::Response), "{}", card.tag);
                out.push((card.tag, response));
            }
            Formulation::Facets(facets) => {
                assert!(card.provides.contains(&Capability::Facets), "{}", card.tag);
                out.push((card.tag, Arc::new(FacetResponse::new(facets, [0.25, 0.25]))));
            }
            other => panic!("{other:?}"),
        }
    }
    out
}

fn length(update: &dyn StressUpdate) -> f64 {
    if update.largest_length().is_finite() { 0.3 * update.largest_length() } else { 1.0 }
}

/// Random walks through strain: equal calls give equal answers, the batch is the points, plastic work is
/// never negative, and the tangent is the derivative wherever ±h stays in one region.
#[test]
fn every_material_with_state_conforms() {
    let mut rng = rng();
    let mut compared: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for (tag, update, again) in materials() {
        let size = update.state_size();
        let length = length(&*update);
        assert_eq!(update.state_names().len(), size, "{tag}");
        for _ in 0..150 {
            let mut old = vec![0.0; size];
            update.initial_state(&mut old);
            let mut strain = [0.0; 6];
            for _ in 0..25 {
                let step = 10f64.powf(uniform(&mut rng, -1.5, 0.5));
                strain.iter_mut().for_each(|e| *e += step * uniform(&mut rng, -1.0, 1.0));
                let (mut new, mut other) = (vec![0.0; size], vec![9.0; size]);
                let here =
                    update.update_point(&strain, length, &old, &mut new).unwrap_or_else(|f| panic!("{tag}: {f}"));
                assert_eq!(here, again.update_point(&strain, length, &old, &mut other).unwrap(), "{tag} is not pure");
                assert_eq!(new, other, "{tag} is not pure");
                let mut batch = [StressPoint::ZERO];
                update.update(&[strain], &[length], &old, &mut other, &mut batch).unwrap();
                assert_eq!((batch[0], &new), (here, &other), "{tag}");
                assert!(here.dissipation >= -1e-14, "{tag}: dissipation {:e}", here.dissipation);
                let direction: [f64; 6] = std::array::from_fn(|_| uniform(&mut rng, -1.0, 1.0));
                let h = 1e-6 * (1.0 + strain.iter().fold(0.0_f64, |a, b| a.max(b.abs())));
                let mut same = true;
                let mut at = |factor: f64| {
                    let moved: [f64; 6] = std::array::from_fn(|i| strain[i] + factor * h * direction[i]);
                    let point = update.update_point(&moved, length, &old, &mut other).unwrap();
                    same &= point.region == here.region;
                    point.stress
                };
                let (a, b, c, d) = (at(1.0), at(-1.0), at(0.5), at(-0.5));
                let worst = |f: &dyn Fn(usize) -> f64| (0..6).fold(0.0_f64, |m, i| m.max(f(i).abs()));
                let spread = worst(&|i| (a[i] - b[i]) / (2.0 * h) - (c[i] - d[i]) / h);
                if same && spread < 1e-6 {
                    let error =
                        worst(&|i| (0..6).map(|j| here.tangent[i][j] * direction[j]).sum::<f64>() - (c[i] - d[i]) / h);
                    assert!(error < 1e-6, "{tag}: tangent off by {error:e} in {:?}", here.region);
                    *compared.entry((tag, here.region.name())).or_default() += 1;
                }
                old = new;
            }
        }
    }
    println!("{compared:?}");
    for wanted in [
        ("elastic", "elastic"),
        ("drucker_prager_cap", "elastic"),
        ("drucker_prager_cap", "cap"),
        ("drucker_prager_cap", "shear"),
        ("drucker_prager_softening", "elastic"),
        ("drucker_prager_softening", "shear"),
        ("drucker_prager_softening", "apex"),
    ] {
        assert!(compared.get(&wanted).is_some_and(|&count| count >= 50), "{wanted:?}: {compared:?}");
    }
}

/// The same for joints; besides, stored energy and work fit together: over a walk in small steps the work
/// done is the change of stored energy plus what is dissipated.
#[test]
fn every_joint_with_state_conforms() {
    let mut rng = rng();
    let mut compared: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for (tag, response) in joints() {
        let size = response.state_size();
        assert_eq!(response.state_names().len(), size, "{tag}");
        for _ in 0..200 {
            let mut old = vec![0.0; size];
            response.initial_state(&mut old);
            let mut gap = [0.0; 2];
            for _ in 0..25 {
                let step = 10f64.powf(uniform(&mut rng, -1.5, 0.5));
                gap.iter_mut().for_each(|g| *g += step * uniform(&mut rng, -1.0, 1.0));
                let (mut new, mut other) = (vec![0.0; size], vec![9.0; size]);
                let here = response.respond_point(gap, &old, &mut new).unwrap_or_else(|f| panic!("{tag}: {f}"));
                assert_eq!(here, response.respond_point(gap, &old, &mut other).unwrap(), "{tag} is not pure");
                let mut batch = [TractionPoint::ZERO];
                response.respond(&[gap], &old, &mut other, &mut batch).unwrap();
                assert_eq!((batch[0], &new), (here, &other), "{tag}");
                assert!(here.dissipated >= 0.0 && here.stored >= 0.0, "{tag}: {here:?}");
                let direction: [f64; 2] = std::array::from_fn(|_| uniform(&mut rng, -1.0, 1.0));
                let h = 1e-6 * (1.0 + gap[0].abs().max(gap[1].abs()));
                let mut at = |factor: f64| {
                    let moved = [gap[0] + factor * h * direction[0], gap[1] + factor * h * direction[1]];
                    response.respond_point(moved, &old, &mut other).unwrap()
                };
                let (a, b, c, d) = (at(1.0), at(-1.0), at(0.5), at(-0.5));
                let same = [a, b, c, d].iter().all(|point| point.branch == here.branch);
                let worst = |f: &dyn Fn(usize) -> f64| f(0).abs().max(f(1).abs());
                let spread =
                    worst(&|i| (a.traction[i] - b.traction[i]) / (2.0 * h) - (c.traction[i] - d.traction[i]) / h);
                if same && spread < 1e-6 {
                    let error = worst(&|i| {
                        here.tangent[i][0] * direction[0] + here.tangent[i][1] * direction[1]
                            - (c.traction[i] - d.traction[i]) / h
                    });
                    assert!(error < 1e-6, "{tag}: tangent off by {error:e} in {:?}", here.branch);
                    *compared.entry((tag, here.branch.name())).or_default() += 1;
                }
                old = new;
            }
        }
    }
    println!("{compared:?}");
    for wanted in ["elastic", "softening", "sliding", "softening_sliding"] {
        let count = compared.get(&("cohesive", wanted)).copied().unwrap_or(0);
        assert!(count >= 50, "{wanted}: {compared:?}");
    }
    for tag in ["coulomb", "coulomb_associated", "mohr_coulomb"] {
        assert!(compared.get(&(tag, "sliding")).is_some_and(|&count| count >= 50), "{tag}: {compared:?}");
    }
}

/// Work = change of stored energy + dissipation, with an error that falls in proportion to the step.
#[test]
fn the_energy_of_a_joint_balances() {
    let path = |s: f64| [0.6 * (9.0 * s).sin() - 0.25, 1.5 * (7.0 * s).sin() + 0.8 * s];
    for (tag, response) in joints() {
        let mut errors = Vec::new();
        for steps in [2000, 4000, 8000] {
            let mut old = vec![0.0; response.state_size()];
            response.initial_state(&mut old);
            let mut new = old.clone();
            let start = path(0.0);
            let mut before = response.respond_point(start, &old, &mut new).unwrap();
            old.copy_from_slice(&new);
            let (mut work, mut dissipated, stored, mut gap) = (0.0, 0.0, before.stored, start);
            for step in 1..=steps {
                let to = path(f64::from(step) / f64::from(steps));
                let point = response.respond_point(to, &old, &mut new).unwrap();
                old.copy_from_slice(&new);
                for i in 0..2 {
                    work -= 0.5 * (before.traction[i] + point.traction[i]) * (to[i] - gap[i]);
                }
                dissipated += point.dissipated;
                (before, gap) = (point, to);
            }
            errors.push((work - (before.stored - stored) - dissipated).abs());
        }
        println!("{tag}: {errors:?}");
        assert!(errors[2] <= 0.6 * errors[0] + 1e-6 && errors[2] < 2e-3, "{tag}: {errors:?}");
    }
}

/// No update allocates, whatever happens in it.
#[test]
fn no_law_call_allocates() {
    let mut rng = rng();
    let strains: Vec<[f64; 6]> = (0..64).map(|_| std::array::from_fn(|_| uniform(&mut rng, -3.0, 3.0))).collect();
    let planar: Vec<[f64; 3]> = strains.iter().map(|s| [s[0], s[1], s[3]]).collect();
    let gaps: Vec<[f64; 2]> = strains.iter().map(|s| [s[0], s[1]]).collect();
    for (tag, update, _) in materials() {
        let size = update.state_size();
        let mut one = vec![0.0; size];
        update.initial_state(&mut one);
        let old: Vec<f64> = one.iter().copied().cycle().take(64 * size).collect();
        let (mut new, mut points) = (old.clone(), vec![StressPoint::ZERO; 64]);
        let lengths = [length(&*update); 64];
        let mut fine = false;
        let count = allocation_counter::measure(|| {
            fine = update.update(&strains, &lengths, &old, &mut new, &mut points).is_ok();
        });
        assert!(fine && count.count_total == 0, "{tag}: {count:?}");
        for plane in [Plane::Strain, Plane::Stress] {
            let wrapped = PlanarUpdate::new(update.clone(), plane).unwrap();
            let size = wrapped.state_size();
            let mut one = vec![0.0; size];
            wrapped.initial_state(&mut one);
            let old: Vec<f64> = one.iter().copied().cycle().take(64 * size).collect();
            let (mut new, mut points) = (old.clone(), vec![PlanarPoint::ZERO; 64]);
            let mut fine = Ok(());
            let count = allocation_counter::measure(|| {
                fine = wrapped.update(&planar, &lengths, &old, &mut new, &mut points);
            });
            assert!(fine.is_ok() && count.count_total == 0, "{tag}: {count:?} {fine:?}");
        }
    }
    for (tag, response) in joints() {
        let old = vec![0.0; 64 * response.state_size()];
        let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; 64]);
        let mut fine = false;
        let count = allocation_counter::measure(|| fine = response.respond(&gaps, &old, &mut new, &mut points).is_ok());
        assert!(fine && count.count_total == 0, "{tag}: {count:?}");
    }
}
