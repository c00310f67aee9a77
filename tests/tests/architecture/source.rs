//! Rust sources as tokens, with enough of the grammar to find imports, types, methods, fields and functions.
//!
//! The source is read as text and not with a parser crate: this includes macros, and the tests need no further
//! dependency.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A word, a sign or a quoted text, with its line.
#[derive(Debug, Clone, PartialEq)]
pub struct Token {
    /// A word, one sign, or `""` for texts, characters and numbers.
    pub text: String,
    /// Line number, from 1.
    pub line: usize,
}

/// A file of a crate: a module.
#[derive(Debug)]
pub struct Source {
    /// Its tokens, without comments and tests.
    pub tokens: Vec<Token>,
}

/// A path of a `use`, or a path written out in code.
#[derive(Debug, Clone)]
pub struct Import {
    /// The path from `crate`, `super`, `self` or a child module.
    pub path: Vec<String>,
    /// The name of the import here; `*` for all items of a module, `None` for a path in code.
    pub name: Option<String>,
}

/// Returns the folder of the workspace to check: this one, or the one in the variable `HOUSE`.
pub fn workspace() -> PathBuf {
    std::env::var_os("HOUSE").map_or(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."), PathBuf::from)
}

/// Returns the files of a crate by module path from its root, without test files; the path of `lib.rs` is empty.
pub fn sources(krate: &str) -> BTreeMap<Vec<String>, Source> {
    let mut all = BTreeMap::new();
    let root = workspace().join(krate).join("src");
    each_source(&root, &mut |path, text| {
        let mut module: Vec<String> = path
            .strip_prefix(&root)
            .expect("below src")
            .with_extension("")
            .iter()
            .map(|part| part.to_string_lossy().into_owned())
            .collect();
        if ["mod", "lib", "main"].contains(&module[module.len() - 1].as_str()) {
            module.pop();
        }
        if !module.iter().any(|part| part == "tests") {
            all.insert(module, Source { tokens: without_tests(&tokens(text)) });
        }
    });
    all
}

/// Calls `check` with each Rust file below a folder.
pub fn each_source(folder: &Path, check: &mut dyn FnMut(&Path, &str)) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            each_source(&path, check);
        } else if path.extension().is_some_and(|e| e == "rs") {
            check(&path, &std::fs::read_to_string(&path).expect("a source file"));
        }
    }
}

/// Splits a text into tokens; comments are dropped.
pub fn tokens(text: &str) -> Vec<Token> {
    let text: Vec<char> = text.chars().collect();
    let at = |i: usize| text.get(i).copied().unwrap_or('\0');
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let (mut all, mut i, mut line) = (Vec::new(), 0, 1);
    while i < text.len() {
        let (start, first) = (i, line);
        let mut word = String::new();
        if at(i).is_whitespace() {
            i += 1;
        } else if (at(i), at(i + 1)) == ('/', '/') {
            while i < text.len() && at(i) != '\n' {
                i += 1;
            }
        } else if (at(i), at(i + 1)) == ('/', '*') {
            i = after_comment(&text, i);
        } else if let Some(end) = after_quotes(&text, i) {
            i = end;
            word = "\"\"".into();
        } else if is_word(at(i)) {
            while is_word(at(i)) {
                i += 1;
            }
            word = text[start..i].iter().collect();
        } else {
            i += 1;
            word = text[start].into();
        }
        line += text[start..i].iter().filter(|&&c| c == '\n').count();
        if !word.is_empty() {
            all.push(Token { text: word, line: if i - start == 1 { first } else { line } });
        }
    }
    all
}

/// Returns the end of a comment between `/*` and `*/`, which may contain other comments.
fn after_comment(text: &[char], start: usize) -> usize {
    let (mut i, mut depth) = (start, 0);
    while i < text.len() {
        match text.get(i..i + 2) {
            Some(['/', '*']) => (i, depth) = (i + 2, depth + 1),
            Some(['*', '/']) => (i, depth) = (i + 2, depth - 1),
            _ => i += 1,
        }
        if depth == 0 {
            break;
        }
    }
    i
}

/// Returns the end of the text, character or lifetime that begins here, if one begins here.
fn after_quotes(text: &[char], start: usize) -> Option<usize> {
    let at = |i: usize| text.get(i).copied().unwrap_or('\0');
    let mut i = start;
    if at(i) == '\'' {
        return Some(if at(i + 1) == '\\' {
            (i + 3..).find(|&k| k >= text.len() || at(k) == '\'')? + 1
        } else if at(i + 2) == '\'' {
            i + 3
        } else {
            (i + 1..).find(|&k| !at(k).is_alphanumeric() && at(k) != '_')?
        });
    }
    if at(i) == 'b' {
        i += 1;
    }
    if at(i) == 'r' {
        let hashes = (i + 1..).take_while(|&k| at(k) == '#').count();
        if at(i + 1 + hashes) == '"' {
            let closes = |k: usize| at(k) == '"' && (1..=hashes).all(|h| at(k + h) == '#');
            return (i + 2 + hashes..=text.len()).find(|&k| k >= text.len() || closes(k)).map(|k| k + 1 + hashes);
        }
    }
    if at(i) != '"' {
        return None;
    }
    i += 1;
    while i < text.len() && at(i) != '"' {
        i += if at(i) == '\\' { 2 } else { 1 };
    }
    Some(i + 1)
}

/// Drops every item that is for tests only.
fn without_tests(tokens: &[Token]) -> Vec<Token> {
    let (mut kept, mut i) = (Vec::new(), 0);
    while i < tokens.len() {
        if ["#", "[", "cfg", "(", "test", ")", "]"].iter().enumerate().all(|(k, t)| is(tokens, i + k, t)) {
            i += 7;
            while is(tokens, i, "#") {
                i = closing(tokens, i + 1) + 1;
            }
            while i < tokens.len() && !is(tokens, i, ";") && !is(tokens, i, "{") {
                i = if is(tokens, i, "(") || is(tokens, i, "[") { closing(tokens, i) + 1 } else { i + 1 };
            }
            i = if is(tokens, i, "{") { closing(tokens, i) + 1 } else { i + 1 };
            // `use a::{b, c};` ends at its semicolon.
            if is(tokens, i, ";") {
                i += 1;
            }
        } else {
            kept.push(tokens[i].clone());
            i += 1;
        }
    }
    kept
}

/// Returns true if the token at this index is the word or sign.
pub fn is(tokens: &[Token], i: usize, text: &str) -> bool {
    tokens.get(i).is_some_and(|t| t.text == text)
}

/// Returns the index of the bracket that closes the one at `open`.
pub fn closing(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate().skip(open) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return i;
        }
    }
    tokens.len()
}

/// Returns true if an item may begin here: after another item, an attribute, a visibility or an opening bracket.
fn begins_item(tokens: &[Token], i: usize) -> bool {
    let before = i.checked_sub(1).map_or(";", |k| tokens[k].text.as_str());
    [";", "}", "{", "]", ")", "pub", "unsafe", "const", "async"].contains(&before)
}

impl Source {
    /// Returns the child modules declared here.
    pub fn children(&self) -> impl Iterator<Item = &str> {
        let t = &self.tokens;
        (0..t.len()).filter(|&i| is(t, i, "mod") && is(t, i + 2, ";")).map(|i| t[i + 1].text.as_str())
    }

    /// Returns true if an item with this name is defined here.
    pub fn defines(&self, name: &str) -> bool {
        let t = &self.tokens;
        let kinds = ["struct", "enum", "union", "trait", "type", "fn", "const", "static", "macro_rules"];
        (1..t.len()).any(|i| {
            let before = if is(t, i - 1, "!") && i > 1 { i - 2 } else { i - 1 };
            t[i].text == name && kinds.contains(&t[before].text.as_str())
        })
    }

    /// Returns all imports from this crate, by `use` and by paths in code.
    pub fn imports(&self) -> Vec<Import> {
        let t = &self.tokens;
        let children: Vec<&str> = self.children().collect();
        let starts = |word: &str| ["crate", "super", "self"].contains(&word) || children.contains(&word);
        let (mut all, mut i) = (Vec::new(), 0);
        while i < t.len() {
            if is(t, i, "use") && begins_item(t, i) && !is(t, i + 1, "<") {
                let end = (i..t.len()).find(|&k| is(t, k, ";")).unwrap_or(t.len());
                use_tree(&t[i + 1..end], &[], &mut all);
                i = end;
            } else if starts(&t[i].text) && is(t, i + 1, ":") && is(t, i + 2, ":") && !(i > 0 && is(t, i - 1, ":")) {
                let mut path = vec![t[i].text.clone()];
                while is(t, i + 1, ":") && is(t, i + 2, ":") && t.get(i + 3).is_some_and(is_name) {
                    i += 3;
                    path.push(t[i].text.clone());
                }
                all.push(Import { path, name: None });
            }
            i += 1;
        }
        all.retain(|import| starts(&import.path[0]));
        all
    }

    /// Returns every `impl` block: its type and the number of its functions.
    pub fn impls(&self) -> Vec<(Vec<String>, usize)> {
        let t = &self.tokens;
        let mut all = Vec::new();
        for i in (0..t.len()).filter(|&i| is(t, i, "impl") && begins_item(t, i)) {
            let Some(open) = (i..t.len()).find(|&k| is(t, k, "{")) else { continue };
            let mut k = if is(t, i + 1, "<") { after_angles(t, i + 1) } else { i + 1 };
            let header = k;
            while k < open {
                if is(t, k, "for") && !is(t, k + 1, "<") {
                    break;
                }
                k = if is(t, k, "<") { after_angles(t, k) } else { k + 1 };
            }
            k = if k < open { k + 1 } else { header };
            while k < open && (!is_name(&t[k]) || ["dyn", "mut"].contains(&t[k].text.as_str())) {
                k += 1;
            }
            let mut path = vec![t[k].text.clone()];
            while is(t, k + 1, ":") && is(t, k + 2, ":") {
                k += 3;
                path.push(t[k].text.clone());
            }
            let end = closing(t, open);
            let (mut methods, mut k) = (0, open + 1);
            while k < end {
                methods += usize::from(is(t, k, "fn"));
                k = if is(t, k, "{") || is(t, k, "(") { closing(t, k) + 1 } else { k + 1 };
            }
            all.push((path, methods));
        }
        all
    }

    /// Returns every struct and the number of its fields.
    pub fn structs(&self) -> Vec<(String, usize)> {
        let t = &self.tokens;
        let mut all = Vec::new();
        for i in (0..t.len()).filter(|&i| is(t, i, "struct") && begins_item(t, i)) {
            let mut open = if is(t, i + 2, "<") { after_angles(t, i + 2) } else { i + 2 };
            while open < t.len() && !["{", "(", ";"].iter().any(|sign| is(t, open, sign)) {
                open += 1;
            }
            all.push((t[i + 1].text.clone(), if is(t, open, ";") { 0 } else { parts(t, open) }));
        }
        all
    }

    /// Returns every function with a body: its name and the number of lines from `fn` to its closing bracket.
    pub fn functions(&self) -> Vec<(String, usize)> {
        let t = &self.tokens;
        let mut all = Vec::new();
        for i in (0..t.len()).filter(|&i| is(t, i, "fn") && t.get(i + 1).is_some_and(is_name)) {
            let mut k = i + 2;
            while k < t.len() && !is(t, k, "{") && !is(t, k, ";") {
                k = if is(t, k, "(") || is(t, k, "[") { closing(t, k) + 1 } else { k + 1 };
            }
            if is(t, k, "{") {
                all.push((t[i + 1].text.clone(), t[closing(t, k).min(t.len() - 1)].line - t[i].line + 1));
            }
        }
        all
    }
}

fn is_name(token: &Token) -> bool {
    token.text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Returns the index after the generics that open here; the arrow `->` closes nothing.
fn after_angles(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for i in open..tokens.len() {
        match tokens[i].text.as_str() {
            "<" => depth += 1,
            ">" if !is(tokens, i - 1, "-") => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return i + 1;
        }
    }
    tokens.len()
}

/// Returns the number of parts between commas in the bracket that opens here.
fn parts(tokens: &[Token], open: usize) -> usize {
    let end = closing(tokens, open);
    let (mut count, mut is_empty, mut k) = (0, true, open + 1);
    while k < end {
        match tokens[k].text.as_str() {
            "," => (count, is_empty, k) = (count + usize::from(!is_empty), true, k + 1),
            "#" => k = closing(tokens, k + 1) + 1,
            "(" | "[" | "{" => (is_empty, k) = (false, closing(tokens, k) + 1),
            "<" => (is_empty, k) = (false, after_angles(tokens, k)),
            _ => (is_empty, k) = (false, k + 1),
        }
    }
    count + usize::from(!is_empty)
}

/// Collects the paths of a `use` tree.
fn use_tree(tokens: &[Token], before: &[String], all: &mut Vec<Import>) {
    let mut path = before.to_vec();
    let mut i = 0;
    while i < tokens.len() {
        match tokens[i].text.as_str() {
            "{" => {
                let end = closing(tokens, i);
                let mut start = i + 1;
                let mut k = start;
                while k <= end {
                    if k == end || is(tokens, k, ",") {
                        if start < k {
                            use_tree(&tokens[start..k], &path, all);
                        }
                        start = k + 1;
                    }
                    k = if k < end && is(tokens, k, "{") { closing(tokens, k) } else { k + 1 };
                }
                return;
            }
            "as" => {
                all.push(Import { name: Some(tokens[i + 1].text.clone()), path });
                return;
            }
            ":" => {}
            // `a::{self}` is `a`.
            "self" if !path.is_empty() => {}
            word => path.push(word.into()),
        }
        i += 1;
    }
    all.push(Import { name: path.last().cloned(), path });
}
