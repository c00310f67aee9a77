//! `[output] fields = false`: the same answers without the forces and motions that prove them; `verify` finds every
//! change.

use crate::forgery::forgeries;
use serde_json::{Value, json};
use voussoir_tests::written::{findings, results};
use voussoir_tests::{Arch, Wall, compliant, friction};

/// Keys of a case that are left out, and keys that become `null`.
const LEFT_OUT: [&str; 6] = ["displacements", "joint_states", "yielded", "fill", "associated_motion", "lower_proof"];
const EMPTIED: [&str; 4] = ["field", "ray", "motion", "thrust_line"];

#[test]
fn answers_without_fields_are_those_with_them() {
    let slips = Wall { joint: "law = \"coulomb\"\nfriction = 0.65".into(), ..Wall::in_bond(3, 2) };
    let path =
        Arch { joint: compliant(&friction(0.6), 2e10, 8e9), solver: "newton_path", voussoirs: 7, ..Arch::default() };
    let unbounded = Arch { rise: 1.19, ..Arch::default() };
    for text in [Arch::default().study(), unbounded.study(), slips.study(), path.study()] {
        let (_, mut whole) = results(&text);
        let (study, short) = results(&format!("{text}\n[output]\nfields = false\n"));
        for name in LEFT_OUT {
            whole["cases"][0].as_object_mut().expect("a case").shift_remove(name);
        }
        for name in EMPTIED {
            whole["cases"][0][name] = Value::Null;
        }
        let mut rest = short.clone();
        for results in [&mut whole, &mut rest] {
            let case = results["cases"][0].as_object_mut().expect("a case");
            // The word of a proof is kept, its steps are left out; hash and time differ.
            ["lower_proof", "case_hash", "seconds"].iter().for_each(|name| drop(case.shift_remove(*name)));
        }
        assert_eq!(whole, rest);
        assert_eq!(findings(&study, &short), Vec::<String>::new());
        let mut places = Vec::new();
        forgeries(&short["cases"][0], "/cases/0", &mut places);
        // Residuals are rounding errors: another machine's residuals differ by as much, so their changes are not found
        // if they are most of the remaining numbers.
        for (path, forged) in places.into_iter().filter(|(path, _)| !path.contains("/residuals/")) {
            let mut changed = short.clone();
            *changed.pointer_mut(&path).expect("it is there") = forged;
            assert!(!findings(&study, &changed).is_empty(), "{path} was changed and not found");
        }
        let mut foreign = short;
        foreign["cases"][0]["field"] = json!([]);
        assert!(!findings(&study, &foreign).is_empty(), "a field was added and not found");
    }
}
