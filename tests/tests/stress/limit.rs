//! Random scenes: every answer is certified, and two solvers that share no numerical method agree.

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use voussoir::core::limit::Status;
use voussoir_tests::{Arch, Wall, answered, answered_within, assert_close, crushing, friction};

/// Random walls are certified: pushed in random directions, with windows, dry or with mortar.
#[test]
fn random_walls_are_certified() {
    let scenes = (
        2usize..8,
        2usize..7,
        0.1f64..1.2,
        -180.0f64..180.0,
        any::<bool>(),
        prop::option::of((4.0f64..7.0, 0.0f64..5e3)),
    );
    let mut runner = TestRunner::new_with_rng(
        Config { cases: 200, failure_persistence: None, ..Config::default() },
        proptest::test_runner::TestRng::deterministic_rng(proptest::test_runner::RngAlgorithm::ChaCha),
    );
    let collapses = std::cell::Cell::new(0);
    runner
        .run(&scenes, |(courses, bricks, mu, direction, window, mortar)| {
            let joint = match mortar {
                Some((exponent, cohesion)) => {
                    format!(
                        "{}\ncohesion = {cohesion:?}\ntensile_strength = {:?}",
                        crushing(mu, 10f64.powf(exponent)),
                        cohesion / 3.0
                    )
                }
                None => friction(mu),
            };
            let (sin, cos) = direction.to_radians().sin_cos();
            let (width, push) = (0.3, [9.81 * cos, 9.81 * sin]);
            let wall = Wall { brick: [0.4, 0.2], width, joint, push, ..Wall::in_bond(courses, bricks) };
            let has_window = window && courses > 3 && bricks > 3;
            let study = if has_window { wall.with_opening([0.8, 0.4], [1.2, 0.6]) } else { wall }.study();
            let result = answered(&study);
            assert!(result.certificate.passed, "{:?} {:?}\n{study}", result.notes, result.certificate);
            collapses.set(collapses.get() + usize::from(result.status == Status::Collapse));
            Ok(())
        })
        .unwrap();
    assert!(collapses.get() > 80, "{}", collapses.get());
}

/// Random arches have the same certified status and factor with both solvers: from slender to stout, deep to flat, low
/// to high friction, with and without crushing, bonded and jointed, loaded anywhere.
#[test]
fn random_arches_are_answered_alike_by_both_solvers() {
    let scenes = (
        0.05f64..1.4,
        0.02f64..0.2,
        3usize..40,
        any::<bool>(),
        0.05f64..2.0,
        0.06f64..0.94,
        prop::option::of(5.0f64..9.0),
    );
    let mut runner = TestRunner::new_with_rng(
        Config { cases: 400, failure_persistence: None, ..Config::default() },
        proptest::test_runner::TestRng::deterministic_rng(proptest::test_runner::RngAlgorithm::ChaCha),
    );
    let counts = std::cell::RefCell::new(std::collections::BTreeMap::<String, usize>::new());
    runner
        .run(&scenes, |(rise, thickness, voussoirs, bonded, mu, span_fraction, strength)| {
            let joint = match strength {
                Some(exponent) => crushing(mu, 10f64.powf(exponent)),
                None => friction(mu),
            };
            let arch = Arch {
                span: 10.0,
                rise: 10.0 * rise,
                thickness: 10.0 * thickness,
                voussoirs,
                ends: if bonded && voussoirs > 4 { "bonded" } else { "jointed" },
                joint,
                span_fraction,
                ..Arch::default()
            };
            // A load on a voussoir that is part of the ground is an input error.
            if voussoir::study::load(&arch.study(), "random.toml", &[]).is_err() {
                return Ok(());
            }
            // The bounds differ by the rounding of strengths up to 1 GPa.
            let [chain, conic] = ["limit_chain", "limit_conic"]
                .map(|solver| answered_within(&Arch { solver, ..arch.clone() }.study(), 1e-8));
            for result in [&chain, &conic] {
                assert!(result.certificate.passed, "{}: {:?}\n{}", result.solver, result.notes, arch.study());
            }
            assert_eq!(chain.status, conic.status, "{}", arch.study());
            if let (Some(a), Some(b)) = (chain.load_factor, conic.load_factor) {
                assert_close(a, b, 1e-9);
            }
            *counts.borrow_mut().entry(format!("{:?}", chain.status)).or_default() += 1;
            Ok(())
        })
        .unwrap();
    let counts = counts.into_inner();
    let count = |status: Status| counts.get(&format!("{status:?}")).copied().unwrap_or(0);
    assert!(count(Status::Collapse) > 100 && count(Status::NoEquilibrium) > 20, "{counts:?}");
}
