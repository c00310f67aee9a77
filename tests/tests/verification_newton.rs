//! Newton path against limit analysis, closed forms and hand-made systems.

use voussoir::core::limit::Status;
use voussoir::core::path::{PathAnswer, PathProblem, PathSettings, PathSolver, Unobserved};
use voussoir::solvers::path::newton::NewtonPath;
use voussoir_tests::{Arch, assert_close, first_case, friction};

fn settings() -> PathSettings {
    PathSettings { finite: false, tolerance: 1e-9, stop_displacement: None, stop_factor: None, continuation: None }
}

fn problem(text: &str) -> PathProblem {
    let case = first_case(text);
    PathProblem::new(&case.assembly, &case.stages).expect("a path problem")
}

fn traced(text: &str) -> PathAnswer {
    NewtonPath {}.trace(&problem(text), &settings(), &mut Unobserved)
}

fn compliant(law: String) -> String {
    format!("{law}\nnormal_stiffness = 1e10\nshear_stiffness = 4e9")
}

/// The arch scenes of limit analysis, joints compliant: the path ends at the rigid-block limit load.
#[test]
fn compliant_joints_end_at_the_limit_load() {
    let cases = [
        (Arch { joint: compliant(friction(0.6)), ..Arch::default() }, 698.022_665_212_378_8),
        (Arch { joint: compliant(friction(0.3)), ..Arch::default() }, 517.901_443_003_289_2),
        (
            Arch { joint: compliant(friction(0.6)), voussoirs: 13, ends: "jointed", ..Arch::default() },
            491.370_923_687_825_1,
        ),
        (Arch { joint: compliant("law = \"unilateral\"".into()), ..Arch::default() }, 698.022_665_212_378_8),
        (
            Arch { joint: compliant("law = \"coulomb\"\nfriction = 0.6".into()), ..Arch::default() },
            698.022_665_212_378_8,
        ),
    ];
    for (arch, limit) in cases {
        let answer = traced(&arch.study());
        println!("{:?} {:?} {:?} {:?}", answer.status, answer.factor, answer.counters, answer.notes);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), limit, 1e-8);
    }
}

#[test]
fn a_locked_arch_is_unbounded() {
    let arch = Arch { rise: 0.59, joint: compliant(friction(0.6)), ..Arch::default() };
    let answer = traced(&arch.study());
    println!("{:?} {:?} {:?} {:?}", answer.status, answer.factor, answer.counters, answer.notes);
    assert_eq!(answer.status, Status::Unbounded, "{:?}", answer.notes);
}

#[test]
fn elastic_voussoirs_end_at_the_limit_load() {
    let arch = Arch { voussoirs: 15, ..Arch::default() };
    let text = arch.study().replace("law = \"rigid\"", "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.3");
    let answer = traced(&text);
    println!("{:?} {:?} {:?} {:?}", answer.status, answer.factor, answer.counters, answer.notes);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 698.022_665_212_378_8, 1e-8);
}

/// Finite displacements: exploratory.
#[test]
#[ignore]
fn finite_peaks() {
    for young in ["5e9", "2e10", "8e10", "3.2e11"] {
        let arch = Arch { voussoirs: 15, ..Arch::default() };
        let text = arch
            .study()
            .replace("law = \"rigid\"", &format!("law = \"elastic\"\nyoung_modulus = {young}\npoisson_ratio = 0.3"));
        let how = PathSettings { finite: true, ..settings() };
        let start = std::time::Instant::now();
        let answer = NewtonPath {}.trace(&problem(&text), &how, &mut Unobserved);
        println!(
            "{young} {:?} {:?} {:?} {:?} {:?}",
            answer.status,
            answer.factor,
            answer.counters,
            answer.notes,
            start.elapsed()
        );
        println!("{} {:?}", answer.state.displacement, answer.last.map(|l| (l.factor, l.displacement)));
    }
}
