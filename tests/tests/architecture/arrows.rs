//! Allowed dependencies between crates, and operations that libraries must not use.

use super::source::{each_source, workspace};

fn manifest(folder: &str) -> toml::Table {
    let path = workspace().join(folder).join("Cargo.toml");
    std::fs::read_to_string(&path).expect("a manifest").parse().expect("TOML")
}

/// The dependencies of crates are the allowed ones: core depends on no plug-in, laws on no solver, solvers on no law.
/// Libraries do not read clocks or files.
#[test]
fn the_arrows_hold() {
    let ours = |folder: &str| -> Vec<String> {
        let table = manifest(folder);
        let dependencies = table["dependencies"].as_table().expect("a table").clone();
        dependencies.keys().filter(|name| name.starts_with("voussoir")).cloned().collect()
    };
    // The derive of keys belongs to the core: a proc macro must be a separate crate.
    assert_eq!(ours("core"), ["voussoir-keys-derive"]);
    assert_eq!(ours("core/keys-derive"), Vec::<String>::new());
    // Plug-ins outside of this repository see only the core, under names that stay.
    assert_eq!(ours("core/plug"), ["voussoir-core", "voussoir-keys-derive"]);
    assert_eq!(ours("laws"), ["voussoir-core"]);
    assert_eq!(ours("solvers"), ["voussoir-core"]);
    assert_eq!(ours("laws/external"), ["voussoir-core"]);
    assert_eq!(ours("studies/plot"), ["voussoir-core"]);
    assert_eq!(ours("studies/study"), ["voussoir-core", "voussoir-solvers"]);
    assert_eq!(ours("studies/verify"), ["voussoir-core", "voussoir-study"]);
    let of_report = ["voussoir-core", "voussoir-plot", "voussoir-solvers", "voussoir-study", "voussoir-verify"];
    assert_eq!(ours("studies/report"), of_report);
    // The facade names every crate.
    let own = ["core", "external", "laws", "plot", "report", "solvers", "study", "verify"];
    assert_eq!(ours("studies"), own.map(|name| format!("voussoir-{name}")));
    // Tests register their own plug-ins, as any other project would.
    assert_eq!(ours("tests"), ["voussoir", "voussoir-independent", "voussoir-core"]);
    assert_eq!(ours("tests/independent"), ["voussoir"]);
    assert_eq!(ours("benches"), ["voussoir", "voussoir-tests"]);
    for folder in ["core", "core/keys-derive", "core/plug", "laws", "solvers"] {
        each_source(&workspace().join(folder).join("src"), &mut |path, text| {
            // Long forms of unit tests print counts; the rest of a library prints nothing.
            let unit_tests = path.file_name().is_some_and(|name| name == "tests.rs");
            for word in ["println!", "eprintln!", "std::fs", "Instant::now", "SystemTime"] {
                if unit_tests && word == "println!" {
                    continue;
                }
                assert!(!text.contains(word), "{} uses {word}", path.display());
            }
        });
    }
}
