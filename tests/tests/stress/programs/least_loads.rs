//! `limit_least` against an enumeration of modes by linear programs.
//!
//! ```sh
//! CASES=30 FIRST=0 cargo test --release -p voussoir-tests --test stress -- --ignored --nocapture least_loads_of_many
//! ```

use super::least::{Least, least_load};
use super::rigid::Rigid;
use std::collections::BTreeMap;
use voussoir::core::limit::{Greatest, Status};
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir_tests::family::{Family, FamilyScene, Form, Law, family_scene};
use voussoir_tests::{first_case, keep};

/// Relative difference of equal loads.
const SAME_LOAD: f64 = 1e-6;
/// Greatest number of programs of an enumeration.
const PROGRAMS: usize = 20_000;
/// Greatest number of contact points of a scene.
const MOST_POINTS: usize = 12;

/// The outcome of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    Agrees,
    InsideBracket,
    Undecided,
    NoAnswer,
    Contradicts,
}

/// Returns rigid scene `k` of the families, in turn, with `coulomb`, every fourth with dilatancy.
fn scene(k: u64) -> FamilyScene {
    let families = [Family::Random, Family::Symmetric, Family::Bricks, Family::Finite];
    let law = if k % 4 == 3 { Law::Dilatant } else { Law::Coulomb };
    family_scene(families[(k % 4) as usize], k / 4).rigid().with_law(law)
}

fn compared(result: &CaseResult, least: Least) -> Outcome {
    let size = |load: f64| SAME_LOAD * load.abs().max(1e-3);
    let certified = result.certificate.passed || result.status == Status::Open;
    match (least, result.load_factor) {
        (Least::Undecided, _) => Outcome::Undecided,
        (Least::Load(load, _), Some(found)) if certified => {
            let [low, high] = result.bounds.unwrap_or([None, Some(found)]);
            let inside =
                low.is_none_or(|low| low <= load + size(load)) && high.is_none_or(|high| load <= high + size(load));
            match (inside, (found - load).abs() <= size(load)) {
                (true, true) => Outcome::Agrees,
                (true, false) if result.greatest != Greatest::ProvedOptimal => Outcome::InsideBracket,
                _ => Outcome::Contradicts,
            }
        }
        (Least::Never, _) if matches!(result.status, Status::Unbounded | Status::NoEquilibrium) => Outcome::Agrees,
        (Least::Never, Some(_)) if certified => Outcome::Contradicts,
        (Least::Load(..), None) if matches!(result.status, Status::Unbounded | Status::NoEquilibrium) => {
            Outcome::Contradicts
        }
        _ => Outcome::NoAnswer,
    }
}

/// Returns the outcome of a scene with a line for the table; `None` if it is too large.
fn outcome(k: u64) -> Option<(Outcome, String)> {
    let scene = scene(k);
    let text = scene.study(Form::Given, "solver = \"limit_least\"");
    let case = first_case(&text);
    let rigid = Rigid::of_case(&case, scene.friction(), scene.dilatancy());
    if rigid.touches.len() > MOST_POINTS {
        return None;
    }
    let least = least_load(&rigid, PROGRAMS);
    let result = solve_case(&case);
    let outcome = compared(&result, least);
    if outcome != Outcome::Agrees {
        keep(&format!("least{k}.toml"), &text);
    }
    let joints = rigid.touches.len() / 2;
    let line = format!(
        "{k} {} {:?}, {joints} joints: {least:?} | {outcome:?} {:?} {:?} {:?}",
        scene.shape, scene.law, result.status, result.load_factor, result.bounds
    );
    Some((outcome, line))
}

/// On a few scenes `limit_least` finds the least load of the enumeration.
#[test]
fn least_loads_of_some() {
    let found: Vec<_> = (0..8).filter_map(outcome).collect();
    assert!(found.iter().filter(|(outcome, _)| *outcome == Outcome::Agrees).count() >= 3, "{found:?}");
    assert!(found.iter().all(|(outcome, _)| *outcome != Outcome::Contradicts), "{found:?}");
}

/// Many scenes: `limit_least` never contradicts the enumeration. The test prints a table.
#[test]
#[ignore = "minutes; CASES and FIRST choose the scenes"]
fn least_loads_of_many() {
    let number = |key: &str, default: u64| std::env::var(key).ok().and_then(|s| s.parse().ok()).unwrap_or(default);
    let (first, cases) = (number("FIRST", 0), number("CASES", 30) as usize);
    let mut counts = BTreeMap::new();
    for (outcome, line) in (first..).filter_map(outcome).take(cases) {
        println!("{line}");
        *counts.entry(outcome).or_insert(0) += 1;
    }
    println!("{counts:?}");
    assert_eq!(counts.get(&Outcome::Contradicts), None);
}
