//! Runs the console blocks of the README and of the pages, and compares their output with the pages.
//!
//! A block of the language `console` runs: each line `$ voussoir …` is a command, and the lines after it are its
//! output, with both streams together. In the output `[..]` matches any characters and a line `...` matches any lines.
//! A line `? 1` after a command is its exit code. A block of the language `toml` that begins with `name = "NAME"` is
//! saved as `NAME.toml` before the commands run. A block with `,ignore` after its language does not run.
//!
//! The crate `trycmd` does the same, but it changes the features of dependencies of `toml`, so that Cargo compiles
//! `voussoir` twice.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A block of code of a page.
struct Block {
    page: PathBuf,
    /// Line number of its first row, from 1.
    line: usize,
    language: String,
    ignored: bool,
    rows: Vec<String>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the tree")
}

/// The pages that are read: all except the notebook, which is a record of past work.
fn pages(folder: &Path, out: &mut Vec<PathBuf>) {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() && !path.ends_with("notebook") {
            pages(&path, out);
        } else if path.extension().is_some_and(|ending| ending == "md") {
            out.push(path);
        }
    }
}

fn all_pages() -> Vec<PathBuf> {
    let mut found = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    pages(&root().join("docs"), &mut found);
    found
}

fn blocks(page: &Path) -> Vec<Block> {
    let text = std::fs::read_to_string(page).expect("a page");
    let mut found: Vec<Block> = Vec::new();
    let mut open: Option<Block> = None;
    for (place, line) in text.lines().enumerate() {
        let fence = line.trim_start().strip_prefix("```");
        match (fence, &mut open) {
            (Some(_), Some(_)) => found.extend(open.take()),
            (Some(info), None) => {
                let mut words = info.split([',', ' ']);
                let language = words.next().unwrap_or_default().to_string();
                let ignored = words.any(|word| word == "ignore");
                open = Some(Block { page: page.into(), line: place + 2, language, ignored, rows: Vec::new() });
            }
            (None, Some(block)) => block.rows.push(line.into()),
            (None, None) => {}
        }
    }
    found
}

/// A command of a block with the output that the page shows.
struct Step {
    line: usize,
    words: Vec<String>,
    code: i32,
    shown: Vec<String>,
}

fn steps(block: &Block) -> Vec<Step> {
    let mut found: Vec<Step> = Vec::new();
    for (place, row) in block.rows.iter().enumerate() {
        let last = found.last_mut();
        if let Some(command) = row.strip_prefix("$ ") {
            let command = command.split(" #").next().unwrap_or_default();
            let words = command.split_whitespace().map(|word| word.trim_matches(['"', '\'']).to_string()).collect();
            found.push(Step { line: block.line + place, words, code: 0, shown: Vec::new() });
        } else if let Some(step) = last {
            match row.strip_prefix("? ").map(str::parse) {
                Some(Ok(code)) if step.shown.is_empty() => step.code = code,
                _ => step.shown.push(row.clone()),
            }
        }
    }
    found
}

/// Returns true if a line matches a pattern with `[..]`.
fn fits_line(pattern: &str, line: &str) -> bool {
    let Some((before, after)) = pattern.split_once("[..]") else { return pattern.trim_end() == line.trim_end() };
    let Some(rest) = line.strip_prefix(before) else { return false };
    rest.char_indices().map(|(place, _)| place).chain([rest.len()]).any(|place| fits_line(after, &rest[place..]))
}

/// Returns true if lines match patterns; the pattern `...` matches any number of lines.
fn fits(patterns: &[String], lines: &[&str]) -> bool {
    match (patterns.split_first(), lines.split_first()) {
        (None, None) => true,
        (Some((pattern, rest)), _) if pattern.trim() == "..." => {
            (0..=lines.len()).any(|skipped| fits(rest, &lines[skipped..]))
        }
        (Some((pattern, rest)), Some((line, more))) => fits_line(pattern, line) && fits(rest, more),
        _ => false,
    }
}

/// Runs a step. Returns a description of the differences.
fn run(step: &Step, folder: &Path) -> Result<(), String> {
    let [program, arguments @ ..] = step.words.as_slice() else { return Err("no command".into()) };
    if program != "voussoir" {
        return Err(format!("only voussoir runs here, not {program}: mark the block with ,ignore"));
    }
    let output = Command::new(env!("CARGO_BIN_EXE_voussoir")).args(arguments).current_dir(folder).output();
    let output = output.expect("the program starts");
    let printed = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    let lines: Vec<&str> = printed.trim_end().lines().collect();
    let code = output.status.code().unwrap_or(-1);
    if code != step.code {
        return Err(format!("exit code {code}, not {}:\n{printed}", step.code));
    }
    let shown: Vec<String> = step.shown.iter().map(|row| row.trim_end().to_string()).collect();
    let end = shown.iter().rposition(|row| !row.is_empty()).map_or(0, |place| place + 1);
    if fits(&shown[..end], &lines) { Ok(()) } else { Err(format!("it prints\n{printed}")) }
}

/// Creates a folder for a page, with the cases of the project and the studies of the page.
fn folder(page: &Path, blocks: &[Block]) -> PathBuf {
    let name = page.strip_prefix(root()).unwrap_or(page).to_string_lossy().replace(['/', '\\', '.'], "_");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("console").join(name);
    drop(std::fs::remove_dir_all(&folder));
    copy(&root().join("studies/cases"), &folder.join("studies/cases"));
    for block in blocks.iter().filter(|block| block.language == "toml") {
        let name = block.rows.first().and_then(|row| row.strip_prefix("name = \"")?.split('"').next());
        if let Some(name) = name {
            std::fs::write(folder.join(format!("{name}.toml")), block.rows.join("\n") + "\n").expect("written");
        }
    }
    folder
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder") {
        let entry = entry.expect("an entry");
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &to);
        } else {
            std::fs::copy(path, to).expect("copied");
        }
    }
}

/// Commands of the pages print the output that the pages show.
#[test]
fn console_blocks_print_what_the_pages_show() {
    let mut wrong = Vec::new();
    for page in all_pages() {
        let blocks = blocks(&page);
        let runs = |block: &&Block| block.language == "console" && !block.ignored;
        if !blocks.iter().any(|block| runs(&block)) {
            continue;
        }
        let folder = folder(&page, &blocks);
        for step in blocks.iter().filter(runs).flat_map(steps) {
            if let Err(why) = run(&step, &folder) {
                wrong.push(format!("{}:{}: {}\n{why}", page.display(), step.line, step.words.join(" ")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Every block of commands is run by the test above, or is marked as not run. The files that commands name exist.
#[test]
fn every_block_of_commands_runs_or_is_marked() {
    let mut wrong = Vec::new();
    for block in all_pages().iter().flat_map(|page| blocks(page)) {
        if !["console", "sh", "bash", "shell"].contains(&block.language.as_str()) {
            continue;
        }
        let place = format!("{}:{}", block.page.display(), block.line);
        if !block.ignored && (block.language != "console" || steps(&block).is_empty()) {
            wrong.push(format!(
                "{place}: write ```console with \"$ \" before each command, or ```{},ignore",
                block.language
            ));
        }
        let words = block.rows.iter().flat_map(|row| row.split_whitespace());
        for word in words.filter(|word| word.starts_with("studies/") && word.ends_with(".toml")) {
            if !root().join(word).exists() {
                wrong.push(format!("{place}: there is no {word}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn outputs_are_compared_with_wildcards() {
    let rows = |text: &str| text.lines().map(str::to_string).collect::<Vec<_>>();
    let fits = |patterns: &str, lines: &str| fits(&rows(patterns), &lines.lines().collect::<Vec<_>>());
    assert!(fits("a\nb", "a\nb"));
    assert!(!fits("a\nb", "a\nb\nc"));
    assert!(!fits("a\nb\nc", "a\nb"));
    assert!(fits("a [..] s", "a 0.12 s"));
    assert!(!fits("a [..] s", "a 0.12 m"));
    assert!(fits("[..]b[..]d", "abcd"));
    assert!(fits("a\n...\nd", "a\nb\nc\nd") && fits("a\n...\nd", "a\nd") && fits("a\n...", "a"));
    assert!(!fits("a\n...\nd", "a\nb"));
}
