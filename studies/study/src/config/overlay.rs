//! Sets single keys of a document: `--set`, variants and sweeps.

use crate::config::diagnostic::{LocatedDiagnostic, suggest};
use crate::config::document::{Entry, Node, Table, Value};
use crate::config::dotted_key::{join, segments};
use crate::config::limits::MAX_DEPTH;
use crate::config::origin::Origin;

/// Sets the key at a dotted path. List entries are found by index from 0, or by `name` if they are tables with this key.
/// Missing tables and keys are created, so that the check of the whole study finds a misspelt key; list entries are never
/// created. `key_origin` is the place of the path.
pub fn set(root: &mut Node, path: &str, value: Node, key_origin: &Origin) -> Result<(), Box<LocatedDiagnostic>> {
    let wrong = |message: String| LocatedDiagnostic::new(key_origin, path, message);
    let segments = segments(path);
    if segments.is_empty() || segments.iter().any(String::is_empty) {
        let help = "write it as in scene.profile.rise";
        return Err(wrong(format!("\"{path}\" is not a dotted key")).help(help).into());
    }
    if segments.len() > MAX_DEPTH {
        let message = format!("has {} segments; a key has at most {MAX_DEPTH}", segments.len());
        return Err(wrong(message).help("write it as in scene.profile.rise").into());
    }
    let mut node = root;
    let walked = |place: usize| segments[..place].iter().fold(String::new(), |path, segment| join(&path, segment));
    for (place, segment) in segments.iter().enumerate() {
        node = match &mut node.value {
            Value::Table(table) => child(table, segment, key_origin),
            Value::Array(nodes) => {
                let index = find(nodes, segment).map_err(|help| {
                    wrong(format!("the list {} has no entry \"{segment}\"", walked(place))).help(help)
                })?;
                &mut nodes[index]
            }
            other => {
                let message = format!("{} is {}, so nothing can be set inside it", walked(place), other.describe());
                return Err(wrong(message).into());
            }
        };
    }
    *node = value;
    Ok(())
}

/// Returns the value under a key; adds an empty table if the key is missing.
fn child<'a>(table: &'a mut Table, key: &str, origin: &Origin) -> &'a mut Node {
    let index = table.entries.iter().position(|entry| entry.key == key).unwrap_or_else(|| {
        let node = Node { value: Value::Table(Table::default()), origin: origin.clone() };
        table.entries.push(Entry { key: key.into(), origin: origin.clone(), node });
        table.entries.len() - 1
    });
    &mut table.entries[index].node
}

/// Returns the position of a list entry by index or name. The error is advice.
fn find(nodes: &[Node], segment: &str) -> Result<usize, String> {
    let name = |node: &Node| node.table().and_then(|table| table.get("name")?.text().map(str::to_string));
    if let Ok(index) = segment.parse::<usize>() {
        return if index < nodes.len() {
            Ok(index)
        } else {
            Err(match nodes.len() {
                0 => "the list is empty".into(),
                1 => "it has one entry, 0".into(),
                count => format!("its {count} entries are counted from 0 to {}", count - 1),
            })
        };
    }
    nodes.iter().position(|node| name(node).as_deref() == Some(segment)).ok_or_else(|| {
        let names: Vec<_> = nodes.iter().filter_map(name).collect();
        if names.is_empty() {
            "its entries have no names: give an index, counted from 0".into()
        } else {
            suggest(segment, &names.iter().map(String::as_str).collect::<Vec<_>>(), "its entries")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::document::{parse, parse_value};

    const TEXT: &str = "name = \"x\"\n[[stages]]\nname = \"live\"\nloads = [{ force = 1 }]\n[scene]\nspan = 3\n";

    fn with(path: &str, value: &str) -> Result<Node, Box<LocatedDiagnostic>> {
        let mut root = parse(TEXT, "a.toml").unwrap();
        let origin = Origin::Set(path.into());
        set(&mut root, path, parse_value(value, &origin).unwrap(), &origin)?;
        Ok(root)
    }

    #[test]
    fn entries_of_lists_go_by_index_or_name_and_take_the_origin_of_what_is_set() {
        for path in ["stages.0.loads.0.force", "stages.live.loads.0.force"] {
            let root = with(path, "7").unwrap();
            assert_eq!(root.place("stages.0.loads.0.force"), Origin::Set(path.into()));
            assert_eq!(root.to_json()["stages"][0]["loads"][0]["force"], 7);
        }
    }

    #[test]
    fn missing_tables_are_created_but_not_list_entries() {
        assert_eq!(with("solver.tolerance", "1e-6").unwrap().to_json()["solver"]["tolerance"], 1e-6);
        let message = |path| with(path, "1").unwrap_err().to_string();
        assert_eq!(
            message("stages.liv.factor"),
            "--set stages.liv.factor: the list stages has no entry \"liv\"\n  help: did you mean \"live\"?"
        );
        assert_eq!(
            message("stages.3.factor"),
            "--set stages.3.factor: the list stages has no entry \"3\"\n  help: it has one entry, 0"
        );
        assert_eq!(
            message("scene.span.rise"),
            "--set scene.span.rise: scene.span is the number 3, so nothing can be set inside it"
        );
        assert!(message("scene..rise").contains("is not a dotted key"));
    }
}
