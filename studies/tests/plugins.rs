//! External plug-ins: a solver whose table is refused when the study is loaded, `auto` by cards, writers with options,
//! study kinds that choose values.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::Path;
use voussoir::core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, Status};
use voussoir::core::model::stage_loads;
use voussoir::core::plugin::{Card, Diagnostic, Need, Parameter, PluginKind, Quantity, Range, Shape};
use voussoir::kinds::{KindEntry, LoadedStudy, OwnResults, RunRequest, SceneStudy, StudyKind, read_study};
use voussoir::results::{CaseLabel, CaseResult};
use voussoir::solve::{CaseInput, Observer, solve_case, solve_cases};
use voussoir::solve::{limit_solvers, path_solvers};
use voussoir::study::{Case, Outline, SelectedSolver, Study, StudyError, StudySource, load};

/// A number; the card allows values up to 10, the solver up to 5.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(try_from = "u64")]
struct Effort(u64);

impl TryFrom<u64> for Effort {
    type Error = String;

    fn try_from(effort: u64) -> Result<Self, String> {
        if effort > 5 { Err(format!("an effort of {effort} is beyond it")) } else { Ok(Effort(effort)) }
    }
}

/// A solver whose card allows more than the solver accepts.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Fussy {
    effort: Option<Effort>,
}

#[typetag::serde(name = "fussy_limit")]
impl LimitSolver for Fussy {
    fn solve(&self, _: &LimitProblem, _: LimitQuestion) -> LimitAnswer {
        assert!(self.effort.is_none_or(|effort| effort.0 != 5), "an effort of 5 is too much");
        LimitAnswer::stalled("it never answers")
    }

    fn refuses(&self, _: &LimitProblem) -> Option<String> {
        None
    }
}

const fn number(name: &'static str) -> Parameter {
    let shape = Shape::Integer { min: 0, max: 10 };
    Parameter { name, doc: "work of the search", shape, need: Need::Optional("little") }
}

voussoir::core::inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "fussy_limit",
        summary: "reads less than its card says",
        parameters: &[number("effort"), number("efort_of_old")],
        file: file!(),
        package: voussoir_core::package!(),
        page: "for this test only",
        ..Card::BLANK
    }
}

const ARCH: &str = r#"name = "arch"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 4.0, rise = 1.0 }
thickness = 0.5
width = 1.0
voussoirs = 7
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.25, force = [0.0, -1000.0] }]
"#;

/// The mistakes in the arch with additional text.
fn wrong(more: &str, sets: &[(&str, &str)]) -> Vec<String> {
    let sets: Vec<_> = sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    let Err(wrong) = load(&format!("{ARCH}{more}"), "a.toml", &sets) else { panic!("{more} is accepted") };
    wrong.mistakes().iter().map(ToString::to_string).collect()
}

/// If a plug-in panics, its case ends, and the other cases continue.
#[test]
fn a_panic_ends_one_case() {
    let more = "[solver]\nsolver = \"fussy_limit\"\n[sweep]\n\"solver.effort\" = { list = [5, 1] }\n";
    let study = load(&format!("{ARCH}{more}"), "a.toml", &[]).expect("a study");
    let results: Vec<CaseResult> = study.cases.iter().map(solve_case).collect();
    assert!(results.iter().all(|result| result.status == Status::Stalled));
    let said = |result: &CaseResult| result.notes.iter().any(|note| note.contains("an effort of 5 is too much"));
    assert_eq!([said(&results[0]), said(&results[1])], [true, false], "{:?}", results[0].notes);
}

/// A solver table that its solver cannot read is a mistake with line and key, wherever it is written. It never falls
/// back to `auto`.
#[test]
fn a_solver_table_that_cannot_be_read_is_a_mistake() {
    let lines = ARCH.lines().count();
    let [message] = &wrong("[solver]\nsolver = \"fussy_limit\"\neffort = 7\n", &[])[..] else { panic!("one mistake") };
    let place = format!("a.toml:{}:10: solver.effort: ", lines + 3);
    assert!(message.starts_with(&place) && message.contains("beyond it"), "{message}");
    let text = "[solver]\nsolver = \"fussy_limit\"\nefort_of_old = 2\n";
    let [message] = &wrong(text, &[])[..] else { panic!("one mistake") };
    assert!(message.contains("solver.efort_of_old") && message.contains("unknown field"), "{message}");
    let solver = "[solver]\nsolver = \"fussy_limit\"\n";
    let [message] = &wrong(&format!("{solver}[sweep]\n\"solver.effort\" = {{ list = [1, 7] }}\n"), &[])[..] else {
        panic!("one mistake")
    };
    assert!(message.starts_with("a.toml:") && message.contains("solver.effort = 7"), "{message}");
    let variant = "[[variants]]\nname = \"much\"\nset = { \"solver.effort\" = 9 }\n";
    let [message] = &wrong(&format!("{solver}{variant}"), &[])[..] else { panic!("one mistake") };
    let place = format!("a.toml:{}:27: solver.effort: ", lines + 5);
    assert!(message.starts_with(&place) && message.contains("beyond it"), "{message}");
    let sets = [("solver.solver", "fussy_limit"), ("solver.effort", "6")];
    let [message] = &wrong("", &sets)[..] else { panic!("one mistake") };
    assert!(message.starts_with("--set solver.effort: ") && message.contains("beyond it"), "{message}");
    // Unknown names of solvers, in a sweep and in a variant.
    let sweep = "[sweep]\n\"solver.solver\" = { list = [\"limit_chain\", \"limit_chian\"] }\n";
    assert!(wrong(sweep, &[])[0].contains("did you mean \"limit_chain\"?"));
    let variant = "[[variants]]\nname = \"a\"\nset = { \"solver.effrt\" = 1, \"solver.solver\" = \"fussy_limit\" }\n";
    assert!(wrong(variant, &[])[0].contains("did you mean \"effort\"?"));
    let strategy = "[solver]\nsolver = \"newton_path\"\ncontinuation = { strategy = \"arc_lenght\" }\n";
    assert!(wrong(strategy, &[]).iter().any(|message| message.contains("did you mean \"arc_length\"?")));
}

fn every_study() -> Vec<(String, Study)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut files: Vec<_> = std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("a file").path()).collect();
    files.retain(|path| path.is_file());
    files.sort();
    let texts = files.iter().map(|path| (path, std::fs::read_to_string(path).expect("a text")));
    let scenes = texts.filter(|(_, text)| text.contains("[scene]"));
    let read =
        |path: &Path, text: &str| load(text, "study.toml", &[]).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    scenes.map(|(path, text)| (path.display().to_string(), read(path, &text))).collect()
}

/// `auto` chooses by the cards. It uses paths if something deforms, and the exact path solver if laws have facets,
/// blocks are linear and displacements small. Otherwise it uses limit analysis, with three redundants for chains.
#[test]
fn auto_chooses_what_it_chose_by_name() {
    let (mut paths, mut limits) = (0, 0);
    for (name, study) in every_study() {
        for case in &study.cases {
            let (assembly, settings) = (&case.assembly, &case.solver.settings);
            let input = CaseInput { solver: &SelectedSolver::Auto, ..CaseInput::of(case) };
            let chosen: Vec<String> = path_solvers(&input).into_iter().map(|(tag, _)| tag).collect();
            if assembly.deforms() || settings.finite {
                let facets = |j| assembly.law(j).is_none_or(|law| law.facets().is_some());
                let linear = (0..assembly.bodies.len()).all(|b| assembly.bodies[b].fixed || !assembly.yields(b));
                let exact = !settings.finite && linear && assembly.joints.iter().all(facets);
                assert_eq!(chosen[0], if exact { "event_path" } else { "newton_path" }, "{name}, case {}", case.id);
                assert_eq!(chosen.last().map(String::as_str), Some("newton_path"), "{name}");
                paths += 1;
                continue;
            }
            assert_eq!(chosen, Vec::<String>::new(), "{name}, case {}", case.id);
            for loads in stage_loads(assembly, &case.stages) {
                let problem = LimitProblem::new(assembly, &loads).expect("laws of facets");
                let chosen: Vec<_> = limit_solvers(&SelectedSolver::Auto, &problem).map(|s| s.0).collect();
                let mut expected = vec!["limit_conic"];
                let chain = voussoir::solvers::limit::chain::LimitChain {};
                if chain.refuses(&problem).is_none() {
                    expected.insert(0, "limit_chain");
                }
                if problem.non_associated {
                    expected.insert(0, "limit_least");
                }
                assert_eq!(chosen, expected, "{name}, case {}", case.id);
                limits += 1;
            }
        }
    }
    assert!(paths >= 30 && limits >= 40, "{paths} paths, {limits} stages of limit analysis");
}

/// A solver without a cost is used only if it is named. Defaults of cards are the defaults of the types.
#[test]
fn defaults_of_cards_are_those_of_the_types() {
    let study = Study::from_toml(ARCH).expect("a study");
    let case = &study.cases[0];
    let problem = LimitProblem::new(&case.assembly, &stage_loads(&case.assembly, &case.stages)[1]).expect("a problem");
    let mut open = problem.clone();
    open.non_associated = true;
    let chosen: Vec<_> = limit_solvers(&SelectedSolver::Auto, &open).collect();
    assert!(chosen.iter().all(|(tag, _)| *tag != "fussy_limit" && *tag != "limit_sequential"));
    let least = voussoir::solvers::limit::nonassociated::LimitNonassociated::default();
    assert_eq!(format!("{:?}", chosen[0].1), format!("{least:?}"));
}

/// A study kind that chooses values requests cases by key and value; mistakes name the key.
#[test]
fn a_study_makes_cases_at_other_values() {
    let study =
        Study::from_toml(&format!("{ARCH}[sweep]\n\"scene.thickness\" = {{ list = [0.4, 0.5] }}\n")).expect("a study");
    let case = study.at(1, &[("scene.profile.rise".into(), 1.2.into())]).expect("a case");
    assert_eq!(case.assembly.arch.as_ref().map(|arch| arch.rise), Some(1.2));
    assert_eq!(case.parameters["scene.thickness"], 0.5);
    assert_eq!(case.parameters["scene.profile.rise"], 1.2);
    let same = study.at(1, &[]).expect("a case");
    assert_eq!(same.resolved, study.cases[1].resolved);
    let wrong = study.at(0, &[("scene.profile.rise".into(), (-1.0).into())]).expect_err("no arch");
    assert_eq!(wrong.mistakes()[0].key, "scene.profile.rise");
}

/// An external study kind. It tries another value of one key for each case, and reports which case carries more.
struct Try;

impl Try {
    fn other<'a>(&self, study: &'a Study, label: &CaseLabel) -> Option<Cow<'a, Case>> {
        let (key, value) = (study.outline.table["key"].as_str()?, study.outline.table["value"].as_f64()?);
        let mut case = study.at(label.id % study.cases.len(), &[(key.to_string(), value.into())]).ok()?;
        case.id = label.id;
        Some(Cow::Owned(case))
    }
}

impl StudyKind for Try {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        Ok(Box::new(SceneStudy(Study::from_source(source)?)))
    }

    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        let missing = !outline.table.contains_key("key");
        missing.then(|| Diagnostic::new("kind", "needs a table [try_value]")).into_iter().collect()
    }

    fn solve(&self, study: &Study, wanted: &[usize], _: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        let made = wanted.iter().filter_map(|id| {
            let label = CaseLabel { id: study.cases.len() + id, ..CaseLabel::default() };
            Some(solve_case(&*self.case(study, &label)?))
        });
        solve_cases(study, wanted, 1, observer).into_iter().chain(made).collect()
    }

    fn case<'a>(&self, study: &'a Study, label: &CaseLabel) -> Option<Cow<'a, Case>> {
        match study.cases.get(label.id) {
            Some(case) => Some(Cow::Borrowed(case)),
            None => self.other(study, label),
        }
    }

    fn own_results(&self, _: &Study, cases: &[CaseResult]) -> OwnResults {
        let stronger = cases.iter().max_by(|a, b| a.load_factor.partial_cmp(&b.load_factor).expect("numbers"));
        let mut own = OwnResults::default();
        own.entries.other.insert("strongest".into(), stronger.map(|case| case.label.id).into());
        own
    }
}

voussoir::core::inventory::submit! { KindEntry { tag: "try_value", kind: &Try } }

voussoir::core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "try_value",
        summary: "each case once more with another value of one key",
        parameters: &[
            Parameter { name: "key", doc: "of a number", shape: Shape::Text, need: Need::Required },
            Parameter::number("value", Quantity::Ratio, Range::ANY, "that is tried"),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "for this test only",
        ..Card::BLANK
    }
}

/// Its keys are in the schema, it has cases and results, and these are verified. Mistakes in its table suggest the
/// nearest known name.
#[test]
fn a_study_kind_of_ones_own() {
    let kind = "kind = \"try_value\"\n";
    let with = |table: &str| format!("{kind}{ARCH}[output]\nwriters = [\"results_csv\"]\n[try_value]\n{table}");
    let text = with("key = \"scene.thickness\"\nvalue = 0.4\n");
    let study = read_study(&text, "a.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let output = study.run(&RunRequest { wanted: vec![0], jobs: 1, ..RunRequest::default() }, &Silent);
    assert!(output.certified);
    let (_, bytes) = output.files.iter().find(|(name, _)| name == "results.json").expect("results");
    let results = String::from_utf8(bytes.clone()).expect("text");
    let json: serde_json::Value = serde_json::from_str(&results).expect("JSON");
    assert_eq!((json["cases"].as_array().map(Vec::len), &json["strongest"]), (Some(2), &0.into()));
    assert_eq!(json["cases"][1]["parameters"]["scene.thickness"], 0.4);
    assert_eq!(study.verify(&results).expect("results").findings, vec![]);
    let weaker = study.verify(&results.replace("\"strongest\": 0", "\"strongest\": 1")).expect("results");
    assert!(weaker.findings[0].1.contains("try_value"), "{:?}", weaker.findings);
    let factor = json["cases"][1]["load_factor"].to_string();
    assert_ne!(factor, "null");
    assert!(!study.verify(&results.replace(&factor, "1.0")).expect("results").findings.is_empty());
    assert!(voussoir::kinds::json_schema().to_string().contains("\"try_value\""));
    let wrong = read_study(&with("kee = \"scene.thickness\"\nvalue = 0.4\n"), "a.toml", &[]).err().expect("a mistake");
    assert!(wrong.mistakes().iter().any(|one| one.to_string().contains("did you mean \"key\"?")), "{wrong:?}");
    let wrong = read_study(&format!("{kind}{ARCH}"), "a.toml", &[]).err().expect("a mistake");
    assert!(wrong.mistakes()[0].message.contains("[try_value]"));
}

struct Silent;

impl Observer for Silent {
    fn answered(&self, _: &CaseResult) {}
}

/// `[output] writers` selects the writers, `[output.options]` sets their options; unknown names are mistakes with the
/// nearest known name.
#[test]
fn writers_are_chosen_and_have_options() {
    let run = |more: &str| {
        let study = read_study(&format!("{ARCH}{more}"), "a.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
        study.run(&RunRequest { wanted: vec![0], jobs: 1, ..RunRequest::default() }, &Silent).files
    };
    let names = |more: &str| run(more).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
    assert_eq!(names("[output]\nwriters = [\"results_csv\"]\n"), ["results.csv", "results.json"]);
    assert!(names("").contains(&"report.html".to_string()));
    let report = |more: &str| {
        let files = run(more);
        let (_, bytes) = files.into_iter().find(|(name, _)| name == "report.html").expect("a report");
        String::from_utf8(bytes).expect("text")
    };
    assert!(report("").contains("The scene with its loads"));
    assert!(!report("[output.options.report]\ndrawn = 0\n").contains("The scene with its loads"));
    assert!(wrong("[output]\nwriters = [\"result_csv\"]\n", &[])[0].contains("did you mean \"results_csv\"?"));
    assert!(wrong("[output.options.report]\ndrwan = 1\n", &[])[0].contains("did you mean \"drawn\"?"));
    assert!(wrong("[output.options.reprot]\n", &[])[0].contains("did you mean \"report\"?"));
}

/// Loads and dispersions are plug-ins with cards; mistakes in them suggest the nearest known name.
#[test]
fn mistakes_in_loads_have_the_nearest_right_name() {
    let with = |load: &str| {
        let text = ARCH.replace("{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }", load);
        load_text(&text)
    };
    fn load_text(text: &str) -> Vec<String> {
        load(text, "a.toml", &[])
            .err()
            .map(|wrong| wrong.mistakes().iter().map(ToString::to_string).collect())
            .unwrap_or_default()
    }
    let point = "kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0]";
    assert_eq!(
        with(&format!("{{ {point}, dispersion = {{ law = \"uniform\", angle = 30.0, depth = 0.3 }} }}")),
        Vec::<String>::new()
    );
    let message = with(&format!("{{ {point}, dispersion = {{ law = \"unifrm\", angle = 30.0, depth = 0.3 }} }}"));
    assert!(message[0].contains("did you mean \"uniform\"?"), "{message:?}");
    let message = with(&format!("{{ {point}, dispersion = {{ law = \"uniform\", angel = 30.0, depth = 0.3 }} }}"));
    assert!(message[0].contains("did you mean \"angle\"?"), "{message:?}");
    let message = with("{ kind = \"stripe\", from = 0.1, to = 0.2, pressure = 1.0 }");
    assert!(message[0].contains("did you mean \"strip\"?"), "{message:?}");
    let schema = voussoir::kinds::json_schema();
    let text = schema.to_string();
    for part in ["dispersion_uniform", "\"const\":\"axles\"", "\"drawn\"", "point_study", "\"efort_of_old\""] {
        assert!(text.contains(part), "{part}");
    }
}

/// A card reports `OWN_FILE` exactly if its study kind has separate keys. The keys of study files are made from the cards.
#[test]
fn cards_report_which_kinds_have_separate_keys() {
    use voussoir::core::plugin::{Capability, card};
    for entry in voussoir::kinds::kinds() {
        let offers = card(PluginKind::StudyKind, entry.tag).is_some_and(|card| card.offers(Capability::OWN_FILE));
        assert_eq!(offers, entry.kind.file_keys().is_some(), "{}", entry.tag);
    }
}
