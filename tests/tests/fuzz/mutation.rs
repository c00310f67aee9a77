//! Mutations of a tree of tables and lists: keys removed, doubled, swapped, of another type, with extreme values.

use super::shapes::{entry, entry_of, number, text, value_of};
use toml::{Table, Value};
use voussoir::core::random::Random;

/// Mutates a tree a few times.
pub fn mutate(tree: &mut Table, other: &Table, random: &mut Random) {
    let mut root = Value::Table(std::mem::take(tree));
    let times = *random.one_of(&[1, 1, 1, 2, 3, 5]);
    for _ in 0..times {
        once(&mut root, other, random);
    }
    if let Value::Table(root) = root {
        *tree = root;
    }
}

/// Returns the number of nodes of a tree, including the root.
fn size(value: &Value) -> usize {
    1 + match value {
        Value::Table(table) => table.values().map(size).sum(),
        Value::Array(list) => list.iter().map(size).sum(),
        _ => 0,
    }
}

/// Returns node number `index`, counted as in [`size`]; `index` must be below the number of nodes.
fn node_mut(value: &mut Value, index: usize) -> &mut Value {
    if index == 0 {
        return value;
    }
    let mut rest = index - 1;
    let inner: Vec<&mut Value> = match value {
        Value::Table(table) => table.iter_mut().map(|(_, value)| value).collect(),
        Value::Array(list) => list.iter_mut().collect(),
        _ => Vec::new(),
    };
    for value in inner {
        let own = size(value);
        if rest < own {
            return node_mut(value, rest);
        }
        rest -= own;
    }
    unreachable!("the index is below the size")
}

fn any<'a>(root: &'a mut Value, random: &mut Random) -> &'a mut Value {
    let index = random.whole(0, size(root) - 1);
    node_mut(root, index)
}

/// Returns a table of the tree.
fn any_table<'a>(root: &'a mut Value, random: &mut Random) -> &'a mut Table {
    let count = size(root);
    let mut index = random.whole(0, count - 1);
    while index > 0 && !node_mut(root, index).is_table() {
        index -= 1;
    }
    match node_mut(root, index) {
        Value::Table(table) => table,
        _ => unreachable!("the root is a table"),
    }
}

fn key_of(table: &Table, random: &mut Random) -> Option<String> {
    let keys: Vec<&String> = table.keys().collect();
    (!keys.is_empty()).then(|| (*random.one_of(&keys)).clone())
}

fn once(root: &mut Value, other: &Table, random: &mut Random) {
    match random.whole(0, 24) {
        0 => {
            let table = any_table(root, random);
            if let Some(key) = key_of(table, random) {
                table.remove(&key);
            }
        }
        1 => {
            let table = any_table(root, random);
            table.extend([entry(random)]);
        }
        2 => {
            let table = any_table(root, random);
            if let Some(key) = key_of(table, random) {
                let value = table[&key].clone();
                let (name, _) = entry(random);
                table.insert(
                    random.one_of(&[format!("{key}_"), name, key.to_uppercase(), format!("{key}.{key}")]).clone(),
                    value,
                );
            }
        }
        3 => {
            let value = any(root, random).clone();
            *any(root, random) = value;
            keep_root(root);
        }
        4 => {
            let table = any_table(root, random);
            if let Some(key) = key_of(table, random)
                && let Some(foreign) = other.get(&key).or_else(|| other.values().next())
            {
                table.insert(key, foreign.clone());
            }
        }
        5 => list(root, random),
        6 => {
            let key = key_path(root, random);
            let axis = [
                Table::from_iter([(
                    "list".to_string(),
                    Value::Array(vec![number(random), text(random), number(random)]),
                )]),
                Table::from_iter(
                    [("from", number(random)), ("to", number(random)), ("count", Value::Integer(3))]
                        .map(|(k, v)| (k.to_string(), v)),
                ),
            ];
            let axis = random.one_of(&axis).clone();
            if let Value::Table(root) = root
                && let Value::Table(sweep) = root.entry("sweep").or_insert_with(|| Table::new().into())
            {
                sweep.insert(key, axis.into());
            }
        }
        7..=10 => {
            let place = any(root, random);
            *place = scalar(place, random);
            keep_root(root);
        }
        11..=13 => {
            let table = any_table(root, random);
            table.extend(entry_of(table, random));
        }
        14..=17 => {
            let place = any(root, random);
            if let Value::Float(_) | Value::Integer(_) = place {
                *place = near(place, random);
            }
        }
        _ => {
            let table = any_table(root, random);
            if let Some(key) = key_of(table, random)
                && let Some(value) = value_of(&key, random)
            {
                table.insert(key, value);
            }
        }
    }
}

/// Returns a plausible number near another one.
fn near(old: &Value, random: &mut Random) -> Value {
    match old {
        Value::Integer(x) => Value::Integer((x + random.whole(0, 6) as i64 - 3).max(1)),
        Value::Float(x) => Value::Float(x * random.power(-1.0, 1.0)),
        other => other.clone(),
    }
}

/// Makes the root a table again.
fn keep_root(root: &mut Value) {
    if !root.is_table() {
        *root = Table::from_iter([("name".to_string(), root.clone())]).into();
    }
}

/// Returns another value, often of the same type.
fn scalar(old: &Value, random: &mut Random) -> Value {
    match (old, random.whole(0, 6)) {
        (Value::Float(x), 0..=2) => {
            Value::Float(x * *random.one_of(&[0.0, 0.5, 2.0, -1.0, 1e3, 1e-3, 1e12, 1e-12, 1.0 + 1e-9]))
        }
        (Value::Integer(x), 0..=2) => Value::Integer(x.wrapping_add(*random.one_of(&[1, -1, 2, 1000]))),
        (_, 3) => Value::Array(vec![old.clone()]),
        (_, 4) => text(random),
        (Value::Table(_) | Value::Array(_), 5) => Table::new().into(),
        (_, 5) => random.chance(0.5).into(),
        _ => number(random),
    }
}

/// Changes a list: doubles an entry, empties or shortens it, or changes its order.
fn list(root: &mut Value, random: &mut Random) {
    let count = size(root);
    let mut index = random.whole(0, count - 1);
    while index > 0 && !node_mut(root, index).is_array() {
        index -= 1;
    }
    let Value::Array(list) = node_mut(root, index) else { return };
    match (list.len(), random.whole(0, 3)) {
        (0, _) => list.push(number(random)),
        (_, 0) => list.reverse(),
        (len, 1) => list.truncate(random.whole(0, len - 1)),
        (len, 2) => {
            let entry = list[random.whole(0, len - 1)].clone();
            list.insert(random.whole(0, len), entry);
        }
        (_, _) => list.clear(),
    }
}

/// Returns the dotted key of a value in the tree.
fn key_path(root: &Value, random: &mut Random) -> String {
    let (mut path, mut value) = (Vec::new(), root);
    loop {
        let (segment, inner) = match value {
            Value::Table(table) if !table.is_empty() => {
                let entries: Vec<_> = table.iter().collect();
                let (key, inner) = *random.one_of(&entries);
                (key.clone(), inner)
            }
            Value::Array(list) if !list.is_empty() => {
                let index = random.whole(0, list.len() - 1);
                (index.to_string(), &list[index])
            }
            _ => return path.join("."),
        };
        path.push(segment);
        value = inner;
    }
}

/// Changes the characters of a text: some are removed, doubled, replaced or cut off.
pub fn scramble(text: &str, random: &mut Random) -> String {
    const OTHERS: [char; 20] = [
        '"', '\'', '[', ']', '{', '}', '=', '.', ',', '#', '\n', '\\', '\0', '9', '-', 'e', ';', '\u{202e}', 'é',
        '\u{1b}',
    ];
    let mut all: Vec<char> = text.chars().collect();
    for _ in 0..*random.one_of(&[1, 1, 2, 4, 16]) {
        if all.is_empty() {
            break;
        }
        let place = random.whole(0, all.len() - 1);
        match random.whole(0, 4) {
            0 => drop(all.remove(place)),
            1 => all.insert(place, *random.one_of(&OTHERS)),
            2 => all[place] = *random.one_of(&OTHERS),
            3 if random.chance(0.2) => all.truncate(place),
            _ => {
                let end = (place + random.whole(1, 40)).min(all.len());
                let part = all[place..end].to_vec();
                let to = random.whole(0, all.len());
                all.splice(to..to, part);
            }
        }
    }
    all.into_iter().collect()
}
