//! Numerical stability: scenes at the ends of what numbers can be, by every solver that takes them. An answer is certified and
//! right, or refused with a reason; it is never wrong, never a crash, and never late.

mod scenes;

use self::scenes::{Extreme, Known, all};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir_tests::gates::above_gates;
use voussoir_tests::{first_case, keep};

/// Processor time that an answer may take \[s\].
const LATE: f64 = 60.0;

/// What an answer came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    Right,
    /// Not proven, with a reason, or refused as input.
    Refused,
    /// Proven and not true, or refused without a reason.
    Wrong,
    Crash,
    Late,
}

/// The answer of a scene by a solver, in a thread of its own: verdict, what was said.
fn tried(extreme: &Extreme, solver: &'static str) -> (Verdict, String) {
    let (text, known) = (extreme.text.replace("SOLVER", solver), extreme.known);
    let (send, answer) = mpsc::channel();
    thread::spawn(move || {
        let judged = catch_unwind(AssertUnwindSafe(|| judged(&text, known)));
        let _ = send.send(judged.unwrap_or_else(|panic| {
            let said = panic.downcast_ref::<String>().map(String::as_str);
            (Verdict::Crash, said.or(panic.downcast_ref::<&str>().copied()).unwrap_or("a panic").to_string())
        }));
    });
    // On a machine that does other things too.
    answer.recv_timeout(Duration::from_secs_f64(5.0 * LATE)).unwrap_or((Verdict::Late, "no answer".into()))
}

fn judged(text: &str, known: Known) -> (Verdict, String) {
    let study = match voussoir::study::load(text, "extreme.toml", &[]) {
        Ok(study) => study,
        Err(wrong) => return (Verdict::Refused, format!("as input: {wrong}")),
    };
    let Some(case) = study.cases.first() else { return (Verdict::Wrong, "no case".into()) };
    let begin = processor_time();
    let result = solve_case(case);
    let taken = processor_time() - begin;
    let said = format!(
        "{:?} {:?} {:?} {:?} in {taken:.2} s",
        result.status, result.load_factor, result.certificate.failures, result.notes
    );
    let verdict = if taken > LATE { Verdict::Late } else { verdict(&result, known) };
    (verdict, said)
}

/// Processor time of this thread \[s\], where the system tells it.
fn processor_time() -> f64 {
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    said.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) * 1e-9
}

fn verdict(result: &CaseResult, known: Known) -> Verdict {
    if result.status == Status::Stalled || !result.certificate.passed {
        let reason = !result.notes.is_empty() || !result.certificate.failures.is_empty();
        return if reason && !result.certificate.passed { Verdict::Refused } else { Verdict::Wrong };
    }
    // Bounds may differ by the rounding of enormous strengths, as the certificate says.
    if !above_gates(result, 1e-9, f64::INFINITY).is_empty() {
        return Verdict::Wrong;
    }
    let right = match (known, result.load_factor) {
        (Known::Factor(expected, within), Some(factor)) => {
            let ends = matches!(result.status, Status::Collapse | Status::LimitPoint);
            ends && (factor - expected).abs() <= within * expected.abs()
        }
        (Known::Factor(..), None) => false,
        (Known::Ends(status), _) => result.status == status,
        (Known::Edge(ends, least), Some(factor)) => {
            ends.contains(&result.status) || (result.status == Status::Collapse && factor >= least - 1e-9)
        }
        (Known::Edge(ends, _), None) => ends.contains(&result.status),
    };
    if right { Verdict::Right } else { Verdict::Wrong }
}

/// A scene of ordinary numbers, solved by whatever takes it.
fn ordinary(text: &str) -> f64 {
    let result = solve_case(&first_case(&text.replace("SOLVER", "auto")));
    assert!(result.certificate.passed, "{:?}\n{text}", result.notes);
    result.load_factor.expect("scenes of ordinary numbers collapse")
}

/// Tries the scenes that `wanted` takes; prints each that was not answered, and how often each family ended how.
fn try_all(wanted: impl Fn(&Extreme, &str) -> bool) -> BTreeMap<Verdict, usize> {
    let only = std::env::var("ONLY").unwrap_or_default();
    let mut table: BTreeMap<(&str, &str), BTreeMap<Verdict, usize>> = BTreeMap::new();
    let mut counts = BTreeMap::new();
    for extreme in all(ordinary) {
        for &solver in extreme.solvers {
            let name = format!("{}, {}", extreme.family, extreme.name);
            if !wanted(&extreme, solver) || !name.contains(&only) {
                continue;
            }
            let (verdict, said) = tried(&extreme, solver);
            if verdict != Verdict::Right || std::env::var_os("SHOW").is_some() {
                println!("{verdict:?}: {name}, {solver}: {said}; {:?}", extreme.known);
            }
            if verdict != Verdict::Right {
                let file = format!("{name}, {solver}.toml").replace(['/', ' '], "_");
                keep(&file, &extreme.text.replace("SOLVER", solver));
            }
            *table.entry((extreme.family, solver)).or_default().entry(verdict).or_default() += 1;
            *counts.entry(verdict).or_default() += 1;
        }
    }
    table.iter().for_each(|(cell, counts)| println!("{cell:?}: {counts:?}"));
    counts
}

fn none_is_wrong(counts: &BTreeMap<Verdict, usize>) {
    let count = |verdict| counts.get(&verdict).copied().unwrap_or(0);
    assert_eq!([Verdict::Wrong, Verdict::Crash, Verdict::Late].map(count), [0, 0, 0], "{counts:?}");
}

/// All families by limit analysis but those that take long.
#[test]
fn extreme_scenes_are_answered_or_refused_by_limit_analysis() {
    let counts = try_all(|extreme, solver| {
        !extreme.name.contains("slivers") && extreme.family != "stiffness" && solver != "newton_path"
    });
    none_is_wrong(&counts);
    assert!(counts.get(&Verdict::Right).is_some_and(|&right| right > 100), "{counts:?}");
}

/// All families by all solvers. `ONLY=ring` takes some of them, `SHOW=1` prints all, `KEEP=folder` writes the studies of
/// those that were not answered.
#[test]
#[ignore = "minutes; what came out stands in docs/notebook/random_scenes.md"]
fn extreme_scenes_are_answered_or_refused_by_all_solvers() {
    none_is_wrong(&try_all(|_, _| true));
}
