//! Paths with small displacements against each other and against the linear program of the associated limit load.
//!
//! ```sh
//! CASES=300 FIRST=0 cargo test --release -p voussoir-tests --test stress -- --ignored --nocapture small_paths_of_many
//! ```
//!
//! | claim | of |
//! |---|---|
//! | the load is the program's limit load | associated or no slip |
//! | the load is not above it | all |
//! | `event_path` and `newton_path` have the same status, load and first limit point | all |

use super::rigid::Rigid;
use crate::conic::Extreme;
use std::collections::BTreeMap;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir_tests::family::{Family, Form, Law, family_scene};
use voussoir_tests::{first_case, keep};

/// Relative difference of equal loads.
const SAME_LOAD: f64 = 1e-6;
/// Loads below it are zero: live loads have the size of the weights.
const ZERO_LOAD: f64 = 1e-8;
/// The path solvers.
const SOLVERS: [&str; 2] = ["event_path", "newton_path"];

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= (SAME_LOAD * a.abs().max(b.abs())).max(ZERO_LOAD)
}

/// Returns load and first limit point of a certified answer.
fn loads(result: &CaseResult) -> Option<[f64; 2]> {
    let load = result.load_factor.filter(|_| result.certificate.passed && result.status.is_answer())?;
    Some([load, result.path.first_limit_point.unwrap_or(load)])
}

/// Returns the contradictions of a certified result with the program.
fn against_program(result: &CaseResult, limit: Extreme, exact: bool) -> Option<String> {
    match (limit, loads(result)) {
        (Extreme::Value(limit), Some([load, _])) if load > limit && !same(load, limit) => {
            Some(format!("{load:.10} is above the associated limit {limit:.10}"))
        }
        (Extreme::Value(limit), Some([load, _])) if exact && !same(load, limit) => {
            Some(format!("{load:.10} is not the limit {limit:.10}"))
        }
        (Extreme::Value(_), None) if result.status == Status::Unbounded && result.certificate.passed => {
            Some("unbounded, but the program has a limit".into())
        }
        (Extreme::Unbounded, Some(_)) if exact => Some("the program has no limit".into()),
        (Extreme::Infeasible, Some(_)) => Some("no field is admissible".into()),
        _ => None,
    }
}

/// Counts of many scenes.
#[derive(Debug, Default)]
struct Tally {
    scenes: usize,
    contradictions: Vec<String>,
    unanswered: BTreeMap<String, usize>,
}

/// Checks scene `k` of the families, in turn.
fn tried(k: u64, tally: &mut Tally) {
    let families = [Family::Random, Family::Symmetric, Family::Bricks, Family::Settlements];
    let family = families[(k % 4) as usize];
    let scene = family_scene(family, 1_000 + k / 4).small();
    let exact = matches!(scene.law, Law::Associated | Law::Stuck);
    let texts = SOLVERS.map(|solver| scene.study(Form::Given, &format!("solver = \"{solver}\"")));
    let limit = Rigid::of_case(&first_case(&texts[0]), scene.friction(), 0.0).associated_limit();
    let results = [0, 1].map(|side| solve_case(&first_case(&texts[side])));
    tally.scenes += 1;
    let mut wrong = Vec::new();
    for (solver, result) in SOLVERS.iter().zip(&results) {
        if !result.status.is_answer() || !result.certificate.passed {
            *tally.unanswered.entry(format!("{solver} {:?}", result.status)).or_default() += 1;
            println!("{k} {solver}: {:?} {:?}", result.status, result.notes);
        }
        // A stage before the live load may end the path.
        let live = result.stages.last().is_some_and(|stage| stage.name == "live");
        let against = if live { against_program(result, limit, exact) } else { None };
        wrong.extend(against.map(|what| format!("{solver}: {what}")));
    }
    if limit == Extreme::Unknown {
        *tally.unanswered.entry("program".into()).or_default() += 1;
    }
    if let [Some(event), Some(newton)] = [loads(&results[0]), loads(&results[1])] {
        let differs = !same(event[0], newton[0]) || !same(event[1], newton[1]);
        wrong.extend(differs.then(|| format!("event [load, first] {event:.10?}, Newton {newton:.10?}")));
    }
    let [event, newton] = &results;
    if event.status != newton.status && results.iter().all(|r| r.status.is_answer() && r.certificate.passed) {
        wrong.push(format!("event {:?}, Newton {:?}", event.status, newton.status));
    }
    if wrong.is_empty() {
        return;
    }
    SOLVERS.iter().zip(&texts).for_each(|(solver, text)| keep(&format!("small{k}_{solver}.toml"), text));
    let line = format!("{k} {} ({} {:?}): {}", family.name(), scene.shape, scene.law, wrong.join("; "));
    println!("{line}");
    tally.contradictions.push(line);
}

fn family(range: std::ops::Range<u64>) -> Tally {
    let mut tally = Tally::default();
    range.for_each(|k| tried(k, &mut tally));
    let Tally { scenes, contradictions, unanswered } = &tally;
    println!("{scenes} scenes, {} contradict, not answered: {unanswered:?}", contradictions.len());
    tally
}

/// On a few scenes no path contradicts the linear program.
#[test]
fn small_paths_of_some() {
    let tally = family(0..8);
    assert!(tally.contradictions.is_empty(), "{}", tally.contradictions.join("\n"));
}

/// Many scenes: no path contradicts the linear program. The test prints a table.
#[test]
#[ignore = "minutes; CASES and FIRST choose the scenes"]
fn small_paths_of_many() {
    let number = |key: &str, default: u64| std::env::var(key).ok().and_then(|s| s.parse().ok()).unwrap_or(default);
    let first = number("FIRST", 0);
    let tally = family(first..first + number("CASES", 300));
    assert!(tally.contradictions.is_empty(), "{}", tally.contradictions.join("\n"));
}
