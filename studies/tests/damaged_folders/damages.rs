//! Damages of a results folder: changes of each node of its JSON, of each line of its study, and of each file.

use serde_json::{Value, json};
use std::fmt;
use std::path::Path;

/// One damage.
#[derive(Debug, Clone)]
pub enum Damage {
    /// Changes a node of results.json, given by its pointer.
    Node(String, Change),
    /// Replaces a line of resolved.toml by another one.
    Line(usize, String),
    /// Damages a file, given by its name.
    File(String, Harm),
}

/// A change of a JSON node.
#[derive(Debug, Clone)]
pub enum Change {
    /// Deletes the node.
    Delete,
    /// Duplicates an element of a list.
    Duplicate,
    /// Replaces the value.
    Value(Value),
}

/// A damage of a whole file.
#[derive(Debug, Clone)]
pub enum Harm {
    /// Truncates the file to these thousandths of its length.
    Cut(usize),
    /// Overwrites a byte with one that is not UTF-8, at these thousandths of its length.
    Byte(usize),
    Missing,
    Empty,
    /// Replaces the file by the file with the same name in another folder.
    Swapped,
    Folder,
    Zero,
    Pipe,
}

const KINDS: [Harm; 6] = [Harm::Missing, Harm::Empty, Harm::Swapped, Harm::Folder, Harm::Zero, Harm::Pipe];

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Damage::Node(pointer, change) => write!(f, "{pointer} {change:?}"),
            Damage::Line(number, line) => write!(f, "resolved.toml:{} {line}", number + 1),
            Damage::File(name, harm) => write!(f, "{name} {harm:?}"),
        }
    }
}

/// Values that replace a node.
fn values() -> Vec<Value> {
    vec![
        Value::Null,
        json!("NaN"),
        json!(1e308),
        json!(-1e308),
        json!(-1),
        json!(u64::MAX),
        json!(4_000_000_000u64),
        json!(0.5),
        json!([]),
        json!(""),
        json!({}),
        json!(true),
        json!([[[[1e308]]]]),
    ]
}

/// Pointers of all nodes; for lists only the first two elements and the last.
fn pointers(value: &Value, at: &str, out: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                let place = format!("{at}/{}", key.replace('~', "~0").replace('/', "~1"));
                out.push(place.clone());
                pointers(inner, &place, out);
            }
        }
        Value::Array(list) => {
            for (index, inner) in list.iter().enumerate().filter(|(index, _)| *index < 2 || index + 1 == list.len()) {
                let place = format!("{at}/{index}");
                out.push(place.clone());
                pointers(inner, &place, out);
            }
        }
        _ => {}
    }
}

/// All damages of a folder, in the same order in each run.
pub fn damages(folder: &Path) -> Vec<Damage> {
    let text = std::fs::read_to_string(folder.join("results.json")).expect("results");
    let whole: Value = serde_json::from_str(&text).expect("JSON");
    let (mut places, mut all) = (Vec::new(), Vec::new());
    pointers(&whole, "", &mut places);
    for (number, line) in std::fs::read_to_string(folder.join("resolved.toml")).expect("a study").lines().enumerate() {
        let Some((key, value)) = line.split_once(" = ") else { continue };
        let others = match value.parse::<f64>() {
            Ok(number) => {
                vec![number * 2.0, -number, 0.0, 1e308, number + 1.0].into_iter().map(|x| format!("{x:?}")).collect()
            }
            Err(_) => vec!["\"other\"".to_string(), "[]".into(), "nan".into()],
        };
        let whole = value.parse::<i64>().into_iter().flat_map(|x| [x + 1, 0, -1, i64::MAX].map(|x| x.to_string()));
        let lines = others.into_iter().chain(whole).map(|other| Damage::Line(number, format!("{key} = {other}")));
        all.extend(lines.chain([Damage::Line(number, String::new())]));
    }
    for name in files(folder, "") {
        all.extend(KINDS.iter().map(|harm| Damage::File(name.clone(), harm.clone())));
        all.extend((0..10).flat_map(|i| {
            [Damage::File(name.clone(), Harm::Cut(100 * i + 37)), Damage::File(name.clone(), Harm::Byte(100 * i + 41))]
        }));
    }
    for place in places {
        all.push(Damage::Node(place.clone(), Change::Delete));
        all.push(Damage::Node(place.clone(), Change::Duplicate));
        let own = whole.pointer(&place);
        let others = values().into_iter().filter(|value| Some(value) != own);
        all.extend(others.map(|value| Damage::Node(place.clone(), Change::Value(value))));
    }
    // The stride has no common factor with the number, so that neighbours in the selection are different damages of
    // different places.
    let (count, stride) = (all.len(), 7919);
    (0..count).map(|i| all[i * stride % count].clone()).collect()
}

fn files(folder: &Path, inner: &str) -> Vec<String> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder.join(inner)).expect("a folder").flatten() {
        let name = format!("{inner}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() { names.extend(files(folder, &format!("{name}/"))) } else { names.push(name) }
    }
    names.sort();
    names
}

impl Damage {
    /// True if the damage may be in an entry that claims nothing, or may have no effect.
    pub fn may_be_free(&self) -> bool {
        match self {
            Damage::Line(..) => true,
            Damage::File(name, harm) => match harm {
                // A missing table or figure is not a finding.
                Harm::Missing => !["results.json", "resolved.toml"].contains(&name.as_str()),
                _ => false,
            },
            Damage::Node(pointer, _) => {
                // The origin in the head only selects the kind of comparison.
                let origin = voussoir::results::HEAD.iter().any(|key| pointer.starts_with(&format!("/{key}")));
                origin || ["/seconds", "/counters", "/version", "/date"].iter().any(|key| pointer.contains(key))
            }
        }
    }

    /// Damages a folder; files are swapped with the files of `other`.
    pub fn apply(&self, folder: &Path, other: &Path) {
        match self {
            Damage::Node(pointer, change) => damage_node(&folder.join("results.json"), pointer, change),
            Damage::Line(number, line) => {
                let path = folder.join("resolved.toml");
                let text = std::fs::read_to_string(&path).expect("a study");
                let lines = text.lines().enumerate().map(|(at, own)| if at == *number { line } else { own });
                std::fs::write(&path, lines.collect::<Vec<_>>().join("\n")).expect("written");
            }
            Damage::File(name, harm) => damage_file(&folder.join(name), harm, &other.join(name)),
        }
    }
}

fn damage_node(path: &Path, pointer: &str, change: &Change) {
    let mut whole: Value = serde_json::from_slice(&std::fs::read(path).expect("results")).expect("JSON");
    if let Change::Value(value) = change {
        *whole.pointer_mut(pointer).expect("a node") = value.clone();
    } else {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        match (whole.pointer_mut(parent).expect("a node"), change) {
            (Value::Object(map), Change::Delete) => drop(map.remove(&key.replace("~1", "/").replace("~0", "~"))),
            (Value::Object(map), _) => drop(map.insert(format!("{key}2"), json!([1]))),
            (Value::Array(list), Change::Delete) => drop(list.remove(key.parse().expect("an index"))),
            (Value::Array(list), _) => {
                let index: usize = key.parse().expect("an index");
                list.insert(index, list[index].clone());
            }
            _ => {}
        }
    }
    std::fs::write(path, serde_json::to_string_pretty(&whole).expect("JSON")).expect("written");
}

fn damage_file(path: &Path, harm: &Harm, other: &Path) {
    let mut bytes = std::fs::read(path).expect("a file");
    let place = |thousandths: usize| bytes.len() * thousandths / 1000;
    match harm {
        Harm::Cut(at) => bytes.truncate(place(*at)),
        Harm::Byte(at) => {
            let at = place(*at);
            bytes[at] = 0xff;
        }
        Harm::Empty => bytes.clear(),
        Harm::Swapped => bytes = std::fs::read(other).unwrap_or_else(|_| b"name = 1\n".to_vec()),
        Harm::Missing | Harm::Folder | Harm::Zero | Harm::Pipe => {
            std::fs::remove_file(path).expect("removed");
            match harm {
                Harm::Folder => std::fs::create_dir(path).expect("a folder"),
                #[cfg(unix)]
                Harm::Zero => std::os::unix::fs::symlink("/dev/zero", path).expect("a link"),
                #[cfg(unix)]
                Harm::Pipe => {
                    let made = std::process::Command::new("mkfifo").arg(path).status().expect("mkfifo runs");
                    assert!(made.success());
                }
                _ => {}
            }
            return;
        }
    }
    std::fs::write(path, bytes).expect("written");
}
