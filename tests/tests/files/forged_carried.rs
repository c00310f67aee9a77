//! Forged results of a load that is carried: `verify` finds a forged force, zone, reserve and check.

use super::tolerances::of_another_processor;
use super::units::Written;
use serde_json::{Value, json};
use voussoir_tests::written::{findings, results};
use voussoir_tests::{Arch, changed};

fn carried() -> String {
    let arch = Arch { voussoirs: 9, ends: "jointed", ..Arch::default() }.study();
    changed(&arch, "until = \"collapse\"", "factor = 30.0")
}

/// Every forged number is found, by comparison of bits and by the claims. Omitted and added entries are found too.
#[test]
fn forged_forces_zones_and_reserves_are_found() {
    let (study, original) = results(&carried());
    assert_eq!(original["cases"][0]["status"], "stands");
    for original in [original.clone(), of_another_processor(&original)] {
        assert_eq!(findings(&study, &original), Vec::<String>::new(), "untouched");
        let joint = "/cases/0/joints/4";
        let numbers =
            ["normal", "shear", "moment", "eccentricity", "contact_length", "greatest_stress", "sliding_reserve"];
        let numbers = numbers.iter().map(|key| format!("{joint}/{key}"));
        let zones = [0, 1].map(|end| format!("{joint}/zone/{end}"));
        let reserve = ["factor", "target", "bounds/0", "bounds/1"].map(|key| format!("/cases/0/reserve/{key}"));
        let check = ["share", "used"].map(|key| format!("/cases/0/permissible/{key}"));
        for at in numbers.chain(zones).chain(reserve).chain(check) {
            let mut forged = original.clone();
            let slot = forged.pointer_mut(&at).unwrap_or_else(|| panic!("no {at}"));
            let x = slot.as_f64().unwrap_or_else(|| panic!("{at} is {slot}"));
            *slot = json!(x * (1.0 + 1e-5) + 1e-9);
            assert!(!findings(&study, &forged).is_empty(), "{at}");
        }
        for (at, word) in [
            ("reserve/status", json!("unbounded")),
            ("reserve/flow", json!("read_as_associated")),
            ("reserve/stage", json!("dead")),
            ("permissible/holds", json!(null)),
            ("permissible/rule", json!("none")),
            ("joints/4/zone", Value::Null),
            ("joints/4/between/0", json!("nobody")),
            ("joints/4/joint", json!(5)),
            ("joints", json!([])),
            ("reserve", Value::Null),
            ("permissible", Value::Null),
        ] {
            let mut forged = original.clone();
            *forged.pointer_mut(&format!("/cases/0/{at}")).unwrap_or_else(|| panic!("no {at}")) = word;
            assert!(!findings(&study, &forged).is_empty(), "{at}");
        }
    }
}

/// The report, the drawing and joints.csv show the forces, the zone and the reserve; a collapse has none of them.
#[test]
fn pages_show_a_load_that_is_carried() {
    let written = Written::of(&carried());
    let report = written.text("report.html");
    for words in ["Loads that are carried", "Permissible limit state fulfilled", "zone of thrust", "collapse at factor"]
    {
        assert!(report.contains(words), "{words}");
    }
    assert!(written.text("figures/case-0000-scene.svg").contains("zone of thrust"));
    let table = written.text("joints.csv");
    assert_eq!(table.lines().count(), 1 + 10, "nine voussoirs have ten joints");
    assert!(table.lines().next().is_some_and(|header| header.ends_with("zone_least [m],zone_greatest [m]")));
    let collapse = Written::of(&Arch { voussoirs: 9, ends: "jointed", ..Arch::default() }.study());
    assert!(!collapse.text("report.html").contains("Loads that are carried"));
}
