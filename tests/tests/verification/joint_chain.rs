//! `event_path` by the chain of joints against itself on the whole system: the same scene with an additional part
//! without effect, for which the solver cannot use the chain.

use voussoir::core::limit::Status;
use voussoir::core::model::geometry::Vec2;
use voussoir::core::path::{Attachment, Contact, PathAnswer, PathProblem, PathSolver, PointLaw, Sliding};
use voussoir::solvers::path::event::EventPath;
use voussoir_tests::seen::Seen;
use voussoir_tests::{Arch, Wall, answered, assert_close, compliant, elastic, first_case, small_displacements};

/// Adds a joint between the ground and itself.
fn with_a_joint_of_the_ground(mut problem: PathProblem) -> PathProblem {
    let body = problem.bodies.iter().position(|b| b.held).unwrap();
    let ground = Attachment { body, slot: None };
    problem.contacts.push(Contact {
        joint: problem.contacts.last().unwrap().joint,
        position: Vec2::zeros(),
        normal: Vec2::new(0.0, 1.0),
        tangent: Vec2::new(-1.0, 0.0),
        minus: ground,
        plus: ground,
        area: 1.0,
        gap: 0.0,
        law: PointLaw::Bonded,
        compliance: [1e-9; 2],
        sliding: Sliding::middle(0.0),
    });
    problem
}

fn followed(problem: &PathProblem) -> (PathAnswer, Seen) {
    let mut seen = Seen::default();
    let answer = EventPath {}.trace(problem, &small_displacements(), &mut seen);
    (answer, seen)
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a, b| a.max(b.abs()))
}

/// Asserts that both give the same path, and that the chain solved most of its rate problems. Returns status and last
/// factor.
fn same_path(study: &str) -> (Status, Option<f64>) {
    let case = first_case(study);
    let problem = || PathProblem::new(&case.assembly, &case.stages).unwrap();
    let (few, seen) = followed(&problem());
    let (whole, other) = followed(&with_a_joint_of_the_ground(problem()));
    let count = |answer: &PathAnswer, name: &str| answer.counters[name];
    assert_eq!(count(&whole, "rate_problems_by_redundants"), 0);
    let (by_redundants, all) = (count(&few, "rate_problems_by_redundants"), count(&few, "rate_problems"));
    // With non-associated flow and few choices, other rates are searched on the whole system.
    let least = if study.contains("law = \"coulomb\"\n") { 0 } else { all / 2 };
    assert!(by_redundants > least, "{by_redundants} of {all} rate problems by the chain\n{study}");
    for (name, value) in &seen.checker.worst {
        assert!(*value <= 1e-10, "{name} is {value:.1e} (whole: {:.1e})\n{study}", other.checker.worst[name]);
    }
    assert_eq!(few.status, whole.status, "{:?} {:?}\n{study}", few.notes, whole.notes);
    match (few.factor, whole.factor) {
        (Some(a), Some(b)) => assert!((a - b).abs() <= 1e-11 * b.abs(), "{a:.15} {b:.15}\n{study}"),
        (a, b) => assert_eq!(a, b),
    }
    // Events at one factor may be in another order.
    let events = |answer: &PathAnswer| {
        let mut all: Vec<(usize, usize, String, f64)> =
            answer.events.iter().map(|e| (e.load_step, e.contact, format!("{:?}", e.what), e.factor)).collect();
        all.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.3.total_cmp(&b.3)));
        all
    };
    let (own, others) = (events(&few), events(&whole));
    assert_eq!(own.len(), others.len(), "{study}");
    let scale = largest(own.iter().map(|e| e.3));
    for (a, b) in own.iter().zip(&others) {
        assert_eq!((a.0, a.1, &a.2), (b.0, b.1, &b.2), "{study}");
        assert!((a.3 - b.3).abs() <= 1e-9 * scale, "{a:?} {b:?}\n{study}");
    }
    let (a, b) = (&few.state, &whole.state);
    let force = largest(b.force.iter().flatten().copied());
    let motion = largest(b.motion.iter().flatten().copied());
    assert!(largest(a.force.iter().flatten().zip(b.force.iter().flatten()).map(|(a, b)| a - b)) <= 1e-9 * force);
    assert!(largest(a.motion.iter().flatten().zip(b.motion.iter().flatten()).map(|(a, b)| a - b)) <= 1e-9 * motion);
    for (a, b) in [(a.work, b.work), (a.stored, b.stored), (a.dissipated, b.dissipated)] {
        let work = few.state.work.abs() + few.state.stored;
        assert!((a - b).abs() <= 1e-9 * work, "{a:e} {b:e}\n{study}");
    }
    assert_eq!(other.states.last().map(|s| s.load_step), seen.states.last().map(|s| s.load_step));
    (few.status, few.factor)
}

fn on_springs(law: &str) -> String {
    compliant(law, 1e10, 4e9)
}

const LAWS: [&str; 6] = [
    "law = \"coulomb_associated\"\nfriction = 0.6",
    "law = \"coulomb\"\nfriction = 0.6",
    "law = \"coulomb\"\nfriction = 0.35",
    "law = \"coulomb\"\nfriction = 0.6\ndilatancy_angle = 15.0",
    "law = \"unilateral\"\ntangential = \"stuck\"",
    "law = \"mohr_coulomb\"\nfriction = 0.6\ncohesion = 2e4\ntensile_strength = 1e4\ncompressive_strength = 4e6",
];

#[test]
fn arches_of_all_laws() {
    let mut collapses = 0;
    for law in LAWS {
        for (voussoirs, rise, span_fraction) in [(13, 2.99, 0.25), (12, 2.0, 0.5), (21, 4.2, 0.37)] {
            let joint = on_springs(law);
            let arch = Arch { joint, voussoirs, rise, span_fraction, ends: "jointed", ..Arch::default() };
            let (status, factor) = same_path(&arch.study());
            if law.contains("associated") {
                // By linear programming, which uses neither stiffness nor history.
                let rigid = answered(&Arch { joint: law.into(), solver: "limit_chain", ..arch }.study());
                assert!(rigid.certificate.passed && rigid.status == status, "{:?} {status:?}", rigid.status);
                if let Some(limit) = rigid.load_factor {
                    assert_close(factor.unwrap(), limit, 1e-9);
                    collapses += 1;
                }
            }
            assert!(matches!(status, Status::Collapse | Status::LimitPoint | Status::Unbounded), "{status:?}");
        }
    }
    assert_eq!(collapses, 2);
}

/// The chain of joints and the whole system have the same path for a load that comes, goes and returns: slip remains.
#[test]
fn unloading_and_reloading() {
    for law in &LAWS[..4] {
        let arch = Arch { joint: on_springs(law), ends: "jointed", ..Arch::default() };
        let study = arch.study();
        let (head, live) = study.split_at(study.rfind("[[stages]]").unwrap());
        let load = |name: &str, force: f64| {
            format!(
                "[[stages]]\nname = \"{name}\"\nfactor = 300.0\nloads = [{{ kind = \"point\", span_fraction = 0.25, force = [0.0, {force:?}] }}]\n"
            )
        };
        same_path(&format!("{head}{}{}{live}", load("first", -1000.0), load("up", 1000.0)));
    }
}

/// The chain of joints and the whole system have the same path for a wall of a few bricks in running bond, which has
/// several cycles of joints.
#[test]
fn walls_of_a_few_bricks() {
    for law in &LAWS[..4] {
        let study = Wall { brick: [0.4, 0.2], joint: on_springs(law), ..Wall::in_bond(3, 2) }.study();
        same_path(&study);
    }
}

/// The chain of joints and the whole system have the same path for elastic voussoirs, whose joints influence each
/// other. Loads are off the middle, because rounding decides which half of a symmetric arch yields first.
#[test]
fn chains_of_elastic_voussoirs() {
    let mut collapses = 0;
    for law in LAWS {
        for (voussoirs, rise, span_fraction) in [(13, 2.99, 0.25), (12, 2.0, 0.45)] {
            let arch = Arch { joint: law.into(), voussoirs, rise, span_fraction, ends: "jointed", ..Arch::default() };
            let rigid = answered(&Arch { solver: "auto", ..arch.clone() }.study());
            let mesh = "elements = [1, 3]\norder = 2".into();
            let (status, factor) = same_path(&Arch { material: elastic(5e9, 0.3), mesh, ..arch }.study());
            if law.contains("associated") && status == Status::Collapse {
                assert_close(factor.unwrap(), rigid.load_factor.unwrap(), 1e-9);
                collapses += 1;
            }
        }
    }
    assert!(collapses > 0);
}

/// The chain of joints and the whole system have the same path for voussoirs far shorter than high, many of which open
/// together.
#[test]
fn slender_voussoirs() {
    let mesh = "elements = [1, 4]\norder = 2".into();
    let arch = Arch { voussoirs: 60, ends: "jointed", material: elastic(5e9, 0.3), mesh, ..Arch::default() };
    same_path(&arch.study());
}
