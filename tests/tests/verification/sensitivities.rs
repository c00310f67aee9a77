//! Derivatives of limit loads: closed forms, and differences of loads that are solved again on each side.

use serde_json::json;
use voussoir::prelude::*;
use voussoir::results::SensitivityEntry;
use voussoir::{Study, solve_case};
use voussoir_tests::{Arch, assert_close, crushing, friction, study, written};

const WANTED: &str = "\n[output]\nfigures = false\nsensitivities = true\n";

fn entry<'a>(case: &'a CaseResult, key: &str) -> &'a SensitivityEntry {
    let found = case.sensitivities.iter().find(|entry| entry.key == key);
    found.unwrap_or_else(|| panic!("{key}: {:?} {:?}", case.sensitivities, case.notes))
}

/// Returns the answer for the first case of the study.
fn answer(study: &Study) -> CaseResult {
    study.run().cases.swap_remove(0)
}

/// Asserts that every derivative equals a second-order difference quotient of two loads on its side.
fn assert_differences(study: &Study, tolerance: f64) -> CaseResult {
    let case = answer(study);
    let factor = case.load_factor.unwrap_or_else(|| panic!("{:?}", case.status));
    assert!(case.sensitivities.len() > 5, "{:?}", case.notes);
    for entry in &case.sensitivities {
        let scale = if entry.value == 0.0 { 1.0 } else { entry.value.abs() };
        for (slope, step) in [(entry.left, -2e-5 * scale), (entry.right, 2e-5 * scale)] {
            let load = |value: f64| {
                let mut changed = study.at(0, &[(entry.key.clone(), json!(value))]).ok()?;
                changed.output_sensitivities.clear();
                solve_case(&changed).load_factor
            };
            let (Some(slope), Some(near), Some(far)) =
                (slope, load(entry.value + step), load(entry.value + 2.0 * step))
            else {
                assert!(entry.why.is_some(), "{entry:?}");
                continue;
            };
            let difference = (4.0 * near - 3.0 * factor - far) / (2.0 * step);
            let size = slope.abs().max(1e-3 * factor / scale);
            assert!((slope - difference).abs() < tolerance * size, "{entry:?}: {difference} by {step}");
        }
    }
    case
}

/// For a dry ring λ is proportional to weight and width and inversely proportional to the load; all other derivatives
/// are differences of loads.
#[test]
fn derivatives_of_rings_are_differences_of_loads() {
    let arch = Arch { ends: "jointed", span_fraction: 0.27, ..Arch::default() };
    let case = assert_differences(&study(&(arch.study() + WANTED)), 1e-6);
    let factor = case.load_factor.expect("a load");
    for (key, power) in [
        ("materials.stone.density", 1.0),
        ("scene.width", 1.0),
        ("stages.0.gravity", 1.0),
        ("stages.1.loads.0.force.1", -1.0),
        ("joints.dry.friction", 0.0),
    ] {
        let entry = entry(&case, key);
        assert!(!entry.kink, "{entry:?}");
        for slope in [entry.left, entry.right] {
            assert_close(slope.expect("a slope") * entry.value / factor, power, 1e-8);
        }
    }
    for (joint, rise) in [(friction(0.3), 2.99), (crushing(0.6, 1e7), 1.2), (crushing(0.35, 3e6), 2.0)] {
        assert_differences(
            &study(&(Arch { joint, rise, span_fraction: 0.31, ..Arch::default() }.study() + WANTED)),
            1e-6,
        );
    }
}

/// A load above the crown has two mirror mechanisms, so that the load factor falls with the same slope in both
/// directions.
#[test]
fn mirror_mechanisms_give_a_kink_in_the_place_of_the_load() {
    let arch = Arch { ends: "jointed", span_fraction: 0.5, ..Arch::default() };
    let case = assert_differences(&study(&(arch.study() + WANTED)), 1e-6);
    let place = entry(&case, "stages.1.loads.0.span_fraction");
    let (left, right) = (place.left.expect("a slope"), place.right.expect("a slope"));
    assert!(place.kink && left > 0.0, "{place:?}");
    assert_close(right, -left, 1e-8);
    assert!(case.sensitivities.iter().all(|entry| !entry.kink || entry.key.contains("loads")));
}

fn block(friction: f64, length: f64) -> String {
    format!(
        "name = \"block\"\n[scene]\nscene = \"wall\"\nwidth = 0.8\nbrick = [{length}, 1.0]\ncourses = 1\nbricks = 1\n\
         material = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n[joints.dry]\n\
         law = \"coulomb_associated\"\nfriction = {friction}\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\n\
         name = \"push\"\nuntil = \"collapse\"\nloads = [{{ kind = \"body\", acceleration = [9.81, 0.0] }}]\n{WANTED}"
    )
}

/// A block of length b and height h = 1 slides or rocks, λ = min(μ, b / h). At μ = b / h both mechanisms exist and both
/// slopes are given.
#[test]
fn where_the_mechanism_changes_both_slopes_are_given() {
    for (mu, length, by_friction, by_length) in
        [(0.5, 0.5, [1.0, 0.0], [1.0, 0.0]), (0.4, 0.5, [1.0, 1.0], [0.0, 0.0]), (0.6, 0.5, [0.0, 0.0], [1.0, 1.0])]
    {
        let case = answer(&study(&block(mu, length)));
        assert_close(case.load_factor.expect("a load"), f64::min(mu, length), 1e-9);
        for (key, slopes) in [("joints.dry.friction", by_friction), ("scene.brick.0", by_length)] {
            if slopes == [0.0; 2] {
                let none = case.sensitivities.iter().filter(|entry| entry.key == key);
                none.for_each(|entry| assert_eq!((entry.left, entry.right), (Some(0.0), Some(0.0)), "{entry:?}"));
                continue;
            }
            let entry = entry(&case, key);
            assert_eq!(entry.kink, slopes[0] != slopes[1], "{entry:?}");
            assert_close(entry.left.expect("a slope"), slopes[0], 1e-6);
            assert_close(entry.right.expect("a slope"), slopes[1], 1e-6);
        }
    }
}

/// A beam of weight W on three supports, pushed at their level: λ = Σ μ_i N_i is the greatest over the shares N_i. With
/// equal coefficients the share of the middle is undetermined between 0 and W. The slope with respect to its
/// coefficient is therefore W if it increases and 0 if it decreases.
#[test]
fn where_the_field_is_not_unique_both_slopes_are_given() {
    let ground = |name: &str, x: f64| {
        let (a, b) = (x - 0.1, x + 0.1);
        format!("{{ name = \"{name}\", vertices = [[{a}, -0.2], [{b}, -0.2], [{b}, 0.0], [{a}, 0.0]], fixed = true }}")
    };
    let blocks = [ground("left", -1.0), ground("middle", 0.0), ground("right", 1.0)].join(", ");
    let text = format!(
        "name = \"beam\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\n\
         pairs = [{{ between = [\"middle\", \"beam\"], joint = \"own\" }}]\nblocks = [{blocks}, {{ name = \"beam\", \
         vertices = [[-1.1, 0.0], [1.1, 0.0], [1.1, 0.25], [-1.1, 0.25]] }}]\n[materials.stone]\nlaw = \"rigid\"\n\
         density = 2000.0\n[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = 0.6\n[joints.own]\n\
         law = \"coulomb_associated\"\nfriction = 0.6\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\n\
         name = \"push\"\nuntil = \"collapse\"\n\
         loads = [{{ kind = \"point\", block = \"beam\", point = [-1.1, 0.0], force = [1000.0, 0.0] }}]\n{WANTED}"
    );
    let weight = 2.2 * 0.25 * 2000.0 * 9.81 / 1000.0;
    let case = answer(&study(&text));
    assert_close(case.load_factor.expect("a load"), 0.6 * weight, 1e-9);
    for (key, least) in [("joints.own.friction", 0.0), ("joints.dry.friction", 0.0)] {
        let entry = entry(&case, key);
        assert!(entry.kink, "{entry:?}");
        assert_close(entry.left.expect("a slope"), least * weight, 1e-6);
        assert_close(entry.right.expect("a slope"), weight, 1e-6);
    }
}

/// A changed derivative is found; a result without an optimum, or a path, has no derivatives and gives the reason.
#[test]
fn derivatives_are_verified_and_refused_where_there_are_none() {
    let ring = Arch { ends: "jointed", ..Arch::default() };
    let text = ring.study() + WANTED;
    let (study_of_ring, mut results) = written::results(&text);
    assert_eq!(written::findings(&study_of_ring, &results), Vec::<String>::new());
    results["cases"][0]["sensitivities"][0]["left"] = json!(1.0);
    assert!(!written::findings(&study_of_ring, &results).is_empty());
    let none = |text: &str, words: &str| {
        let case = answer(&study(text));
        assert!(
            case.sensitivities.is_empty() && case.notes.iter().any(|note| note.contains(words)),
            "{:?}",
            case.notes
        );
    };
    let own = Arch { joint: "law = \"coulomb\"\nfriction = 0.6".into(), ..ring.clone() };
    none(&(own.study() + WANTED), "no sensitivities: a joint law flows otherwise");
    let flat = Arch { rise: 0.9, ..ring };
    none(&(flat.study() + WANTED), "no sensitivities: there is no collapse load");
}
