//! Materials: stresses from strains, elasticity, axes.

use super::findings::Recorder;
use super::options::Options;
use super::plug_in::PlugIn;
use super::point::Point;
use super::random::random_step;
use super::samples::samples_of;
use super::scaled::LENGTH;
use super::subject::Subject;
use super::walk;
use super::{energy, outputs, sign, units};
use voussoir_core::law::{BulkMaterial, Elasticity, PlanarPoint, PlanarUpdate, Plane, UpdateContext};
use voussoir_core::plugin::{Capability, Card, PluginKind, Property, Sample};
use voussoir_core::random::Random;

/// Checks every sample of a material; does nothing for other plug-ins.
pub(super) fn check(recorder: &mut Recorder, card: &Card, options: &Options) {
    if card.kind != PluginKind::BulkMaterial {
        return;
    }
    for (sample, table, law) in samples_of(card) {
        recorder.sample(&sample);
        let PlugIn::Material(material) = law else { continue };
        let other = units::other_units(recorder, card, &table);
        check_sample(recorder, (card, &sample), material.as_ref(), other.as_ref(), options);
    }
}

fn check_sample(
    recorder: &mut Recorder,
    (card, sample): (&Card, &Sample),
    material: &dyn BulkMaterial,
    other: Option<&PlugIn>,
    options: &Options,
) {
    let density = material.density();
    recorder.hold("density", density.is_finite() && density >= 0.0, || format!("has a density of {density}"));
    let update = material.stress_update();
    recorder.hold("capabilities", update.is_some() == card.offers(Capability::STRESS_UPDATE), || {
        "stress_update() is not what its card says of stresses from strains".into()
    });
    let linear = material.inelastic().is_none();
    recorder.hold("capabilities", linear == card.offers(Capability::LINEAR) || update.is_none(), || {
        "inelastic() is not what its card says of a linear law".into()
    });
    let (Some(update), Some(elasticity)) = (update.clone(), material.elasticity()) else {
        return recorder.hold("elasticity", update.is_none(), || "gives stresses, but no elasticity".into());
    };
    let possible = elasticity.check();
    recorder.hold("elasticity", possible.is_ok(), || format!("{possible:?}"));
    let written = serde_json::to_value(material).ok().and_then(|table| PlugIn::read(card.kind, &table).ok());
    let again = match &written {
        Some(PlugIn::Material(again)) => again.stress_update(),
        _ => None,
    };
    let point = Point::material(update.clone());
    let Some(stiffness) = walk::measure(recorder, &point, sample) else { return };
    let again = Point::material(again.unwrap_or(update));
    let subject = Subject { card, sample, point, again, stiffness };
    walk::check(recorder, &subject, options);
    elastic_branch(recorder, &subject, &elasticity);
    sign::check_material(recorder, &subject);
    energy::check(recorder, &subject);
    axes(recorder, &subject);
    planar(recorder, &subject, options);
    let mut there = match other {
        Some(PlugIn::Material(other)) => other.stress_update().map(Point::material),
        _ => None,
    };
    if let (Some(Point::Material(_, length)), Point::Material(_, here)) = (&mut there, &subject.point) {
        *length = here * LENGTH;
    }
    if let Some(there) = &there {
        units::check(recorder, &subject, there);
    }
    outputs::check(recorder, &subject, there.as_ref());
}

/// As long as nothing has changed the material, an elastic step has the tangent of `elasticity()`, because solvers compute the body
/// from it at first.
fn elastic_branch(recorder: &mut Recorder, subject: &Subject, elasticity: &Elasticity) {
    let (elastic, mut random) = (elasticity.stiffness(), Random::new(19));
    for _ in 0..40 {
        let (mut old, mut new) = (subject.point.untouched(), vec![0.0; subject.point.state_size()]);
        let (mut at, mut path) = ([0.0; 6], Vec::new());
        for _ in 0..25 {
            path.push(at);
            let Ok(said) = subject.point.update(&at, &old, &mut new) else { break };
            let off = said.tangent.iter().flatten().zip(elastic.iter().flatten()).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max) / subject.stiffness;
            let virgin = said.branch.is_elastic() && old == subject.point.untouched();
            recorder.hold_on("regions", !virgin || off <= 1e-9, &path, || {
                format!("calls the step elastic, but its tangent is off elasticity() by {off:.1e} of the stiffness")
            });
            old.copy_from_slice(&new);
            random_step(&mut random, &mut at, 6, subject.sample.size);
        }
    }
}

/// Strains that rotate together with the block give rotated stresses. If the block does not rotate, this holds only for a
/// material without axes.
fn axes(recorder: &mut Recorder, subject: &Subject) {
    let Point::Material(law, length) = &subject.point else { return };
    let (mut random, mut turned_alone) = (Random::new(23), 0.0_f64);
    let (untouched, mut new) = (subject.point.untouched(), vec![0.0; subject.point.state_size()]);
    for _ in 0..60 {
        let (sine, cosine) = random.between(0.1, 3.0).sin_cos();
        let axes = [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]];
        let strain: [f64; 6] = std::array::from_fn(|_| subject.sample.size * random.between(-2.0, 2.0));
        let mut at = |strain: [f64; 6], axes: Option<&[[f64; 3]; 3]>| {
            let context = UpdateContext { axes, ..UpdateContext::of_length(*length) };
            law.update_point(&strain, &context, &untouched, &mut new).map(|said| said.stress)
        };
        let Ok(plain) = at(strain, None) else { continue };
        let expected = turned(plain, &axes, 1.0);
        let off = |found: [f64; 6]| {
            let worst = (0..6).map(|i| (found[i] - expected[i]).abs()).fold(0.0, f64::max);
            worst / (subject.stiffness * subject.sample.size)
        };
        let strain = turned(strain, &axes, 0.5);
        let with_block = at(strain, Some(&axes)).map(off);
        recorder.hold("axes", with_block.is_ok_and(|off| off < 1e-9), || {
            format!("if block and strain rotate together, the stress does not rotate with them: {strain:?}")
        });
        turned_alone = turned_alone.max(at(strain, None).map_or(f64::INFINITY, off));
    }
    let claims = subject.card.claims(Property::ISOTROPIC);
    recorder.hold("isotropy", (turned_alone < 1e-9) == claims, || {
        let word = if claims { "claims" } else { "does not claim" };
        format!("{word} to be isotropic, but turned strains give stresses that are off by {turned_alone:.1e}")
    });
}

/// Returns a strain (`shear` = ½, because engineering shear strains count twice) or stress (1) in rotated axes.
fn turned(v: [f64; 6], axes: &[[f64; 3]; 3], shear: f64) -> [f64; 6] {
    let t =
        [[v[0], v[3] * shear, v[5] * shear], [v[3] * shear, v[1], v[4] * shear], [v[5] * shear, v[4] * shear, v[2]]];
    let entry = |i: usize, j: usize| (0..9).map(|k| axes[k / 3][i] * t[k / 3][k % 3] * axes[k % 3][j]).sum::<f64>();
    [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1) / shear, entry(1, 2) / shear, entry(2, 0) / shear]
}

/// Checks that the material also works in plane strain and plane stress, without allocations.
fn planar(recorder: &mut Recorder, subject: &Subject, options: &Options) {
    let Point::Material(law, length) = &subject.point else { return };
    let (mut random, context) = (Random::new(29), [UpdateContext::of_length(*length)]);
    for plane in [Plane::Strain, Plane::Stress] {
        let Ok(wrapped) = PlanarUpdate::new(law.clone(), plane) else {
            recorder.fail("planar", format!("cannot be used in plane {plane:?}"));
            continue;
        };
        let mut old = vec![0.0; wrapped.state_size()];
        wrapped.initial_state(&mut old);
        let (mut new, mut points) = (old.clone(), [PlanarPoint::ZERO]);
        for _ in 0..64 {
            let strain: [f64; 3] = std::array::from_fn(|_| subject.sample.size * random.between(-3.0, 3.0));
            let mut failed = None;
            let mut update = || failed = wrapped.update(&[strain], &context, &old, &mut new, &mut points).err();
            match options.allocations {
                Some(count) => {
                    let allocated = count(&mut update);
                    recorder.hold("allocation", allocated == 0, || {
                        format!("an update in plane {plane:?} allocates {allocated} times")
                    });
                }
                None => update(),
            }
            recorder.hold("planar", failed.is_none(), || {
                format!("in plane {plane:?} strain it refuses {strain:?}: {failed:?}")
            });
        }
    }
}
