//! Envelopes: the most onerous position of a vehicle against every position of a fine scan.

use serde_json::Value;
use voussoir::kinds::{RunRequest, read_study};
use voussoir::solve::Unobserved;
use voussoir_tests::{assert_close, changed, collapse_factor};

const BRIDGE: &str = r#"
name = "envelope"
kind = "envelope"
[scene]
scene = "bridge"
width = 3.0
material = "stone"
joint = "dry"
spans = [{ profile = { shape = "segmental", span = 3.0, rise = 0.75 }, thickness = 0.25, voussoirs = 20 }]
[scene.fill]
cover = 0.3
density = 1800.0
dispersion = { law = "uniform", angle = 30.0 }
[materials.stone]
law = "rigid"
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[vehicles.bogie]
axles = [{ at = 0.0, force = "10 kN", length = 0.3 }, { at = 1.2, force = "6 kN", length = 0.3 }]
[vehicles.single]
axles = [{ at = 0.0, force = "11.5 kN", length = 0.3 }]
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "vehicle", vehicle = "bogie", at = 0.75 }]
[envelope]
parameter = "stages.1.loads.0.at"
from = -2.0
to = 4.0
vehicles = ["bogie", "single"]
"#;

/// Returns results.json of a run.
fn run(text: &str, jobs: usize) -> Value {
    let study = read_study(text, "test.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let request = RunRequest { wanted: vec![0], jobs, version: "test".into(), ..RunRequest::default() };
    let output = study.run(&request, &Unobserved);
    assert!(output.certified);
    let (_, bytes) = output.files.iter().find(|(name, _)| name == "results.json").expect("results");
    let text = String::from_utf8(bytes.clone()).expect("text");
    let checked = study.verify(&text).expect("results");
    assert_eq!(checked.findings, Vec::new());
    serde_json::from_str(&text).expect("JSON")
}

/// The most onerous position has a lower factor than every position of a scan in steps of 15 mm, and its factor is that
/// of the position itself.
#[test]
fn the_worst_place_is_the_lowest_of_a_fine_scan() {
    let text = changed(BRIDGE, "[envelope]", "[output]\nwriters = []\n[envelope]");
    let results = run(&text, 2);
    let worst = &results["worsts"][0];
    let (value, factor) = (worst["value"].as_f64().expect("a place"), worst["result"].as_f64().expect("a factor"));
    let plain = changed(&text[..text.find("[envelope]").expect("envelope")], "kind = \"envelope\"", "kind = \"run\"");
    let at = |vehicle: &str, direction: &str, x: f64| {
        let load = format!("vehicle = \"{vehicle}\", direction = \"{direction}\", at = {x:?} }}");
        voussoir_tests::answered(&changed(&plain, "vehicle = \"bogie\", at = 0.75 }", &load)).load_factor
    };
    let (vehicle, direction) =
        (worst["vehicle"].as_str().expect("a vehicle"), worst["direction"].as_str().expect("a way"));
    assert_close(at(vehicle, direction, value).expect("a collapse"), factor, 1e-9);
    for vehicle in ["bogie", "single"] {
        for direction in ["forward", "backward"] {
            for i in 0..400 {
                let x = -2.0 + 6.0 * f64::from(i) / 399.0;
                let here = at(vehicle, direction, x).unwrap_or(f64::INFINITY);
                assert!(here >= factor * (1.0 - 1e-4), "{vehicle} {direction} at {x}: {here} {factor}");
            }
        }
    }
    let curve = results["curve"].as_array().expect("a curve");
    assert!(curve.iter().all(|place| place["result"].as_f64().is_none_or(|y| y >= factor)));
    assert_eq!(worst["intervals"][0]["status"], "unbounded");
}

/// One direction alone, and another kind of load, are envelopes too; results do not depend on the number of jobs.
#[test]
fn one_way_and_other_loads() {
    let text = changed(BRIDGE, "vehicles = [\"bogie\", \"single\"]\n", "directions = \"forward\"\nscan = 9\n");
    let text = changed(&text, "[envelope]", "[output]\nwriters = []\n[envelope]");
    let [mut one, mut two] = [1, 2].map(|jobs| run(&text, jobs));
    for results in [&mut one, &mut two] {
        results["cases"].as_array_mut().expect("cases").iter_mut().for_each(|case| case["seconds"] = 0.0.into());
    }
    assert_eq!(one, two);
    assert!(one["curve"].as_array().expect("a curve").iter().all(|place| place["direction"] == "forward"));
    let axles = changed(
        &text,
        "kind = \"vehicle\", vehicle = \"bogie\", at = 0.75",
        "kind = \"axles\", at = 0.25, positions = [0.0], forces = [1e3]",
    );
    let axles = changed(&axles, "from = -2.0\nto = 4.0\ndirections = \"forward\"", "from = 0.05\nto = 0.95");
    let results = run(&axles, 1);
    let worst = results["worsts"][0]["result"].as_f64().expect("a factor");
    let plain = changed(&axles[..axles.find("[envelope]").expect("envelope")], "kind = \"envelope\"", "kind = \"run\"");
    assert!(worst <= collapse_factor(&plain));
}
