//! Paths with friction and finite displacements against an integrator that shares no code with the solvers.
//!
//! ```sh
//! CASES=60 FIRST=0 cargo test --release -p voussoir-tests --test stress -- --ignored --nocapture integrator_of_many
//! ```
//!
//! `FLOW=associated` gives all scenes associated friction.

use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir_independent::integrator::families::SmallScene;
use voussoir_independent::integrator::{End, Found, integrate};
use voussoir_tests::{assert_close, first_case, keep};

/// Relative difference of equal loads.
const SAME_LOAD: f64 = 1e-5;
/// Longest step of the integrator.
const LONGEST_STEP: f64 = 1e-3;
/// Relative difference of two loads at which a joint is lost: the integrator checks this only after each step.
const JOINT_LOST: f64 = 1e-3;
/// Maxima after which the load falls by a smaller share are not compared.
const SMALLEST_FALL: f64 = 1e-7;

/// The outcome of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// The greatest load is a maximum after which the integrator's load falls.
    Agrees,
    /// The integrator ends at the greatest load, without a step after it.
    AgreesUpToItsEnd,
    FirstPeakDiffers,
    /// The load rises until a joint is lost; the program ends at this load, open or with a limit point.
    JointLost,
    ProgramOpen,
    ProgramStalled,
    IntegratorLost,
    Contradicts,
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_LOAD * a.abs().max(b.abs())
}

/// Returns true if the load falls after the greatest maximum.
fn falls_behind(found: &Found) -> bool {
    let falls = |[load, fall]: &[f64; 2]| fall.is_finite() && *fall > SMALLEST_FALL * load.abs();
    found.peaks.iter().any(|peak| same(peak[0], found.greatest) && falls(peak))
}

/// Returns true if the integrator loses a joint at its greatest load, and this load is near `load`.
fn lost_together(found: &Found, load: f64) -> bool {
    let near = (load - found.greatest).abs() <= JOINT_LOST * found.greatest.abs();
    near && found.end == End::JointLost && !falls_behind(found)
}

/// Compares a result with the integrator's path.
fn compared(result: &CaseResult, found: Option<&Found>) -> Outcome {
    let Some(found) = found else { return Outcome::IntegratorLost };
    let complete = !matches!(found.end, End::Lost | End::Steps);
    let lost_or = |outcome| if complete { outcome } else { Outcome::IntegratorLost };
    match (result.status, result.load_factor) {
        (Status::Collapse | Status::LimitPoint, Some(load)) if same(load, found.greatest) => {
            let first = found.peaks.iter().find(|[load, fall]| *fall > SMALLEST_FALL * load.abs());
            match (first, result.path.first_limit_point) {
                (Some([one, _]), Some(other)) if !same(*one, other) => Outcome::FirstPeakDiffers,
                _ if falls_behind(found) => Outcome::Agrees,
                _ => Outcome::AgreesUpToItsEnd,
            }
        }
        (Status::LimitPoint, Some(load)) if lost_together(found, load) => Outcome::JointLost,
        // A greater load of the integrator is a contradiction, wherever its path ends.
        (Status::Collapse | Status::LimitPoint, Some(load)) if load < found.greatest => Outcome::Contradicts,
        (Status::Collapse | Status::LimitPoint, Some(_)) => lost_or(Outcome::Contradicts),
        (Status::Open, _) => {
            let lower = result.bounds.and_then(|bounds| bounds[0]).unwrap_or(0.0);
            if lost_together(found, lower) {
                Outcome::JointLost
            } else if lower <= found.greatest * (1.0 + SAME_LOAD) {
                Outcome::ProgramOpen
            } else {
                lost_or(Outcome::Contradicts)
            }
        }
        _ => Outcome::ProgramStalled,
    }
}

/// The outcomes of a scene and of its mirror image, with a line for the table.
fn outcomes(seed: u64, associated: bool) -> ([Outcome; 2], String) {
    let mut scene = SmallScene::of_seed(seed);
    scene.associated = associated;
    let texts = [scene.study(""), scene.mirrored().study("")];
    let found = integrate(&first_case(&texts[0]), LONGEST_STEP);
    let mut line = format!("{seed} {}: ", scene.family);
    line += &found.as_ref().map_or("dead load not carried".into(), |f| format!("{:.9} {:?}", f.greatest, f.end));
    let outcomes = [0, 1].map(|side| {
        let result = solve_case(&first_case(&texts[side]));
        let outcome = compared(&result, found.as_ref());
        if !matches!(outcome, Outcome::Agrees) {
            keep(&format!("integrator{seed}_{side}.toml"), &texts[side]);
        }
        line += &format!(" | {outcome:?} {:?} {:?} {:?}", result.status, result.load_factor, result.bounds);
        outcome
    });
    (outcomes, line)
}

/// A stack, a portal, an arch and a wall carry the load of an independent integrator, and so do their mirror images; one
/// portal has associated flow.
#[test]
fn integrator_of_some() {
    let found: Vec<_> = std::thread::scope(|scope| {
        let work = [vec![(2, false), (9025, true)], vec![(1, false), (20, false), (3, false)]].map(|scenes| {
            scope.spawn(move || scenes.into_iter().map(|(seed, flow)| outcomes(seed, flow)).collect::<Vec<_>>())
        });
        work.into_iter().flat_map(|part| part.join().expect("no panic")).collect()
    });
    for (outcomes, line) in found {
        // The loads agree; the integrator may end without a step after the greatest load.
        let agrees = |outcome: &Outcome| matches!(outcome, Outcome::Agrees | Outcome::AgreesUpToItsEnd);
        assert!(outcomes.iter().all(agrees), "{line}");
    }
}

/// An arch with associated friction that is pushed sideways, whose load once changed with the step and in the mirror image
/// (58.15 to 58.22), and the same arch without dilatancy.
#[test]
fn a_pushed_arch_agrees_with_and_without_dilatancy() {
    for (law, load) in [("coulomb_associated", 58.218323), ("coulomb", 22.817583)] {
        let case = first_case(&PUSHED_ARCH.replace("LAW", law));
        let found = integrate(&case, LONGEST_STEP).expect("a path");
        let result = solve_case(&case);
        assert_eq!(compared(&result, Some(&found)), Outcome::Agrees, "{law}: {:?} {found:?}", result.load_factor);
        assert_close(result.load_factor.expect("a load"), load, 1e-7);
        assert!(result.certificate.passed, "{:?}", result.certificate);
    }
}

const PUSHED_ARCH: &str = r#"name = "pushed arch"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 1.2052944130139251, rise = 0.28133115948306436 }
thickness = 0.17736007096246809
voussoirs = 5
ends = "bonded"
width = 1.0
mesh = { elements = [1, 2], order = 2 }
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2249.7736281299995
[joints.dry]
law = "LAW"
friction = 0.9518956069923712
normal_stiffness = 2032251711.7920132
shear_stiffness = 1056864769.3255891
[solver]
kinematics = "finite"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "body", acceleration = [9.81, 0.0] }]
"#;

/// Many scenes: no path contradicts the independent integrator. The test prints a table.
#[test]
#[ignore = "minutes; CASES and FIRST choose the scenes"]
fn integrator_of_many() {
    let number = |key: &str, default: u64| std::env::var(key).ok().and_then(|s| s.parse().ok()).unwrap_or(default);
    let first = number("FIRST", 0);
    let associated = std::env::var("FLOW").is_ok_and(|flow| flow == "associated");
    let mut counts = std::collections::BTreeMap::new();
    for seed in first..first + number("CASES", 60) {
        let (outcomes, line) = outcomes(seed, associated);
        println!("{line}");
        outcomes.into_iter().for_each(|outcome| *counts.entry(outcome).or_insert(0) += 1);
    }
    println!("{counts:?}");
    assert_eq!(counts.get(&Outcome::Contradicts), None);
}
