//! Softening laws: a published test of a finite-element program, fracture energies, dry friction.

use std::sync::Arc;
use voussoir::core::law::{BulkMaterial, InterfaceLaw, InterfaceResponse, PointContext, UpdateContext, UpdateFailure};
use voussoir::laws::cohesive::Cohesive;
use voussoir::laws::drucker_prager_cap::DruckerPragerCap;
use voussoir::laws::drucker_prager_softening::DruckerPragerSoftening;
use voussoir::solvers::point::{Control, DrivenPoint, PointLaw};

const MPA: f64 = 1e6;
const FREE: Control = Control::Stress(0.0);
const HELD: Control = Control::Strain(0.0);

fn near(found: f64, wanted: f64, relative: f64) {
    assert!((found - wanted).abs() <= relative * wanted.abs(), "{found} instead of {wanted}");
}

fn rock() -> DruckerPragerSoftening {
    DruckerPragerSoftening {
        young_modulus: 5800.0 * MPA,
        poisson_ratio: 0.3,
        density: 2500.0,
        pressure_coefficient: 0.33,
        yield_stress: 2.57 * MPA,
        residual_stress: 0.57 * MPA,
        ultimate_plastic_strain: Some(0.01),
        crushing_fracture_energy: None,
    }
}

/// code_aster SSNV168A (published): triaxial compression at 2 MPa; axial stress at three strains, to 1e-6, in one step
/// or in many.
#[test]
fn code_aster_ssnv168a() {
    let law = rock();
    assert_eq!(law.validate(), vec![]);
    for steps in [1, 5, 40] {
        let mut point = DrivenPoint::new(PointLaw::Space(law.stress_update().unwrap(), 1.0)).unwrap();
        let side = Control::Stress(-2.0 * MPA);
        point.step(&[side, side, side, HELD, HELD, HELD]).unwrap();
        let start = point.response.strain[0];
        let mut from = start;
        for (axial, wanted) in [(-2.4e-3, -8.19785989), (-5.1e-3, -6.894825305), (-7.95e-3, -5.805970149)] {
            let to = start + axial;
            for step in 1..=steps {
                let now = from + (to - from) * f64::from(step) / f64::from(steps);
                point.step(&[Control::Strain(now), side, side, HELD, HELD, HELD]).unwrap();
            }
            from = to;
            near(point.response.stress[0] / MPA, wanted, 1e-6);
        }
    }
}

/// With a fracture energy the work of softening per area is this energy for any length, and a length above the largest
/// is refused, because the stress would have to jump.
#[test]
fn crushing_takes_its_fracture_energy_at_any_length() {
    let energy = 5e3;
    let law = DruckerPragerSoftening {
        residual_stress: 0.0,
        ultimate_plastic_strain: None,
        crushing_fracture_energy: Some(energy),
        ..rock()
    };
    assert_eq!(law.validate(), vec![]);
    let update = law.stress_update().unwrap();
    let largest = update.largest_length();
    let crushing = 2.57 * MPA / (1.0 - 0.33);
    near(largest, 2.0 * energy * law.young_modulus / crushing.powi(2), 1e-12);
    for share in [0.9, 0.5, 0.1, 0.01] {
        let length = share * largest;
        let mut point = DrivenPoint::new(PointLaw::Space(update.clone(), length)).unwrap();
        let end = 2.0 * energy / (length * 2.57 * MPA) * (1.0 - 0.33);
        let (mut work, mut peak, steps) = (0.0, 0.0_f64, 2000);
        for step in 1..=steps {
            let now = -1.2 * end.max(crushing / law.young_modulus) * f64::from(step) / f64::from(steps);
            let before = (point.response.strain[0], point.response.stress[0]);
            point.step(&[Control::Strain(now), FREE, FREE, HELD, HELD, HELD]).unwrap();
            work += 0.5 * (before.1 + point.response.stress[0]) * (now - before.0);
            peak = peak.max(-point.response.stress[0]);
        }
        assert!(point.response.stress[0].abs() < 1e-6 * crushing);
        // The trapezoidal rule misses the peak between two steps: an error of the order of the step squared.
        near(work * length, energy, 2e-4);
        assert!(peak <= crushing * (1.0 + 1e-12) && peak > 0.98 * crushing);
    }
    let mut new = [0.0; 7];
    let refused = update.update_point(&[0.0; 6], &UpdateContext::of_length(largest * 1.001), &[0.0; 7], &mut new);
    assert_eq!(refused, Err(UpdateFailure::LengthTooLarge));
}

/// The cap of the paper with softening: under hydrostatic compression the work above the residual strength is G_c for
/// any length, in uniaxial compression too (this cap is almost a wall), and a length above the largest is refused.
#[test]
fn crushing_of_the_cap_takes_its_fracture_energy_at_any_length() {
    let energy = 20e3;
    let law = DruckerPragerCap {
        crushing_fracture_energy: Some(energy),
        residual_ratio: 0.2,
        ..DruckerPragerCap::drosopoulos_2008(10.0 * MPA)
    };
    assert_eq!(law.validate(), vec![]);
    let update = law.stress_update().unwrap();
    let largest = update.largest_length();
    for share in [1.0, 0.5, 0.1, 0.01] {
        let length = share * largest;
        let end = 2.0 * energy / (8.0 * MPA) / length;
        let bulk = 5e9 / (3.0 * 0.6);
        let steps = 4000;
        // Hydrostatic compression under strain control.
        let (mut old, mut new) = ([0.0; 8], [0.0; 8]);
        let (mut before, mut work) = ((0.0, 0.0), 0.0);
        let last = 1.3 * end + 10.0 * MPA / bulk;
        for step in 1..=steps {
            let trace = last * f64::from(step) / f64::from(steps);
            let e = -trace / 3.0;
            let point = update
                .update_point(&[e, e, e, 0.0, 0.0, 0.0], &UpdateContext::of_length(length), &old, &mut new)
                .unwrap();
            old = new;
            work += 0.5 * (before.1 - point.stress[0]) * (trace - before.0);
            before = (trace, -point.stress[0]);
        }
        near(before.1, 2.0 * MPA, 1e-12);
        let left = (2.0 * MPA).powi(2) / (2.0 * bulk) + 2.0 * MPA * old[7];
        near((work - left) * length, energy, 1e-3);
        // Uniaxial compression.
        let mut point = DrivenPoint::new(PointLaw::Space(update.clone(), length)).unwrap();
        let mut work = 0.0;
        let last = -(1.3 * end / 3.0 + 30.0 * MPA / 5e9);
        for step in 1..=steps {
            let now = last * f64::from(step) / f64::from(steps);
            let before = (point.response.strain[0], point.response.stress[0]);
            point.step(&[Control::Strain(now), FREE, FREE, HELD, HELD, HELD]).unwrap();
            work += 0.5 * (before.1 + point.response.stress[0]) * (now - before.0);
        }
        let residual = -point.response.stress[0];
        near(residual, 6.0 * MPA, 1e-3);
        let left = residual.powi(2) / (2.0 * 5e9) + residual * (-last - residual / 5e9);
        near((work - left) * length, energy, 5e-3);
    }
    let refused = update.update_point(&[0.0; 6], &UpdateContext::of_length(largest * 1.001), &[0.0; 8], &mut [0.0; 8]);
    assert_eq!(refused, Err(UpdateFailure::LengthTooLarge));
}

/// After the peak a controlled stress that falls unloads the point along E (a cohesive joint along its secant) without
/// softening; a stress that rises again follows the same line, and a stress above the remaining strength is refused.
#[test]
fn a_stress_that_falls_unloads_a_softened_point() {
    let update = rock().stress_update().unwrap();
    let mut point = DrivenPoint::new(PointLaw::Space(update, 1.0)).unwrap();
    point.step(&[Control::Strain(-2e-3), FREE, FREE, HELD, HELD, HELD]).unwrap();
    let (strain, stress, state) = (point.response.strain[0], point.response.stress[0], point.state().to_vec());
    assert!(state[6] > 0.0 && -stress < 0.98 * 2.57 * MPA / 0.67, "it has softened: {stress}");
    for share in [0.99, 0.5, 0.0, 0.7, 1.0 - 1e-9] {
        point.step(&[Control::Stress(share * stress), FREE, FREE, HELD, HELD, HELD]).unwrap();
        near(point.response.strain[0], strain - (1.0 - share) * stress / 5800e6, 1e-9);
        assert_eq!(point.state(), state);
    }
    assert!(point.step(&[Control::Stress(1.01 * stress), FREE, FREE, HELD, HELD, HELD]).is_err());
    let mut joint = DrivenPoint::new(PointLaw::Joint(response(&mortar()))).unwrap();
    joint.step(&[Control::Strain(5e-5), HELD]).unwrap();
    let (traction, damage) = (joint.response.stress[0], joint.state()[0]);
    for share in [0.9, 0.2, 0.8] {
        joint.step(&[Control::Stress(share * traction), HELD]).unwrap();
        near(joint.response.strain[0], share * 5e-5, 1e-9);
        assert_eq!(joint.state()[0], damage);
    }
}

/// At the tip of the cone the stress is R/(3A) in all directions, and hydrostatic tension has the closed form.
#[test]
fn hydrostatic_tension_ends_at_the_tip() {
    let update = rock().stress_update().unwrap();
    let mut old = [0.0; 7];
    let mut new = [0.0; 7];
    for step in 1..=20 {
        let e = 1e-4 * f64::from(step);
        let point =
            update.update_point(&[e, e, e, 0.0, 0.0, 0.0], &UpdateContext::of_length(1.0), &old, &mut new).unwrap();
        old = new;
        if old[6] > 0.0 {
            let strength = (2.57 - 200.0 * old[6]).max(0.57) * MPA;
            near(point.stress[0], strength / (3.0 * 0.33), 1e-12);
            assert_eq!(point.branch.name, "apex");
        }
    }
    assert!(old[6] > 0.0);
}

fn mortar() -> Cohesive {
    // Order of magnitude of Lourenço & Rots (1997), tests of masonry in shear.
    Cohesive {
        friction: Some(0.75),
        friction_angle: None,
        tensile_strength: 0.25 * MPA,
        cohesion: 0.35 * MPA,
        normal_stiffness: 82e9,
        shear_stiffness: 36e9,
        tensile_fracture_energy: 18.0,
        shear_fracture_energy: 125.0,
    }
}

fn response(law: &Cohesive) -> Arc<dyn InterfaceResponse> {
    assert_eq!(law.validate(), vec![]);
    law.response().expect("a response")
}

/// In opening and in pure shear the peak is the strength and the dissipated energy is exactly G_I or G_II, for any
/// number of steps; the work is the same, with an error that decreases with the step.
#[test]
fn each_mode_takes_its_fracture_energy() {
    let law = mortar();
    let update = response(&law);
    let modes = [
        ([1.0, 0.0], 0.25 * MPA, 18.0, 82e9),
        ([0.0, 1.0], 0.35 * MPA, 125.0, 36e9),
        ([0.0, -1.0], 0.35 * MPA, 125.0, 36e9),
    ];
    for (direction, strength, energy, stiffness) in modes {
        for steps in [1, 2, 10, 1000] {
            let (mut old, mut new) = ([0.0; 2], [0.0; 2]);
            let (mut dissipated, mut work, mut peak) = (0.0, 0.0, 0.0_f64);
            let mut before = (0.0, 0.0);
            let end = 2.0 * energy / strength * 1.01;
            for step in 1..=steps {
                let size = end * f64::from(step) / f64::from(steps);
                let point = update
                    .respond_point(direction.map(|d| size * d), &PointContext::default(), &old, &mut new)
                    .unwrap();
                old = new;
                dissipated += point.dissipated;
                let against = -(point.traction[0] * direction[0] + point.traction[1] * direction[1]);
                work += 0.5 * (before.1 + against) * (size - before.0);
                before = (size, against);
                peak = peak.max(against);
            }
            near(dissipated, energy, 1e-12);
            assert!(before.1.abs() <= 1e-9 * strength && old[0] == 1.0);
            assert!(peak <= strength * (1.0 + 1e-12));
            if steps == 1000 {
                near(work, energy, 5e-3);
            }
        }
        // The peak itself.
        let onset = strength / stiffness;
        let point = update
            .respond_point(direction.map(|d| onset * d), &PointContext::default(), &[0.0; 2], &mut [0.0; 2])
            .unwrap();
        let against = -(point.traction[0] * direction[0] + point.traction[1] * direction[1]);
        near(against, strength, 1e-12);
    }
}

/// After the bond is lost, |t_t| = μ p exactly, in both senses; the peak before is between max(c, μ p) and c + μ p and
/// tends to c + μ p as the joint becomes stiffer.
#[test]
fn dry_friction_is_left() {
    let mut ratio = Vec::new();
    for stiffer in [1.0, 10.0, 100.0] {
        let law = Cohesive { normal_stiffness: 82e9 * stiffer, shear_stiffness: 36e9 * stiffer, ..mortar() };
        let update = response(&law);
        for pressure in [0.1 * MPA, 0.5 * MPA, 2.0 * MPA] {
            let closing = -pressure / law.normal_stiffness;
            let (mut old, mut new) = ([0.0; 2], [0.0; 2]);
            let mut peak = 0.0_f64;
            for step in 1..=20_000 {
                let slip = 1.2e-3 * (f64::from(step) / 20_000.0).powi(3);
                let point = update.respond_point([closing, slip], &PointContext::default(), &old, &mut new).unwrap();
                old = new;
                peak = peak.max(-point.traction[1]);
            }
            let end = update.respond_point([closing, 2e-3], &PointContext::default(), &old, &mut new).unwrap();
            near(-end.traction[1], 0.75 * pressure, 1e-12);
            old = new;
            let back = update.respond_point([closing, -2e-3], &PointContext::default(), &old, &mut new).unwrap();
            near(back.traction[1], 0.75 * pressure, 1e-12);
            let (low, high) = ((0.35 * MPA).max(0.75 * pressure), 0.35 * MPA + 0.75 * pressure);
            assert!(peak >= low * (1.0 - 1e-12) && peak <= high * (1.0 + 1e-12), "{peak} not in {low} .. {high}");
            if pressure == 0.5 * MPA {
                ratio.push(peak / high);
            }
        }
    }
    assert!(ratio[0] < ratio[1] && ratio[1] < ratio[2] && ratio[2] > 0.96, "{ratio:?}");
}

/// Unloading of an open joint returns to the origin, and a closed joint in compression behaves as if it were intact:
/// opening has no effect in compression, but damage remains.
#[test]
fn an_opened_joint_closes_where_it_was() {
    let update = response(&mortar());
    let mut state = [0.0; 2];
    let opened = update.respond_point([5e-5, 0.0], &PointContext::default(), &[0.0; 2], &mut state).unwrap();
    let damage = state[0];
    assert!(damage > 0.0 && damage < 1.0);
    let mut new = [0.0; 2];
    let half = update.respond_point([2.5e-5, 0.0], &PointContext::default(), &state, &mut new).unwrap();
    near(half.traction[0], 0.5 * opened.traction[0], 1e-12);
    let closed = update.respond_point([-1e-6, 0.0], &PointContext::default(), &state, &mut new).unwrap();
    near(closed.traction[0], 82e9 * 1e-6, 1e-12);
    assert_eq!(new[0], damage);
}
