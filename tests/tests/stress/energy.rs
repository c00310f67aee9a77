//! Paths of rigid blocks on springs without slip against minima of the potential energy.
//!
//! ```sh
//! CASES=60 FIRST=0 cargo test --release -p voussoir-tests --test stress -- --ignored --nocapture energy_of_many
//! ```
//!
//! The energy program holds the load point and finds stable states. Its first peak is the first limit point; after a
//! snap it may be on another branch than the path. `CASES` counts the scenes that the energy program describes.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir_independent::energy::{EnergyScene, Landing, TraceLimits, dead_load, load_path, settle, weigh};
use voussoir_tests::family::{Family, FamilyScene, Form, family_scene};
use voussoir_tests::{first_case, keep};

/// Relative difference of equal loads.
const SAME_LOAD: f64 = 1e-6;
/// Longest steps of the energy program, in spans; shorter steps do not pass over a dip.
const STEPS: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6];
/// Tangential gap, relative to the height of a joint, up to which a point stays in the middle of both blocks. Beyond it
/// the program moves points to the corners of one block, and the energy program does not.
const LARGEST_SHEAR: f64 = 0.005;
/// Displacement of the load point at which the energy program ends, in spans.
const FARTHEST: f64 = 0.05;

/// The outcome of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// First limit point and greatest load are peaks of the energy.
    Agrees,
    /// Only the first limit point is a peak; the greatest load is after a snap or beyond the range of the energy
    /// program.
    FirstAgrees,
    /// The first limit points agree; the program's path does not reach the end of its range.
    FirstAgreesOpen,
    /// The energy program snaps at a lower load, before any smooth peak.
    SnapsBefore,
    ProgramOpen,
    /// The energy has no peak in its range, or the dead load is not carried.
    NoPeak,
    /// A joint shears by more than the energy program describes before the first limit point.
    LargeShear,
    EnergyLost,
    Contradicts,
}

/// A stable branch of the energy.
#[derive(Debug, Clone)]
struct Branch {
    /// Peaks, each with true if the branch snaps there.
    peaks: Vec<(f64, bool)>,
    snaps: bool,
    /// Greatest load before a joint shears too much.
    greatest: f64,
    shears: bool,
}

/// Returns true if a joint shears by more than the energy program describes.
fn shears(energy: &EnergyScene, landing: &Landing) -> bool {
    let joints = energy.points.chunk_by(|a, b| a.joint == b.joint);
    let mut gaps = landing.at.gap.iter();
    joints.into_iter().any(|joint| {
        let height = (joint[joint.len() - 1].position - joint[0].position).norm();
        let shear = gaps.by_ref().take(joint.len()).map(|gap| gap[1].abs()).fold(0.0, f64::max);
        shear > LARGEST_SHEAR * height
    })
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_LOAD * a.abs().max(b.abs())
}

/// Returns scene `k` of the families with point loads, in turn.
fn scene(k: u64) -> FamilyScene {
    let families = [Family::Random, Family::Symmetric, Family::Settlements, Family::Finite];
    family_scene(families[(k % 4) as usize], 2_000 + k / 4).on_springs()
}

/// Returns the stable branches; `None` if the energy program fails.
fn branches(text: &str, largest: f64) -> Option<Vec<Branch>> {
    let energy = EnergyScene::of_case(&first_case(text));
    let limits = TraceLimits { largest, farthest: FARTHEST };
    let starts = if energy.settled.len() > 1 {
        let branches = settle(&energy, TraceLimits::default());
        let ends = branches.iter().filter_map(|stages| stages.last()).filter(|trace| trace.broken.is_none());
        ends.map(|trace| trace.last().landing.clone()).collect()
    } else {
        vec![dead_load(&energy)]
    };
    let found = starts.iter().map(|start| {
        let trace = load_path(&energy, start, limits);
        let described = |landing: &Landing| !shears(&energy, landing);
        let states: Vec<_> = trace.states.iter().take_while(|state| described(&state.landing)).collect();
        let end = states.last().map_or(f64::NEG_INFINITY, |state| state.at);
        let peaks = trace.peaks.iter().filter(|peak| peak.displacement <= end);
        Branch {
            peaks: peaks.map(|peak| (peak.factor, peak.snaps)).collect(),
            snaps: trace.snaps.iter().any(|snap| snap.at <= end),
            greatest: states.iter().map(|state| state.landing.factor).fold(f64::NEG_INFINITY, f64::max),
            shears: states.len() < trace.states.len(),
        }
    });
    let found: Vec<_> = found.collect();
    (!found.is_empty()).then_some(found)
}

fn compared(result: &CaseResult, branches: Option<&Vec<Branch>>) -> Outcome {
    let Some(branches) = branches else { return Outcome::EnergyLost };
    let answered = result.status.is_answer() && result.certificate.passed;
    let Some(load) = result.load_factor else { return Outcome::ProgramOpen };
    let first = result.path.first_limit_point.unwrap_or(load);
    let of_branch = |branch: &Branch| match branch.peaks.first() {
        // The energy rises beyond the first limit point, or has none.
        None if !answered && result.path.first_limit_point.is_none() => Outcome::ProgramOpen,
        None if branch.greatest > first && !same(branch.greatest, first) => Outcome::Contradicts,
        None if branch.shears => Outcome::LargeShear,
        None => Outcome::NoPeak,
        Some((peak, _)) if same(*peak, first) => {
            if !answered {
                Outcome::FirstAgreesOpen
            } else if branch.peaks.iter().any(|(peak, _)| same(*peak, load)) {
                Outcome::Agrees
            } else if branch.snaps || branch.shears || load > branch.greatest {
                Outcome::FirstAgrees
            } else {
                Outcome::Contradicts
            }
        }
        Some((peak, true)) if *peak < first => Outcome::SnapsBefore,
        Some(_) => Outcome::Contradicts,
    };
    branches.iter().map(of_branch).min().unwrap_or(Outcome::EnergyLost)
}

/// Returns the outcome of a scene with a line for the table; `None` if it has other loads than forces.
fn outcome(k: u64) -> Option<(Outcome, String)> {
    let scene = scene(k);
    if !scene.has_point_loads() {
        return None;
    }
    let text = scene.study(Form::Given, "");
    let result = solve_case(&first_case(&text));
    let mut best = (Outcome::EnergyLost, None);
    for largest in STEPS {
        let found = catch_unwind(AssertUnwindSafe(|| branches(&text, largest))).ok().flatten();
        let outcome = compared(&result, found.as_ref());
        if best.1.is_none() || outcome < best.0 {
            best = (outcome, found);
        }
        if best.0 != Outcome::Contradicts {
            break;
        }
    }
    let (outcome, branches) = best;
    if outcome != Outcome::Agrees {
        keep(&format!("energy{k}.toml"), &text);
    }
    let line = format!(
        "{k} {}: {outcome:?} {:?} {:.9?} first {:.9?} | energy {branches:.9?}",
        scene.shape, result.status, result.load_factor, result.path.first_limit_point
    );
    Some((outcome, line))
}

/// On a few scenes the path agrees with the energy program.
#[test]
fn energy_of_some() {
    let found: Vec<_> = (0..6).filter_map(outcome).collect();
    // The energy program ends earlier than some paths, and some paths do not reach their ends: then the first limit
    // points agree.
    let agrees =
        |outcome: &Outcome| matches!(outcome, Outcome::Agrees | Outcome::FirstAgrees | Outcome::FirstAgreesOpen);
    assert!(found.iter().filter(|(outcome, _)| agrees(outcome)).count() >= 3, "{found:?}");
    assert!(found.iter().all(|(outcome, _)| *outcome != Outcome::Contradicts), "{found:?}");
}

/// Many scenes: no path contradicts the energy program. The test prints a table.
#[test]
#[ignore = "minutes; CASES and FIRST choose the scenes"]
fn energy_of_many() {
    let number = |key: &str, default: u64| std::env::var(key).ok().and_then(|s| s.parse().ok()).unwrap_or(default);
    let (first, cases) = (number("FIRST", 0), number("CASES", 60) as usize);
    let mut counts = BTreeMap::new();
    let mut described = 0;
    for (outcome, line) in (first..).filter_map(outcome) {
        println!("{line}");
        *counts.entry(outcome).or_insert(0) += 1;
        described += usize::from(!matches!(outcome, Outcome::LargeShear | Outcome::NoPeak));
        if described == cases {
            break;
        }
    }
    println!("{counts:?}");
    assert_eq!(counts.get(&Outcome::Contradicts), None);
}

/// Returns true if scene `k` carries the same share of gravity, with a line for the table. Its joints are softer by 10 to 10,000.
/// `None` if the path is not certified, if a joint shears too much, or below the share with which the energy program begins.
fn weighed(k: u64) -> Option<(bool, String)> {
    let families = [Family::Random, Family::Symmetric, Family::Bricks, Family::Finite];
    let scene = family_scene(families[(k % 4) as usize], 2_000 + k / 4).on_springs();
    let scene = scene.softer(10f64.powf(1.0 + (k % 13) as f64 / 4.0));
    if !scene.has_point_loads() {
        return None;
    }
    let text = scene.study(Form::Given, "");
    let case = first_case(&text);
    let result = solve_case(&case);
    let own = match result.path.limit_points.iter().find(|point| point.gravity) {
        _ if result.status == Status::Stalled => return None,
        Some(point) => point.factor,
        None => 1.0,
    };
    let energy = EnergyScene::of_case(&case);
    let (trace, ends) = catch_unwind(AssertUnwindSafe(|| weigh(&energy))).ok()?;
    let sheared = trace.states.iter().find(|state| shears(&energy, &state.landing)).map(|state| state.at);
    if sheared.is_some_and(|at| at < own) || own < trace.states[0].at {
        return None;
    }
    let within = |[low, high]: &[f64; 2]| (low * (1.0 - SAME_LOAD)..high * (1.0 + SAME_LOAD)).contains(&own);
    let agrees = ends.iter().any(within) || (own, trace.last().at) == (1.0, 1.0);
    let line = format!("{k} {}: {:?} {own:.9}, energy {ends:.9?} {:.9}", scene.shape, result.status, trace.last().at);
    if !agrees {
        keep(&format!("weight{k}.toml"), &text);
    }
    Some((agrees, line))
}

/// On a few scenes, half of which snap under their weight, gravity is carried up to the same share.
#[test]
fn weights_of_some() {
    let found: Vec<_> = [3, 7, 19, 20, 62, 71, 374, 0, 1, 2, 6, 8, 15, 16].into_iter().filter_map(weighed).collect();
    assert!(found.iter().all(|(agrees, _)| *agrees) && found.len() >= 10, "{found:#?}");
}

/// Many scenes: gravity is carried up to the same share. The test prints a table.
#[test]
#[ignore = "minutes; CASES and FIRST choose the scenes"]
fn weights_of_many() {
    let number = |key: &str, default: u64| std::env::var(key).ok().and_then(|s| s.parse().ok()).unwrap_or(default);
    let (first, cases) = (number("FIRST", 0), number("CASES", 200));
    let found: Vec<_> = (first..first + cases).filter_map(weighed).collect();
    found.iter().for_each(|(_, line)| println!("{line}"));
    let less = found.iter().filter(|(_, line)| line.contains("LimitPoint")).count();
    let wrong: Vec<&String> = found.iter().filter(|(agrees, _)| !agrees).map(|(_, line)| line).collect();
    println!("{} of {cases} scenes compared, {less} limit points", found.len());
    assert!(wrong.is_empty(), "{wrong:#?}");
}
