//! Values of expressions: numbers, words, truths, lists, and series over a swept number.

use voussoir_study::results::format::format_short;

/// Returns the value of a series by its name.
pub type SeriesByName<'a> = &'a dyn Fn(&str) -> Option<Value>;

/// The value of an expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// No value, with the reason. If it is `proven` that no value exists (no equilibrium, no greatest load), a comparison with it
    /// is false. Otherwise a comparison is open too.
    Missing {
        /// The reason.
        why: String,
        /// True if the missing result cannot exist.
        proven: bool,
    },
    /// A number; infinite for the load factor of a structure that carries any load.
    Number(f64),
    /// A word.
    Word(String),
    /// A truth.
    Truth(bool),
    /// Several values.
    List(Vec<Value>),
    /// Values over a number, by ascending abscissa unless they are a path.
    Series(Vec<(f64, Value)>),
}

impl Value {
    /// Returns a missing value that may exist.
    pub fn unknown(why: impl Into<String>) -> Self {
        Value::Missing { why: why.into(), proven: false }
    }

    /// Returns a missing value that cannot exist.
    pub fn none(why: impl Into<String>) -> Self {
        Value::Missing { why: why.into(), proven: true }
    }

    /// Returns the number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// Describes the value in words.
    pub fn describe(&self) -> String {
        match self {
            Value::Missing { why, .. } => why.clone(),
            Value::Number(x) if *x == f64::INFINITY => "unbounded".into(),
            Value::Number(x) => format_short(*x, 6),
            Value::Word(word) => word.replace('_', " "),
            Value::Truth(truth) => if *truth { "yes" } else { "no" }.into(),
            Value::List(values) => values.iter().map(Value::describe).collect::<Vec<_>>().join(", "),
            Value::Series(points) => {
                let point = |(x, value): &(f64, Value)| format!("{} at {}", value.describe(), format_short(*x, 5));
                points.iter().map(point).collect::<Vec<_>>().join("; ")
            }
        }
    }

    /// Applies a function to the value, or to every element of a series.
    pub fn map(self, f: &dyn Fn(Value) -> Value) -> Value {
        match self {
            Value::Series(points) => Value::Series(points.into_iter().map(|(x, value)| (x, f(value))).collect()),
            Value::Missing { .. } => self,
            value => f(value),
        }
    }

    /// Applies a function to two values, element by element if one is a series. Two series are combined at abscissas that both
    /// have.
    pub fn zip(self, other: Value, f: &dyn Fn(Value, Value) -> Value) -> Value {
        match (self, other) {
            (Value::Series(a), Value::Series(b)) => {
                let same = |x: f64, y: f64| (x - y).abs() <= 1e-9 * x.abs().max(y.abs()).max(1.0);
                let pair = |(x, value): (f64, Value)| {
                    let (_, other) = b.iter().find(|(y, _)| same(x, *y))?;
                    Some((x, f(value, other.clone())))
                };
                Value::Series(a.into_iter().filter_map(pair).collect())
            }
            (Value::Series(a), b) => Value::Series(a.into_iter().map(|(x, a)| (x, f(a, b.clone()))).collect()),
            (a, Value::Series(b)) => Value::Series(b.into_iter().map(|(x, b)| (x, f(a.clone(), b))).collect()),
            (a, b) => f(a, b),
        }
    }
}
