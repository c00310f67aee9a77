//! Links of the pages lead to existing files and headings.

use super::source::workspace;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// Pages outside `docs/` that readers open separately.
const PAGES: [&str; 7] = [
    "README.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "CHANGELOG.md",
    "studies/cases/README.md",
    "studies/python/README.md",
    "studies/examples/my_law/README.md",
];

/// Removes `.` and `name/..` from a path.
fn plain(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if out.file_name().is_some() => {
                out.pop();
            }
            Component::CurDir => {}
            other => out.push(other),
        }
    }
    out
}

/// The text without blocks of code and without code in quotes.
fn prose(text: &str) -> String {
    let mut fenced = false;
    let mut out = String::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            line.split('`').enumerate().for_each(|(place, part)| out.push_str(if place % 2 == 0 { part } else { "x" }));
        }
        out.push('\n');
    }
    out
}

/// Targets of the links of a page.
fn links(text: &str) -> Vec<String> {
    prose(text).split("](").skip(1).filter_map(|after| Some(after.split_once(')')?.0.trim().to_string())).collect()
}

/// Anchors of the headings of a page: small letters, digits and hyphens, a hyphen for each space.
fn anchors(text: &str) -> Vec<String> {
    let mut fenced = false;
    let mut out: Vec<String> = Vec::new();
    for line in text.lines() {
        fenced ^= line.starts_with("```");
        if fenced || !line.starts_with('#') {
            continue;
        }
        let heading = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        let anchor: String = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_')).collect();
        let again = out.iter().filter(|other| **other == anchor).count();
        out.push(if again == 0 { anchor } else { format!("{anchor}-{again}") });
    }
    out
}

/// The pages of a folder and its folders.
fn pages_below(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let pages = files.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    pages.chain(folders.iter().flat_map(|folder| pages_below(folder))).collect()
}

/// Every link of a page to a file of the project leads to a file, and to a heading if it names one.
#[test]
fn links_lead_somewhere() {
    let root = workspace();
    let mut pages: BTreeMap<PathBuf, String> = BTreeMap::new();
    let mut read = |path: PathBuf| pages.insert(path.clone(), std::fs::read_to_string(&path).expect("a page"));
    PAGES.iter().for_each(|page| drop(read(root.join(page))));
    pages_below(&root.join("docs")).into_iter().for_each(|page| drop(read(page)));
    let mut dead = Vec::new();
    for (page, text) in &pages {
        for link in links(text).iter().filter(|link| !link.contains(':')) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let to = if file.is_empty() { page.clone() } else { plain(&page.parent().unwrap_or(&root).join(file)) };
            let known = |text: &str| anchor.is_empty() || anchors(text).iter().any(|own| own == anchor);
            let leads =
                to.exists() && (anchor.is_empty() || std::fs::read_to_string(&to).is_ok_and(|text| known(&text)));
            if !leads {
                dead.push(format!("{}: {link}", plain(page).display()));
            }
        }
    }
    assert!(dead.is_empty(), "{} dead links:\n{}", dead.len(), dead.join("\n"));
    assert!(pages.len() > 20, "{} pages", pages.len());
}

#[test]
fn links_and_anchors_are_read() {
    assert_eq!(links("see [a](b.md) and ![c](d.svg#e) but not `[f](g)`"), ["b.md", "d.svg#e"]);
    assert_eq!(
        anchors("# One, two\n```\n# code\n```\n## Three `x` 4\n## One, two\n"),
        ["one-two", "three-x-4", "one-two-1"]
    );
    assert_eq!(plain(Path::new("a/../b/./c")), Path::new("b/c"));
}
