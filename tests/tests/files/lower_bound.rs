//! The lower end of a bracket is recomputed: multipliers of products prove it, and no other number is confirmed.

use serde_json::{Value, json};
use voussoir_tests::Wall;
use voussoir_tests::written::{findings, results};

/// Returns a wall whose least load is below the associated load.
fn wall(limits: &str, joint: &str) -> String {
    let rows: [&[f64]; 3] = [&[1.0, 1.0], &[0.5, 1.0, 0.5], &[1.0, 1.0]];
    Wall {
        brick: [0.4, 0.2],
        gravity: 10.0,
        push: [10.0, 0.0],
        joint: joint.into(),
        solver: format!("solver = \"limit_least\"\n{limits}"),
        ..Wall::of_rows(&rows)
    }
    .study()
}

const COULOMB: &str = "law = \"coulomb\"\nfriction = 0.9";

/// An unchanged bracket is confirmed. A raised bound, a changed, dropped or negative multiplier, another range and
/// another proof are found, for walls with friction, with cohesion and tension, and with dilatancy.
#[test]
fn a_changed_lower_proof_is_found() {
    for joint in [
        COULOMB,
        "law = \"coulomb\"\nfriction = 0.6\ndilatancy_angle = 10.0",
        "law = \"mohr_coulomb\"\nfriction = 0.6\ndilatancy_angle = 0.0\ncohesion = 200.0\ntensile_strength = 100.0",
    ] {
        let (study, original) = results(&wall("search_limit = 0.0\nproduct_rows = 4000", joint));
        let case = &original["cases"][0];
        assert_eq!(case["lower_proof"]["by"], "products", "{joint}: {} {}", case["notes"], case["certificate"]);
        assert_eq!(findings(&study, &original), Vec::<String>::new(), "{joint}");
        let [low, high] = [0, 1].map(|i| case["bounds"][i].as_f64().expect("a bound"));
        println!("{joint}: [{low}, {high}] {} bytes", case["lower_proof"].to_string().len());
        assert!(low > 0.5 * high, "{joint}: [{low}, {high}]");
        let change = |path: &str, value: Value| {
            let mut changed = original.clone();
            *changed.pointer_mut(&format!("/cases/0/{path}")).unwrap_or_else(|| panic!("{path}")) = value;
            assert!(!findings(&study, &changed).is_empty(), "{joint}: {path} was changed and not found");
        };
        for by in [1e-3, 1e-5] {
            // Only if the bracket is open; a closed bracket leaves no range for it.
            let open = low * (1.0 + by) < high;
            assert!(open || joint != COULOMB, "[{low}, {high}]");
            if open {
                change("bounds/0", json!(low * (1.0 + by)));
            }
        }
        let step = &case["lower_proof"]["steps"][0];
        let bound = step["bound"].as_f64().expect("a bound");
        change("lower_proof/steps/0/bound", json!(bound * (1.0 + 1e-3)));
        change("lower_proof/steps/0/range/0", json!(0.5 * low));
        change("lower_proof/steps/0/range/1", json!(0.9 * high));
        change("lower_proof/steps", json!([]));
        change("lower_proof/by", json!("start"));
        // Multipliers of products that are not zero at the found state.
        let multipliers = step["multipliers"].as_array().expect("multipliers");
        let mut tried = 0;
        for (i, row) in multipliers.iter().enumerate() {
            for (j, entry) in row[1].as_array().expect("a row").iter().enumerate() {
                let value = entry[1].as_f64().expect("a multiplier");
                if (7 * i + j) % 13 == 0 && value.abs() > 1e-2 && value.abs() < 1e2 {
                    let path = format!("lower_proof/steps/0/multipliers/{i}/1/{j}/1");
                    change(&path, json!(value * 1.001));
                    change(&path, json!(0.0));
                    tried += 1;
                }
            }
        }
        assert!(tried >= 10, "{tried} multipliers were tried");
    }
}

/// With all products the bracket closes and is confirmed.
#[test]
fn a_closed_bracket_is_confirmed() {
    let (study, original) = results(&wall("search_limit = 0.0", COULOMB));
    let case = &original["cases"][0];
    let [low, high] = [0, 1].map(|i| case["bounds"][i].as_f64().expect("a bound"));
    assert!((high - 5.0 / 7.0).abs() < 1e-12 && low > high * (1.0 - 1e-6), "[{low}, {high}] {}", case["notes"]);
    assert_eq!(case["lower_proof"]["by"], "products");
    assert_eq!(findings(&study, &original), Vec::<String>::new());
}

/// Splitting the program of all products proves nearly the found load, range by range, and is confirmed; every other
/// bound, range and multiplier of a product of the found state is refused.
#[test]
fn a_bound_by_splitting_is_confirmed() {
    let split = wall("search_limit = 0.0\nproduct_rows = 0\nproduct_limit = 8.0", COULOMB);
    let (study, original) = results(&split);
    let case = &original["cases"][0];
    let [low, high] = [0, 1].map(|i| case["bounds"][i].as_f64().expect("a bound"));
    println!("[{low}, {high}] {}", case["counters"]);
    assert!((high - 5.0 / 7.0).abs() < 1e-12 && low > 0.98 * high && low <= high, "[{low}, {high}] {}", case["notes"]);
    assert_eq!(case["lower_proof"]["by"], "products");
    assert_eq!(findings(&study, &original), Vec::<String>::new());
    let change = |path: &str, value: Value| {
        let mut changed = original.clone();
        *changed.pointer_mut(&format!("/cases/0/{path}")).unwrap_or_else(|| panic!("{path}")) = value;
        assert!(!findings(&study, &changed).is_empty(), "{path} was changed and not found");
    };
    change("bounds/0", json!(low * (1.0 + 1e-4)));
    // The curve along which the bracket closed ends at the bounds and never widens.
    let curve = case["bracket"].as_array().expect("a curve");
    let end = curve.len() - 1;
    assert!(
        curve.iter().any(|point| point["by"] == "splitting" && point["lower"].as_f64() > Some(0.9 * high)),
        "{curve:?}"
    );
    change(&format!("bracket/{end}/lower"), json!(low * (1.0 + 1e-4)));
    change(&format!("bracket/{end}/found"), json!(high * (1.0 - 1e-4)));
    change("bracket/0/found", json!(0.9 * high));
    change("bracket/0/lower", json!(low * (1.0 + 1e-4)));
    let last = case["lower_proof"]["steps"].as_array().expect("steps").len() - 1;
    change(&format!("lower_proof/steps/{last}/range/1"), json!(0.9 * high));
    change(&format!("lower_proof/steps/{last}/range/0"), json!(low));
    let greatest =
        case["lower_proof"]["steps"][last]["multipliers"].as_array().expect("multipliers").iter().enumerate();
    let entries = greatest.flat_map(|(i, row)| {
        let row = row[1].as_array().expect("a row").iter().enumerate();
        row.map(move |(j, entry)| (entry[1].as_f64().expect("a multiplier"), i, j))
    });
    let (value, i, j) = entries.fold((0.0f64, 0, 0), |most, e| if e.0.abs() > most.0.abs() { e } else { most });
    for changed in [value * 1.001, 0.0, f64::from(i32::MAX)] {
        change(&format!("lower_proof/steps/{last}/multipliers/{i}/1/{j}/1"), json!(changed));
    }
}

/// A bound that a search has proved names the search.
#[test]
fn a_search_is_named() {
    let (study, original) = results(&wall("product_rows = 0", COULOMB));
    let case = &original["cases"][0];
    assert_eq!(case["lower_proof"], json!({ "by": "search" }), "{}", case["bounds"]);
    assert_eq!(findings(&study, &original), Vec::<String>::new());
}
