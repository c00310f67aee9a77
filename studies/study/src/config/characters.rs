//! Characters that a reader cannot see or that change the order of the text around them: escaped in messages.

use crate::config::limits::MAX_MESSAGE;
use std::borrow::Cow;

/// Returns true for control characters, for characters that set the direction of writing, and for others without a shape.
pub fn is_invisible(c: char) -> bool {
    c.is_control()
        || changes_direction(c)
        || matches!(c, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2028}' | '\u{2029}' | '\u{2060}'..='\u{2064}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

/// Returns true for embeddings, overrides and isolates of Unicode's bidirectional algorithm.
pub fn changes_direction(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Returns a text for a terminal: invisible characters, except line breaks and tabs, are written as `\u{…}`.
pub fn escape(text: &str) -> Cow<'_, str> {
    escape_if(text, |c| is_invisible(c) && !matches!(c, '\n' | '\t'))
}

/// Returns a part of a message, on one line and of bounded length.
pub fn quoted(text: &str) -> Cow<'_, str> {
    let length = text.chars().count();
    if length <= MAX_MESSAGE {
        return escape_if(text, is_invisible);
    }
    let head: String = text.chars().take(MAX_MESSAGE * 2 / 3).collect();
    let tail: String = text.chars().skip(length - MAX_MESSAGE / 6).collect();
    let left_out = length - MAX_MESSAGE * 2 / 3 - MAX_MESSAGE / 6;
    let (head, tail) = (escape_if(&head, is_invisible), escape_if(&tail, is_invisible));
    format!("{head} … ({left_out} characters left out) … {tail}").into()
}

fn escape_if(text: &str, escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&escaped) {
        return text.into();
    }
    let one = |c: char| if escaped(c) { c.escape_unicode().to_string() } else { c.to_string() };
    text.chars().map(one).collect::<String>().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_hold_no_invisible_characters_and_no_endless_quotes() {
        assert_eq!(escape("a\u{1b}[31m\n\u{202e}b"), "a\\u{1b}[31m\n\\u{202e}b");
        assert_eq!(quoted("a\nb"), "a\\u{a}b");
        assert!(quoted(&"x".repeat(100_000)).chars().count() < MAX_MESSAGE);
        assert!(matches!(escape("Gewölbe, 橋, قوس"), Cow::Borrowed(_)));
    }
}
