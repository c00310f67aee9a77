//! Variants, scenes of a comparison and sweeps: the cases of a study. Variants are outermost, then the scenes, then the axes
//! of the sweep in the order of the file; the first axis changes slowest. A variant overrides a scene, a swept value
//! overrides both.

use crate::config::diagnostic::{LocatedDiagnostic, suggest};
use crate::config::document::{Node, Table, Value};
use crate::config::dotted_key::{join, segments};
use crate::config::gravity::gravity_of;
use crate::config::key_meaning::key_meaning;
use crate::config::origin::Origin;
use crate::config::overlay::set;
use crate::config::synonyms::nearest_name;
use serde_json::{Map, Value as Json};
use voussoir_core::plugin::Parameter;

/// Greatest number of cases.
pub const MAX_CASES: usize = 1_000_000;

/// Keys that change together.
#[derive(Debug, Clone)]
struct Axis {
    keys: Vec<(String, Origin)>,
    /// One value per key for each step.
    values: Vec<Vec<Node>>,
}

#[derive(Debug, Clone)]
struct Variant {
    name: Option<String>,
    set: Vec<(String, Origin, Node)>,
}

/// The cases of a study, created one at a time.
#[derive(Debug, Clone)]
pub struct Expansion {
    base: Node,
    variants: Vec<Variant>,
    scenes: Vec<Variant>,
    axes: Vec<Axis>,
    /// Keys of the study file; their quantities convert texts with units into numbers.
    schema: &'static [Parameter],
}

/// One case before its check.
#[derive(Debug)]
pub struct Expanded {
    /// Name of its variant.
    pub variant: Option<String>,
    /// Name of its scene, if the study compares several.
    pub scene: Option<String>,
    /// Swept key → value. A text with a unit becomes the number in the unit of its key.
    pub parameters: Map<String, Json>,
    /// The whole study file of this case, without `sweep`, `variants`
    /// and the tables of study kinds.
    pub root: Node,
}

/// Rounds `x` to 12 significant digits, so that 5.69 − 9 · 0.30 is 2.99.
pub fn rounded(x: f64) -> f64 {
    if x.is_finite() { format!("{x:.11e}").parse().unwrap_or(x) } else { x }
}

impl Expansion {
    /// Reads `sweep` and `variants` of a study file, and the `scenes` of its kind's table. The error lists all mistakes in them.
    /// `kind_tables` are the tables of study kinds, which are not part of a case; `schema` has the keys of the study file.
    pub fn new(
        root: &Node,
        kind_tables: &[&str],
        schema: &'static [Parameter],
    ) -> Result<Self, Vec<LocatedDiagnostic>> {
        let mut mistakes = Vec::new();
        let table = root.table().cloned().unwrap_or_default();
        let axes = table.get("sweep").map(|node| axes(node, &mut mistakes)).unwrap_or_default();
        let overrides =
            |node: Option<&Node>, key: &str, what: &str, mistakes: &mut Vec<LocatedDiagnostic>| -> Vec<Variant> {
                let read = node.map(|node| read_variants(node, key, what, mistakes)).unwrap_or_default();
                if read.is_empty() { vec![Variant { name: None, set: Vec::new() }] } else { read }
            };
        let variants = overrides(table.get("variants"), "variants", "variants", &mut mistakes);
        let kind = table.get("kind").and_then(Node::text).filter(|kind| kind_tables.contains(kind)).unwrap_or_default();
        let scenes = table.get(kind).and_then(|own| own.table()?.get("scenes"));
        let scenes = overrides(scenes, &join(kind, "scenes"), "scenes", &mut mistakes);
        let swept: Vec<&str> = axes.iter().flat_map(|axis| &axis.keys).map(|(key, _)| key.as_str()).collect();
        for (index, (key, origin)) in axes.iter().flat_map(|axis| &axis.keys).enumerate() {
            if swept[..index].contains(&key.as_str()) {
                mistakes.push(LocatedDiagnostic::new(origin, key, "is swept twice").help("keep one of the two axes"));
            }
        }
        for (what, list) in [("variant", &variants), ("scene", &scenes)] {
            for (key, origin, _) in list.iter().flat_map(|entry| &entry.set) {
                if swept.contains(&key.as_str()) {
                    let help = format!("remove it from the sweep or from the {what}");
                    mistakes.push(
                        LocatedDiagnostic::new(origin, key, format!("is set by a {what}, but swept too")).help(help),
                    );
                }
            }
        }
        let apart = |key: &str| ["sweep", "variants"].contains(&key) || kind_tables.contains(&key);
        let base = table.entries.into_iter().filter(|entry| !apart(&entry.key));
        let base = Table { entries: base.collect() };
        let base = Node { value: Value::Table(base), origin: root.origin.clone() };
        let expansion = Expansion { base, variants, scenes, axes, schema };
        let overridden = expansion.variants.len().checked_mul(expansion.scenes.len());
        let count = expansion
            .axes
            .iter()
            .try_fold(overridden.unwrap_or(usize::MAX), |n, axis| n.checked_mul(axis.values.len()));
        if count.is_none_or(|count| count > MAX_CASES) {
            let count = count.map_or("far too many".into(), |count| count.to_string());
            let message = format!("makes {count} cases; a study holds at most {MAX_CASES}");
            mistakes
                .push(LocatedDiagnostic::new(&root.place("sweep"), "sweep", message).help("use fewer values per axis"));
        }
        if mistakes.is_empty() { Ok(expansion) } else { Err(mistakes) }
    }

    /// Returns the study file from which the cases are made.
    pub fn base(&self) -> &Node {
        &self.base
    }

    /// Returns true if a variant, a scene or the sweep sets a top-level key or a key below it.
    pub fn changes(&self, name: &str) -> bool {
        let set = self.variants.iter().chain(&self.scenes).flat_map(|entry| &entry.set).map(|(key, ..)| key.as_str());
        set.chain(self.swept()).any(|key| segments(key).first().is_some_and(|first| first == name))
    }

    /// Returns the swept keys.
    pub fn swept(&self) -> impl Iterator<Item = &str> {
        self.axes.iter().flat_map(|axis| &axis.keys).map(|(key, _)| key.as_str())
    }

    /// Returns the keys of each axis of the sweep, with true if the values of the first key are numbers.
    pub fn axes(&self) -> Vec<(Vec<String>, bool)> {
        let keys = |axis: &Axis| axis.keys.iter().map(|(key, _)| key.clone()).collect();
        (0..self.axes.len()).map(|axis| (keys(&self.axes[axis]), self.is_number(axis, 0))).collect()
    }

    /// Returns the swept keys, each with true if all its values are numbers.
    pub fn number_keys(&self) -> Vec<(String, bool)> {
        let keys = |axis: usize| {
            let keys = self.axes[axis].keys.iter().enumerate();
            keys.map(move |(place, (key, _))| (key.clone(), self.is_number(axis, place)))
        };
        (0..self.axes.len()).flat_map(keys).collect()
    }

    /// The values of a swept key in the order of its axis, as the first variant and scene have them.
    pub fn values(&self, key: &str) -> Vec<Json> {
        let place = |axis: &Axis| axis.keys.iter().any(|(own, _)| own == key);
        let Some(axis) = self.axes.iter().position(place) else { return Vec::new() };
        let inner: usize = self.axes[axis + 1..].iter().map(|axis| axis.values.len()).product();
        let of = |step: usize| self.case(step * inner).ok()?.parameters.get(key).cloned();
        (0..self.axes[axis].values.len()).filter_map(of).collect()
    }

    /// Returns true if all values of a key are numbers, or texts that are numbers with a unit in every variant and scene.
    fn is_number(&self, axis: usize, place: usize) -> bool {
        let own = &self.axes[axis];
        let inner: usize = self.axes[axis + 1..].iter().map(|axis| axis.values.len()).product();
        let outer = self.count() / (own.values.len() * inner);
        let key = &own.keys[place].0;
        let in_case = |id: usize| self.case(id).is_ok_and(|case| case.parameters[key].is_number());
        let texts = own.values.iter().enumerate().filter(|(_, step)| step[place].number().is_none());
        // The axes outside this axis do not change the unit.
        let stride = self.axes[..axis].iter().map(|axis| axis.values.len()).product::<usize>().max(1);
        texts
            .map(|(step, _)| step)
            .all(|step| (0..outer).step_by(stride).all(|outer| in_case((outer * own.values.len() + step) * inner)))
    }

    /// Returns the names of the variants; empty if the study has none.
    pub fn variants(&self) -> Vec<String> {
        self.variants.iter().filter_map(|variant| variant.name.clone()).collect()
    }

    /// Returns the names of the compared scenes; empty if the study has a single scene.
    pub fn scenes(&self) -> Vec<String> {
        self.scenes.iter().filter_map(|scene| scene.name.clone()).collect()
    }

    /// Returns the number of cases.
    pub fn count(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product::<usize>() * self.variants.len() * self.scenes.len()
    }

    /// Returns the ids of up to `most` cases: one for each variant, scene and text of an axis. Axes of numbers stay at their
    /// first value.
    pub fn one_of_each(&self, most: usize) -> Vec<usize> {
        let mut ids: Vec<usize> = (0..self.variants.len() * self.scenes.len()).take(most).collect();
        for axis in &self.axes {
            let numbers = axis.values.iter().flatten().all(|value| value.number().is_some());
            let steps = if numbers { 1 } else { axis.values.len() };
            let further = |id: usize| (0..steps).map(move |step| id * axis.values.len() + step);
            ids = ids.into_iter().flat_map(further).take(most).collect();
        }
        ids
    }

    /// Returns case `id < count()`.
    pub fn case(&self, id: usize) -> Result<Expanded, Vec<LocatedDiagnostic>> {
        let mut rest = id;
        let mut steps = vec![0; self.axes.len()];
        for (step, axis) in steps.iter_mut().zip(&self.axes).rev() {
            (*step, rest) = (rest % axis.values.len(), rest / axis.values.len());
        }
        let (variant, scene) = (&self.variants[rest / self.scenes.len()], &self.scenes[rest % self.scenes.len()]);
        let (mut root, mut mistakes, mut parameters) = (self.base.clone(), Vec::new(), Map::new());
        for (key, origin, value) in scene.set.iter().chain(&variant.set) {
            mistakes.extend(set(&mut root, key, value.clone(), origin).err().map(|mistake| *mistake));
        }
        for (axis, &step) in self.axes.iter().zip(&steps) {
            for ((key, origin), value) in axis.keys.iter().zip(&axis.values[step]) {
                parameters.insert(key.clone(), value.to_json());
                mistakes.extend(set(&mut root, key, value.clone(), origin).err().map(|mistake| *mistake));
            }
        }
        self.add_numbers(&root, &mut parameters);
        if mistakes.is_empty() {
            Ok(Expanded { variant: variant.name.clone(), scene: scene.name.clone(), parameters, root })
        } else {
            Err(mistakes)
        }
    }
}

impl Expansion {
    /// Replaces texts with units by numbers in the unit of their key.
    fn add_numbers(&self, root: &Node, parameters: &mut Map<String, Json>) {
        if !parameters.values().any(Json::is_string) {
            return;
        }
        let (tables, gravity) = (root.to_json(), gravity_of(root));
        for (key, value) in parameters.iter_mut() {
            let Some(text) = value.as_str() else { continue };
            let quantity = key_meaning(self.schema, &|name| tables.get(name), key).and_then(|meaning| meaning.quantity);
            let number = quantity.and_then(|quantity| quantity.parse(text, gravity).ok());
            if let Some(number) = number.map(rounded).filter(|number| number.is_finite()) {
                *value = number.into();
            }
        }
    }
}

/// Reads the entries of a list of overrides: `key` is its key, `what` the name of its entries in messages.
fn read_variants(node: &Node, key: &str, what: &str, mistakes: &mut Vec<LocatedDiagnostic>) -> Vec<Variant> {
    let mut out: Vec<Variant> = Vec::new();
    for (index, node) in node.array().unwrap_or_default().iter().enumerate() {
        let Some(table) = node.table() else { continue };
        let name = table.get("name").and_then(Node::text).map(str::to_string);
        if name.is_some() && out.iter().any(|earlier| earlier.name == name) {
            let key = join(&join(key, &index.to_string()), "name");
            let message = format!("two {what} are called \"{}\"", name.clone().unwrap_or_default());
            let place = table.get("name").map_or(&node.origin, |name| &name.origin);
            mistakes.push(
                LocatedDiagnostic::new(place, key, message)
                    .help(format!("give each {} a name of its own", what.trim_end_matches('s'))),
            );
        }
        let set = table.get("set").and_then(Node::table).map(|set| set.entries.as_slice()).unwrap_or_default();
        let set = set.iter().map(|e| (e.key.clone(), e.origin.clone(), e.node.clone())).collect();
        out.push(Variant { name, set });
    }
    out
}

fn axes(node: &Node, mistakes: &mut Vec<LocatedDiagnostic>) -> Vec<Axis> {
    let Some(table) = node.table() else {
        let message = format!("must be a table from keys to axes, but is {}", node.describe());
        mistakes.push(LocatedDiagnostic::new(&node.origin, "sweep", message));
        return Vec::new();
    };
    let mut axes = Vec::new();
    for entry in &table.entries {
        if entry.key != "zip" {
            if let Some(values) = axis(&entry.node, &join("sweep", &entry.key), mistakes) {
                let values = values.into_iter().map(|value| vec![value]).collect();
                axes.push(Axis { keys: vec![(entry.key.clone(), entry.origin.clone())], values });
            }
            continue;
        }
        let mut keys = Vec::new();
        let mut columns: Vec<Vec<Node>> = Vec::new();
        for entry in entry.node.table().map(|table| table.entries.as_slice()).unwrap_or_default() {
            let path = join("sweep.zip", &entry.key);
            let Some(values) = axis(&entry.node, &path, mistakes) else {
                continue;
            };
            if let Some(first) = columns.first()
                && first.len() != values.len()
            {
                let message = format!(
                    "has {} values, but {} has {}; keys in [sweep.zip] change together",
                    values.len(),
                    keys_name(&keys),
                    first.len()
                );
                mistakes.push(
                    LocatedDiagnostic::new(&entry.node.origin, path, message)
                        .help("give both the same number of values"),
                );
                continue;
            }
            keys.push((entry.key.clone(), entry.origin.clone()));
            columns.push(values);
        }
        let steps = columns.first().map_or(0, Vec::len);
        if steps > 0 {
            let values = (0..steps).map(|i| columns.iter().map(|column| column[i].clone()).collect()).collect();
            axes.push(Axis { keys, values });
        }
    }
    axes
}

fn keys_name(keys: &[(String, Origin)]) -> &str {
    keys.first().map_or("", |(key, _)| key)
}

const FORMS: &str = "write { list = [1.0, 2.0] }, { from = 1.0, to = 2.0, step = 0.5 } or { from = 1.0, to = 2.0, count = 3 }, and the swept key in quotes: \"scene.profile.rise\"";

/// Returns the values of one axis; `None` if it has mistakes.
fn axis(node: &Node, path: &str, mistakes: &mut Vec<LocatedDiagnostic>) -> Option<Vec<Node>> {
    let before = mistakes.len();
    let Some(table) = node.table() else {
        mistakes.push(
            LocatedDiagnostic::new(&node.origin, path, format!("must be a table, but is {}", node.describe()))
                .help(FORMS),
        );
        return None;
    };
    for entry in &table.entries {
        let names = ["list", "from", "to", "step", "count"];
        if !names.contains(&entry.key.as_str()) {
            let help = match nearest_name(&entry.key, names) {
                Some(_) => suggest(&entry.key, &names, "keys here"),
                None => FORMS.into(),
            };
            mistakes.push(
                LocatedDiagnostic::new(&entry.origin, join(path, &entry.key), "is not a key of an axis").help(help),
            );
        }
    }
    if mistakes.len() > before {
        return None;
    }
    let given: Vec<&str> = table.keys().collect();
    let values = match (table.get("list"), given.len()) {
        (Some(list), 1) => listed(list, &join(path, "list"), mistakes),
        (None, 3) if !(given.contains(&"step") && given.contains(&"count")) => spaced(node, table, path, mistakes),
        _ => {
            let message = format!("has the keys {}, which is no axis", given.join(", "));
            mistakes.push(LocatedDiagnostic::new(&node.origin, path, message).help(FORMS));
            None
        }
    };
    values.filter(|_| mistakes.len() == before)
}

fn listed(list: &Node, path: &str, mistakes: &mut Vec<LocatedDiagnostic>) -> Option<Vec<Node>> {
    let Some(nodes) = list.array().filter(|nodes| !nodes.is_empty()) else {
        let message = "must be a list of at least one value";
        mistakes.push(LocatedDiagnostic::new(&list.origin, path, message));
        return None;
    };
    let mut values = nodes.to_vec();
    for (index, node) in values.iter_mut().enumerate() {
        match &mut node.value {
            Value::Float(number) => *number = rounded(*number),
            Value::Integer(_) | Value::String(_) | Value::Boolean(_) => {}
            _ => {
                let message =
                    format!("a swept value is a number, a text, true or false, but this is {}", node.describe());
                let help = "sweep a single number of it (its index from 0 is part of the key), or use variants";
                mistakes.push(LocatedDiagnostic::new(&node.origin, join(path, &index.to_string()), message).help(help));
            }
        }
    }
    Some(values)
}

fn spaced(node: &Node, table: &Table, path: &str, mistakes: &mut Vec<LocatedDiagnostic>) -> Option<Vec<Node>> {
    let mut number = |key: &str| -> Option<f64> {
        let value = table.get(key)?;
        let number = value.number().filter(|number| number.is_finite());
        if number.is_none() {
            let message = format!("must be a finite number, but is {}", value.describe());
            mistakes.push(LocatedDiagnostic::new(&value.origin, join(path, key), message));
        }
        number
    };
    let (from, to, step, count) = (number("from"), number("to"), number("step"), number("count"));
    let (from, to) = (from?, to?);
    let mut wrong = |key: &str, message: String, help: &str| -> Option<Vec<Node>> {
        mistakes.push(LocatedDiagnostic::new(&table.get(key)?.origin, join(path, key), message).help(help));
        None
    };
    let (count, step) = match (step, count) {
        (Some(0.0), _) => {
            return wrong("step", "is zero, so the sweep would never end".into(), "give a step towards `to`");
        }
        (Some(step), _) => {
            if (to - from) * step < 0.0 {
                let message = format!("{step} leads away from {to}, since the sweep starts at {from}");
                return wrong("step", message, "change the sign of the step, or swap from and to");
            }
            ((to - from) / step + 1e-9, Some(step))
        }
        (None, Some(count)) => {
            if count < 1.0 || count.fract() != 0.0 {
                return wrong(
                    "count",
                    format!("must be a whole number of at least 1, but is {count}"),
                    "give the number of values",
                );
            }
            (count - 1.0, None)
        }
        (None, None) => return None,
    };
    if count >= MAX_CASES as f64 {
        let key = if step.is_some() { "step" } else { "count" };
        return wrong(
            key,
            format!("makes {:.0} values; a study holds at most {MAX_CASES}", count.floor() + 1.0),
            "use fewer values",
        );
    }
    let last = count.floor();
    let at = |i: f64| match step {
        Some(step) => from + i * step,
        None if last == 0.0 => from,
        None => from + (to - from) * (i / last),
    };
    // A rounding error around zero becomes 0.
    let size = at(0.0).abs().max(at(last).abs());
    let whole = |x: f64| if x.abs() < 1e-12 * size { 0.0 } else { rounded(x) };
    let numbers: Vec<f64> = (0..=last as usize).map(|i| whole(at(i as f64))).collect();
    let written_whole = table.entries.iter().all(|entry| matches!(entry.node.value, Value::Integer(_)));
    let whole = written_whole && numbers.iter().all(|number| number.fract() == 0.0);
    let value = |number: f64| {
        if whole { Value::Integer(number as i64) } else { Value::Float(number) }
    };
    Some(numbers.into_iter().map(|number| Node { value: value(number), origin: node.origin.clone() }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::document::parse;

    fn expansion(text: &str) -> Result<Expansion, Vec<LocatedDiagnostic>> {
        Expansion::new(&parse(text, "a.toml").unwrap(), &[], &[])
    }

    fn column(expansion: &Expansion, key: &str) -> Vec<Json> {
        (0..expansion.count()).map(|id| expansion.case(id).unwrap().parameters[key].clone()).collect()
    }

    #[test]
    fn the_value_used_is_the_rounded_one() {
        let expansion =
            expansion("[scene]\nrise = 1.0\n[sweep]\n\"scene.rise\" = { from = 5.69, to = 0.29, step = -0.30 }")
                .unwrap();
        let rises = column(&expansion, "scene.rise");
        assert_eq!(rises.len(), 19);
        assert_eq!(rises[9].as_f64(), Some(2.99));
        assert_eq!(rises[18].as_f64(), Some(0.29));
        assert_eq!(expansion.case(9).unwrap().root.to_json()["scene"]["rise"].as_f64(), Some(2.99));
    }

    #[test]
    fn variants_are_outermost_and_the_first_axis_is_slowest() {
        let text = "[sweep]\n\"a\" = { list = [1, 2] }\n\"b\" = { from = 0, to = 4, count = 3 }\n[[variants]]\nname = \"x\"\n[[variants]]\nname = \"y\"\nset = { c = true }";
        let expansion = expansion(text).unwrap();
        assert_eq!(expansion.count(), 12);
        assert_eq!(column(&expansion, "a")[..6], [1, 1, 1, 2, 2, 2].map(Json::from));
        assert_eq!(column(&expansion, "b")[..4], [0, 2, 4, 0].map(Json::from));
        assert_eq!(expansion.case(5).unwrap().variant.as_deref(), Some("x"));
        assert_eq!(expansion.case(6).unwrap().root.to_json()["c"], true);
    }

    #[test]
    fn keys_under_zip_change_together() {
        let expansion = expansion("[sweep.zip]\n\"a\" = { list = [1, 2] }\n\"b\" = { list = [3, 4] }").unwrap();
        assert_eq!(
            (column(&expansion, "a"), column(&expansion, "b")),
            (vec![1.into(), 2.into()], vec![3.into(), 4.into()])
        );
    }

    #[test]
    fn too_many_cases_are_a_mistake() {
        let axis = "{ from = 1, to = 2000, step = 1 }";
        let mistakes = expansion(&format!("[sweep]\n\"a\" = {axis}\n\"b\" = {axis}")).unwrap_err();
        assert!(mistakes[0].message.contains("makes 4000000 cases"));
    }
}
