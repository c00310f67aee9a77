//! Outputs that plug-ins declare on their cards, in every file: of joints, blocks, points and the case, and of a solver.

use super::units::Written;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use voussoir::core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver};
use voussoir::core::plugin::{Card, Output, PluginKind};
use voussoir::core::{inventory, typetag};
use voussoir::solvers::limit::conic::LimitConic;
use voussoir_tests::written::{findings, results};
use voussoir_tests::{Arch, changed};

/// A block that water lifts from its base, with a block of a material that can be damaged on top of it; the thrust is swept.
const DAM: &str = r#"name = "dam"
[scene]
scene = "blocks"
width = 2.0
plane = "strain"
material = "concrete"
joint = "base"
mesh = { elements = [2, 20], order = 1 }
blocks = [
  { name = "rock", material = "rock", vertices = [[-1.0, -1.0], [5.0, -1.0], [5.0, 0.0], [-1.0, 0.0]], fixed = true },
  { name = "dam", vertices = [[0.0, 0.0], [4.0, 0.0], [4.0, 6.0], [0.0, 6.0]] },
]
[materials.rock]
law = "rigid"
density = 2400.0
[materials.concrete]
law = "mazars_damage"
young_modulus = "20 GPa"
poisson_ratio = 0.2
density = 2400.0
tensile_strength = "2 MPa"
fracture_energy = 200.0
[joints.base]
law = "uplift_joint"
friction = 0.9
normal_stiffness = "10 GPa/m"
shear_stiffness = "4 GPa/m"
water_weight = "10 kPa/m"
[[stages]]
name = "weight"
gravity = 10.0
fields = { water_level = "0 m" }
[[stages]]
name = "water"
fields = { water_level = "6 m" }
loads = [{ kind = "point", block = "dam", point = [0.0, 2.0], force = ["360 kN", 0.0] }]
[sweep]
"stages.1.factor" = { list = [0.5, 0.8, 1.0] }
[output]
vtu = true
writers = ["results_csv", "results_parquet", "outputs_csv", "joints_csv", "report", "figures", "vtu"]
"#;

/// The values of a column of a CSV file.
fn column(table: &str, name: &str) -> Vec<f64> {
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let place = header.iter().position(|own| *own == name).unwrap_or_else(|| panic!("no {name} in {header:?}"));
    lines.map(|line| line.split(',').nth(place).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN)).collect()
}

fn output<'a>(case: &'a Value, name: &str) -> &'a Value {
    let outputs = case["outputs"].as_array().expect("outputs");
    outputs.iter().find(|own| own["name"] == name).unwrap_or_else(|| panic!("no output {name}"))
}

/// The same numbers are in results.json, both tables, the Parquet file, the files for ParaView, the report and the charts.
#[test]
fn outputs_are_in_every_file() {
    let written = Written::of(DAM);
    let results: Value = serde_json::from_str(&written.text("results.json")).expect("results");
    let cases = results["cases"].as_array().expect("cases");
    let lengths: Vec<f64> =
        cases.iter().map(|case| output(case, "total_crack_length")["values"][0].as_f64().expect("a number")).collect();
    assert!(lengths[0] < lengths[2] && lengths[2] > 0.0 && lengths[2] < 4.0, "{lengths:?}");
    let table = written.text("results.csv");
    assert_eq!(column(&table, "total_crack_length [m]"), lengths);
    assert!(column(&table, "greatest_damage [-]").iter().all(|own| (0.0..1.0).contains(own)));
    assert_eq!(column(&written.text("joints.csv"), "crack_length [m]"), lengths, "one joint in each case");
    let values: usize = cases
        .iter()
        .flat_map(|case| case["outputs"].as_array().expect("outputs"))
        .map(|own| own["values"].as_array().expect("values").len())
        .sum();
    assert_eq!(written.text("outputs.csv").lines().count(), 1 + values);
    assert!(written.text("results.parquet").contains("total_crack_length [m]"));
    let mesh = written.text("vtu/case-0002.vtu");
    for name in ["damage [-]", "block_damage [-]", "damaged_area [m2]"] {
        assert!(mesh.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    let points = written.text("vtu/points-0002.vtu");
    for name in ["damage [-]", "open [-]", "water_pressure [Pa]", "crack_length [m]"] {
        assert!(points.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    let count = ["damage", "open"].map(|name| output(&cases[2], name)["values"].as_array().expect("values").len());
    assert!(points.contains(&format!("NumberOfPoints=\"{}\"", count[0] + count[1])));
    let report = written.text("report.html");
    for words in [
        "Outputs of plug-ins",
        "length of the open parts of all joints",
        "total crack length [m]",
        "joint 0 (rock – dam)",
    ] {
        assert!(report.contains(words), "{words}");
    }
    assert!(written.text("figures/sweep-total_crack_length.svg").contains("total crack length [m]"));
}

/// Every changed value, name, unit, place and position of an output is found, by comparison of bits and by the claims.
#[test]
fn forged_outputs_are_found() {
    let single = changed(DAM, "[sweep]\n\"stages.1.factor\" = { list = [0.5, 0.8, 1.0] }\n", "");
    let (study, original) = results(&single);
    for original in [original.clone(), super::tolerances::of_another_processor(&original)] {
        assert_eq!(findings(&study, &original), Vec::<String>::new(), "untouched");
        for index in 0..original["cases"][0]["outputs"].as_array().expect("outputs").len() {
            let at = |key: &str| format!("/cases/0/outputs/{index}/{key}");
            let forge = |key: &str, value: Value| {
                let mut forged = original.clone();
                let Some(slot) = forged.pointer_mut(&at(key)) else { return };
                *slot = value;
                assert!(!findings(&study, &forged).is_empty(), "{}", at(key));
            };
            let value = original.pointer(&at("values/0")).and_then(Value::as_f64).expect("a number");
            forge("values/0", json!(value + 0.1 * value.abs().max(1.0)));
            forge("values/0", Value::Null);
            forge("name", json!("other"));
            forge("unit", json!("N"));
            forge("plugin", json!("coulomb"));
            forge("places/0", json!(1_000_000));
            forge("positions/0/0", json!(123.0));
        }
        let mut forged = original.clone();
        forged["cases"][0]["outputs"] = json!([]);
        assert!(!findings(&study, &forged).is_empty(), "no outputs");
    }
}

/// A solver with outputs: one that it returns, one that it forgets, and one that its card does not declare.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Reporting {}

#[typetag::serde(name = "reporting_limit")]
impl LimitSolver for Reporting {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let mut answer = LimitConic {}.solve(problem, question);
        answer.outputs.insert("joints_read".into(), problem.joints.len() as f64);
        answer.outputs.insert("joint_read".into(), 1.0);
        answer.outputs.insert("gap_of_bounds".into(), f64::NAN);
        answer
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        LimitConic {}.refuses(problem)
    }
}

inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "reporting_limit",
        summary: "for this test",
        outputs: &[
            Output::case("joints_read", "-", "number of joints of the problem"),
            Output::case("gap_of_bounds", "-", "never a number"),
        ],
        sources: &["this test"],
        file: file!(),
        page: "for this test",
        ..Card::BLANK
    }
}

/// Outputs of a solver are checked against its card.
#[test]
fn outputs_of_a_solver_are_those_of_its_card() {
    let arch = Arch { voussoirs: 9, ends: "jointed", ..Arch::default() }.study();
    let text = changed(&arch, "solver = \"auto\"", "solver = \"reporting_limit\"");
    let (study, results) = results(&text);
    let case = &results["cases"][0];
    assert_eq!(output(case, "joints_read")["values"], json!([10.0]));
    assert_eq!(output(case, "gap_of_bounds")["values"], json!([null]));
    let notes = case["notes"].to_string();
    for note in [
        "reporting_limit: its answer has an output \\\"joint_read\\\" that its card does not declare; did you mean \\\"joints_read\\\"?",
        "reporting_limit: 1 of 1 values of the output \\\"gap_of_bounds\\\" are not finite; null is stored",
    ] {
        assert!(notes.contains(note), "{notes}");
    }
    assert_eq!(findings(&study, &results), Vec::<String>::new());
    let mut forged = results.clone();
    forged["cases"][0]["outputs"][0]["name"] = json!("other");
    assert!(findings(&study, &forged).iter().any(|why| why.contains("declares no output like \"other\"")));
    let mut forged = results.clone();
    forged["cases"][0]["outputs"][0]["kind"] = json!("interface_law");
    let of_a_law = "outputs: limit analysis gives no output \"joints_read\" of reporting_limit";
    assert!(findings(&study, &forged).iter().any(|why| why == of_a_law));
    let report = Written::of(&text);
    assert!(report.text("report.html").contains("No check proves outputs of solvers."));
}
