//! A mistake as it is printed: its first line, the line of the file with the place marked, then advice.

use super::characters::quoted;
use super::diagnostic::LocatedDiagnostic;
use super::origin::Origin;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use std::ops::Range;

/// Longer lines are not shown.
const MAX_LINE: usize = 1000;

/// A mistake with the line where it was made. The first line begins with `file:line:column: key: `, so that editors and other
/// programs find the place. `text_of` returns the text of a file by its name, if it is at hand.
pub fn with_source(mistake: &LocatedDiagnostic, text_of: &dyn Fn(&str) -> Option<String>, colour: bool) -> String {
    let message = mistake.to_string();
    let Some((line, number, span)) = place(mistake, text_of) else { return message };
    let mut rest = message.lines();
    let title = Level::ERROR.no_name().primary_title(rest.next().unwrap_or_default());
    let snippet = Snippet::source(line.as_str()).line_start(number).annotation(AnnotationKind::Primary.span(span));
    let mut group = Group::with_title(title).element(snippet);
    for words in rest.map(str::trim) {
        group = group.element(match words.strip_prefix("help: ") {
            Some(help) => Level::HELP.message(help.to_string()),
            None => Level::NOTE.message(words.to_string()),
        });
    }
    let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
    renderer.render(&[group])
}

/// The line of a mistake, its number, and the bytes of it that are marked.
fn place(
    mistake: &LocatedDiagnostic,
    text_of: &dyn Fn(&str) -> Option<String>,
) -> Option<(String, usize, Range<usize>)> {
    let Origin::File { file, line, column } = &mistake.origin else { return None };
    let text = text_of(file)?;
    let found = text.lines().nth(line.checked_sub(1)?)?;
    if found.chars().count() > MAX_LINE {
        return None;
    }
    // Invisible characters become visible and have other lengths.
    let before: String = found.chars().take(column.checked_sub(1)?).collect();
    let rest = &found[before.len()..];
    let [before, token, after] =
        [before.as_str(), token(rest), &rest[token(rest).len()..]].map(|part| quoted(part).into_owned());
    let span = before.len()..before.len() + token.len();
    Some((format!("{before}{token}{after}"), *line, span))
}

/// The key, the number or the quoted text at the beginning of a text.
fn token(text: &str) -> &str {
    let end = match text.chars().next() {
        Some(quote @ ('"' | '\'')) => text[1..].find(quote).map_or(text.len(), |at| at + 2),
        Some(first) => {
            let ends = |c: char| c.is_whitespace() || "=,[]{}#".contains(c);
            text.find(ends).filter(|end| *end > 0).unwrap_or(if ends(first) { first.len_utf8() } else { text.len() })
        }
        None => 0,
    };
    &text[..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(text: &str, column: usize, colour: bool) -> String {
        let origin = Origin::File { file: "a.toml".into(), line: 2, column };
        let mistake = LocatedDiagnostic::new(&origin, "scene.span", "is wrong").help("write 2.0");
        with_source(&mistake, &|file| (file == "a.toml").then(|| text.to_string()), colour)
    }

    #[test]
    fn the_place_is_marked_under_its_line() {
        let text = "[scene]\nspan = \"two # m\" # here\n";
        let expected = "a.toml:2:8: scene.span: is wrong\n  |\n2 | span = \"two # m\" # here\n  |        ^^^^^^^^^\n  |\n  = help: write 2.0";
        assert_eq!(printed(text, 8, false), expected);
        assert!(printed(text, 1, false).contains("  | ^^^^\n"));
        assert!(printed(text, 8, true).contains('\u{1b}'));
    }

    /// Places that do not exist, an empty line, and characters that a reader cannot see.
    #[test]
    fn no_line_does_harm() {
        for (text, column) in
            [("", 1), ("\n", 9), ("a\n\n", 1), ("a\n\u{e4}\u{1f600}=\n", 3), ("a\nb\n", 0), ("a\n\"open\n", 1)]
        {
            let printed = printed(text, column, false);
            assert!(printed.starts_with("a.toml:2:") && printed.contains("help: write 2.0"), "{printed}");
        }
        let hidden = printed("\n\u{1b}[31m\u{202e} = 1\n", 1, false);
        assert!(hidden.chars().all(|c| c == '\n' || !super::super::characters::is_invisible(c)), "{hidden}");
    }
}
