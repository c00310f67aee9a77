//! Optima against loads at neighbouring values, and against values of an independent program.

use serde_json::{Value, json};
use voussoir_tests::{Arch, assert_close, changed, collapse_factor, crushing};

/// Returns a study that optimises the inclination of the supports of the reference arch.
fn springing(arch: &Arch, table: &str) -> String {
    let head = "name = \"arch\"\nkind = \"optimise\"\n[optimise]\nparameter = \"scene.springing\"\n";
    changed(&arch.study(), "name = \"arch\"\n", &format!("{head}{table}"))
}

fn optima(text: &str) -> (Vec<Value>, usize) {
    let (study, results) = voussoir_tests::written::results(text);
    assert!(voussoir_tests::written::findings(&study, &results).is_empty());
    (results["optima"].as_array().expect("a list").clone(), results["cases"].as_array().expect("a list").len())
}

fn at(arch: &Arch, degrees: f64) -> f64 {
    collapse_factor(&changed(&arch.study(), "ends = ", &format!("springing = {degrees:?}\nends = ")))
}

/// With 10 MPa and a rise of 1.49 m the best of an independent linear program on whole half degrees is 1899.3 kN at
/// 82.5°; the optimum is not less, and its neighbours are lower.
#[test]
fn the_best_inclination_is_that_of_an_independent_program() {
    let arch = Arch { ends: "jointed", rise: 1.49, joint: crushing(0.6, 10e6), ..Arch::default() };
    let (optima, tried) = optima(&springing(&arch, "from = 40.0\nto = 90.0\nscan = 21\n"));
    let [optimum] = optima.as_slice() else { panic!("{optima:?}") };
    let (value, result) = (optimum["value"].as_f64().expect("a value"), optimum["result"].as_f64().expect("a result"));
    assert_close(at(&arch, 82.5), 1899.3, 3e-5);
    assert!(result >= at(&arch, 82.5) && (value - 82.5).abs() < 0.5, "{value} {result}");
    assert_close(at(&arch, value), result, 1e-11);
    for off in [-0.05, 0.05] {
        assert!(at(&arch, value + off) < result);
    }
    assert_eq!(optimum["best_finite"], json!({ "value": value, "result": result, "case": optimum["case"] }));
    assert!(tried < 80, "{tried}");
}

/// If some inclination carries any load, there is no optimum, and the best finite value is given too; the least load
/// over the same range is finite.
#[test]
fn an_unbounded_result_is_no_optimum() {
    let arch = Arch { ends: "jointed", rise: 0.89, ..Arch::default() };
    let most = springing(&arch, "from = 40.0\nto = 90.0\nscan = 11\ntolerance = 0.01\n");
    let (optima_of_most, _) = optima(&most);
    let optimum = &optima_of_most[0];
    assert_eq!(
        (&optimum["value"], &optimum["result"], &optimum["status"]),
        (&Value::Null, &Value::Null, &json!("unbounded"))
    );
    assert!(optimum["best_finite"]["result"].is_number());
    let statuses = optimum["intervals"].as_array().expect("a list").iter().map(|interval| interval["status"].clone());
    let statuses: Vec<Value> = statuses.collect();
    assert!(statuses.contains(&json!("unbounded")) && statuses.contains(&json!("collapse")), "{statuses:?}");
    let (least, _) = optima(&changed(&most, "tolerance", "goal = \"minimise\"\ntolerance"));
    assert!(least[0]["result"].as_f64() < optimum["best_finite"]["result"].as_f64());
}
