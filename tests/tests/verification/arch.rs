//! Arches whose load factors are known from an independent calculation (CLAIMS, code D of the project's benchmark
//! list): Drosopoulos, Stavroulakis & Massalas (2008), Construction and Building Materials 22.

use voussoir::core::certificate::MechanismKind;
use voussoir::core::limit::Status;
use voussoir_tests::known::{
    PEERS_RING, REFERENCE_ARCH, REFERENCE_ARCH_JOINTED, REFERENCE_ARCH_LOW_FRICTION, peers_ring,
};
use voussoir_tests::{Arch, answered, assert_close, collapse_factor, crushing, friction};

const SOLVERS: [(&str, f64); 2] = [("limit_chain", 1e-12), ("limit_conic", 1e-11)];

/// With rise 2.99 m, bonded ends and unlimited strength the load is 698.0226652123788 kN, with four hinges.
#[test]
fn strathmashie_bonded() {
    for (solver, tolerance) in SOLVERS {
        let arch = Arch { solver, ..Arch::default() };
        assert_close(collapse_factor(&arch.study()), REFERENCE_ARCH, tolerance);
        let mechanism = answered(&arch.study()).mechanism.expect("a mechanism");
        assert_eq!((mechanism.kind, mechanism.hinge_count), (MechanismKind::FourHinge, 4));
        assert_eq!(mechanism.unique, Some(true));
    }
}

/// With 13 voussoirs and jointed ends the load is 491.3709236878251 kN.
#[test]
fn strathmashie_jointed() {
    for (solver, tolerance) in SOLVERS {
        let arch = Arch { voussoirs: 13, ends: "jointed", solver, ..Arch::default() };
        assert_close(collapse_factor(&arch.study()), REFERENCE_ARCH_JOINTED, tolerance);
    }
}

/// With friction 0.3 the load is 517.9014430032892 kN, with sliding and hinges.
#[test]
fn strathmashie_with_low_friction() {
    for (solver, tolerance) in SOLVERS {
        let arch = Arch { joint: friction(0.3), solver, ..Arch::default() };
        assert_close(collapse_factor(&arch.study()), REFERENCE_ARCH_LOW_FRICTION, tolerance);
        assert_eq!(answered(&arch.study()).mechanism.expect("a mechanism").kind, MechanismKind::Mixed);
    }
}

/// With crushing at 10 MPa and the rectangular stress block the load is 669.346 kN.
#[test]
fn strathmashie_with_crushing() {
    for (solver, _) in SOLVERS {
        let arch = Arch { joint: crushing(0.6, 10e6), solver, ..Arch::default() };
        assert_close(collapse_factor(&arch.study()), 669.346, 1e-5);
    }
}

/// With rise 1.19 m, bonded ends and unlimited strength no load is finite: two straight struts fit in the ring.
#[test]
fn shallow_arch_is_unbounded_and_proves_it() {
    for (solver, _) in SOLVERS {
        let result = answered(&Arch { rise: 1.19, solver, ..Arch::default() }.study());
        assert_eq!(result.status, Status::Unbounded);
        assert!(result.certificate.passed && result.load_factor.is_none());
        assert!(result.certificate.residuals["ray_equilibrium"] < 1e-12);
    }
}

/// The load at midspan is unbounded at rise 2.99 m, and 987.1 kN at rise 3.89 m, with five hinges (statement 12).
#[test]
fn load_at_midspan() {
    for (solver, _) in SOLVERS {
        let arch = |rise| Arch { rise, span_fraction: 0.5, solver, ..Arch::default() };
        assert_eq!(answered(&arch(2.99).study()).status, Status::Unbounded);
        let result = answered(&arch(3.89).study());
        assert_close(result.load_factor.expect("a collapse"), 987.1, 1e-4);
        let mechanism = result.mechanism.expect("a mechanism");
        assert_eq!(mechanism.hinge_count, 5, "{:?}", mechanism.hinges);
    }
}

/// The published ring of the peers, 13 equal straight-sided voussoirs, jointed, 1 m wide, carries 84.57330872 kN.
#[test]
fn the_peers_ring() {
    for (solver, _) in SOLVERS {
        let arch = Arch { solver, ..peers_ring(13) };
        assert_close(collapse_factor(&arch.study()), PEERS_RING, 1e-9);
    }
}

/// Statements 1, 4 and 7 of the paper hold: with bonded ends the load increases as the rise decreases, is finite down
/// to 1.49 m, unbounded below with unlimited strength, and finite for all rises with 10 MPa. Statement 2 holds: with
/// crushing the greatest load of the nineteen is that of rise 0.59 m.
#[test]
fn nineteen_rises() {
    let mut last = 0.0;
    let mut greatest = (0.0, 0.0);
    for k in 0..19 {
        let rise = (569.0 - 30.0 * k as f64) / 100.0;
        let unlimited = answered(&Arch { rise, ..Arch::default() }.study());
        let limited = answered(&Arch { rise, joint: crushing(0.6, 10e6), ..Arch::default() }.study());
        assert!(unlimited.certificate.passed && limited.certificate.passed);
        let crushing = limited.load_factor.expect("crushing bounds every load");
        if crushing > greatest.0 {
            greatest = (crushing, rise);
        }
        if rise > 1.48 {
            let factor = unlimited.load_factor.expect("finite above 1.49 m");
            assert!(factor > last && crushing < factor, "rise {rise}");
            last = factor;
        } else {
            assert_eq!(unlimited.status, Status::Unbounded, "rise {rise}");
        }
    }
    assert_eq!(greatest.1, 0.59);
}
