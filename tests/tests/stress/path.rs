//! Random elastic scenes: exact path, Newton path and limit analysis against each other.

use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::cell::RefCell;
use std::collections::BTreeMap;
use voussoir::core::certificate::MechanismKind;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir_tests::random::{History, Law, RandomScene, numbers, scene};
use voussoir_tests::{answered, changed, keep};

/// The results of a solver over all scenes.
#[derive(Default)]
struct Tally {
    scenes: usize,
    walls: usize,
    sliding: usize,
    histories: usize,
    slippery: usize,
    events: Vec<usize>,
    statuses: BTreeMap<String, usize>,
    below: usize,
    branches: usize,
    unnamed: Vec<String>,
    sure_stalls: usize,
    wrong: Vec<String>,
    unsolved: BTreeMap<&'static str, Vec<String>>,
}

impl Tally {
    fn stalls(&self, solver: &str) -> usize {
        self.unsolved.get(solver).map_or(0, Vec::len)
    }
}

fn shown(result: &CaseResult) -> String {
    format!("{:?} {:?} {:?} {:?}", result.status, result.load_factor, result.notes, result.certificate.failures)
}

/// Checks the path of one solver against the associated limit load.
fn check(scene: &RandomScene, solver: &'static str, path: &CaseResult, limit: &CaseResult, tally: &mut Tally) -> bool {
    let number = tally.scenes;
    let mut wrong = Vec::new();
    *tally.statuses.entry(format!("{solver} {:?}", path.status)).or_default() += 1;
    if path.status == Status::Stalled {
        tally.sure_stalls += usize::from(solver == "newton_path" && scene.law.is_monotone());
        // Exact paths with strengths are counted separately.
        let solver =
            if scene.law == Law::Strengths && solver == "event_path" { "event_path, strengths" } else { solver };
        tally.unsolved.entry(solver).or_default().push(format!("{number} {:?}: {:?}", scene.law, path.notes));
        assert!(!path.notes.is_empty(), "a stall without a reason");
        return false;
    }
    if !path.certificate.passed {
        wrong.push("not certified".to_string());
    }
    if scene.law.is_sure() && path.status != limit.status {
        wrong.push(format!("limit analysis: {:?}", limit.status));
    }
    if let (Some(a), Some(b)) = (path.load_factor, limit.load_factor)
        && scene.law != Law::Strengths
    {
        let scale = b.abs().max(1e-6);
        if a > b + 1e-8 * scale || (scene.law.is_sure() && (a - b).abs() > 1e-8 * scale) {
            wrong.push(format!("associated limit {b:.12}"));
        }
        tally.below += usize::from(a < 0.999 * b);
    }
    let fine = wrong.is_empty();
    tally.wrong.extend(wrong.into_iter().map(|w| format!("{number} {:?} {solver}: {w}: {}", scene.law, shown(path))));
    fine
}

fn tried(scene: &RandomScene, tally: &mut Tally) {
    let limit = answered(&scene.associated());
    tally.scenes += 1;
    let number = tally.scenes;
    let only = std::env::var("ONLY").ok().and_then(|n| n.parse::<usize>().ok());
    if only.is_some_and(|only| only != number) {
        return;
    }
    if !limit.certificate.passed {
        tally.unsolved.entry("limit_conic").or_default().push(format!("{number}: {:?}", limit.notes));
    }
    let known = if limit.status == Status::Collapse { limit.load_factor } else { None };
    let mut results = Vec::new();
    for solver in ["event_path", "newton_path"] {
        let text = scene.study(solver, known);
        keep(&format!("{number}_{solver}.toml"), &text);
        results.push(answered(&text));
    }
    let [event, newton] = &results[..] else { return };
    if std::env::var("SHOW").is_ok() {
        eprintln!(
            "{number} {:?} wall {} {:?} limit {:?} {:?}",
            scene.law, scene.is_wall, scene.history, limit.status, limit.load_factor
        );
        for result in &results {
            eprintln!(
                "    {} {} events {} steps {:?} iterations {:?} pivots {:?} {:.2} s",
                result.solver,
                shown(result),
                result.path.events.len(),
                result.counters.get("steps"),
                result.counters.get("newton_iterations"),
                result.counters.get("pivots"),
                result.seconds
            );
        }
    }
    tally.walls += usize::from(scene.is_wall);
    tally.histories += usize::from(scene.history != History::None && known.is_some());
    tally.slippery += usize::from(!scene.law.is_monotone());
    tally.events.push(event.path.events.len());
    if let Some(mechanism) = &event.mechanism {
        tally.sliding += usize::from(!mechanism.sliding.is_empty() || mechanism.kind == MechanismKind::Sliding);
    }
    let fine = [check(scene, "event_path", event, &limit, tally), check(scene, "newton_path", newton, &limit, tally)];
    if fine != [true, true] {
        return;
    }
    let apart = match (event.load_factor, newton.load_factor) {
        (Some(a), Some(b)) => (a - b).abs() > 1e-8 * a.abs().max(1e-6),
        _ => event.status != newton.status,
    };
    if apart && scene.law.is_monotone() {
        tally.wrong.push(format!("{number} {:?}: event {}, Newton {}", scene.law, shown(event), shown(newton)));
    }
    if apart && !scene.law.is_monotone() {
        tally.branches += 1;
        let named =
            |r: &CaseResult| r.notes.iter().any(|n| n.contains("solutions") || n.contains("proved that no rate"));
        if !named(event) && !named(newton) && !tends(scene, event, newton) {
            tally.unnamed.push(format!("{number} {:?}: event {}, Newton {}", scene.law, shown(event), shown(newton)));
        }
    }
}

/// Returns true if much smaller steps bring Newton's end load much closer to the load of the exact path.
fn tends(scene: &RandomScene, event: &CaseResult, newton: &CaseResult) -> bool {
    let (Some(exact), Some(coarse), Some(displacements)) =
        (event.load_factor, newton.load_factor, event.path.displacements.as_ref())
    else {
        return false;
    };
    let moved = displacements.iter().flat_map(|d| &d.displacement[..2]).fold(0.0, |a: f64, u| a.max(u.abs()));
    let step = moved / 4.0 / 200.0;
    let fine = format!(
        "newton_path\"\ncontinuation = {{ strategy = \"arc_length\", first_step = 0.01, largest_step = {step:?} }}\n#\""
    );
    let fine = answered(&changed(&scene.study("newton_path", Some(coarse)), "newton_path\"", &fine));
    if std::env::var("SHOW").is_ok() {
        eprintln!("    fine steps: {} steps {:?}", shown(&fine), fine.counters.get("steps"));
    }
    fine.load_factor.is_some_and(|fine| (fine - exact).abs() <= 0.5 * (coarse - exact).abs())
}

/// Random walls, rings and arches, some with settlements or unloading before the load grows; μ from 0.05 to 2,
/// stiffnesses of blocks different by up to 1e6. Without slip or with associated flow event path, Newton path and limit
/// analysis agree to 1e-8, and no Newton path stalls. Otherwise both paths are certified and not above the associated
/// load, or stop with a reason (in less than a tenth of the scenes). SCENES sets the number of scenes (24 by default),
/// SHOW prints each, KEEP stores their studies, ONLY selects one. Two exact paths may end at different branches, which
/// their notes name.
#[test]
fn paths_end_where_limit_analysis_does() {
    let cases = std::env::var("SCENES").ok().and_then(|n| n.parse().ok()).unwrap_or(24);
    let mut runner = TestRunner::new_with_rng(
        Config { cases, failure_persistence: None, max_shrink_iters: 0, ..Config::default() },
        TestRng::deterministic_rng(RngAlgorithm::ChaCha),
    );
    let tally = RefCell::new(Tally::default());
    runner
        .run(&numbers(), |numbers| {
            if let Some(scene) = scene(numbers) {
                tried(&scene, &mut tally.borrow_mut());
            }
            Ok(())
        })
        .unwrap();
    let mut tally = tally.into_inner();
    tally.events.sort_unstable();
    let median = tally.events[tally.events.len() / 2];
    eprintln!(
        "{} scenes, {} walls, {} with sliding, {} with a history, {} not associated, median {median} events, {:?}, {} below 0.999 of the associated load, {} on different branches",
        tally.scenes,
        tally.walls,
        tally.sliding,
        tally.histories,
        tally.slippery,
        tally.statuses,
        tally.below,
        tally.branches
    );
    assert!(tally.unnamed.is_empty(), "end loads apart, not explained:\n{}", tally.unnamed.join("\n"));
    for (solver, reasons) in &tally.unsolved {
        eprintln!("{solver}: {} unsolved\n{}", reasons.len(), reasons.join("\n"));
    }
    assert!(tally.wrong.is_empty(), "{}\n{}", tally.wrong.len(), tally.wrong.join("\n"));
    // Without friction or with associated flow every Newton path is solved.
    assert!(tally.sure_stalls == 0, "{} Newton paths of monotone problems stalled", tally.sure_stalls);
    for (solver, most) in [("event_path", 10), ("newton_path", 25)] {
        assert!(most * tally.stalls(solver) <= tally.scenes, "{solver}: {} stalls", tally.stalls(solver));
    }
    if tally.scenes >= 60 {
        assert!(median >= 20 && 3 * tally.walls >= tally.scenes && 3 * tally.sliding >= tally.scenes);
    }
}
