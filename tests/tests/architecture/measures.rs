//! Measures of the solvers that must not get worse: lines, import chains, large mutable structs, constants, counters.

use super::graph::Graph;
use super::source::{Source, is, workspace};
use std::collections::{BTreeMap, BTreeSet};

/// Greatest number of lines without tests: of solvers of plane scenes, and of solvers in space.
const LINES: [usize; 2] = [26_740, 5_400];
/// Greatest length of a chain of imports between files; each sub-folder counts as one file.
const CHAIN: usize = 8;
/// Least number of fields of a large struct.
const LARGE: usize = 9;
/// Greatest number of parameters of the paths that are `&mut` of a large struct.
const MUTABLE: usize = 50;
/// Greatest number of places in the paths that ask for the kind of a problem, and the words by which they ask.
const QUESTIONS: usize = 25;
const KINDS: [&[&str]; 6] = [
    &[".", "finite", "(", ")"],
    &["responses", ".", "is_empty"],
    &["blocks", ".", "is_empty"],
    &["limits", ".", "remembers"],
    &["limits", ".", "carries_any_load"],
    &["is_associated"],
];
/// Greatest number of numeric constants, and greatest number of fields of a struct of settings.
const NUMBERS: usize = 114;
const TOLERANCES: usize = 40;

fn solvers() -> Graph {
    Graph::of("solvers")
}

fn of_paths(files: &BTreeMap<Vec<String>, Source>) -> impl Iterator<Item = (&Vec<String>, &Source)> {
    files.iter().filter(|(module, _)| module.first().is_some_and(|part| part == "path"))
}

/// The solvers stay small: the number of lines of all files without tests is limited.
#[test]
fn the_solvers_stay_small() {
    let (mut lines, root) = ([0; 2], workspace().join("solvers/src"));
    super::source::each_source(&root, &mut |path, text| {
        let own = path.strip_prefix(&root).expect("a file of the solvers");
        let test =
            own.iter().any(|part| part == "tests") || own.ends_with("tests.rs") || own.ends_with("two_blocks.rs");
        if !test {
            lines[usize::from(own.starts_with("space"))] +=
                text.split("#[cfg(test)]\nmod tests {").next().map_or(0, |own| own.lines().count());
        }
    });
    assert!(lines[0] > 0 && lines.iter().zip(LINES).all(|(lines, most)| *lines <= most), "{lines:?} lines");
}

/// In each folder of the solvers the longest chain of imports has at most eight files. A sub-folder counts as one file.
#[test]
fn import_chains_are_short() {
    let edges = solvers().edges();
    let folders: BTreeSet<Vec<String>> =
        edges.keys().flat_map(|module| (0..module.len()).map(|n| module[..n].to_vec())).collect();
    for folder in folders {
        let part = |module: &Vec<String>| {
            module.starts_with(&folder).then(|| module.get(folder.len()).cloned().unwrap_or_default())
        };
        let mut own: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (from, targets) in &edges {
            let Some(from) = part(from) else { continue };
            let others = targets.iter().filter_map(part).filter(|to| *to != from && !to.is_empty());
            own.entry(from.clone()).or_default().extend(others);
        }
        let mut known = BTreeMap::new();
        let longest = own.keys().map(|from| length(&own, from, &mut known)).max().unwrap_or(0);
        assert!(longest <= CHAIN, "{}: a chain of {longest}", folder.join("/"));
    }
}

/// Returns the number of parts in the longest chain of imports from a part.
fn length(edges: &BTreeMap<String, BTreeSet<String>>, from: &String, known: &mut BTreeMap<String, usize>) -> usize {
    if let Some(found) = known.get(from) {
        return *found;
    }
    // A circle counts once.
    known.insert(from.clone(), 0);
    let beyond = edges.get(from).into_iter().flatten().map(|to| length(edges, to, known)).max().unwrap_or(0);
    known.insert(from.clone(), beyond + 1);
    beyond + 1
}

/// Few functions of the paths change a struct of many fields.
#[test]
fn few_functions_take_a_large_struct_to_change_it() {
    let files = solvers().files;
    let large: BTreeSet<String> = of_paths(&files)
        .flat_map(|(_, source)| source.structs())
        .filter(|(_, fields)| *fields >= LARGE)
        .map(|(name, _)| name)
        .collect();
    let mut places = Vec::new();
    for (module, source) in of_paths(&files) {
        let t = &source.tokens;
        for i in (0..t.len()).filter(|&i| is(t, i, "mut") && i > 0 && is(t, i - 1, "&")) {
            if t.get(i + 1).is_some_and(|name| large.contains(&name.text)) {
                places.push(format!("{}: {}", module.join("/"), t[i].line));
            }
        }
    }
    assert!(places.len() <= MUTABLE, "{} places: {large:?}", places.len());
}

/// The kind of a problem decides its limits when its system is built. Few places ask for it again.
#[test]
fn few_places_ask_for_the_kind_of_a_problem() {
    let files = solvers().files;
    let mut places = Vec::new();
    for (module, source) in of_paths(&files) {
        let t = &source.tokens;
        let asks = |i: usize, words: &[&str]| words.iter().enumerate().all(|(k, word)| is(t, i + k, word));
        let asked = (0..t.len()).filter(|&i| KINDS.iter().any(|words| asks(i, words)));
        places.extend(asked.map(|i| format!("{}: {}", module.join("/"), t[i].line)));
    }
    assert!(places.len() <= QUESTIONS, "{places:#?}");
}

/// Tolerances are fields of structs of settings with at most forty fields each, and few other constants are numbers.
#[test]
fn numbers_live_in_settings() {
    let files = solvers().files;
    let kinds = ["f64", "usize", "u8", "u16", "u32", "u64", "i32", "i64"];
    let mut numbers = 0;
    for source in files.values() {
        let t = &source.tokens;
        let constant = |i: usize| is(t, i, "const") && is(t, i + 2, ":");
        let number = |i: usize| kinds.iter().any(|kind| is(t, i, kind) || is(t, i, "[") && is(t, i + 1, kind));
        numbers += (0..t.len()).filter(|&i| constant(i) && number(i + 3)).count();
    }
    assert!(numbers <= NUMBERS, "{numbers} constants");
    for (module, source) in files.iter().filter(|(module, _)| module.last().is_some_and(|part| part == "settings")) {
        for (name, fields) in source.structs() {
            assert!(fields <= TOLERANCES, "{}::{name}: {fields} fields", module.join("::"));
        }
    }
}

/// Counters of a report do not control any algorithm: no solver reads them.
#[test]
fn no_solver_reads_its_counters() {
    for (module, source) in solvers().files {
        let t = &source.tokens;
        for i in (0..t.len()).filter(|&i| is(t, i, "counters")) {
            let read = is(t, i + 1, "[") || is(t, i + 1, ".") && (is(t, i + 2, "get") || is(t, i + 2, "contains_key"));
            assert!(!read, "{}: {}", module.join("/"), t[i].line);
        }
    }
}
