//! Packages can be published: they are complete, and have correct versions, licences and pinned tools.

use super::source::{each_source, workspace};
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

/// The output of `cargo metadata` in a workspace.
fn metadata(folder: &Path) -> Json {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["metadata", "--format-version", "1", "--locked", "--offline", "--filter-platform"];
    let output = Command::new(cargo).args(arguments).arg("x86_64-unknown-linux-gnu").current_dir(folder).output();
    let output = output.expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn text<'a>(value: &'a Json, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

/// Packages of the workspace that are published, with their folders.
fn published(metadata: &Json) -> Vec<(&Json, PathBuf)> {
    let members: BTreeSet<&str> =
        metadata["workspace_members"].as_array().expect("a list").iter().filter_map(Json::as_str).collect();
    let packages = metadata["packages"].as_array().expect("a list").iter();
    packages
        .filter(|package| members.contains(text(package, "id")) && package["publish"].is_null())
        .map(|package| (package, Path::new(text(package, "manifest_path")).parent().expect("a folder").to_path_buf()))
        .collect()
}

/// Returns the number of examples in the comments of a file: code without a language, or in Rust.
fn examples(text: &str) -> usize {
    let comment = |line: &str| line.trim_start().trim_start_matches("//!").trim_start_matches("///").trim().to_string();
    let fences = text.lines().map(comment).filter(|line| line.starts_with("```"));
    // Every second fence closes.
    fences.step_by(2).filter(|fence| ["```", "```rust", "```no_run", "```compile_fail"].contains(&&**fence)).count()
}

/// Crates whose examples are not tested have none.
#[test]
fn crates_without_documentation_tests_have_no_examples() {
    let metadata = metadata(&workspace());
    let list = |value: &Json| value.as_array().expect("a list").clone();
    let mut tested = 0;
    for package in list(&metadata["packages"]).iter().filter(|package| package["source"].is_null()) {
        let folder = Path::new(text(package, "manifest_path")).parent().expect("a folder").join("src");
        let is_tested = list(&package["targets"]).iter().any(|target| target["doctest"] == true);
        let mut found = 0;
        each_source(&folder, &mut |_, text| found += examples(text));
        assert!(is_tested || found == 0, "{}: {found} examples, but doctest = false", text(package, "name"));
        tested += usize::from(is_tested);
    }
    assert_eq!(tested, 3, "core, plug and the command line have examples");
}

/// The path without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        if part == Component::ParentDir {
            out.pop();
        } else {
            out.push(part);
        }
    }
    out
}

/// Every published crate has the metadata that crates.io requires, its licences, and the versions of the project's crates that it needs.
#[test]
fn crates_can_be_published() {
    let metadata = metadata(&workspace());
    let crates = published(&metadata);
    assert!(crates.len() >= 5, "{} crates", crates.len());
    let version = text(crates[0].0, "version");
    for (package, folder) in &crates {
        let name = text(package, "name");
        for key in ["description", "license", "readme"] {
            assert!(!text(package, key).is_empty(), "{name}: no {key}");
        }
        for key in ["keywords", "categories"] {
            assert!(package[key].as_array().is_some_and(|words| (1..=5).contains(&words.len())), "{name}: {key}");
        }
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(folder.join(licence).exists(), "{name}: no {licence}");
        }
        assert_eq!(text(package, "version"), version, "{name}");
        for needed in package["dependencies"].as_array().expect("a list") {
            if needed["path"].is_string() && needed["kind"] != "dev" {
                assert_eq!(text(needed, "req"), format!("^{version}"), "{name}: {}", text(needed, "name"));
            }
        }
    }
    assert!(workspace().join("studies/report/LICENSE-DEJAVU").exists(), "the font of PNG has its licence");
}

/// Files that a crate includes when it is compiled are in its package: below its folder and in no crate inside it.
#[test]
fn packages_hold_what_they_include() {
    let metadata = metadata(&workspace());
    let mut missing = Vec::new();
    for (_, folder) in published(&metadata) {
        let root = plain(&folder);
        each_source(&folder.join("src"), &mut |path, source| {
            // A page whose examples are tested is not part of the program.
            let compiled = source.split("#[cfg(doctest)]").next().unwrap_or_default();
            for after in ["include_str!(\"", "include_bytes!(\""].iter().flat_map(|word| compiled.split(word).skip(1)) {
                let name = after.split('"').next().unwrap_or_default();
                let file = plain(&path.parent().expect("a folder").join(name));
                let own = file.ancestors().skip(1).find(|above| above.join("Cargo.toml").exists());
                if own != Some(root.as_path()) {
                    missing.push(format!("{}: {name}", path.display()));
                }
            }
        });
    }
    assert!(missing.is_empty(), "not in the package:\n{}", missing.join("\n"));
}

/// Files outside a package that the program includes are copied into it: the files of the example, which `voussoir new` writes,
/// and the glossary.
#[test]
fn copies_are_up_to_date() {
    let read = |path: &str| std::fs::read_to_string(workspace().join(path)).expect("a file");
    for (copy, original) in [
        ("templates/keyed.rs", "studies/examples/my_law/src/keyed.rs"),
        ("templates/keyed.md", "studies/examples/my_law/src/keyed.md"),
        ("templates/test.rs", "studies/examples/my_law/tests/keyed.rs"),
        ("templates/study.rs", "studies/examples/my_law/tests/study.rs"),
        ("templates/main.rs", "studies/examples/my_law/src/main.rs"),
        ("templates/keyed.toml", "studies/examples/my_law/keyed.toml"),
        ("templates/gitignore", "studies/examples/my_law/.gitignore"),
        ("templates/fnv.rs", "studies/study/src/fnv.rs"),
        ("study/templates/glossary.md", "docs/reference/glossary.md"),
    ] {
        let copy = format!("studies/{copy}");
        assert!(read(&copy) == read(original), "cp {original} {copy}");
    }
}

/// `rust-version` is the greatest version that a dependency requires, or a later one; lints (`incompatible_msrv`) check our own code.
#[test]
fn the_oldest_supported_rust_is_true() {
    let number = |version: &str| -> Vec<u32> {
        let mut parts: Vec<u32> = version.split('.').map(|part| part.parse().expect("a number")).collect();
        parts.resize(3, 0);
        parts
    };
    let metadata = metadata(&workspace());
    let packages = metadata["packages"].as_array().expect("a list").iter();
    let own = packages.clone().find(|package| package["name"] == "voussoir").expect("the crate");
    let stated = text(own, "rust_version");
    let newer: Vec<String> = packages
        .filter(|package| package["rust_version"].is_string())
        .filter(|package| number(text(package, "rust_version")) > number(stated))
        .map(|package| format!("{} needs {}", text(package, "name"), text(package, "rust_version")))
        .collect();
    assert!(newer.is_empty(), "rust-version is {stated}, but {}", newer.join(", "));
}

/// Everything that CI and the workflow install has an exact version: Python packages, npm packages, actions by their commit.
#[test]
fn tools_of_ci_have_exact_versions() {
    let mut loose = Vec::new();
    let mut seen = 0;
    let mut exact = |place: &str, word: &str, good: bool| {
        seen += 1;
        if !good {
            loose.push(format!("{place}: {word}"));
        }
    };
    let root = workspace();
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in [".ci", ".github/workflows"] {
        files
            .extend(std::fs::read_dir(root.join(folder)).expect("a folder").map(|entry| entry.expect("a file").path()));
    }
    for path in files {
        let place = path.strip_prefix(&root).unwrap_or(&path).display().to_string();
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        for line in text.replace("\\\n", " ").lines().map(str::trim).filter(|line| !line.starts_with('#')) {
            if path.extension().is_some_and(|ending| ending == "txt") {
                exact(&place, line, line.is_empty() || line.contains("=="));
            }
            if let Some(after) = line.split("pip\" install").nth(1).or_else(|| line.split("pip install").nth(1)) {
                let packages = after.split("&&").next().unwrap_or_default().split_whitespace();
                for word in packages.filter(|word| !word.starts_with('-') && !word.contains(['/', '$', '*'])) {
                    exact(&place, word, word.contains("=="));
                }
            }
            for word in line.split_whitespace().filter(|word| word.starts_with("puppeteer-core@")) {
                exact(&place, word, word.matches('.').count() == 2);
            }
            if let Some(action) = line.trim_start_matches("- ").strip_prefix("uses: ") {
                let commit = action.split('@').nth(1).and_then(|after| after.split(' ').next()).unwrap_or_default();
                exact(&place, action, commit.len() == 40 && commit.chars().all(|c| c.is_ascii_hexdigit()));
            }
            if line.contains("cargo install") && !line.contains("--path") {
                exact(&place, line, line.contains("--version") || line.contains('@'));
            }
        }
    }
    assert!(loose.is_empty(), "without an exact version:\n{}", loose.join("\n"));
    assert!(seen >= 10, "{seen} tools");
}
