//! The cap model against closed forms (reference values derived from its equations by hand, by name).

use voussoir::core::law::{BulkMaterial, Isotropic, PlanarUpdate, Plane, StressUpdate, UpdateContext};
use voussoir::laws::drucker_prager_cap::DruckerPragerCap;
use voussoir::solvers::point::{Control, DrivenPoint, PointLaw};

const MPA: f64 = 1e6;

/// The stone of Drosopoulos et al.: β = 70°, d = 1 GPa, R = 0.005, α = 0.03.
fn paper(strength: f64, poisson_ratio: f64) -> DruckerPragerCap {
    DruckerPragerCap { poisson_ratio, ..DruckerPragerCap::drosopoulos_2008(strength) }
}

fn space(law: &DruckerPragerCap) -> DrivenPoint {
    DrivenPoint::new(PointLaw::Space(law.stress_update().unwrap(), 1.0)).unwrap()
}

fn near(found: f64, wanted: f64, relative: f64) {
    assert!((found - wanted).abs() <= relative * wanted.abs(), "{found} instead of {wanted}");
}

const FREE: Control = Control::Stress(0.0);
const HELD: Control = Control::Strain(0.0);

/// Uniaxial compression yields at about three times p_b.
#[test]
fn uniaxial_compression() {
    for (strength, wanted) in [(10.0 * MPA, 29.99250136), (10.0 / 3.0 * MPA, 9.99915160)] {
        for poisson_ratio in [0.2, 0.3] {
            let mut point = space(&paper(strength, poisson_ratio));
            for _ in 0..10 {
                let next = point.response.strain[0] - 0.002;
                point.step(&[Control::Strain(next), FREE, FREE, HELD, HELD, HELD]).unwrap();
            }
            near(-point.response.stress[0] / MPA, wanted, 5e-10);
            assert_eq!(point.response.region, "cap");
        }
    }
}

/// `uniaxial_strength` is the inverse of the closed form of uniaxial compression.
#[test]
fn uniaxial_strength_sets_the_cap() {
    for strength in [1.0, 10.0, 29.99250136, 300.0] {
        let law = DruckerPragerCap { hardening: None, uniaxial_strength: Some(strength * MPA), ..paper(1.0, 0.2) };
        assert_eq!(law.validate(), vec![]);
        let mut point = space(&law);
        point.step(&[Control::Strain(-0.1), FREE, FREE, HELD, HELD, HELD]).unwrap();
        near(-point.response.stress[0] / MPA, strength, 1e-10);
    }
    let p_b = paper(1.0, 0.2).hydrostatic_strength(29.99250136 * MPA).unwrap();
    near(p_b, 10.0 * MPA, 1e-9);
}

/// Triaxial compression reaches the cap at an axial minus lateral stress of 26.99392608 MPa for a lateral stress of 1 MPa, and
/// of 14.99812522 MPa for 5 MPa.
#[test]
fn triaxial_compression_to_the_cap() {
    for (lateral, wanted) in [(1.0, 26.99392608), (5.0, 14.99812522)] {
        let mut point = space(&paper(10.0 * MPA, 0.2));
        let side = Control::Stress(-lateral * MPA);
        point.step(&[side, side, side, HELD, HELD, HELD]).unwrap();
        let start = point.response.strain[0];
        for step in 1..=10 {
            let axial = Control::Strain(start - 0.002 * f64::from(step));
            point.step(&[axial, side, side, HELD, HELD, HELD]).unwrap();
        }
        near(-point.response.stress[0] / MPA - lateral, wanted, 5e-10);
        assert_eq!(point.response.region, "cap");
    }
}

/// Triaxial compression reaches the shear surface at q = 3 (d + p_lateral tan β) / (3 − tan β), while p < p_a.
#[test]
fn triaxial_compression_to_the_shear_surface() {
    let law = DruckerPragerCap {
        cap_friction_angle: 30.0,
        cap_cohesion: 5.0 * MPA,
        cap_eccentricity: 0.5,
        transition: 0.05,
        hardening: Some(vec![[0.0, 15.0 * MPA]]),
        ..paper(1.0, 0.2)
    };
    assert_eq!(law.validate(), vec![]);
    for lateral in [0.5, 1.0, 2.0] {
        let mut point = space(&law);
        let side = Control::Stress(-lateral * MPA);
        point.step(&[side, side, side, HELD, HELD, HELD]).unwrap();
        for step in 1..=10 {
            let axial = Control::Strain(-0.002 * f64::from(step));
            point.step(&[axial, side, side, HELD, HELD, HELD]).unwrap();
        }
        let friction = 30f64.to_radians().tan();
        let wanted = 3.0 * (5.0 + lateral * friction) / (3.0 - friction);
        near(-point.response.stress[0] / MPA - lateral, wanted, 1e-10);
        assert_eq!(point.response.region, "shear");
    }
}

/// Uniaxial strain first yields on the elastic path q/p = 3 (1 − 2ν)/(1 + ν).
#[test]
fn uniaxial_strain() {
    for (poisson_ratio, wanted) in [(0.2, 19.99874999), (0.3, 16.15346380)] {
        let update = paper(10.0 * MPA, poisson_ratio).stress_update().unwrap();
        let stiffness = 5e9 * (1.0 - poisson_ratio) / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
        near(first_yield(&*update, [1.0, 0.0, 0.0], -stiffness) / MPA, wanted, 5e-10);
    }
}

/// Plane strain with a free face first yields at σ_zz = ν σ_xx.
#[test]
fn plane_strain_with_a_free_face() {
    let update = paper(10.0 * MPA, 0.2).stress_update().unwrap();
    let stiffness = 5e9 / (1.0 - 0.2 * 0.2);
    near(first_yield(&*update, [1.0, -0.2 / 0.8, 0.0], -stiffness) / MPA, 24.99635444, 5e-10);
    // The plane-strain wrapper, driven with a free face, yields at the same stress.
    let planar = PlanarUpdate::new(update, Plane::Strain).unwrap();
    let mut point = DrivenPoint::new(PointLaw::Plane(planar, 1.0)).unwrap();
    let elastic = 24.99635444e6 / stiffness;
    point.step(&[Control::Strain(-elastic * (1.0 - 1e-9)), FREE, HELD]).unwrap();
    assert_eq!(point.response.region, "elastic");
    point.step(&[Control::Strain(-elastic * (1.0 + 1e-9)), FREE, HELD]).unwrap();
    assert_eq!(point.response.region, "cap");
}

/// Returns the size of the stress at which a strain along `direction` first yields, by bisection on the law.
fn first_yield(update: &dyn StressUpdate, direction: [f64; 3], stress_per_strain: f64) -> f64 {
    let mut old = vec![0.0; update.state_size()];
    update.initial_state(&mut old);
    let mut new = old.clone();
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let strain = [-middle * direction[0], -middle * direction[1], -middle * direction[2], 0.0, 0.0, 0.0];
        let point = update.update_point(&strain, &UpdateContext::of_length(1.0), &old, &mut new).unwrap();
        if point.branch.name == "elastic" { low = middle } else { high = middle }
    }
    -low * stress_per_strain
}

/// Hydrostatic compaction follows the table: p = p_b(ε_v) with ε_v = −tr ε − p/K, across every corner of the table and
/// beyond its end, from the initial compaction on.
#[test]
fn hydrostatic_compaction_along_the_table() {
    let table = vec![[0.0, 2.0 * MPA], [0.001, 5.0 * MPA], [0.004, 6.0 * MPA], [0.005, 12.0 * MPA]];
    let law = DruckerPragerCap {
        cap_friction_angle: 35.0,
        cap_cohesion: 1.0 * MPA,
        cap_eccentricity: 0.4,
        transition: 0.02,
        hardening: Some(table.clone()),
        initial_compaction: 0.0005,
        ..paper(1.0, 0.25)
    };
    assert_eq!(law.validate(), vec![]);
    let bulk = Isotropic::new(5e9, 0.25).bulk;
    let update = law.stress_update().unwrap();
    for steps in [1, 7, 100] {
        let mut old = vec![0.0; 7];
        update.initial_state(&mut old);
        let mut new = old.clone();
        for step in 1..=steps {
            let trace = -0.02 * f64::from(step) / f64::from(steps);
            let strain = [trace / 3.0, trace / 3.0, trace / 3.0, 0.0, 0.0, 0.0];
            let point = update.update_point(&strain, &UpdateContext::of_length(1.0), &old, &mut new).unwrap();
            old.copy_from_slice(&new);
            let p = -point.stress[0];
            let compaction = 0.0005 - trace - p / bulk;
            near(old[6], compaction, 1e-9);
            let wanted = table
                .windows(2)
                .find(|w| w[0][0] <= compaction && compaction <= w[1][0])
                .map_or(12.0 * MPA, |w| w[0][1] + (compaction - w[0][0]) * (w[1][1] - w[0][1]) / (w[1][0] - w[0][0]));
            if point.branch.name == "cap" {
                near(p, wanted, 1e-9);
            }
        }
    }
}
