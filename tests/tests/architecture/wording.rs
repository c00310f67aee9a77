//! Plain English: the number of phrases that read badly may not rise in any folder.
//!
//! `tests/wording.csv` holds the counts. `WORDING=lower cargo test -p voussoir-tests --test architecture wording` lowers them.

use super::source::workspace;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Phrases to avoid, by kind. A phrase is a row of words; `a|b` matches either, `^` matches the start of a sentence that is no
/// question.
const PHRASES: &[(&str, &[&str])] = &[
    ("start", &["^ whether|what|how|which|of"]),
    ("where for if", &["^ where", "where it|they|there|nothing|nobody|none|no|neither|both|one"]),
    (
        "what as a noun",
        &[
            "what is|are|was|were|has|have|had|it|they|a|an|the|each|every|no|one",
            "what came|comes|stands|stood|lies|lay|goes|went|remains|waits|follows|counts|holds",
        ],
    ),
    ("is none", &["is|are|was|were|be none", "none is"]),
    ("come to", &["come|comes|came|coming to|out"]),
    ("is told", &["is|are|was|were|be told", "tell|tells of|it|them|which|how|that"]),
    ("says so", &["say|says|said so|it|that|which|what|how|why|where|nothing|who"]),
    ("stands", &["as it stands", "what stands", "stand|stands in|beside|for|behind|there|on|with"]),
    (
        "is answered",
        &["is|are|was|were answered", "answer|answers it|them", "answer|answers the case|cases|scene|scenes"],
    ),
    (
        "personification",
        &["look|looks on", "look|looks at it", "hear|hears|somebody|nobody", "hear of", "wait|waits for|at|until"],
    ),
    ("of which no", &["of which|whom no|none|more|each|one|some|two"]),
    ("those of the", &["those|that|these of the|a|an|its|their|all|every|each|another"]),
    ("of its own", &["of its|their own"]),
    (
        "fillers",
        &[
            "in vain",
            "by turns",
            "so many|much|often|few",
            "so long as",
            "once more",
            "for ever",
            "no more than that",
            "at that",
        ],
    ),
    ("takes", &["take|takes it|them|no|none|what|that|this|all", "is|are taken as|for|from"]),
    ("history", &["earlier version|versions|run|runs", "used to", "no longer"]),
];

/// Folders that are counted, with their Markdown pages and the comments of their Rust files.
const FOLDERS: [&str; 7] = ["docs", "core", "laws", "solvers", "studies", "tests", "benches"];
/// Folders without prose of the project: built files, the notebook, which is history, and copies of an example.
const SKIPPED: [&str; 4] = ["target", "notebook", "results", "templates"];

/// Folder → kind of phrase → places.
type Found = BTreeMap<String, BTreeMap<&'static str, Vec<String>>>;

/// The sentences of a line of prose as words; `?` ends the words of a question.
fn sentences(line: &str) -> Vec<Vec<String>> {
    let mut text = String::new();
    // Code in quotes counts as one word.
    for (place, part) in line.split('`').enumerate() {
        text.push_str(if place % 2 == 0 { part } else { "x" });
    }
    let ends = |c: char| matches!(c, '.' | ':' | ';' | '!');
    text.split_inclusive(ends).map(words).filter(|words| !words.is_empty()).collect()
}

fn words(sentence: &str) -> Vec<String> {
    let apart = sentence.replace('?', " ? ").replace([',', '—'], " , ");
    let letters = |word: &str| word.trim_matches(|c: char| !c.is_alphanumeric() && c != '?' && c != ',').to_string();
    apart.split_whitespace().map(letters).filter(|word| !word.is_empty()).collect()
}

/// Returns true if the phrase is in the sentence.
fn contains(sentence: &[String], phrase: &str) -> bool {
    let at_start = phrase.starts_with('^');
    let begins = |word: &String| word.starts_with(char::is_uppercase);
    if at_start && (!sentence.first().is_some_and(begins) || sentence.iter().any(|word| word == "?")) {
        return false;
    }
    let wanted: Vec<&str> = phrase.trim_start_matches('^').split_whitespace().collect();
    let same = |word: &String, any: &str| any.split('|').any(|one| one.eq_ignore_ascii_case(word));
    let fits = |window: &[String]| window.iter().zip(&wanted).all(|(word, any)| same(word, any));
    sentence.windows(wanted.len()).take(if at_start { 1 } else { usize::MAX }).any(fits)
}

/// Lines of prose of a file, numbered from 1: a page without its code, or the comments of a Rust file.
fn prose(path: &Path, text: &str) -> Vec<(usize, String)> {
    let page = path.extension().is_some_and(|ending| ending == "md");
    let mut fenced = false;
    let mut lines = Vec::new();
    for (place, line) in text.lines().enumerate() {
        let line = line.trim_start();
        let line = match page {
            true => Some(line),
            false => line.split_once("//").map(|(_, after)| after.trim_start_matches(['/', '!', ' '])),
        };
        match line {
            Some(line) if line.starts_with("```") => fenced = !fenced,
            Some(line) if !fenced && !line.is_empty() => lines.push((place + 1, line.into())),
            _ => {}
        }
    }
    lines
}

fn files(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && !SKIPPED.contains(&name.as_str()) && !name.starts_with('.') {
            files(&path, out);
        } else if path.extension().is_some_and(|ending| ending == "md" || ending == "rs") {
            out.push(path);
        }
    }
}

fn found() -> Found {
    let root = workspace();
    let mut all = vec![("README".to_string(), vec![root.join("README.md")])];
    for folder in FOLDERS {
        let mut of_folder = Vec::new();
        files(&root.join(folder), &mut of_folder);
        of_folder.sort();
        all.push((folder.into(), of_folder));
    }
    let mut found = Found::new();
    for (folder, files) in all {
        let kinds = found.entry(folder).or_default();
        for path in files.iter().filter(|path| !path.ends_with("architecture/wording.rs")) {
            for (number, line) in prose(path, &std::fs::read_to_string(path).expect("a file")) {
                let sentences = sentences(&line);
                for (kind, phrases) in PHRASES {
                    if phrases.iter().any(|phrase| sentences.iter().any(|sentence| contains(sentence, phrase))) {
                        let shown = path.strip_prefix(&root).unwrap_or(path).display();
                        kinds.entry(*kind).or_default().push(format!("{shown}:{number}: {line}"));
                    }
                }
            }
        }
    }
    found
}

/// The number of lines with each kind of phrase does not rise in a folder: `tests/wording.csv` has a row for each folder and
/// kind. The sum of a folder counts, so a phrase of one kind may replace one of another.
#[test]
fn wording_does_not_get_worse() {
    let file = workspace().join("tests/wording.csv");
    let text = std::fs::read_to_string(&file).expect("tests/wording.csv");
    let mut stored: BTreeMap<(String, String), usize> = BTreeMap::new();
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        stored.insert((cells[0].into(), cells[1].into()), cells[2].parse().expect("a count"));
    }
    let (mut worse, mut lowered) = (Vec::new(), "folder,kind,count\n".to_string());
    for (folder, kinds) in found() {
        let limit: usize = stored.iter().filter(|((of, _), _)| *of == folder).map(|(_, count)| count).sum();
        let sum: usize = kinds.values().map(Vec::len).sum();
        for (kind, places) in &kinds {
            let before = stored.get(&(folder.clone(), kind.to_string())).copied().unwrap_or(0);
            lowered += &format!("{folder},{kind},{}\n", places.len());
            if sum > limit && places.len() > before {
                worse.push(format!("{folder}, \"{kind}\": {} places, {before} allowed", places.len()));
                worse.extend(places.iter().map(|place| format!("  {place}")));
            }
        }
    }
    assert!(worse.is_empty(), "write these sentences in another way:\n{}", worse.join("\n"));
    if std::env::var("WORDING").is_ok_and(|word| word == "lower") {
        std::fs::write(&file, lowered).expect("tests/wording.csv");
    }
}

/// Phrases are found as words, at the start of a sentence only where that is asked for, and never in code or in questions.
#[test]
fn phrases_are_found_as_words() {
    let has = |line: &str, phrase: &str| sentences(line).iter().any(|sentence| contains(sentence, phrase));
    assert!(has("The sum. Whether it carries.", "^ whether|what"));
    assert!(!has("It asks whether it carries.", "^ whether|what"));
    assert!(!has("whether it carries, on a line of its own", "^ whether|what"));
    assert!(!has("What is a hinge?", "^ whether|what"));
    assert!(has("There is none, as the proof shows", "is|are none"));
    assert!(!has("`is none` is code", "is none"));
    assert!(!has("The noneness is", "none is"));
    let page = "# Head\n```text\nWhat is\n```\nWhat is\n";
    assert_eq!(prose(Path::new("a.md"), page), [(1, "# Head".into()), (5, "What is".into())]);
    let source = "/// Doc\nlet a = 1; // why\n";
    assert_eq!(prose(Path::new("a.rs"), source), [(1, "Doc".into()), (2, "why".into())]);
}
