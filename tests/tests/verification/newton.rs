//! Newton path against limit analysis, closed forms and systems made by hand.

use voussoir::core::limit::Status;
use voussoir::core::path::{PathAnswer, PathProblem, PathSolver, Unobserved};
use voussoir::solvers::path::newton::NewtonPath;
use voussoir_tests::known::{REFERENCE_ARCH, REFERENCE_ARCH_JOINTED, REFERENCE_ARCH_LOW_FRICTION};
use voussoir_tests::{
    Arch, Wall, answered, assert_close, compliant, elastic, first_case, friction, small_displacements,
};

fn problem(text: &str) -> PathProblem {
    let case = first_case(text);
    PathProblem::new(&case.assembly, &case.stages).expect("a path problem")
}

fn traced(text: &str) -> PathAnswer {
    NewtonPath {}.trace(&problem(text), &small_displacements(), &mut Unobserved)
}

fn on_springs(law: String) -> String {
    compliant(&law, 1e10, 4e9)
}

/// The arches of limit analysis with compliant joints end at the rigid-block limit load.
#[test]
fn compliant_joints_end_at_the_limit_load() {
    let cases = [
        (Arch { joint: on_springs(friction(0.6)), ..Arch::default() }, REFERENCE_ARCH),
        (Arch { joint: on_springs(friction(0.3)), ..Arch::default() }, REFERENCE_ARCH_LOW_FRICTION),
        (
            Arch { joint: on_springs(friction(0.6)), voussoirs: 13, ends: "jointed", ..Arch::default() },
            REFERENCE_ARCH_JOINTED,
        ),
        (Arch { joint: on_springs("law = \"unilateral\"".into()), ..Arch::default() }, REFERENCE_ARCH),
        (Arch { joint: on_springs("law = \"coulomb\"\nfriction = 0.6".into()), ..Arch::default() }, REFERENCE_ARCH),
    ];
    for (arch, limit) in cases {
        let answer = traced(&arch.study());
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), limit, 1e-8);
    }
}

#[test]
fn a_locked_arch_is_unbounded() {
    let arch = Arch { rise: 0.59, joint: on_springs(friction(0.6)), ..Arch::default() };
    let answer = traced(&arch.study());
    assert_eq!(answer.status, Status::Unbounded, "{:?}", answer.notes);
}

#[test]
fn elastic_voussoirs_end_at_the_limit_load() {
    let answer = traced(&Arch { material: elastic(5e9, 0.3), ..Arch::default() }.study());
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), REFERENCE_ARCH, 1e-8);
}

/// On random arches and walls, with associated friction or none and stiffness ratios up to 1e4, the last factor of the
/// path is that of limit analysis, or both are unbounded, or the dead load alone fails. A path whose claim is not
/// certified is stalled, never wrong. SCENES sets the number of scenes (6 by default).
#[test]
fn random_scenes_agree_with_limit_analysis() {
    let mut seed = 12345u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut compared, mut stalled) = (0, 0);
    let mut wrong = Vec::new();
    let scenes = std::env::var("SCENES").ok().and_then(|n| n.parse().ok()).unwrap_or(6);
    for index in 0..scenes {
        let mu = 0.05 * 40f64.powf(random());
        let stiffness = [10f64.powf(8.0 + 3.0 * random()), 10f64.powf(7.0 + 4.0 * random())];
        let joint = compliant(&friction(mu), stiffness[0], stiffness[1]);
        let text = if index % 3 == 0 {
            let wall = Wall::in_bond(2 + (4.0 * random()) as usize, 1 + (3.0 * random()) as usize);
            Wall { joint, ..wall }.study()
        } else {
            Arch {
                rise: 0.7 + 3.5 * random(),
                thickness: 0.3 + 0.6 * random(),
                voussoirs: 5 + (13.0 * random()) as usize,
                ends: if random() < 0.5 { "bonded" } else { "jointed" },
                span_fraction: 0.25 + 0.5 * random(),
                joint,
                ..Arch::default()
            }
            .study()
        };
        let limit = answered(&text);
        let answer = traced(&text);
        let same = answer.status == limit.status;
        let difference = match (answer.status, answer.factor, limit.load_factor) {
            (Status::Collapse, Some(a), Some(b)) => (a - b).abs() / b.abs().max(1e-3),
            _ => 0.0,
        };
        stalled += usize::from(answer.status == Status::Stalled);
        compared += usize::from(answer.status == Status::Collapse);
        if (!same && answer.status != Status::Stalled) || difference > 1e-8 {
            wrong.push(format!(
                "{index}: {:?} {:?} against {:?} {:?}: {:?} {:?}",
                answer.status, answer.factor, limit.status, limit.load_factor, answer.notes, limit.notes
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // Claims that cannot be certified end as stalled with their reason: none is wrong, a few are missing.
    assert!(2 * compared >= scenes && 3 * stalled <= scenes, "{compared} {stalled}");
}
