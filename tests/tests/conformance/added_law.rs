//! The law of docs/adding_a_law.md: the page shows the file that is compiled here, and every solver supports the law.

use std::path::Path;
use voussoir_tests::{Arch, answered, assert_close, crushing, elastic};

/// The page shows the compiled file; `UPDATE_EXPECTED=1` copies the file to the page.
#[test]
fn the_page_shows_the_law_that_is_compiled() {
    let law = include_str!("capped_friction.rs");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/adding_a_law.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let start = page.find("```rust\n").expect("its example") + "```rust\n".len();
    let end = start + page[start..].find("```").expect("the end of it");
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, format!("{}{law}{}", &page[..start], &page[end..])).expect("written");
    } else {
        assert_eq!(&page[start..end], law, "UPDATE_EXPECTED=1 copies the file to the page");
    }
}

/// With this law limit analysis and both path solvers give the same results as with the same facets of `mohr_coulomb`.
#[test]
fn every_solver_takes_the_added_law() {
    let added = "law = \"capped_friction\"\nfriction = 0.6\ncompressive_strength = 1e7".to_string();
    let known = crushing(0.6, 1e7);
    for solver in ["limit_chain", "limit_conic", "event_path", "newton_path"] {
        let material = if solver.ends_with("path") { elastic(5e9, 0.3) } else { "law = \"rigid\"".into() };
        let arch = Arch { material, mesh: "elements = [1, 2]".into(), solver, voussoirs: 9, ..Arch::default() };
        let [added, known] = [&added, &known].map(|joint| {
            let result = answered(&Arch { joint: joint.clone(), ..arch.clone() }.study());
            assert!(result.certificate.passed, "{solver}: {:?} {:?}", result.certificate, result.notes);
            result.load_factor.expect("a factor")
        });
        assert_close(added, known, 1e-12);
    }
}
