//! Very small and very large strengths: the answer is that of the limiting law.

use voussoir::core::limit::Status;
use voussoir_tests::{Arch, answered, answered_within, assert_close, collapse_factor, crushing, friction};

const SOLVERS: [&str; 2] = ["limit_chain", "limit_conic"];

fn jointed(joint: &str, solver: &'static str) -> String {
    Arch { ends: "jointed", joint: joint.into(), solver, ..Arch::default() }.study()
}

/// A jointed arch without friction cannot carry its own weight, with any solver.
#[test]
fn joints_without_friction_do_not_carry_the_dead_load() {
    let free = ["law = \"unilateral\"\ntangential = \"free\"", "law = \"coulomb_associated\"\nfriction = 0.0"];
    for joint in free {
        for solver in SOLVERS {
            assert_eq!(answered(&jointed(joint, solver)).status, Status::NoEquilibrium, "{solver}: {joint}");
        }
    }
    for solver in ["limit_sequential", "limit_least"] {
        let case = answered(&jointed("law = \"coulomb\"\nfriction = 0.0", solver));
        assert_eq!(case.status, Status::NoEquilibrium, "{solver}");
    }
}

/// Friction that no force reaches gives the same load as stuck joints.
#[test]
fn great_friction_is_none_that_slides() {
    let stuck = answered(&jointed("law = \"unilateral\"\ntangential = \"stuck\"", "limit_chain"));
    let factor = stuck.load_factor.expect("a collapse");
    for mu in ["1e6", "1e10", "1e12", "1e30"] {
        for solver in SOLVERS {
            let case = answered(&jointed(&format!("law = \"coulomb_associated\"\nfriction = {mu}"), solver));
            assert_close(case.load_factor.expect("a collapse"), factor, 1e-12);
        }
        for solver in ["limit_sequential", "limit_least"] {
            let case = answered(&jointed(&format!("law = \"coulomb\"\nfriction = {mu}"), solver));
            assert_close(case.load_factor.expect("a collapse"), factor, 1e-12);
        }
    }
}

/// A very large compressive strength gives the load without crushing in a deep arch: both solvers have the same load,
/// which tends to the unlimited one; a compressed depth N / f_c b costs N / (f_c h b) at each hinge.
#[test]
fn great_compressive_strength_is_none_that_crushes() {
    // The bounds differ only by the rounding of such strengths.
    let within = |joint: &str, solver| answered_within(&jointed(joint, solver), f64::INFINITY);
    let factor = |joint: &str, solver| within(joint, solver).load_factor.expect("a collapse");
    let unlimited = factor("law = \"coulomb_associated\"\nfriction = 0.6", "limit_chain");
    for (strength, off) in [(1e11, 4e-6), (1e13, 4e-8), (1e15, 4e-10), (1e18, 1e-12), (1e30, 1e-12)] {
        let joint = format!("law = \"mohr_coulomb\"\nfriction = 0.6\ncompressive_strength = {strength:e}");
        let [chain, conic] = SOLVERS.map(|solver| factor(&joint, solver));
        assert_close(chain, conic, 1e-11);
        assert_close(chain, unlimited, off);
        assert!(chain <= unlimited * (1.0 + 1e-12));
    }
}

/// Flat arches whose live load is bounded only by the strength of their stone: the conic program and the chain have the
/// same load, although it is a million times the weight.
#[test]
fn flat_arches_of_strong_stone_in_the_conic_program() {
    for (rise, strength, voussoirs) in [(0.2, 1e10, 15), (0.29, 1e12, 10), (0.59, 1e9, 41)] {
        let arch = |solver| Arch { rise, voussoirs, solver, joint: crushing(0.6, strength), ..Arch::default() }.study();
        let conic = answered(&arch("limit_conic"));
        assert!(!conic.counters.contains_key("pivots"), "by its own program: {:?}", conic.counters);
        assert_close(conic.load_factor.expect("a collapse"), collapse_factor(&arch("limit_chain")), 1e-8);
    }
}

/// 20,000 voussoirs have the same load in the conic program and in the chain: the neighbours of a hinge are closed
/// except for 1e-9 of the thickness.
#[test]
#[ignore = "by hand: some ten seconds of processor time"]
fn twenty_thousand_voussoirs_in_the_conic_program() {
    let bonded = Arch { voussoirs: 20_000, ..Arch::default() };
    let jointed = Arch { ends: "jointed", joint: friction(0.6), ..bonded.clone() };
    let crushing = Arch { ends: "jointed", joint: crushing(0.6, 10e6), ..bonded.clone() };
    for arch in [bonded, jointed, crushing] {
        let [conic, chain] = SOLVERS.map(|solver| collapse_factor(&Arch { solver, ..arch.clone() }.study()));
        assert_close(conic, chain, 1e-9);
    }
}
