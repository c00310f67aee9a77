//! Values made from the schema.

use std::collections::BTreeMap;
use std::sync::LazyLock;
use toml::{Table, Value};
use voussoir::core::plugin::{Need, Parameter, PluginKind, Shape, card, cards, cards_of};
use voussoir::core::random::Random;
use voussoir::study::study_keys;

/// Numbers at the limits of arithmetic.
const NUMBERS: [f64; 22] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e-9,
    1e-12,
    1e-300,
    5e-324,
    1e300,
    f64::MAX,
    f64::MIN,
    f64::EPSILON,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    1e9,
    1e16,
    0.5,
    90.0,
    180.0,
    360.0,
    89.999_999_999,
];
const WHOLES: [i64; 12] = [0, 1, -1, 2, 3, 7, 41, 1000, 100_000, 1_000_000_000, i64::MAX, i64::MIN];
const TEXTS: [&str; 24] = [
    "",
    " ",
    "1 m",
    "5 GPa",
    "-3 in",
    "1e400 kN",
    "nan Pa",
    "inf m",
    "25",
    "20 kN/m3",
    "0x10 m",
    "1,5 m",
    "µ",
    "a.b",
    "\"",
    "..",
    "/",
    "a\nb",
    "\u{1b}[31m",
    "\u{202e}x",
    "\u{feff}",
    "collapse",
    "left",
    "0",
];

/// Returns a special or an ordinary number.
pub fn number(random: &mut Random) -> Value {
    match random.whole(0, 3) {
        0 => Value::Integer(*random.one_of(&WHOLES)),
        1 => Value::Float(random.power(-12.0, 12.0)),
        2 => Value::Float(random.between(-2.0, 10.0)),
        _ => Value::Float(*random.one_of(&NUMBERS)),
    }
}

/// Returns a special text or a word of the schema.
pub fn text(random: &mut Random) -> Value {
    if random.chance(0.5) {
        return (*random.one_of(&TEXTS)).into();
    }
    random.one_of(cards()).tag.into()
}

/// Returns a key of the schema with a value.
pub fn entry(random: &mut Random) -> (String, Value) {
    let parameters = match random.chance(0.3) {
        true => study_keys(),
        false => random.one_of(cards()).parameters,
    };
    match parameters {
        [] => ("name".into(), text(random)),
        some => of_parameter(random.one_of(some), random, 0),
    }
}

/// Every key of the schema at any depth, by name.
static KEYS: LazyLock<BTreeMap<&'static str, Vec<&'static Parameter>>> = LazyLock::new(|| {
    let mut keys = BTreeMap::new();
    let cards = cards().iter().flat_map(|card| card.parameters);
    study_keys().iter().chain(cards).for_each(|parameter| gather(parameter, &mut keys));
    keys
});

fn gather(parameter: &'static Parameter, keys: &mut BTreeMap<&'static str, Vec<&'static Parameter>>) {
    keys.entry(parameter.name).or_default().push(parameter);
    inside(&parameter.shape, keys);
}

fn inside(shape: &'static Shape, keys: &mut BTreeMap<&'static str, Vec<&'static Parameter>>) {
    match shape {
        Shape::Table(parameters) => parameters.iter().for_each(|parameter| gather(parameter, keys)),
        Shape::List { of, .. } | Shape::Map(of) => inside(of, keys),
        Shape::Tuple(shapes) => shapes.iter().for_each(|(_, shape)| inside(shape, keys)),
        Shape::Either(shapes) => shapes.iter().for_each(|shape| inside(shape, keys)),
        Shape::Tagged { variants, .. } => {
            variants.iter().flat_map(|variant| variant.parameters).for_each(|parameter| gather(parameter, keys));
        }
        _ => {}
    }
}

/// Returns a value that a key may have; `None` if the schema has no such key.
pub fn value_of(key: &str, random: &mut Random) -> Option<Value> {
    let parameters = KEYS.get(key)?;
    Some(of_shape(&random.one_of(parameters).shape, random, 0))
}

/// Returns a key with a value for a table that contains the tag of a plug-in; `None` for other tables.
pub fn entry_of(table: &Table, random: &mut Random) -> Option<(String, Value)> {
    let own = |kind: PluginKind| table.get(kind.tag_key()).and_then(Value::as_str).and_then(|tag| card(kind, tag));
    let found: Vec<_> =
        PluginKind::ALL.into_iter().filter_map(own).filter(|card| !card.parameters.is_empty()).collect();
    if found.is_empty() {
        return None;
    }
    let card = random.one_of(&found);
    Some(of_parameter(random.one_of(card.parameters), random, 0))
}

fn of_parameter(parameter: &Parameter, random: &mut Random, depth: usize) -> (String, Value) {
    (parameter.name.into(), of_shape(&parameter.shape, random, depth))
}

fn table(parameters: &[Parameter], random: &mut Random, depth: usize) -> Table {
    let mut out = Table::new();
    for parameter in parameters {
        if parameter.need == Need::Required || random.chance(0.3) {
            out.extend([of_parameter(parameter, random, depth + 1)]);
        }
    }
    out
}

/// Greatest depth of generated tables.
const DEPTH: usize = 6;

/// Returns a value of a shape, usually within its range.
fn of_shape(shape: &Shape, random: &mut Random, depth: usize) -> Value {
    if depth > DEPTH || random.chance(0.03) {
        return number(random);
    }
    match shape {
        Shape::Number(quantity, _) if random.chance(0.2) => {
            format!("{} {}", random.between(0.0, 3.0), quantity.unit()).into()
        }
        Shape::Number(_, range) => {
            let ends = [range.min, range.max].map(|x| if x.is_finite() { x } else { random.power(-3.0, 3.0) });
            Value::Float(*random.one_of(&[ends[0], ends[1], (ends[0] + ends[1]) / 2.0]))
        }
        Shape::Integer { min, max } => Value::Integer(*random.one_of(&[*min, *max, (*min).max(1).min(*max), 2, 5])),
        Shape::Boolean => random.chance(0.5).into(),
        Shape::Text => text(random),
        Shape::Choice(words) => (*random.one_of(words)).into(),
        Shape::Reference(_) => (*random.one_of(&["stone", "dry", "axle", "none"])).into(),
        Shape::List { of, min, max } => {
            let count = (*min).max(random.whole(0, 3)).min((*max).max(*min));
            Value::Array((0..count.min(8)).map(|_| of_shape(of, random, depth + 1)).collect())
        }
        Shape::Tuple(shapes) => {
            Value::Array(shapes.iter().map(|(_, shape)| of_shape(shape, random, depth + 1)).collect())
        }
        Shape::Table(parameters) => table(parameters, random, depth).into(),
        Shape::Tagged { key, variants } => {
            let variant = random.one_of(variants);
            let mut own = table(variant.parameters, random, depth);
            own.insert((*key).into(), variant.tag.into());
            own.into()
        }
        Shape::Either(shapes) => of_shape(random.one_of(shapes), random, depth + 1),
        Shape::Plugin(kind) => plugin(*kind, random, depth),
        Shape::Map(of) => Table::from_iter([("stone".to_string(), of_shape(of, random, depth + 1))]).into(),
        Shape::Free => {
            if random.chance(0.5) {
                number(random)
            } else {
                text(random)
            }
        }
    }
}

fn plugin(kind: PluginKind, random: &mut Random, depth: usize) -> Value {
    let registered = cards_of(kind);
    if registered.is_empty() {
        return number(random);
    }
    let card = random.one_of(&registered);
    let mut own = table(card.parameters, random, depth);
    own.insert(kind.tag_key().into(), card.tag.into());
    own.into()
}
