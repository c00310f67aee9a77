//! Pages: the study of the README gives the numbers shown, links have targets, and paragraphs are short.

use std::path::{Path, PathBuf};
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::solve::solve_case;
use voussoir_tests::{assert_close, study};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns README.md, docs/*.md and the index of studies: name and text.
fn pages() -> Vec<(PathBuf, String)> {
    let docs = std::fs::read_dir(root().join("docs")).expect("docs").map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<PathBuf> = docs.filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    paths.extend(["README.md", "studies/cases/README.md"].map(|name| root().join(name)));
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), std::fs::read_to_string(path).expect("a page"))).collect()
}

/// Returns the first block of code in a language.
fn block<'a>(page: &'a str, language: &str) -> &'a str {
    let start = page.find(&format!("```{language}\n")).expect("a block") + language.len() + 4;
    &page[start..start + page[start..].find("```").expect("its end")]
}

/// Returns true if a page shows the number, within half a unit of its last digit.
fn is_shown(shown: &str, value: f64) -> bool {
    let digits = shown.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
    let number: f64 = shown.parse().expect("a number");
    (number - value).abs() <= 0.5000001 * 10f64.powi(-digits)
}

/// Every number of the README's table is the result of its study; the study is that of the first command.
#[test]
fn the_study_of_the_readme_gives_its_numbers() {
    let page = std::fs::read_to_string(root().join("README.md")).expect("the README");
    let text = block(&page, "toml");
    let cases = study(text).cases;
    let first_command = std::fs::read_to_string(root().join("studies/cases/strathmashie_rise.toml")).expect("a study");
    let others = study(&first_command).cases;
    assert_eq!(cases.len(), others.len());
    let results: Vec<CaseResult> = cases.iter().map(solve_case).collect();
    for (result, other) in results.iter().zip(&others) {
        assert!(result.certificate.passed);
        let other = solve_case(other);
        assert_eq!((&result.label.parameters, result.status), (&other.label.parameters, other.status));
        if let (Some(factor), Some(same)) = (result.load_factor, other.load_factor) {
            assert_close(factor, same, 1e-12);
        }
    }
    let (mut shown, mut lines) = (0, page.lines());
    lines.find(|line| line.starts_with("| rise [m] |")).expect("the table");
    for line in lines.skip(1).take_while(|line| line.starts_with('|')) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let rise: f64 = cells[0].parse().expect("a rise");
        for (cell, variant) in cells[1..].iter().zip(["unlimited strength", "10 MPa"]) {
            let found = results.iter().find(|result| {
                let value = result.label.parameters["scene.profile.rise"].as_f64().expect("a number");
                result.label.variant.as_deref() == Some(variant) && (value - rise).abs() < 1e-9
            });
            let found = found.unwrap_or_else(|| panic!("no case of rise {rise}, {variant}"));
            shown += 1;
            match found.load_factor {
                Some(factor) => assert!(is_shown(cell, factor), "{line}: {factor}"),
                None => assert_eq!((found.status, *cell), (Status::Unbounded, "unbounded"), "{line}"),
            }
        }
    }
    assert_eq!(shown, 12);
}

/// Links between files of the project have existing files and headings as targets.
#[test]
fn links_lead_somewhere() {
    let anchor = |heading: &str| -> String {
        let kept = heading.trim_start_matches('#').trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.collect::<String>().to_lowercase().replace(' ', "-")
    };
    let mut seen = 0;
    for (path, page) in pages() {
        let prose: String = page.split("```").step_by(2).collect();
        for link in prose.split("](").skip(1).map(|rest| &rest[..rest.find(')').expect("an end")]) {
            if link.starts_with("http") {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { path.clone() } else { path.parent().expect("a folder").join(file) };
            assert!(target.exists(), "{}: {link}", path.display());
            if !heading.is_empty() {
                let text = std::fs::read_to_string(&target).expect("a page");
                let there = text.lines().filter(|line| line.starts_with('#')).any(|line| anchor(line) == heading);
                assert!(there, "{}: {link}", path.display());
            }
            seen += 1;
        }
    }
    assert!(seen > 30, "{seen}");
}

/// The README has at most 130 lines, and no paragraph of any page has more than 500 characters.
#[test]
fn pages_can_be_read() {
    let mut long = Vec::new();
    for (path, page) in pages() {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.parent() == Some(&root()) {
            assert!(page.lines().count() <= 130, "{name}: {} lines", page.lines().count());
        }
        let prose = page.split("```").step_by(2).flat_map(|text| text.split("\n\n"));
        for paragraph in prose.flat_map(|text| text.split("\n- ")).filter(|text| !text.trim().starts_with('|')) {
            let length = paragraph.trim().chars().count();
            if length > 500 {
                let start: String = paragraph.trim().chars().take(60).collect();
                long.push(format!("{name}: {length} characters: {start} …"));
            }
        }
    }
    assert!(long.is_empty(), "{}", long.join("\n"));
}
