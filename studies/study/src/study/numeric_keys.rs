//! The numbers of a checked case by dotted key, with their description in the schema, and its tables of laws and solvers.
//! Sliders and derivatives of the load factor use them.

use crate::config::common_keys::common_parameters;
use crate::config::dotted_key::join;
use crate::config::key_meaning::outer_form;
use serde_json::Value as Json;
use voussoir_core::plugin::{Parameter, PluginKind, Quantity, Range, Shape, candidate};

/// Tables of a study file whose numbers describe structure and loads, not solution or output.
const TABLES: [&str; 6] = ["scene", "materials", "joints", "vehicles", "stages", "factors"];
/// Tables below these that control solvers.
const STEERING: [&str; 5] = ["continuation", "stop", "solver", "factor_min", "factor_max"];

/// The values that a number may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberKind {
    /// A real number in a range, in the unit of the quantity.
    Real(Quantity, Range),
    /// A whole number from a least to a greatest value.
    Whole(i64, i64),
}

/// A number of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct NumericKey {
    /// Its dotted key, with indices for entries of lists.
    pub key: String,
    /// Type and range.
    pub kind: NumberKind,
    /// Value in SI units; `None` if the key is optional and not given.
    pub value: Option<f64>,
    /// Description in the schema.
    pub doc: &'static str,
}

/// A table of a case whose tag chooses a law or a solver.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PluginTable {
    /// Its dotted key, such as `joints.dry`.
    pub key: String,
    /// Kind of the plug-in.
    pub kind: PluginKind,
    /// Tag of the plug-in; `auto` if the program chooses the solver.
    pub tag: String,
}

/// Returns the numbers of a checked case ([`super::Case::resolved`]) in the order of the schema. Optional numbers that are
/// not given are listed too, if they are keys of a table. Lists of more than `longest` numbers or tables are omitted: they
/// are data, not parameters. `keys` are the keys of study files ([`super::study_keys`]).
pub fn numeric_keys(keys: &[Parameter], resolved: &Json, longest: usize) -> Vec<NumericKey> {
    walked(keys, &TABLES, resolved, longest).found
}

/// Returns the tables of a checked case that choose a plug-in of one of these kinds, in the order of the schema.
pub fn plugin_tables(keys: &[Parameter], resolved: &Json, kinds: &[PluginKind]) -> Vec<PluginTable> {
    let tables: Vec<&str> = TABLES.into_iter().chain(["solver"]).collect();
    let mut found = walked(keys, &tables, resolved, usize::MAX).plugins;
    found.retain(|table| kinds.contains(&table.kind));
    found
}

fn walked(keys: &[Parameter], tables: &[&str], resolved: &Json, longest: usize) -> Walk {
    let mut walk = Walk { longest, found: Vec::new(), plugins: Vec::new() };
    for parameter in keys.iter().filter(|parameter| tables.contains(&parameter.name)) {
        if let Some(value) = resolved.get(parameter.name) {
            walk.shape(parameter.name, &parameter.shape, value, parameter.doc);
        }
    }
    walk
}

struct Walk {
    longest: usize,
    found: Vec<NumericKey>,
    plugins: Vec<PluginTable>,
}

impl Walk {
    fn number(&mut self, key: &str, kind: NumberKind, value: &Json, doc: &'static str) {
        self.found.push(NumericKey { key: key.into(), kind, value: value.as_f64(), doc });
    }

    fn shape(&mut self, key: &str, shape: &Shape, value: &Json, doc: &'static str) {
        match (shape, value) {
            (Shape::Number(quantity, range), Json::Number(_)) => {
                self.number(key, NumberKind::Real(*quantity, *range), value, doc);
            }
            (Shape::Integer { min, max }, Json::Number(_)) => {
                self.number(key, NumberKind::Whole(*min, *max), value, doc);
            }
            (Shape::Either(shapes), _) => {
                if let Some(fitting) = shapes.iter().find(|shape| outer_form(shape, value)) {
                    self.shape(key, fitting, value, doc);
                }
            }
            (Shape::List { of, .. }, Json::Array(items)) if items.len() <= self.longest => {
                for (index, item) in items.iter().enumerate() {
                    self.shape(&join(key, &index.to_string()), of, item, doc);
                }
            }
            (Shape::Tuple(shapes), Json::Array(items)) => {
                for (index, ((_, of), item)) in shapes.iter().zip(items).enumerate() {
                    self.shape(&join(key, &index.to_string()), of, item, doc);
                }
            }
            (Shape::Map(of), Json::Object(map)) => {
                for (name, item) in map {
                    self.shape(&join(key, name), of, item, doc);
                }
            }
            (Shape::Table(parameters), Json::Object(_)) => self.table(key, parameters, value),
            (Shape::Tagged { key: tag, variants }, Json::Object(map)) => {
                let word = map.get(*tag).and_then(Json::as_str);
                if let Some(variant) = variants.iter().find(|variant| Some(variant.tag) == word) {
                    self.table(key, variant.parameters, value);
                }
            }
            (Shape::Plugin(kind), Json::Object(_)) => self.plugin(key, *kind, value),
            _ => {}
        }
    }

    fn plugin(&mut self, key: &str, kind: PluginKind, value: &Json) {
        let tag = value[kind.tag_key()].as_str().unwrap_or_default();
        self.plugins.push(PluginTable { key: key.into(), kind, tag: tag.into() });
        let Some(card) = candidate(kind, tag) else { return };
        self.table(key, card.parameters, value);
        let common = common_parameters(kind).iter();
        let common: Vec<Parameter> =
            common.filter(|common| card.parameters.iter().all(|own| own.name != common.name)).copied().collect();
        self.table(key, &common, value);
    }

    fn table(&mut self, key: &str, parameters: &[Parameter], value: &Json) {
        for parameter in parameters.iter().filter(|parameter| !STEERING.contains(&parameter.name)) {
            let key = join(key, parameter.name);
            match (value.get(parameter.name), plain_number(&parameter.shape)) {
                (Some(given), _) if !given.is_null() => self.shape(&key, &parameter.shape, given, parameter.doc),
                (_, Some(kind)) => self.number(&key, kind, &Json::Null, parameter.doc),
                _ => {}
            }
        }
    }
}

/// Returns the type of an optional key that is a plain number. Whole numbers are excluded: their absence has another
/// meaning.
fn plain_number(shape: &Shape) -> Option<NumberKind> {
    match shape {
        Shape::Number(quantity, range) => Some(NumberKind::Real(*quantity, *range)),
        Shape::Either(shapes) => shapes.iter().find_map(plain_number),
        _ => None,
    }
}
