//! Checks a value against its [`Shape`]. Collects every mistake with its place, or returns the normalised value (numbers in
//! the unit of their quantity, defaults filled in).

use crate::config::common_keys::{common_parameters, common_words, word_for};
use crate::config::diagnostic::{LocatedDiagnostic, any_of, suggest};
use crate::config::document::{Node, Table, Value, parse_value};
use crate::config::documented_vehicles;
use crate::config::dotted_key::join;
use crate::config::gravity::gravity_of;
use crate::config::origin::Origin;
use crate::config::shape_words::{any_shape, describe, fits};
use crate::config::synonyms::nearest_name;
use serde_json::{Map, Value as Json};
use voussoir_core::plugin::{Card, Need, Parameter, PluginKind, Quantity, Shape, Variant, candidate, candidates, card};

/// A key that another plug-in of the same kind knows, but the chosen one does not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unused {
    /// Its dotted key.
    pub key: String,
    /// The plug-in that does not use the key, in words: `interface law "coulomb"`.
    pub by: String,
}

/// The value has mistakes; they are in the list of the checker.
#[derive(Debug, Clone, Copy)]
pub struct Rejected;

/// Returns message and help for a tag that is not one of `tags`.
fn unknown_tag(tag: &str, tags: &[&str], what: &str) -> (String, String) {
    let is_plugin = PluginKind::ALL.iter().any(|kind| kind.describe() == what);
    let other = PluginKind::ALL.into_iter().find(|kind| is_plugin && card(*kind, tag).is_some());
    if let Some(other) = other {
        let message = format!("\"{tag}\" is {}, not {}", with_article(other.describe()), with_article(what));
        let place = match other {
            PluginKind::InterfaceLaw => "it belongs in [joints.NAME]".into(),
            PluginKind::BulkMaterial => "it belongs in [materials.NAME]".into(),
            _ => format!("choose it by {} = \"{tag}\"", other.tag_key()),
        };
        let help = format!("{place}; choices here: {}", tags.join(", "));
        return (message, help);
    }
    let mut help = suggest(tag, tags, "choices");
    if is_plugin && nearest_name(tag, tags.iter().copied()).is_none() {
        help += "; one of another crate is there only in a program that names that crate (docs/adding_a_law.md)";
    }
    (format!("there is no {what} \"{tag}\""), help)
}

/// `a scene`, `an interface law`.
fn with_article(word: &str) -> String {
    format!("{} {word}", if word.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" })
}

/// A check in progress.
#[derive(Debug)]
pub struct Checker<'a> {
    /// Root of the study, in which names are looked up.
    pub root: &'a Node,
    /// Gravity that converts specific weights into densities \[m/s²\].
    pub gravity: f64,
    /// Mistakes so far.
    pub diagnostics: Vec<LocatedDiagnostic>,
    /// Unused keys so far.
    pub unused: Vec<Unused>,
    /// Tables of the study in which names were looked up.
    pub references: Vec<&'static str>,
}

impl<'a> Checker<'a> {
    /// Begins a check of values in the study `root`.
    pub fn new(root: &'a Node) -> Self {
        Checker { root, gravity: gravity_of(root), diagnostics: Vec::new(), unused: Vec::new(), references: Vec::new() }
    }

    fn wrong(&mut self, origin: &Origin, key: &str, message: impl Into<String>) -> Option<Json> {
        self.diagnostics.push(LocatedDiagnostic::new(origin, key, message));
        None
    }

    fn wrong_with_help(&mut self, origin: &Origin, key: &str, message: String, help: String) -> Option<Json> {
        self.diagnostics.push(LocatedDiagnostic::new(origin, key, message).help(help));
        None
    }

    /// Returns the normalised value; `None` if it has mistakes.
    pub fn check(&mut self, node: &Node, shape: &Shape, key: &str) -> Option<Json> {
        let found = self.diagnostics.len();
        let value = match (shape, &node.value) {
            (Shape::Number(..), Value::Integer(_) | Value::Float(_) | Value::String(_)) => {
                self.number(node, shape, key).map(Json::from)
            }
            (Shape::Integer { min, max }, Value::Integer(whole)) => self.integer(node, *whole, [*min, *max], key),
            (Shape::Boolean, Value::Boolean(value)) => Some((*value).into()),
            (Shape::Text, Value::String(text)) => Some(text.clone().into()),
            (Shape::Choice(words), Value::String(text)) => self.choice(node, text, words, key),
            (Shape::Reference(table), Value::String(text)) => self.reference(node, text, table, key),
            (Shape::List { of, min, max }, Value::Array(nodes)) => self.list(node, nodes, of, [*min, *max], key),
            (Shape::Tuple(shapes), Value::Array(nodes)) => self.tuple(node, nodes, shapes, key),
            (Shape::Table(parameters), Value::Table(table)) => self.table(node, table, parameters, &[], &[], key),
            (Shape::Map(of), Value::Table(table)) => {
                let entries: Vec<_> = table
                    .entries
                    .iter()
                    .map(|entry| Some((entry.key.clone(), self.check(&entry.node, of, &join(key, &entry.key))?)))
                    .collect();
                entries.into_iter().collect::<Option<Map<_, _>>>().map(Json::Object)
            }
            (Shape::Tagged { key: tag_key, variants }, Value::Table(table)) => {
                self.tagged(node, table, tag_key, variants, key)
            }
            (Shape::Plugin(kind), Value::Table(table)) => self.plugin(node, table, *kind, key),
            (Shape::Either(shapes), _) => return self.either(node, shapes, key),
            (Shape::Free, _) => {
                self.finite(node, key);
                Some(node.to_json())
            }
            _ => {
                let message = format!("must be {}, but is {}", describe(shape), node.describe());
                if let (Shape::List { .. }, Some(_)) = (shape, node.table()) {
                    let help = format!("write [[{key}]] with two brackets, or the table in brackets: [{{ … }}]");
                    return self.wrong_with_help(&node.origin, key, message, help);
                }
                return self.wrong(&node.origin, key, message);
            }
        };
        value.filter(|_| self.diagnostics.len() == found)
    }

    /// Returns a number in the unit of its quantity.
    fn number(&mut self, node: &Node, shape: &Shape, key: &str) -> Option<f64> {
        let Shape::Number(quantity, range) = shape else { return None };
        let number = match &node.value {
            Value::String(text) => match quantity.parse(text, self.gravity) {
                Ok(number) => number,
                Err(why) => {
                    let help = format!("write {}", describe(shape));
                    self.wrong_with_help(&node.origin, key, why, help);
                    return None;
                }
            },
            _ => node.number().unwrap_or(f64::NAN),
        };
        if !number.is_finite() {
            let message = format!("{} is not a finite number", number.to_string().to_lowercase());
            self.wrong(&node.origin, key, message);
            return None;
        }
        if !range.contains(number) {
            let unit = if *quantity == Quantity::Ratio { String::new() } else { format!(" {}", quantity.unit()) };
            let message = format!("{number}{unit} is out of range: it must be {}", range.describe());
            if *quantity == Quantity::Acceleration && number < 0.0 {
                let help =
                    "a single number acts downwards: write it without its sign, or a vector [gx, gy]".to_string();
                self.wrong_with_help(&node.origin, key, message, help);
            } else {
                self.wrong(&node.origin, key, message);
            }
            return None;
        }
        Some(number)
    }

    fn integer(&mut self, node: &Node, whole: i64, [min, max]: [i64; 2], key: &str) -> Option<Json> {
        if whole < min || whole > max {
            let range = if max == i64::MAX { format!("at least {min}") } else { format!("from {min} to {max}") };
            return self.wrong(&node.origin, key, format!("{whole} is out of range: it must be {range}"));
        }
        Some(whole.into())
    }

    fn choice(&mut self, node: &Node, text: &str, words: &[&str], key: &str) -> Option<Json> {
        if !words.contains(&text) {
            let (message, help) = (format!("\"{text}\" is not a choice here"), suggest(text, words, "choices"));
            return self.wrong_with_help(&node.origin, key, message, help);
        }
        Some(text.into())
    }

    fn reference(&mut self, node: &Node, text: &str, table: &'static str, key: &str) -> Option<Json> {
        if !self.references.contains(&table) {
            self.references.push(table);
        }
        let entries = self.root.table().and_then(|root| root.get(table)?.table());
        let names: Vec<&str> = entries.map(|entries| entries.keys().collect()).unwrap_or_default();
        if !names.contains(&text) {
            let documented = if table == "vehicles" { documented_vehicles::names() } else { Vec::new() };
            let all = names.iter().copied().chain(documented.iter().map(String::as_str));
            let help = match nearest_name(text, all) {
                Some(name) => format!("did you mean \"{name}\"?"),
                None => suggest(text, &names, &format!("entries of [{table}]")),
            };
            let message = format!("there is no [{table}.{text}] in this study");
            return self.wrong_with_help(&node.origin, key, message, help);
        }
        Some(text.into())
    }

    fn list(&mut self, node: &Node, nodes: &[Node], of: &Shape, [min, max]: [usize; 2], key: &str) -> Option<Json> {
        if nodes.len() < min || nodes.len() > max {
            let wanted = match (min, max) {
                (least, most) if least == most => format!("{least}"),
                (least, usize::MAX) => format!("at least {least}"),
                (least, most) => format!("from {least} to {most}"),
            };
            let entries = if nodes.len() == 1 { "entry" } else { "entries" };
            self.wrong(&node.origin, key, format!("the list has {} {entries}; it needs {wanted}", nodes.len()));
        }
        let entries: Vec<_> =
            nodes.iter().enumerate().map(|(i, node)| self.check(node, of, &join(key, &i.to_string()))).collect();
        entries.into_iter().collect::<Option<Vec<_>>>().map(Json::Array)
    }

    fn tuple(
        &mut self,
        node: &Node,
        nodes: &[Node],
        shapes: &'static [(&'static str, Shape)],
        key: &str,
    ) -> Option<Json> {
        if nodes.len() != shapes.len() {
            let entries = if nodes.len() == 1 { "entry" } else { "entries" };
            let message = format!("the list has {} {entries}; it needs {}", nodes.len(), shapes.len());
            let help = format!("write {}", describe(&Shape::Tuple(shapes)));
            return self.wrong_with_help(&node.origin, key, message, help);
        }
        let entries = nodes.iter().zip(shapes).enumerate();
        let entries: Vec<_> =
            entries.map(|(i, (node, (_, shape)))| self.check(node, shape, &join(key, &i.to_string()))).collect();
        entries.into_iter().collect::<Option<Vec<_>>>().map(Json::Array)
    }

    fn tagged(&mut self, node: &Node, table: &Table, tag_key: &str, variants: &[Variant], key: &str) -> Option<Json> {
        let tags: Vec<_> = variants.iter().map(|variant| variant.tag).collect();
        let tag = self.tag(node, table, tag_key, &tags, tag_key, key)?;
        let parameters = variants.iter().find(|variant| variant.tag == tag)?.parameters;
        let mut out = Map::from_iter([(tag_key.to_string(), Json::from(tag))]);
        if let Some(Json::Object(rest)) = self.table(node, table, parameters, &[tag_key], variants, key) {
            out.extend(rest);
        }
        Some(Json::Object(out))
    }

    fn finite(&mut self, node: &Node, key: &str) {
        match &node.value {
            Value::Float(number) if !number.is_finite() => {
                self.wrong(&node.origin, key, format!("{} is not a finite number", number.to_string().to_lowercase()));
            }
            Value::Array(nodes) => {
                nodes.iter().enumerate().for_each(|(i, node)| self.finite(node, &join(key, &i.to_string())));
            }
            Value::Table(table) => table.entries.iter().for_each(|e| self.finite(&e.node, &join(key, &e.key))),
            _ => {}
        }
    }

    /// Returns the value by the first alternative that accepts it. If none does, reports the mistakes of the first alternative
    /// with a matching form.
    fn either(&mut self, node: &Node, shapes: &[Shape], key: &str) -> Option<Json> {
        let (before, unused) = (self.diagnostics.len(), self.unused.len());
        let mut first: Option<Vec<LocatedDiagnostic>> = None;
        for shape in shapes.iter().filter(|shape| fits(node, shape)) {
            if let Some(value) = self.check(node, shape, key) {
                return Some(value);
            }
            self.unused.truncate(unused);
            let wrong = self.diagnostics.split_off(before);
            first.get_or_insert(wrong);
        }
        match first {
            Some(wrong) => {
                self.diagnostics.extend(wrong);
                None
            }
            // A text may be meant as a number with a unit: report the mistake in the number.
            None if node.text().is_some() && shapes.iter().any(|shape| matches!(shape, Shape::Number(..))) => {
                let number = shapes.iter().find(|shape| matches!(shape, Shape::Number(..)))?;
                self.check(node, number, key)
            }
            None => {
                let message = format!("must be {}, but is {}", any_shape(shapes), node.describe());
                self.wrong(&node.origin, key, message)
            }
        }
    }

    /// Returns the tag of a table, the word that decides its keys.
    fn tag<'n>(
        &mut self,
        node: &Node,
        table: &'n Table,
        tag_key: &str,
        tags: &[&str],
        what: &str,
        key: &str,
    ) -> Option<&'n str> {
        let list = || format!("choices: {}", tags.join(", "));
        let Some(value) = table.get(tag_key) else {
            self.wrong_with_help(&node.origin, &join(key, tag_key), "is missing".into(), list());
            return None;
        };
        let Some(tag) = value.text() else {
            let message = format!("must be {}, but is {}", any_of(tags.iter().copied()), value.describe());
            self.wrong(&value.origin, &join(key, tag_key), message);
            return None;
        };
        if !tags.contains(&tag) {
            let (message, help) = unknown_tag(tag, tags, what);
            self.wrong_with_help(&value.origin, &join(key, tag_key), message, help);
            return None;
        }
        Some(tag)
    }

    /// Checks the keys of a table; `skip` names keys that are already checked.
    fn table(
        &mut self,
        node: &Node,
        table: &Table,
        parameters: &[Parameter],
        skip: &[&str],
        others: &[Variant],
        key: &str,
    ) -> Option<Json> {
        // A misspelt key is not reported as missing too.
        let mut misspelt = Vec::new();
        for entry in &table.entries {
            let known = skip.contains(&entry.key.as_str()) || parameters.iter().any(|p| p.name == entry.key);
            if !known {
                let names: Vec<_> = skip.iter().copied().chain(parameters.iter().map(|p| p.name)).collect();
                let near = nearest_name(&entry.key, names.iter().copied());
                misspelt.extend(near.filter(|name| table.get(name).is_none()));
                let elsewhere = others.iter().find(|other| other.parameters.iter().any(|p| p.name == entry.key));
                let help = match (near, elsewhere) {
                    (None, Some(other)) => format!("it belongs to \"{}\"", other.tag),
                    _ => suggest(&entry.key, &names, "keys here"),
                };
                self.wrong_with_help(&entry.origin, &join(key, &entry.key), "is not a key here".into(), help);
            }
        }
        let mut out = Map::new();
        let mut sound = true;
        for parameter in parameters {
            if table.get(parameter.name).is_none() && misspelt.contains(&parameter.name) {
                sound = false;
                continue;
            }
            match self.parameter(node, table, parameter, key) {
                Ok(Some(value)) => _ = out.insert(parameter.name.into(), value),
                Ok(None) => {}
                Err(Rejected) => sound = false,
            }
        }
        sound.then_some(Json::Object(out))
    }

    /// Returns one key of a table: its value or its default, or `None` if it is optional and absent.
    pub fn parameter(
        &mut self,
        node: &Node,
        table: &Table,
        parameter: &Parameter,
        key: &str,
    ) -> Result<Option<Json>, Rejected> {
        let path = join(key, parameter.name);
        if let Some(value) = table.get(parameter.name) {
            return self.check(value, &parameter.shape, &path).map(Some).ok_or(Rejected);
        }
        match parameter.need {
            Need::Required => {
                let help = format!("{}; give {}", parameter.doc, describe(&parameter.shape));
                self.wrong_with_help(&node.origin, &path, "is missing".into(), help);
                Err(Rejected)
            }
            Need::Optional(_) => Ok(None),
            Need::Default(text) => {
                let value = parse_value(text, &node.origin).ok_or(Rejected)?;
                self.check(&value, &parameter.shape, &path).map(Some).ok_or(Rejected)
            }
        }
    }

    fn plugin(&mut self, node: &Node, table: &Table, kind: PluginKind, key: &str) -> Option<Json> {
        let tag_key = kind.tag_key();
        let registered = candidates(kind);
        let words = common_words(kind);
        let tags: Vec<_> = words.iter().copied().chain(registered.iter().map(|card| card.tag)).collect();
        let tag = match (table.get(tag_key), words.first()) {
            (None, Some(word)) => word,
            _ => self.tag(node, table, tag_key, &tags, word_for(kind), key)?,
        };
        let chosen: Option<&Card> = candidate(kind, tag);
        let own: &[Parameter] = chosen.map_or(&[], |card| card.parameters);
        let common = common_parameters(kind).iter().filter(|p| own.iter().all(|o| o.name != p.name));
        let mut parameters: Vec<Parameter> = own.iter().chain(common).copied().collect();
        let (mut skip, mut misspelt, found) = (vec![tag_key], Vec::new(), self.diagnostics.len());
        for entry in &table.entries {
            if parameters.iter().any(|p| p.name == entry.key) || entry.key == tag_key {
                continue;
            }
            let others: Vec<&Parameter> =
                registered.iter().flat_map(|card| card.parameters).filter(|p| p.name == entry.key).collect();
            let path = join(key, &entry.key);
            if others.is_empty() {
                let mut names: Vec<_> = std::iter::once(tag_key).chain(parameters.iter().map(|p| p.name)).collect();
                let near = nearest_name(&entry.key, names.iter().copied());
                misspelt.extend(near);
                if near.is_none() {
                    let all = registered.iter().flat_map(|card| card.parameters).map(|p| p.name);
                    if let Some(name) = nearest_name(&entry.key, all) {
                        names = vec![name];
                    }
                }
                let help = suggest(&entry.key, &names, "keys here");
                let message = format!("is not a key of {} \"{tag}\", nor of any other", word_for(kind));
                self.wrong_with_help(&entry.origin, &path, message, help);
            } else {
                let before = self.diagnostics.len();
                for (attempt, other) in others.iter().enumerate() {
                    let wrong = self.diagnostics.len();
                    if self.check(&entry.node, &other.shape, &path).is_some() {
                        self.diagnostics.truncate(before);
                        break;
                    }
                    if attempt > 0 {
                        self.diagnostics.truncate(wrong);
                    }
                }
                self.unused.push(Unused { key: path, by: format!("{} \"{tag}\"", word_for(kind)) });
            }
            skip.push(&entry.key);
        }
        // A misspelt key is not reported as missing too.
        parameters.retain(|p| table.get(p.name).is_some() || !misspelt.contains(&p.name));
        let Some(Json::Object(rest)) = self.table(node, table, &parameters, &skip, &[], key) else { return None };
        let mut out = Map::from_iter([(tag_key.to_string(), Json::from(tag))]);
        out.extend(rest);
        let value = Json::Object(out);
        if let Some(card) = chosen
            && self.diagnostics.len() == found
        {
            // The check of a card reads the concrete type, which has neither the tag nor the common keys.
            let own: Map<_, _> = value
                .as_object()?
                .iter()
                .filter(|(name, _)| card.parameters.iter().any(|p| p.name == name.as_str()))
                .map(|(name, value)| (name.clone(), value.clone()))
                .collect();
            for (name, message) in (card.check)(&Json::Object(own)) {
                let path = if name.is_empty() { key.to_string() } else { format!("{key}.{name}") };
                self.wrong(&self.root.place(&path), &path, message);
            }
        }
        Some(value)
    }
}
