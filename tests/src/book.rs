//! The book: the pages of `docs/` and generated pages. Cards give the pages of plug-ins, the schema gives the keys of a
//! study file, and the tests give the table of verification, so that these pages are always up to date.

pub mod gallery;

use serde_json::{Map, Value as Json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use voussoir::core::plugin::{Card, Need, Parameter, PluginKind, Shape, cards_of};
use voussoir::kinds::json_schema;

/// Root of the tree.
fn tree() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Chapters by part: file and title. Pages of `docs/` and generated ones.
const PARTS: [(&str, &[(&str, &str)]); 6] = [
    (
        "Tutorials",
        &[
            ("tutorials/first_bridge.md", "From nothing to an assessed bridge"),
            ("tutorials/first_law.md", "Your first law"),
            ("tutorials/two_flow_rules.md", "Compare two flow rules"),
            ("tutorials/flow_rules_in_space.md", "Compare flow rules in space"),
            ("gallery.md", "Gallery"),
        ],
    ),
    (
        "How to",
        &[
            ("how_to/surveyed_bridge.md", "Assess a surveyed bridge"),
            ("how_to/settlements.md", "Move supports"),
            ("how_to/rise_abutments.md", "Let abutments move"),
            ("how_to/rise_fill.md", "Find the best rise with fill"),
            ("how_to/rise_softening.md", "Find the best rise of softening stone"),
            ("how_to/walls.md", "Describe a wall"),
            ("how_to/space.md", "Analyse blocks in space"),
            ("how_to/seismic.md", "Check a mechanism under earthquakes"),
            ("how_to/drawings.md", "Use a drawing as scene"),
            ("how_to/one_point.md", "Test a law at one point"),
            ("how_to/best_shape.md", "Find the best shape"),
            ("how_to/own_solver.md", "Write a solver"),
            ("how_to/clusters.md", "Run a sweep on a cluster"),
            ("how_to/pandas.md", "Read results with pandas"),
            ("how_to/compare_runs.md", "Compare two runs"),
            ("how_to/reports.md", "Write a report"),
        ],
    ),
    (
        "Reference",
        &[
            ("reference/command_line.md", "Command line"),
            ("reference/study_files.md", "Study files"),
            ("reference/keys.md", "Every key"),
            ("reference/scenes.md", "Scenes and loads"),
            ("reference/laws.md", "Laws of joints"),
            ("reference/materials.md", "Materials"),
            ("reference/solvers.md", "Solvers"),
            ("reference/outputs.md", "Study kinds and writers"),
            ("reference/statuses.md", "Statuses and results"),
            ("reference/space_data.md", "Data of blocks in space"),
            ("reference/python.md", "Python"),
            ("reference/library.md", "Rust"),
            ("performance.md", "Performance"),
            ("reference/glossary.md", "Glossary"),
        ],
    ),
    (
        "Theory",
        &[
            ("theory/limit_analysis.md", "Limit analysis"),
            ("theory/space.md", "Limit analysis in space"),
            ("theory/flow_rule.md", "Non-associated friction"),
            ("theory/sensitivities.md", "Sensitivities of limit loads"),
            ("theory/carried_loads.md", "Loads that are carried"),
            ("theory/event_paths.md", "Elastic paths from event to event"),
            ("theory/paths.md", "Ends of a path and limit points"),
            ("theory/finite_displacements.md", "Finite displacements"),
            ("theory/crushing.md", "Crushing"),
            ("theory/softening.md", "Softening joints"),
            ("theory/bridges.md", "Bridges and fill"),
            ("theory/accuracy.md", "Error estimates"),
            ("theory/verifying.md", "Certificates and verification"),
        ],
    ),
    (
        "Development",
        &[
            ("architecture.md", "Architecture"),
            ("adding_a_law.md", "Adding a law"),
            ("adding_plug_ins.md", "Adding other plug-ins"),
            ("stability.md", "Stability of plug-ins"),
            ("reference/conformance.md", "Conformance"),
            ("reference/verification.md", "Every test"),
        ],
    ),
    (
        "Notebook",
        &[
            ("notebook/random_scenes.md", "Random scenes"),
            ("notebook/performance.md", "Timings"),
            ("notebook/paths.md", "Paths in pieces"),
            ("notebook/finite_displacements.md", "Finite displacements"),
            ("notebook/flow_rule.md", "Lower ends of walls"),
            ("notebook/bridges.md", "Random bridges"),
            ("notebook/space.md", "Blocks in space"),
            ("notebook/verifying.md", "Attacks on results"),
            ("notebook/clusters.md", "Sweeps on several machines"),
        ],
    ),
];

/// Generated pages of plug-ins: file, title, kinds of plug-ins.
const PLUGINS: [(&str, &str, &[PluginKind]); 5] = [
    ("reference/laws.md", "Laws of joints", &[PluginKind::InterfaceLaw]),
    ("reference/materials.md", "Materials", &[PluginKind::BulkMaterial]),
    ("reference/solvers.md", "Solvers", &[PluginKind::LimitSolver, PluginKind::PathSolver, PluginKind::Continuation]),
    (
        "reference/scenes.md",
        "Scenes and loads",
        &[PluginKind::Scene, PluginKind::LoadKind, PluginKind::Dispersion, PluginKind::FillResistance],
    ),
    ("reference/outputs.md", "Study kinds and writers", &[PluginKind::StudyKind, PluginKind::Writer]),
];

/// Returns the sources of the book by file name, without figures: links lead to the files below `docs/`, and
/// [`gallery`] names the figures that the program `book` draws.
pub fn book() -> BTreeMap<String, String> {
    let docs = tree().join("docs");
    let mut files = Vec::new();
    collect(&docs, &mut files);
    let name = |path: &Path| path.strip_prefix(&docs).expect("below docs").to_string_lossy().replace('\\', "/");
    let with = |ending: &'static str| {
        files
            .iter()
            .filter(move |path| path.extension().is_some_and(|found| found == ending))
            .map(|path| path.as_path())
    };
    let mut pages: BTreeMap<String, String> =
        with("md").map(|path| (name(path), std::fs::read_to_string(path).expect("a page"))).collect();
    pages.insert("index.md".into(), std::fs::read_to_string(tree().join("README.md")).expect("the README"));
    for (file, title, kinds) in PLUGINS {
        pages.insert(file.into(), plugins(title, kinds));
    }
    pages.insert("reference/keys.md".into(), keys());
    pages.insert("reference/verification.md".into(), verification());
    pages.insert("gallery.md".into(), gallery::page());
    let known: BTreeSet<String> =
        pages.keys().cloned().chain(with("svg").map(name)).chain(gallery::figures()).collect();
    pages.iter_mut().for_each(|(file, page)| *page = own_links(file, page, &known));
    let summary = summary(&pages);
    pages.insert("SUMMARY.md".into(), summary);
    pages
}

fn summary(pages: &BTreeMap<String, String>) -> String {
    let mut text = "# Summary\n\n[Voussoir](index.md)\n".to_string();
    for (part, chapters) in PARTS {
        text += &format!("\n# {part}\n\n");
        chapters.iter().for_each(|(file, title)| text += &format!("- [{title}]({file})\n"));
    }
    // Pages that no part lists yet, with their own headings.
    let listed =
        |file: &str| file == "index.md" || PARTS.iter().any(|(_, all)| all.iter().any(|(own, _)| *own == file));
    let mut more = pages.iter().filter(|(file, _)| !listed(file)).peekable();
    if more.peek().is_some() {
        text += "\n# More\n\n";
    }
    for (file, page) in more {
        let heading = page.lines().next().unwrap_or(file).trim_start_matches('#').trim();
        text += &format!("- [{heading}]({file})\n");
    }
    text
}

/// Returns the file of the book for a link of a page.
pub fn target(page: &str, link: &str) -> String {
    let file = link.split('#').next().unwrap_or_default();
    if let Some((_, below)) = file.rsplit_once("docs/") {
        return below.to_string();
    }
    let mut parts: Vec<&str> = page.split('/').collect();
    parts.pop();
    for part in file.split('/') {
        match part {
            ".." => drop(parts.pop()),
            "." => {}
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// Keeps links between pages and to figures. Replaces other links into the tree by the name of the file.
fn own_links(file: &str, page: &str, known: &BTreeSet<String>) -> String {
    let mut text = String::new();
    let mut rest = page;
    while let Some(at) = rest.find("](") {
        let (before, after) = rest.split_at(at + 2);
        let Some(end) = after.find(')') else { break };
        let link = &after[..end];
        let target = target(file, link);
        if link.contains(':') || link.starts_with('#') {
            text += &format!("{before}{link})");
        } else if known.contains(&target) {
            let up = "../".repeat(file.matches('/').count());
            let heading = link.split_once('#').map_or(String::new(), |(_, heading)| format!("#{heading}"));
            text += &format!("{before}{up}{target}{heading})");
        } else {
            let opened = before.rfind('[').unwrap_or(0);
            text += &before[..opened];
            text += &format!("{} (`{}`)", &before[opened + 1..before.len() - 2], link.trim_start_matches("../"));
        }
        rest = &after[end + 1..];
    }
    text + rest
}

fn plugins(title: &str, kinds: &[PluginKind]) -> String {
    let mut text = format!("# {title}\n\nFrom the cards of the plug-ins, as `voussoir explain TAG` prints them.\n");
    for kind in kinds {
        if kinds.len() > 1 {
            let plural = kind.plural().replace('_', " ");
            text += &format!("\n## {}{}\n", plural[..1].to_uppercase(), &plural[1..]);
        }
        for card in cards_of(*kind) {
            text += &of_card(card, kind.tag_key());
        }
    }
    text
}

fn of_card(card: &Card, key: &str) -> String {
    let mut text = format!("\n### `{}`\n\n`{key} = \"{}\"`: {}.\n", card.tag, card.tag, card.summary);
    if !card.parameters.is_empty() {
        text += "\n| key | unit | | |\n|---|---|---|---|\n";
        card.parameters.iter().for_each(|parameter| text += &row(parameter));
    }
    // The heading of the page is the tag, which is already above.
    let page = card.page.trim_start();
    let body = if page.starts_with('#') { page.split_once('\n').map_or("", |(_, body)| body) } else { page };
    format!("{text}\n{}\n", body.trim())
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

fn row(parameter: &Parameter) -> String {
    let unit = match &parameter.shape {
        Shape::Number(quantity, range) => format!("{} ({})", quantity.unit(), range.describe()).trim().to_string(),
        Shape::Choice(words) => words.join(", "),
        _ => String::new(),
    };
    let need = match parameter.need {
        Need::Required => "required".into(),
        Need::Optional(otherwise) => format!("if absent: {otherwise}"),
        Need::Default(value) => format!("default {value}"),
    };
    format!("| `{}` | {} | {} | {} |\n", parameter.name, cell(&unit), cell(parameter.doc), cell(&need))
}

fn keys() -> String {
    let schema = json_schema();
    let mut text =
        "# Every key\n\nFrom the JSON Schema that `voussoir schema` prints. A list in a list of tables is written \
                    `[[stages]]`; tables that name a plug-in have its keys besides.\n"
            .to_string();
    for (definition, title) in
        [("study", "A study with a scene"), ("point_study", "kind = \"point\""), ("report_study", "kind = \"report\"")]
    {
        text += &format!("\n## {title}\n\n| key | type | |\n|---|---|---|\n");
        text += &key_rows(&schema["$defs"][definition], "");
    }
    text
}

fn key_rows(schema: &Json, prefix: &str) -> String {
    let empty = Map::new();
    let mut text = String::new();
    for (key, value) in schema["properties"].as_object().unwrap_or(&empty) {
        let path = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
        let doc = value["description"].as_str().unwrap_or_default();
        let default = match &value["default"] {
            Json::Null | Json::Object(_) => String::new(),
            default => format!("; default `{default}`"),
        };
        text += &format!("| `{path}` | {} | {}{} |\n", shape_word(value), cell(doc), cell(&default));
        text += &key_rows(value, &path);
        text += &key_rows(&value["items"], &format!("{path}[]"));
        text += &key_rows(&value["additionalProperties"], &format!("{path}.NAME"));
    }
    text
}

fn shape_word(value: &Json) -> String {
    if let Some(to) = value["$ref"].as_str() {
        return to.trim_start_matches("#/$defs/").replace('_', " ");
    }
    if let Some(any) = value["anyOf"].as_array() {
        let mut words: Vec<String> = any.iter().map(shape_word).collect();
        words.dedup();
        return words.join(" or ");
    }
    if let Some(words) = value["enum"].as_array() {
        return words
            .iter()
            .map(|word| format!("`{}`", word.as_str().unwrap_or_default()))
            .collect::<Vec<_>>()
            .join(", ");
    }
    value["type"].as_str().unwrap_or("any").to_string()
}

/// The purpose of each folder of tests.
const FOLDERS: [(&str, &str); 8] = [
    ("verification", "somebody else's answers: closed forms, published numbers, independent programs"),
    ("invariance", "what must not matter: units, places, mirror images, numbering"),
    ("conformance", "what every plug-in must keep, and laws with faults that must be found"),
    ("stress", "random scenes"),
    ("files", "what is written and read back, and forged results"),
    ("messages", "wrong input, word for word"),
    ("regression", "our own last answers and counts of work"),
    ("architecture", "the house"),
];

fn verification() -> String {
    let mut text = "# Every test\n\nFrom the tests themselves: what each proves, whose number it is held against as far as its own \
                    words say so (else the head of its file does), and the widest relative difference that it lets pass where it compares \
                    numbers with `assert_close`. Long forms, which are run by hand, are marked so.\n"
        .to_string();
    for (folder, kind) in FOLDERS {
        text += &format!("\n## {}{}: {kind}\n", folder[..1].to_uppercase(), &folder[1..]);
        let mut files = Vec::new();
        collect(&tree().join("tests/tests").join(folder), &mut files);
        files.retain(|path| path.extension().is_some_and(|ending| ending == "rs"));
        files.sort();
        for path in files {
            let source = std::fs::read_to_string(&path).expect("a test");
            let head: Vec<&str> = source.lines().map_while(|line| line.strip_prefix("//!")).map(str::trim).collect();
            let head = head.join(" ");
            let tests = tests_of(&source, folder);
            if tests.is_empty() {
                continue;
            }
            let name = path.strip_prefix(tree().join("tests/tests")).expect("below").display().to_string();
            text += &format!(
                "\n### `{name}`\n\n{}\n\n| test | what it proves | whose number | within |\n|---|---|---|---|\n",
                head
            );
            tests.iter().for_each(|test| text += test);
        }
    }
    text
}

/// Collects all files below a folder.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("a file").path()) {
        if entry.is_dir() { collect(&entry, files) } else { files.push(entry) }
    }
}

/// Words that show the source of the number in a test, and the words for it in the table. The first match counts.
const SOURCES: [(&[&str], &str); 8] = [
    (&["independent", "another program", "other program", "external program"], "another program"),
    (&["closed form", "by hand", "statics", "patch test", "exact", "timoshenko", "theory", " = "], "closed form"),
    (&["published", "doi", "et al", "table of"], "published"),
    (&["linear program", "conic program", "energy program", "minimum of the energy"], "another formulation"),
    (&["difference quotient", "differences", "solved again", "re-solved"], "differences of our own"),
    (&["known", "reference"], "known values of the file"),
    (&["same as", "agree", "the same", "equal"], "another way of ours"),
    (&["mirror", "units", "numbering"], "what must not matter"),
];

/// Returns true if a text cites a year in parentheses: `Milankovitch (1907)`, `(Livesley 1978)`.
fn cites(text: &str) -> bool {
    let year = |part: &str| {
        let digits: String = part.chars().take(4).collect();
        let after = part.chars().nth(4).is_none_or(|c| !c.is_ascii_digit());
        digits.len() == 4
            && after
            && (digits.starts_with("19") || digits.starts_with("20"))
            && digits.parse::<u32>().is_ok()
    };
    let open = text.match_indices('(').filter_map(|(at, _)| text[at + 1..].split(')').next());
    open.into_iter().any(|inside| inside.split([' ', ',']).any(year))
}

/// Returns the source of the number in a test, from its comment.
fn whose(folder: &str, said: &str) -> &'static str {
    match folder {
        "regression" => return "our own last",
        "invariance" => return "the same scene, otherwise said",
        "verification" | "stress" => {}
        _ => return "",
    }
    let found = |text: &str| {
        let lower = text.to_lowercase();
        let by_words =
            || SOURCES.iter().find(|(words, _)| words.iter().any(|word| lower.contains(word))).map(|own| own.1);
        if cites(text) { Some("published") } else { by_words() }
    };
    found(said).unwrap_or("its file says")
}

/// Returns a row for each test of a file.
fn tests_of(source: &str, folder: &str) -> Vec<String> {
    let lines: Vec<&str> = source.lines().collect();
    let mut rows = Vec::new();
    for at in (0..lines.len()).filter(|at| lines[*at] == "#[test]") {
        let above = lines[..at].iter().rev().take_while(|line| line.starts_with("///") || line.starts_with("#["));
        let mut said: Vec<&str> = above.filter_map(|line| line.strip_prefix("///")).map(str::trim).collect();
        said.reverse();
        let Some(open) = (at..lines.len()).find(|line| lines[*line].starts_with("fn ")) else { continue };
        let by_hand = lines[at..open].iter().any(|line| line.starts_with("#[ignore"));
        let name = lines[open].trim_start_matches("fn ").split('(').next().unwrap_or_default();
        let end = (open..lines.len()).find(|line| lines[*line] == "}").unwrap_or(lines.len());
        let within = widest(&lines[open..end].concat()).map_or(String::new(), |most| format!("{most:.0e}"));
        let statement = if said.is_empty() { name.replace('_', " ") } else { said.join(" ") };
        let mark = if by_hand { " (by hand)" } else { "" };
        let whose = whose(folder, &statement);
        rows.push(format!("| `{name}`{mark} | {} | {whose} | {within} |\n", cell(&statement)));
    }
    rows
}

/// Returns the greatest third argument of `assert_close` that is a number.
fn widest(body: &str) -> Option<f64> {
    let calls = body.split("assert_close(").skip(1);
    let arguments =
        calls.filter_map(|call| call.split(");").next()?.rsplit(',').find_map(|last| last.trim().parse().ok()));
    arguments.filter(|most: &f64| *most < 1.0).reduce(f64::max)
}
