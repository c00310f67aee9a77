//! The check of a value against its [`Shape`]: every mistake with its place, else the normalised
//! value (numbers in the unit of their quantity, defaults filled in).

use crate::config::document::{Node, Origin, Table, Value, parse_value};
use crate::config::overlay::join;
use crate::config::report::{Mistake, any_of, suggest};
use serde_json::{Map, Value as Json};
use voussoir_core::plugin::{
    Card, Need, Parameter, PluginKind, Quantity, STANDARD_GRAVITY, Shape, Variant, candidate, candidates,
};

/// A key that another plug-in of the same kind knows, but the chosen one does not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unused {
    /// Its dotted key.
    pub key: String,
    /// In words, what does not use it: `interface law "coulomb"`.
    pub by: String,
}

/// A value has mistakes, which are in the checker's list.
#[derive(Debug, Clone, Copy)]
pub struct Mistaken;

/// A check in progress.
#[derive(Debug)]
pub struct Checker<'a> {
    /// The study's root, where names are looked up.
    pub root: &'a Node,
    /// Turns specific weights into densities \[m/s²\].
    pub gravity: f64,
    /// Found so far.
    pub mistakes: Vec<Mistake>,
    /// Found so far.
    pub unused: Vec<Unused>,
}

/// Keys that every plug-in of a kind has besides those of its card.
pub fn common_parameters(kind: PluginKind) -> &'static [Parameter] {
    if kind == PluginKind::LimitSolver { crate::study::SOLVER } else { &[] }
}

/// What a kind is called in messages: limit and path solvers share one place.
fn word_for(kind: PluginKind) -> &'static str {
    if kind == PluginKind::LimitSolver { "solver" } else { kind.describe() }
}

/// Words that the tag may be besides the registered tags.
pub fn common_words(kind: PluginKind) -> &'static [&'static str] {
    if kind == PluginKind::LimitSolver { &["auto"] } else { &[] }
}

/// The magnitude of the first gravity in the study's stages; standard gravity where there is none.
pub fn gravity_of(root: &Node) -> f64 {
    let number = |node: &Node| match &node.value {
        Value::String(text) => Quantity::Acceleration.parse(text, STANDARD_GRAVITY).ok(),
        _ => node.number(),
    };
    let stages = root.table().and_then(|table| table.get("stages")?.array()).unwrap_or_default();
    let given = stages.iter().find_map(|stage| stage.table()?.get("gravity"));
    let size = given.and_then(|node| match node.array() {
        Some([x, y]) => Some(number(x)?.hypot(number(y)?)),
        _ => number(node).map(f64::abs),
    });
    size.filter(|size| size.is_finite() && *size > 0.0).unwrap_or(STANDARD_GRAVITY)
}

/// What a shape takes, in words.
pub fn describe(shape: &Shape) -> String {
    match shape {
        Shape::Number(Quantity::Ratio, _) => "a number".into(),
        Shape::Number(quantity, _) => {
            format!("a number in {0} or a text with a unit such as \"1 {0}\"", quantity.unit())
        }
        Shape::Integer { .. } => "a whole number".into(),
        Shape::Boolean => "true or false".into(),
        Shape::Text => "a text in quotes".into(),
        Shape::Choice(words) => any_of(words.iter().copied()),
        Shape::Reference(table) => format!("the name of an entry of [{table}]"),
        Shape::List { of, min, max } => match (*min, *max) {
            (least, most) if least == most => {
                format!("a list of {least} entries, each {}", describe(of))
            }
            _ => format!("a list, each entry {}", describe(of)),
        },
        Shape::Tuple(shapes) => {
            format!("a list [{}]", shapes.iter().map(|shape| describe(shape)).collect::<Vec<_>>().join(", "))
        }
        Shape::Table(_) | Shape::Map(_) => "a table".into(),
        Shape::Tagged { key, .. } => format!("a table with the key {key}"),
        Shape::Plugin(kind) => format!("a table with the key {}", kind.tag_key()),
        Shape::Either(shapes) => any_shape(shapes),
        Shape::Free => "anything".into(),
    }
}

fn any_shape(shapes: &[Shape]) -> String {
    shapes.iter().map(describe).collect::<Vec<_>>().join(", or ")
}

/// Whether a value has the outer form of a shape.
fn fits(node: &Node, shape: &Shape) -> bool {
    match (shape, &node.value) {
        (Shape::Free, _) => true,
        (Shape::Either(shapes), _) => shapes.iter().any(|shape| fits(node, shape)),
        (Shape::Number(..), Value::Integer(_) | Value::Float(_)) | (Shape::Integer { .. }, Value::Integer(_)) => true,
        (Shape::Number(..), Value::String(text)) => {
            text.trim_start().starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'))
        }
        (Shape::Boolean, Value::Boolean(_)) => true,
        (Shape::Text | Shape::Choice(_) | Shape::Reference(_), Value::String(_)) => true,
        (Shape::List { .. } | Shape::Tuple(_), Value::Array(_)) => true,
        (Shape::Table(_) | Shape::Map(_) | Shape::Tagged { .. } | Shape::Plugin(_), Value::Table(_)) => true,
        _ => false,
    }
}

impl<'a> Checker<'a> {
    /// A check of values in the study `root`.
    pub fn new(root: &'a Node) -> Self {
        Checker { root, gravity: gravity_of(root), mistakes: Vec::new(), unused: Vec::new() }
    }

    fn wrong(&mut self, origin: &Origin, key: &str, message: impl Into<String>) -> Option<Json> {
        self.mistakes.push(Mistake::new(origin, key, message));
        None
    }

    fn wrong_with_help(&mut self, origin: &Origin, key: &str, message: String, help: String) -> Option<Json> {
        self.mistakes.push(Mistake::new(origin, key, message).help(help));
        None
    }

    /// The normalised value; `None` where it has mistakes.
    pub fn check(&mut self, node: &Node, shape: &Shape, key: &str) -> Option<Json> {
        let found = self.mistakes.len();
        let value = match (shape, &node.value) {
            (Shape::Number(quantity, range), Value::Integer(_) | Value::Float(_) | Value::String(_)) => {
                let number = match &node.value {
                    Value::String(text) => match quantity.parse(text, self.gravity) {
                        Ok(number) => number,
                        Err(why) => {
                            let help = format!("write {}", describe(shape));
                            return self.wrong_with_help(&node.origin, key, why, help);
                        }
                    },
                    _ => node.number().unwrap_or(f64::NAN),
                };
                let unit = if *quantity == Quantity::Ratio { String::new() } else { format!(" {}", quantity.unit()) };
                if !number.is_finite() {
                    return self.wrong(
                        &node.origin,
                        key,
                        format!("{} is not a finite number", number.to_string().to_lowercase()),
                    );
                }
                if !range.contains(number) {
                    let message = format!("{number}{unit} is out of range: it must be {}", range.describe());
                    return self.wrong(&node.origin, key, message);
                }
                Some(number.into())
            }
            (Shape::Integer { min, max }, Value::Integer(whole)) => {
                if whole < min || whole > max {
                    let range =
                        if *max == i64::MAX { format!("at least {min}") } else { format!("from {min} to {max}") };
                    return self.wrong(&node.origin, key, format!("{whole} is out of range: it must be {range}"));
                }
                Some((*whole).into())
            }
            (Shape::Boolean, Value::Boolean(value)) => Some((*value).into()),
            (Shape::Text, Value::String(text)) => Some(text.clone().into()),
            (Shape::Choice(words), Value::String(text)) => {
                if !words.contains(&text.as_str()) {
                    let (message, help) = (format!("\"{text}\" is not a choice here"), suggest(text, words, "choices"));
                    return self.wrong_with_help(&node.origin, key, message, help);
                }
                Some(text.clone().into())
            }
            (Shape::Reference(table), Value::String(text)) => {
                let names: Vec<&str> = self
                    .root
                    .table()
                    .and_then(|t| t.get(table)?.table())
                    .map(|t| t.keys().collect())
                    .unwrap_or_default();
                if !names.contains(&text.as_str()) {
                    let help = suggest(text, &names, &format!("entries of [{table}]"));
                    let message = format!("there is no [{table}.{text}] in this study");
                    return self.wrong_with_help(&node.origin, key, message, help);
                }
                Some(text.clone().into())
            }
            (Shape::List { of, min, max }, Value::Array(nodes)) => {
                if nodes.len() < *min || nodes.len() > *max {
                    let wanted = match (*min, *max) {
                        (least, most) if least == most => format!("{least}"),
                        (least, usize::MAX) => format!("at least {least}"),
                        (least, most) => format!("from {least} to {most}"),
                    };
                    self.wrong(
                        &node.origin,
                        key,
                        format!(
                            "the list has {} {}; it needs {wanted}",
                            nodes.len(),
                            if nodes.len() == 1 { "entry" } else { "entries" }
                        ),
                    );
                }
                let entries: Vec<_> = nodes
                    .iter()
                    .enumerate()
                    .map(|(i, node)| self.check(node, of, &join(key, &i.to_string())))
                    .collect();
                entries.into_iter().collect::<Option<Vec<_>>>().map(Json::Array)
            }
            (Shape::Tuple(shapes), Value::Array(nodes)) => {
                if nodes.len() != shapes.len() {
                    let entries = if nodes.len() == 1 { "entry" } else { "entries" };
                    let message = format!("the list has {} {entries}; it needs {}", nodes.len(), shapes.len());
                    let help = format!("write {}", describe(shape));
                    return self.wrong_with_help(&node.origin, key, message, help);
                }
                let entries = nodes.iter().zip(*shapes).enumerate();
                let entries: Vec<_> =
                    entries.map(|(i, (node, shape))| self.check(node, shape, &join(key, &i.to_string()))).collect();
                entries.into_iter().collect::<Option<Vec<_>>>().map(Json::Array)
            }
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
                let tags: Vec<_> = variants.iter().map(|variant| variant.tag).collect();
                let tag = self.tag(node, table, tag_key, &tags, tag_key, key)?;
                let parameters = variants.iter().find(|variant| variant.tag == tag)?.parameters;
                let mut out = Map::from_iter([(tag_key.to_string(), Json::from(tag))]);
                if let Some(Json::Object(rest)) = self.table(node, table, parameters, &[tag_key], variants, key) {
                    out.extend(rest);
                }
                Some(Json::Object(out))
            }
            (Shape::Plugin(kind), Value::Table(table)) => self.plugin(node, table, *kind, key),
            (Shape::Either(shapes), _) => return self.either(node, shapes, key),
            (Shape::Free, _) => {
                self.finite(node, key);
                Some(node.to_json())
            }
            _ => {
                let message = format!("must be {}, but is {}", describe(shape), node.describe());
                return self.wrong(&node.origin, key, message);
            }
        };
        value.filter(|_| self.mistakes.len() == found)
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

    /// The first alternative that takes the value; else the mistakes of the first whose form fits.
    fn either(&mut self, node: &Node, shapes: &[Shape], key: &str) -> Option<Json> {
        let (mistakes, unused) = (self.mistakes.len(), self.unused.len());
        let mut first: Option<Vec<Mistake>> = None;
        for shape in shapes.iter().filter(|shape| fits(node, shape)) {
            if let Some(value) = self.check(node, shape, key) {
                return Some(value);
            }
            self.unused.truncate(unused);
            let wrong = self.mistakes.split_off(mistakes);
            first.get_or_insert(wrong);
        }
        match first {
            Some(wrong) => {
                self.mistakes.extend(wrong);
                None
            }
            None => {
                let message = format!("must be {}, but is {}", any_shape(shapes), node.describe());
                self.wrong(&node.origin, key, message)
            }
        }
    }

    /// The word under a deciding key.
    fn tag<'n>(
        &mut self,
        node: &Node,
        table: &'n Table,
        tag_key: &str,
        tags: &[&str],
        what: &str,
        key: &str,
    ) -> Option<&'n str> {
        let list = format!("choices: {}", tags.join(", "));
        let Some(value) = table.get(tag_key) else {
            self.wrong_with_help(&node.origin, &join(key, tag_key), "is missing".into(), list);
            return None;
        };
        let Some(tag) = value.text() else {
            let message = format!("must be {}, but is {}", any_of(tags.iter().copied()), value.describe());
            self.wrong(&value.origin, &join(key, tag_key), message);
            return None;
        };
        if !tags.contains(&tag) {
            let message = format!("there is no {what} \"{tag}\"");
            let help = suggest(tag, tags, "choices");
            self.wrong_with_help(&value.origin, &join(key, tag_key), message, help);
            return None;
        }
        Some(tag)
    }

    /// Keys of a table; `skip` names keys already dealt with.
    fn table(
        &mut self,
        node: &Node,
        table: &Table,
        parameters: &[Parameter],
        skip: &[&str],
        others: &[Variant],
        key: &str,
    ) -> Option<Json> {
        // A key that is written wrongly is not missing as well.
        let mut misspelt = Vec::new();
        for entry in &table.entries {
            let known = skip.contains(&entry.key.as_str()) || parameters.iter().any(|p| p.name == entry.key);
            if !known {
                let names: Vec<_> = skip.iter().copied().chain(parameters.iter().map(|p| p.name)).collect();
                let near = voussoir_core::plugin::nearest(&entry.key, names.iter().copied());
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
                Err(Mistaken) => sound = false,
            }
        }
        sound.then_some(Json::Object(out))
    }

    /// One key of a table: its value, its default, or `None` where it is optional and absent.
    pub fn parameter(
        &mut self,
        node: &Node,
        table: &Table,
        parameter: &Parameter,
        key: &str,
    ) -> Result<Option<Json>, Mistaken> {
        let path = join(key, parameter.name);
        if let Some(value) = table.get(parameter.name) {
            return self.check(value, &parameter.shape, &path).map(Some).ok_or(Mistaken);
        }
        match parameter.need {
            Need::Required => {
                let help = format!("{}; give {}", parameter.doc, describe(&parameter.shape));
                self.wrong_with_help(&node.origin, &path, "is missing".into(), help);
                Err(Mistaken)
            }
            Need::Optional(_) => Ok(None),
            Need::Default(text) => {
                let value = parse_value(text, &node.origin).ok_or(Mistaken)?;
                self.check(&value, &parameter.shape, &path).map(Some).ok_or(Mistaken)
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
        let (mut skip, mut misspelt, found) = (vec![tag_key], Vec::new(), self.mistakes.len());
        for entry in &table.entries {
            if parameters.iter().any(|p| p.name == entry.key) || entry.key == tag_key {
                continue;
            }
            let others: Vec<&Parameter> =
                registered.iter().flat_map(|card| card.parameters).filter(|p| p.name == entry.key).collect();
            let path = join(key, &entry.key);
            if others.is_empty() {
                let mut names: Vec<_> = std::iter::once(tag_key).chain(parameters.iter().map(|p| p.name)).collect();
                let near = voussoir_core::plugin::nearest(&entry.key, names.iter().copied());
                misspelt.extend(near);
                if near.is_none() {
                    let all = registered.iter().flat_map(|card| card.parameters).map(|p| p.name);
                    if let Some(name) = voussoir_core::plugin::nearest(&entry.key, all) {
                        names = vec![name];
                    }
                }
                let help = suggest(&entry.key, &names, "keys here");
                let message = format!("is not a key of {} \"{tag}\", nor of any other", word_for(kind));
                self.wrong_with_help(&entry.origin, &path, message, help);
            } else {
                let before = self.mistakes.len();
                for (attempt, other) in others.iter().enumerate() {
                    let wrong = self.mistakes.len();
                    if self.check(&entry.node, &other.shape, &path).is_some() {
                        self.mistakes.truncate(before);
                        break;
                    }
                    if attempt > 0 {
                        self.mistakes.truncate(wrong);
                    }
                }
                self.unused.push(Unused { key: path, by: format!("{} \"{tag}\"", word_for(kind)) });
            }
            skip.push(&entry.key);
        }
        // A key that is written wrongly is not missing as well.
        parameters.retain(|p| table.get(p.name).is_some() || !misspelt.contains(&p.name));
        let rest = self.table(node, table, &parameters, &skip, &[], key)?;
        let mut out = Map::from_iter([(tag_key.to_string(), Json::from(tag))]);
        out.extend(rest.as_object().cloned().unwrap_or_default());
        let value = Json::Object(out);
        if let Some(card) = chosen
            && self.mistakes.len() == found
        {
            // A card's check reads the concrete type, which knows neither the tag nor common keys.
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
