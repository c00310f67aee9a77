//! Every lie in every scene: `run` makes no false statement.

use super::plug_ins::told;
use std::sync::{Mutex, Once};
use voussoir::conformance::lies::{KnownScene, Lie, reference, scenes};
use voussoir::core::limit::Status;
use voussoir::core::plugin::PluginKind;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir_tests::answered;
use voussoir_tests::family::{Family, Form, family_scene};

/// Silences the panics of dishonest solvers.
pub fn quiet() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let said = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            let words = panic.payload().downcast_ref::<&str>().copied().unwrap_or_default();
            if !words.starts_with("a dishonest") {
                said(panic);
            }
        }));
    });
}

/// Returns the keys of `[solver]` for a dishonest plug-in.
pub fn liar(kind: PluginKind, of: &str, lie: &str) -> String {
    let liar = format!("of = \"{of}\"\nlie = \"{lie}\"");
    match kind {
        PluginKind::LimitSolver => format!("solver = \"lying_limit\"\n{liar}"),
        PluginKind::PathSolver => format!("solver = \"lying_path\"\n{liar}"),
        _ => format!(
            "solver = \"newton_path\"\ncontinuation = {{ strategy = \"lying_strategy\", of = \"{of}\", lie = \"{lie}\" }}"
        ),
    }
}

/// Lies that are still accepted.
const BELIEVED: &[&str] = &[];

/// Returns the result of a scene with a dishonest plug-in, and the false statements in it. `None` if the solver refuses
/// the scene.
fn told_in(
    scene: &KnownScene,
    kind: PluginKind,
    of: &str,
    lie: &str,
    known: Option<&CaseResult>,
) -> Option<(CaseResult, Vec<String>)> {
    let case = scene.case(&liar(kind, of, lie)).ok()?;
    let result = solve_case(&case);
    let wrong = scene.truth.contradictions(&result, known);
    Some((result, wrong))
}

/// Returns the accepted lies of a kind, made from each of these honest plug-ins.
fn believed(kind: PluginKind, honest: &[&str]) -> Vec<String> {
    quiet();
    let mut believed = Vec::new();
    let print = std::env::var_os("LIES").is_some();
    for scene in scenes(kind) {
        let known = reference(scene);
        for of in honest {
            for lie in Lie::of(kind) {
                let lie = lie.name();
                let before = told(kind, lie);
                let Some((result, wrong)) = told_in(scene, kind, of, lie, known.as_ref()) else { continue };
                let applies = kind == PluginKind::Continuation || told(kind, lie) > before;
                if print && applies {
                    println!(
                        "{} | {of} | {lie} | {:?} {:?} | passed {} | {}",
                        scene.name,
                        result.status,
                        result.load_factor,
                        result.certificate.passed,
                        wrong.join("; ")
                    );
                }
                if !wrong.is_empty() && !BELIEVED.contains(&lie) {
                    believed.push(format!("{} by {of}, {lie}: {}", scene.name, wrong.join("; ")));
                }
            }
        }
    }
    believed
}

/// Asserts that each lie applies to some scene.
fn each_is_told(kind: PluginKind) {
    let never: Vec<_> = Lie::of(kind).iter().map(Lie::name).filter(|lie| told(kind, lie) == 0).collect();
    assert!(never.is_empty(), "never told: {never:?}");
}

#[test]
fn no_lie_of_a_limit_solver_is_believed() {
    let believed = believed(PluginKind::LimitSolver, &["limit_chain", "limit_conic", "limit_least"]);
    assert!(believed.is_empty(), "{} are believed:\n{}", believed.len(), believed.join("\n"));
    each_is_told(PluginKind::LimitSolver);
}

/// Held by tests that count the lies of path solvers.
static COUNTED: Mutex<()> = Mutex::new(());

#[test]
fn no_lie_of_a_path_solver_is_believed() {
    let _counted = COUNTED.lock();
    let believed = believed(PluginKind::PathSolver, &["event_path", "newton_path"]);
    assert!(believed.is_empty(), "{} are believed:\n{}", believed.len(), believed.join("\n"));
    each_is_told(PluginKind::PathSolver);
}

#[test]
fn no_lie_of_a_strategy_is_believed() {
    let believed = believed(PluginKind::Continuation, &["arc_length"]);
    assert!(believed.is_empty(), "{} are believed:\n{}", believed.len(), believed.join("\n"));
}

/// A path that returns from its proved limit point along the same curve is not a collapse, although the load has fallen
/// to half.
#[test]
fn unloading_is_no_fall() {
    let _counted = COUNTED.lock();
    let lie = "unloads_behind_its_limit_point";
    let mut told_of = 0;
    for scene in scenes(PluginKind::PathSolver) {
        let before = told(PluginKind::PathSolver, lie);
        let Some((result, _)) = told_in(scene, PluginKind::PathSolver, "newton_path", lie, None) else { continue };
        if told(PluginKind::PathSolver, lie) > before {
            told_of += 1;
            assert_ne!(result.status, Status::Collapse, "{}: {:?}", scene.name, result.notes);
        }
    }
    assert!(told_of > 0);
}

/// An elastic structure whose load moves back at a limit point at which a joint opens does not unload: its end is proved. The
/// way back from there is still refused.
#[test]
fn an_elastic_snap_back_is_proved_and_its_way_back_is_refused() {
    let _counted = COUNTED.lock();
    let lie = "unloads_behind_its_limit_point";
    for seed in [12001, 12012, 12034] {
        let scene = family_scene(Family::Finite, seed);
        let honest = answered(&scene.study(Form::Given, ""));
        assert_eq!((honest.status, honest.path.end_is_checked), (Status::Collapse, Some(true)), "{:?}", honest.notes);
        let before = told(PluginKind::PathSolver, lie);
        let result = answered(&scene.study(Form::Given, &liar(PluginKind::PathSolver, "newton_path", lie)));
        assert!(told(PluginKind::PathSolver, lie) > before, "{seed}");
        assert_ne!(result.status, Status::Collapse, "{seed}: {:?}", result.notes);
    }
}

/// An honest solver from another project is accepted if its states and witnesses prove the end.
#[test]
fn the_truth_of_a_stranger_is_proved() {
    let kind = PluginKind::PathSolver;
    let (mut proved, mut all) = (0, 0);
    for scene in scenes(kind) {
        for of in ["event_path", "newton_path"] {
            let Ok(case) = scene.case(&voussoir::conformance::lies::solver_keys(kind, of)) else { continue };
            let honest = solve_case(&case);
            let Some((stranger, _)) = told_in(scene, kind, of, "no lie", reference(scene).as_ref()) else { continue };
            all += 1;
            if honest.path.end_is_checked == Some(true) {
                proved += 1;
                assert_eq!(
                    (stranger.status, stranger.load_factor),
                    (honest.status, honest.load_factor),
                    "{}",
                    scene.name
                );
                assert_eq!(stranger.path.first_limit_point, honest.path.first_limit_point, "{}", scene.name);
                assert!(stranger.certificate.passed && stranger.path.end_is_checked == Some(true), "{}", scene.name);
            }
        }
    }
    assert!(3 * proved >= 2 * all, "{proved} of {all}");
}

/// Honest plug-ins contradict no known answer, and they give answers.
#[test]
fn honest_answers_are_true() {
    for (kind, tags) in [
        (PluginKind::LimitSolver, &["limit_chain", "limit_conic", "limit_least"][..]),
        (PluginKind::PathSolver, &["event_path", "newton_path"]),
        (PluginKind::Continuation, &["arc_length", "displacement_control"]),
    ] {
        for scene in scenes(kind) {
            for tag in tags {
                let keys = voussoir::conformance::lies::solver_keys(kind, tag);
                let Ok(case) = scene.case(&keys) else {
                    println!("{} {tag}: refused", scene.name);
                    continue;
                };
                let result = solve_case(&case);
                println!(
                    "{} {tag}: {:?} {:?} {:?} {:?} {:?} {} {:?}",
                    scene.name,
                    result.status,
                    result.load_factor,
                    result.bounds,
                    result.feasible_interval,
                    result.mechanism.as_ref().map(|m| m.kind),
                    result.seconds,
                    result.notes
                );
                let wrong = scene.truth.contradictions(&result, reference(scene).as_ref());
                assert!(wrong.is_empty(), "{} {tag}: {}", scene.name, wrong.join("; "));
            }
        }
    }
}
