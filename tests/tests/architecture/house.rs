//! Circular imports between the files of a crate, and limits on the size of its parts.
//!
//! Set `HOUSE=/another/workspace` to check another tree.

use super::graph::Graph;
use std::collections::{BTreeMap, BTreeSet};

/// Crates without circular imports between files.
const CRATES: [&str; 10] = [
    "core",
    "core/plug",
    "laws",
    "laws/external",
    "solvers",
    "studies/plot",
    "studies/study",
    "studies/verify",
    "studies/report",
    "studies",
];

/// Crates with the mechanics: small functions, types in few files.
const MECHANICS: [&str; 2] = ["core", "solvers"];

/// Functions of 81 to 120 lines, with the reason why each is not divided: (function, file, reason).
const LONG_FUNCTIONS: [(&str, &str, &str); 0] = [];

/// Asserts that nothing was found, or lists all of it.
fn nothing(found: &[String]) {
    for line in found {
        println!("{line}");
    }
    assert!(found.is_empty(), "{} found:\n{}", found.len(), found.join("\n"));
}

/// No crate with mechanics reads an environment variable: results depend on the study alone.
#[test]
fn results_do_not_depend_on_environment_variables() {
    let mut found = Vec::new();
    for krate in ["core", "laws", "solvers"] {
        for (module, source) in Graph::of(krate).files {
            let texts: Vec<&str> = source.tokens.iter().map(|token| token.text.as_str()).collect();
            for (at, _) in
                texts.windows(4).enumerate().filter(|(_, part)| matches!(part, ["env", ":", ":", "var" | "var_os"]))
            {
                found.push(format!("{krate}/src/{}.rs:{}", module.join("/"), source.tokens[at].line));
            }
        }
    }
    nothing(&found);
}

/// No two files of a crate import each other, directly or in a circle. A name re-exported by a parent counts as the
/// file that defines it; paths from `crate`, `super`, `self` and a child module count.
#[test]
fn no_files_import_each_other_in_a_circle() {
    let mut found = Vec::new();
    for krate in CRATES {
        let circles = Graph::of(krate).circles();
        found.extend(circles.iter().map(|circle| format!("{krate}: {} files: {}", circle.len(), circle.join(", "))));
    }
    nothing(&found);
}

/// No two folders directly below `src` import each other, directly or in a circle.
#[test]
fn no_folders_import_each_other_in_a_circle() {
    let mut found = Vec::new();
    for krate in CRATES {
        let circles = Graph::of(krate).folder_circles();
        found.extend(circles.iter().map(|circle| format!("{krate}: {} folders: {}", circle.len(), circle.join(", "))));
    }
    nothing(&found);
}

/// No type has methods in more than three files; methods of traits count.
#[test]
fn no_type_has_methods_in_more_than_three_files() {
    let mut found = Vec::new();
    for krate in MECHANICS {
        let graph = Graph::of(krate);
        let mut places: BTreeMap<_, (BTreeSet<_>, usize)> = BTreeMap::new();
        for (module, source) in &graph.files {
            for (path, methods) in source.impls().into_iter().filter(|(_, methods)| *methods > 0) {
                if let Some(home) = graph.definition(module, &path) {
                    let name = path[path.len() - 1].clone();
                    let (files, all) = places.entry((home, name)).or_default();
                    files.insert(module.join("/"));
                    *all += methods;
                }
            }
        }
        for ((home, name), (files, methods)) in places.iter().filter(|(_, (files, _))| files.len() > 3) {
            let list = files.iter().cloned().collect::<Vec<_>>().join(", ");
            found.push(format!("{krate} {}::{name}: {methods} methods in {}: {list}", home.join("::"), files.len()));
        }
    }
    nothing(&found);
}

/// No struct of the paths has more than twelve fields.
#[test]
fn no_struct_of_the_paths_has_more_than_twelve_fields() {
    let mut found = Vec::new();
    for (module, source) in Graph::of("solvers").files {
        if module.first().is_some_and(|part| part == "path") {
            let large = source.structs().into_iter().filter(|(_, fields)| *fields > 12);
            found.extend(large.map(|(name, fields)| format!("{}::{name}: {fields} fields", module.join("::"))));
        }
    }
    nothing(&found);
}

/// No function is longer than 80 lines, except for at most five functions of at most 120 lines, listed with the reason.
#[test]
fn no_function_is_longer_than_eighty_lines() {
    assert!(LONG_FUNCTIONS.len() <= 5);
    let (mut found, mut used) = (Vec::new(), BTreeSet::new());
    for krate in MECHANICS {
        for (module, source) in Graph::of(krate).files {
            for (name, lines) in source.functions().into_iter().filter(|(_, lines)| *lines > 80) {
                let place = format!("{krate}/{}", module.join("/"));
                let listed = LONG_FUNCTIONS.iter().position(|(function, file, _)| *function == name && *file == place);
                match listed {
                    Some(entry) if lines <= 120 => drop(used.insert(entry)),
                    _ => found.push(format!("{place}: {name}: {lines} lines")),
                }
            }
        }
    }
    let idle = (0..LONG_FUNCTIONS.len()).filter(|entry| !used.contains(entry));
    found.extend(idle.map(|entry| format!("{}: no longer an exception", LONG_FUNCTIONS[entry].0)));
    nothing(&found);
}
