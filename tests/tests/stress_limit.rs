//! Random scenes: every answer is certified, and two solvers that share no numerical method agree.

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use voussoir::core::limit::Status;
use voussoir_tests::{Arch, answered, assert_close, crushing, friction};

/// Random arches, from slender to stout, deep to flat, slippery to rough, with and without crushing,
/// bonded and jointed, loaded anywhere: both solvers certify the same status and factor.
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
            // A load on a voussoir that is part of the ground is an input error, not a scene.
            if voussoir::study::load(&arch.study(), "random.toml", &[]).is_err() {
                return Ok(());
            }
            let [chain, conic] =
                ["limit_chain", "limit_conic"].map(|solver| answered(&Arch { solver, ..arch.clone() }.study()));
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
