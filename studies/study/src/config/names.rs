//! Checks that names, keys and texts of a study have no characters that a reader cannot see.

use crate::config::characters::{changes_direction, is_invisible};
use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::document::{Node, Value};
use crate::config::dotted_key::join;

/// Adds a mistake for every key and every name of a study that contains an invisible character, and for every other text
/// with a control character or a change of direction. Line breaks and tabs may occur in texts, not in names.
pub fn check_texts(root: &Node, mistakes: &mut Vec<LocatedDiagnostic>) {
    check_node(root, "", mistakes);
}

fn check_node(node: &Node, path: &str, mistakes: &mut Vec<LocatedDiagnostic>) {
    let mut wrong = |origin, path: &str, what: &str, found: Option<char>| {
        if let Some(c) = found {
            let message = format!("the {what} holds the character U+{:04X}, which cannot be seen", u32::from(c));
            mistakes.push(LocatedDiagnostic::new(origin, path, message).help("remove it, or write the text anew"));
        }
    };
    match &node.value {
        Value::String(text) if path == "name" || path.ends_with(".name") => {
            wrong(&node.origin, path, "name", text.chars().find(|&c| is_invisible(c)))
        }
        Value::String(text) => {
            let unfit = |c: &char| (c.is_control() && !matches!(c, '\n' | '\r' | '\t')) || changes_direction(*c);
            wrong(&node.origin, path, "text", text.chars().find(unfit));
        }
        Value::Array(nodes) => {
            nodes.iter().enumerate().for_each(|(i, node)| check_node(node, &join(path, &i.to_string()), mistakes));
        }
        Value::Table(table) => {
            for entry in &table.entries {
                let path = join(path, &entry.key);
                if let Some(c) = entry.key.chars().find(|&c| is_invisible(c)) {
                    let message = format!("the key holds the character U+{:04X}, which cannot be seen", u32::from(c));
                    mistakes.push(
                        LocatedDiagnostic::new(&entry.origin, &path, message).help("remove it, or write the key anew"),
                    );
                }
                check_node(&entry.node, &path, mistakes);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::document::parse;

    #[test]
    fn names_are_one_line_that_can_be_seen() {
        let wrong = |text: &str| {
            let mut mistakes = Vec::new();
            check_texts(&parse(text, "a.toml").unwrap(), &mut mistakes);
            mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
        };
        assert_eq!(wrong("name = \"Bogen قوس\"\n[report]\ntext = [\"\"\"\none\n\ttwo \u{200f}\"\"\"]\n"), "");
        assert!(
            wrong("[[stages]]\nname = \"a\\u001b[31m\"")
                .starts_with("a.toml:2:8: stages.0.name: the name holds the character U+001B")
        );
        assert!(wrong("[[stages]]\nname = \"a\\nb\"").contains("U+000A"));
        assert!(
            wrong("[materials.\"s\\u202etone\"]").starts_with("a.toml:1:12: materials.s\\u{202e}tone: the key holds")
        );
        assert!(wrong("text = \"a\\u2066b\"").contains("the text holds the character U+2066"));
    }
}
