//! `event_path` against limit analysis and closed forms: small displacements, any mesh.

use voussoir::core::limit::Status;
use voussoir::core::path::{PathAnswer, PathProblem, PathSettings, PathSolver, certificate::Watch};
use voussoir::solvers::path::event::EventPath;
use voussoir_tests::{Arch, assert_close, first_case, friction};

fn settings() -> PathSettings {
    PathSettings { finite: false, tolerance: 1e-9, stop_displacement: None, stop_factor: None, continuation: None }
}

fn elastic(study: &str, mesh: &str) -> String {
    study
        .replace("law = \"rigid\"", "law = \"elastic\"\nyoung_modulus = \"5 GPa\"\npoisson_ratio = 0.3")
        .replace("[materials.stone]", &format!("[scene.mesh]\n{mesh}\n[materials.stone]"))
}

fn path(study: &str) -> PathAnswer {
    let case = first_case(study);
    let problem = PathProblem::new(&case.assembly, &case.stages).unwrap();
    let mut watch = Watch::default();
    let now = std::time::Instant::now();
    let answer = EventPath {}.trace(&problem, &settings(), &mut watch);
    eprintln!("{:?} {:?} {:?} {:?} {:?}", answer.status, answer.factor, answer.counters, answer.notes, now.elapsed());
    eprintln!("{}", watch.worst.iter().map(|(k, v)| format!("{k} {v:.1e}")).collect::<Vec<_>>().join(", "));
    answer
}

#[test]
fn the_last_factor_is_that_of_limit_analysis() {
    for mesh in ["elements = [1, 1]\norder = 1", "elements = [2, 2]\norder = 2", "elements = [4, 6]\norder = 2"] {
        let answer = path(&elastic(&Arch { joint: friction(0.6), ..Arch::default() }.study(), mesh));
        assert_eq!(answer.status, Status::Collapse);
        assert_close(answer.factor.unwrap(), 698.0226652123788, 1e-9);
    }
}

#[test]
fn other_arches() {
    for friction_law in ["coulomb", "coulomb_associated"] {
        for (rise, mu, ends, voussoirs) in [
            (2.99, 0.6, "jointed", 13),
            (2.99, 0.3, "bonded", 15),
            (4.49, 0.6, "bonded", 15),
            (1.49, 0.6, "bonded", 15),
            (2.09, 0.4, "bonded", 15),
            (0.59, 0.6, "bonded", 15),
            (1.19, 0.6, "bonded", 15),
        ] {
            let arch = Arch {
                rise,
                voussoirs,
                ends,
                joint: friction(mu).replace("coulomb_associated", friction_law),
                ..Arch::default()
            };
            let limit = voussoir_tests::answered(&Arch { joint: friction(mu), ..arch.clone() }.study());
            let answer = path(&elastic(&arch.study(), "elements = [4, 6]\norder = 2"));
            eprintln!(
                "{friction_law} {rise} {mu} {ends}: limit {:?} {:?} path {:?} {:?} {:e}",
                limit.status,
                limit.load_factor,
                answer.status,
                answer.factor,
                answer.factor.unwrap_or(f64::NAN) / limit.load_factor.unwrap_or(f64::NAN) - 1.0
            );
        }
    }
}
