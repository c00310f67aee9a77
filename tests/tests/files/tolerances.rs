//! Results of another processor: for each tolerance a change just inside, which makes the same claim, and one just
//! outside, which is found.

use super::forgery::path;
use serde_json::{Value, json};
use std::path::Path;
use voussoir::kinds::kind;
use voussoir::solve_case;
use voussoir::study::Study;
use voussoir::verify::Agreement;
use voussoir::verify::tolerances::{
    CURVE, DERIVATIVE, ESTIMATE, FACTOR, GEOMETRY, PEAK, RATE, Route, SEARCHED, STATE, Tolerance, tolerance_table,
};
use voussoir_tests::written::{findings, results};
use voussoir_tests::{Arch, changed, crushing, friction};

/// Returns the same results as if another kind of processor had written them.
pub fn of_another_processor(results: &Value) -> Value {
    let mut foreign = results.clone();
    foreign["processor_features"] = json!(["none"]);
    foreign
}

/// Changes the number at `at` by shares of `scale` inside and outside a tolerance.
fn inside_and_outside(name: &str, text: &str, at: &str, own: (&Tolerance, Route, f64)) {
    let (tolerance, route, scale) = own;
    let (study, original) = results(text);
    let original = of_another_processor(&original);
    assert_eq!(findings(&study, &original), Vec::<String>::new(), "{name}: untouched");
    let at = format!("/cases/0{at}");
    for (share, is_found) in [(0.8, false), (-0.8, false), (1.5, true), (-1.5, true)] {
        let mut forged = original.clone();
        let slot = forged.pointer_mut(&at).unwrap_or_else(|| panic!("{name}: {at}"));
        let x = slot.as_f64().unwrap_or_else(|| panic!("{name}: {at} is {slot}"));
        *slot = json!(x + share * tolerance.of(route) * scale);
        let found = findings(&study, &forged);
        assert_eq!(!found.is_empty(), is_found, "{name}: {at} changed by {share} tolerances: {found:?}");
    }
}

/// Returns the greatest number of a list of numbers, or of a key in a list of entries.
fn greatest(list: &Value, key: &str) -> f64 {
    match list {
        Value::Array(items) => {
            items.iter().map(|item| greatest(if key.is_empty() { item } else { &item[key] }, "")).fold(0.0, f64::max)
        }
        other => other.as_f64().map_or(0.0, f64::abs),
    }
}

#[test]
fn paths_by_steps() {
    let text = changed(&path("newton_path", "finite", false), "curve = true", "curve = true\nstates = 4");
    let (_, original) = results(&text);
    let case = &original["cases"][0];
    let steps = |tolerance, scale: f64| (tolerance, Route::Steps, scale);
    let curve = case["curve"].as_array().expect("a curve");
    let range = |axis: usize| {
        let numbers = || curve.iter().map(|point| point[axis].as_f64().expect("a number"));
        numbers().fold(f64::MIN, f64::max) - numbers().fold(f64::MAX, f64::min)
    };
    let checks: Vec<(String, (&Tolerance, Route, f64))> = vec![
        ("/events/2/factor".into(), steps(&FACTOR, greatest(&case["events"], "factor"))),
        ("/states/1/displacement".into(), steps(&STATE, greatest(&case["states"], "displacement"))),
        ("/mechanism/hinges/0/rotation".into(), steps(&RATE, greatest(&case["mechanism"]["hinges"], "rotation"))),
        ("/limit_points/0/displacement".into(), steps(&PEAK, greatest(&case["limit_points"], "displacement"))),
        ("/limit_points/0/fall".into(), steps(&PEAK, greatest(&case["limit_points"], "fall"))),
        // The last vertex must not leave the end of the other curve.
        (format!("/curve/{}/1", curve.len() - 1), steps(&CURVE, range(1))),
    ];
    for (at, own) in checks {
        inside_and_outside("steps", &text, &at, own);
    }
}

#[test]
fn paths_from_event_to_event() {
    let text = changed(&path("event_path", "small", false), "curve = true", "curve = true\naccuracy = \"estimate\"");
    let (_, original) = results(&text);
    let case = &original["cases"][0];
    let factor = case["load_factor"].as_f64().expect("a factor");
    let events = |tolerance, scale: f64| (tolerance, Route::Events, scale);
    inside_and_outside("events", &text, "/events/2/factor", events(&FACTOR, greatest(&case["events"], "factor")));
    inside_and_outside("events", &text, "/load_factor_error/discretisation", events(&ESTIMATE, factor));
    let hinges = &case["mechanism"]["hinges"];
    inside_and_outside("events", &text, "/mechanism/hinges/0/rotation", events(&RATE, greatest(hinges, "rotation")));
}

#[test]
fn limit_analysis() {
    let differentiated = format!(
        "{}[output]\nsensitivities = true\n",
        Arch { joint: crushing(0.6, 10e6), voussoirs: 9, ..Arch::default() }.study()
    );
    let (_, original) = results(&differentiated);
    let derivatives = original["cases"][0]["sensitivities"].as_array().expect("derivatives");
    let index =
        derivatives.iter().position(|own| own["left"].as_f64().is_some_and(|x| x.abs() > 1e-3)).expect("a derivative");
    let slope = derivatives[index]["left"].as_f64().expect("a number").abs();
    let limit = |tolerance, scale: f64| (tolerance, Route::Limit, scale);
    inside_and_outside("limit", &differentiated, &format!("/sensitivities/{index}/left"), limit(&DERIVATIVE, slope));
    let dry = Arch { joint: friction(0.6), ..Arch::default() }.study();
    let (_, original) = results(&dry);
    let bounds = &original["cases"][0]["bounds"];
    inside_and_outside("limit", &dry, "/bounds/1", limit(&FACTOR, greatest(bounds, "")));
}

#[test]
fn loads_of_a_bridge() {
    let (_, original) = results(super::forgery::BRIDGE);
    let points = original["cases"][0]["loads"]
        .as_array()
        .expect("loads")
        .iter()
        .map(|load| load["point"][0].as_f64().expect("a number"));
    // Numbers of one key have one scale in the second run, and one scale for each axis in the loads of the study.
    let scale = points.fold(0.0, |most: f64, x| most.max(x.abs()));
    inside_and_outside("bridge", super::forgery::BRIDGE, "/loads/3/point/0", (&GEOMETRY, Route::Limit, scale));
}

/// Values of a search on another processor differ by rounding and are solved again; other values are found.
#[test]
fn values_that_a_search_has_chosen() {
    let (study, original): (Study, Value) = results(&super::forgery::optimum());
    let kind = kind(&study.kind).expect("a kind");
    let cases: Vec<voussoir::CaseResult> = serde_json::from_value(original["cases"].clone()).expect("cases");
    let made = cases.iter().position(|case| case.label.id >= study.cases.len()).expect("a case that the search made");
    for (share, is_found) in [(0.8, false), (1.5, true)] {
        let mut moved = cases.clone();
        let label = &mut moved[made].label;
        for value in label.parameters.values_mut() {
            *value = json!(value.as_f64().expect("a number") * (1.0 + share * SEARCHED.of(Route::Limit)));
        }
        let case = kind.case(&study, &moved[made].label).expect("the case");
        moved[made] = solve_case(&case);
        let results = serde_json::to_value(study.results("test", moved)).expect("JSON");
        let found = findings(&study, &of_another_processor(&results));
        assert_eq!(!found.is_empty(), is_found, "{share}: {found:?}");
    }
}

/// The page shows the table of tolerances of the program.
#[test]
fn the_page_states_every_tolerance() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/theory/verifying.md");
    let page = std::fs::read_to_string(page).expect("docs/theory/verifying.md");
    assert!(
        page.contains(&tolerance_table()),
        "docs/theory/verifying.md has another table than\n{}",
        tolerance_table()
    );
}

/// Results of this program on this processor are compared bit by bit; a head that names another program does not avoid
/// the check of the hashes of cases.
#[test]
fn the_head_decides_how_results_are_compared() {
    let (study, original) = results(&Arch::default().study());
    let agreement = |results: &Value| Agreement::of_head(results.as_object().expect("a map"), &study.resolved);
    assert_eq!(agreement(&original), Agreement::Bits);
    assert_eq!(agreement(&of_another_processor(&original)), Agreement::Processor);
    for key in ["commit", "sources"] {
        let mut foreign = original.clone();
        foreign[key] = json!("0000");
        assert_eq!(agreement(&foreign), Agreement::Program, "{key}");
        assert!(findings(&study, &foreign).iter().any(|why| why.contains("case_hash")), "{key}");
    }
    let mut later = original.clone();
    later["format"] = json!(99);
    assert!(findings(&study, &later).iter().any(|why| why.contains("format is 99")));
    // Results without a head are from an older format.
    let mut older = original.clone();
    ["format", "commit", "sources", "platform", "processor_features", "mathematics", "plugins", "files"]
        .iter()
        .for_each(|key| drop(older.as_object_mut().expect("a map").remove(*key)));
    assert_eq!(findings(&study, &older), Vec::<String>::new());
}
