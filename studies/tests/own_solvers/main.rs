//! The solvers of docs/how_to/own_solver.md: the page shows the files that are compiled here, and the solvers agree with
//! the project's own.

mod limit;
mod matrices;
mod path;
mod scenes;

use scenes::{COMPLIANT, arch, scenes};
use serde_json::json;
use std::path::Path;
use voussoir::conformance::{Options, conform};
use voussoir::core::limit::Status;
use voussoir::core::path::{PathObserver, PathProblem, PathSettings, PathSolver, PathState};
use voussoir::core::plugin::{PluginKind, card};
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir::study::load;

/// The result of a study; `solver` is the text after `solver = `.
fn result(text: &str, solver: &str) -> CaseResult {
    let text = format!("{text}[solver]\nsolver = {solver}\n");
    solve_case(&load(&text, "a.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}\n{text}")).cases.remove(0))
}

fn close(a: Option<f64>, b: Option<f64>, tolerance: f64) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= tolerance * b.abs().max(1e-3),
        (a, b) => a.is_none() && b.is_none(),
    }
}

/// Scenes of all statuses: the certificate confirms each answer, and status and factor are those of `limit_conic`.
#[test]
fn a_limit_solver_on_linear_programs_agrees_with_limit_conic() {
    let mut statuses = Vec::new();
    for (name, text) in scenes() {
        let [own, conic] = ["\"clarabel_limit\"", "\"limit_conic\""].map(|solver| result(&text, solver));
        assert!(own.certificate.passed, "{name}: {:?} {:?}", own.certificate, own.notes);
        assert_eq!((own.status, own.solver.as_str()), (conic.status, "clarabel_limit"), "{name}: {:?}", own.notes);
        assert!(
            close(own.load_factor, conic.load_factor, 1e-7),
            "{name}: {:?} {:?}",
            own.load_factor,
            conic.load_factor
        );
        statuses.push(own.status);
    }
    for status in [Status::Stands, Status::Collapse, Status::Unbounded, Status::NoEquilibrium] {
        assert!(statuses.contains(&status), "{status:?}");
    }
    assert!(statuses.len() >= 12);
}

/// Strengths that are not linear are refused, with the reason.
#[test]
fn strengths_that_are_not_linear_are_refused() {
    let crushing = arch(0.5, "compressive_strength = 1e6\n", "until = \"collapse\"\n");
    let teeth = arch(0.5, "", "until = \"collapse\"\n").replace(
        "law = \"mohr_coulomb\"\nfriction = 0.6\n",
        "law = \"strength_envelope\"\ncorners = [[0.0, 0.0], [1e5, 1e5]]\nresidual_friction = 0.6\n",
    );
    for (text, reason) in [(crushing, "a cone"), (teeth, "is not linear")] {
        let refused = result(&text, "\"clarabel_limit\"");
        assert_eq!(refused.status, Status::Stalled, "{refused:?}");
        assert!(refused.notes.iter().any(|note| note.contains(reason)), "{:?}", refused.notes);
    }
}

/// Checks that a solver conforms, and that each dishonest version of it is refused.
fn conforms(kind: PluginKind, tag: &str) {
    let report = conform(card(kind, tag).expect("a card"), &Options::default());
    assert!(report.passed(), "{report}");
}

#[test]
fn the_limit_solver_conforms() {
    conforms(PluginKind::LimitSolver, "clarabel_limit");
}

#[test]
fn the_path_solver_conforms() {
    conforms(PluginKind::PathSolver, "own_newton");
}

/// The states that a path solver passes to its observer.
#[derive(Default)]
struct States(Vec<PathState>);

impl PathObserver for States {
    fn state(&mut self, _: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}

/// On compliant joints, with rigid and elastic blocks, the path solver reaches the state that `newton_path` reaches, and the
/// certificate proves that the arch stands.
#[test]
fn an_own_newton_loop_agrees_with_newton_path() {
    let elastic = |text: String| {
        let stone = "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.3\n";
        text.replace("law = \"rigid\"\n", stone)
    };
    let rigid = |factor: f64| arch(0.5, COMPLIANT, &format!("factor = {factor:?}\n"));
    let scenes = [("small", rigid(2.0)), ("finite", rigid(2.0)), ("small", rigid(8.0)), ("small", elastic(rigid(2.0)))];
    for (kinematics, text) in scenes {
        let keys = |solver: &str| format!("\"{solver}\"\nkinematics = \"{kinematics}\"");
        let own = result(&text, &keys("own_newton"));
        assert_eq!(own.status, Status::Stands, "{:?}", own.notes);
        assert!(own.certificate.passed, "{:?}", own.certificate);
        let case = load(&text, "a.toml", &[]).expect("a study").cases.remove(0);
        let problem = PathProblem::new(&case.assembly, &case.stages).expect("a problem");
        let settings = PathSettings { finite: kinematics == "finite", ..case.solver.settings.clone() };
        let last = |solver: &str| {
            let solver: Box<dyn PathSolver> = serde_json::from_value(json!({ "solver": solver })).expect("a solver");
            let mut states = States::default();
            let answer = solver.trace(&problem, &settings, &mut states);
            assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
            states.0.pop().expect("a state")
        };
        let [own, newton] = ["own_newton", "newton_path"].map(last);
        let size = |values: &[f64]| values.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        let (force, motion) = (newton.force.as_flattened(), newton.motion.as_flattened());
        for (name, a, b, size) in [
            ("forces", own.force.as_flattened(), force, size(force)),
            // Gaps of closed points are rounding errors of motions.
            ("gaps", own.gap.as_flattened(), newton.gap.as_flattened(), size(motion)),
            ("motions", own.motion.as_flattened(), motion, size(motion)),
            ("stored energy", &[own.stored], &[newton.stored], newton.stored),
        ] {
            let error = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size;
            assert!(error <= 1e-8, "{kinematics}: {name} {error:e}");
        }
    }
}

/// Wrong keys of the solvers are mistakes, and a search for collapse is refused by load control.
#[test]
fn wrong_input_is_refused() {
    let text = arch(0.5, COMPLIANT, "until = \"collapse\"\n");
    let wrong = |solver: &str| load(&format!("{text}[solver]\nsolver = {solver}\n"), "a.toml", &[]).map(|_| ());
    assert!(wrong("\"own_newton\"\nstep = 3").expect_err("a mistake").to_string().contains("did you mean \"steps\"?"));
    assert!(wrong("\"own_newton\"\nsteps = 0").is_err() && wrong("\"own_newton\"\nsteps = 3").is_ok());
    let refused = result(&text, "\"own_newton\"");
    assert!(refused.status == Status::Stalled && refused.notes.iter().any(|note| note.contains("needs a target")));
}

/// The page shows the files; `UPDATE_EXPECTED=1` copies them there.
#[test]
fn the_page_shows_the_solvers_that_are_compiled() {
    let python = include_str!("../../python/examples/highs_limit.py");
    let (_, code) = python.split_once("\n\n").expect("a comment and the code");
    let (class, _) = code.split_once("\n\n\nif __name__").expect("a class and its use");
    let shown =
        [("rust", include_str!("limit.rs")), ("python", &format!("{class}\n")), ("rust", include_str!("path.rs"))];
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/how_to/own_solver.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let (mut rest, mut wanted) = (page.as_str(), String::new());
    for (language, file) in shown {
        let fence = format!("```{language}\n");
        let (before, after) = rest.split_once(&fence).expect("a block of code");
        wanted += &format!("{before}{fence}{file}");
        rest = &after[after.find("```").expect("its end")..];
    }
    wanted += rest;
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, wanted).expect("written");
    } else {
        assert_eq!(page, wanted, "UPDATE_EXPECTED=1 copies the files to the page");
    }
}

/// The formulas of the solvers stay short: 40 lines for programs, 150 for a path with its iteration.
#[test]
fn the_solvers_are_short() {
    let code = |text: &str, from: &str| {
        let (_, text) = text.split_once(from).expect("its start");
        let (text, _) = text.split_once("inventory::submit!").unwrap_or((text, ""));
        text.lines().filter(|line| !line.trim().is_empty() && !line.trim().starts_with("//")).count()
    };
    let python = include_str!("../../python/examples/highs_limit.py");
    let (python, _) = python.split_once("if __name__").expect("its end");
    assert!(code(include_str!("limit.rs"), "fn solved") <= 40);
    assert!(code(python, "class Highs") <= 40);
    assert!(code(include_str!("path.rs"), "//!") <= 150);
}
