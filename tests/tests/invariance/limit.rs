//! Changes that must not change a load factor: units, scale, rotation, reflection, numbering, solver.

use voussoir::core::model::geometry::Vec2;
use voussoir_tests::{Arch, answered_within, as_blocks, assert_close, changed, collapse_factor, crushing, friction};

const SOLVERS: [&str; 2] = ["limit_chain", "limit_conic"];

fn variants() -> Vec<Arch> {
    let jointed = Arch { ends: "jointed", ..Arch::default() };
    vec![
        jointed.clone(),
        Arch { joint: friction(0.3), ..jointed.clone() },
        Arch { joint: crushing(0.6, 5e6), ..jointed },
    ]
}

/// Units do not matter: newtons or pounds, metres or feet give the same load.
#[test]
fn units_do_not_matter() {
    for solver in SOLVERS {
        let arch = Arch { solver, ..Arch::default() };
        let plain = collapse_factor(&arch.study());
        let pounds = changed(&arch.study(), "force = [0.0, -1000.0]", "force = [0.0, \"-224.80894309971048 lbf\"]");
        assert_close(collapse_factor(&pounds), plain, 1e-11);
        let feet = changed(&arch.study(), "thickness = 0.6", "thickness = \"600 mm\"");
        let feet = changed(&feet, "width = 5.81", "width = \"5810 mm\"");
        assert_close(collapse_factor(&feet), plain, 1e-11);
        let weight = changed(&arch.study(), "density = 2200.0", "density = \"21.582 kN/m3\"");
        assert_close(collapse_factor(&weight), plain, 1e-11);
    }
}

/// Scale does not matter: a model a thousand times smaller or larger, loaded by a millinewton or a meganewton.
#[test]
fn scale_does_not_matter() {
    for solver in SOLVERS {
        let base = Arch { solver, ..Arch::default() };
        let plain = collapse_factor(&base.study());
        for s in [1e-3, 1e3] {
            for load in [1e-3, 1e9] {
                let arch = Arch {
                    span: base.span * s,
                    rise: base.rise * s,
                    thickness: base.thickness * s,
                    width: base.width * s,
                    load,
                    ..base.clone()
                };
                assert_close(collapse_factor(&arch.study()) * load / (1000.0 * s * s * s), plain, 1e-11);
            }
        }
    }
}

/// Rotation, reflection and numbering do not matter: the scene rotated with its gravity, its mirror image, and its
/// blocks in another order.
#[test]
fn rotation_reflection_and_numbering_do_not_matter() {
    for solver in SOLVERS {
        for arch in variants() {
            let arch = Arch { solver, ..arch };
            let plain = collapse_factor(&arch.study());
            let order: Vec<usize> = (0..arch.voussoirs).collect();
            let shuffled: Vec<usize> = (0..arch.voussoirs).map(|k| (7 * k + 3) % arch.voussoirs).collect();
            for (angle, order) in [(0.0, &order), (0.7, &order), (2.5, &shuffled)] {
                let rotation = nalgebra::Rotation2::new(angle);
                let study = as_blocks(&arch, |p| rotation * p + Vec2::new(3.0, -40.0), |f| rotation * f, order);
                assert_close(collapse_factor(&study), plain, 1e-11);
            }
            let flip = |v: Vec2| Vec2::new(-v.x, v.y);
            assert_close(collapse_factor(&as_blocks(&arch, flip, flip, &order)), plain, 1e-11);
            let mirrored = Arch { span_fraction: 1.0 - arch.span_fraction, ..arch.clone() };
            assert_close(collapse_factor(&mirrored.study()), plain, 1e-11);
        }
    }
}

/// More friction, more strength or less restriction never lowers the load.
#[test]
fn the_load_grows_with_the_yield_set() {
    for solver in SOLVERS {
        let load = |joint: String| collapse_factor(&Arch { joint, ends: "jointed", solver, ..Arch::default() }.study());
        let frictions: Vec<f64> = [0.25, 0.3, 0.35, 0.4, 0.6, 1.0].map(|mu| load(friction(mu))).into();
        assert!(frictions.windows(2).all(|w| w[1] >= w[0] * (1.0 - 1e-13)), "{frictions:?}");
        let strengths: Vec<f64> = [1e6, 3e6, 1e7, 1e8, 1e10].map(|f| load(crushing(0.6, f))).into();
        assert!(strengths.windows(2).all(|w| w[1] > w[0]), "{strengths:?}");
        let unlimited = load(friction(0.6));
        assert!(strengths.iter().all(|f| *f < unlimited));
        let stuck = load("law = \"unilateral\"\ntangential = \"stuck\"".into());
        assert!(frictions.iter().all(|f| *f <= stuck * (1.0 + 1e-13)));
    }
}

/// A very large crushing strength gives the load of unlimited strength.
#[test]
fn a_huge_strength_tends_to_none() {
    for solver in SOLVERS {
        let unlimited = collapse_factor(&Arch { solver, ..Arch::default() }.study());
        // The bounds differ by the rounding of the strength.
        let huge = answered_within(&Arch { joint: crushing(0.6, 1e13), solver, ..Arch::default() }.study(), 1e-6);
        assert!(huge.certificate.passed, "{:?}", huge.certificate);
        assert_close(huge.load_factor.expect("a collapse"), unlimited, 1e-6);
    }
}
