//! Evaluates expressions: operators element by element, and the functions of series.

use super::expression::{Expression, Operator};
use super::types::Type::{self, Number, Truth, Word};
use super::value::{SeriesByName, Value};

/// A function with its documentation.
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// Types of its arguments.
    pub takes: &'static [Type],
    /// Type of its result; `None` if it is the type of the first argument.
    pub gives: Option<Type>,
    /// Description of the result.
    pub doc: &'static str,
    run: fn(&mut dyn Iterator<Item = Value>) -> Value,
}

const NUMBER: &[Type] = &[Type::Number];
const TRUTH: &[Type] = &[Type::Truth];
const ANY: &[Type] = &[Type::Unknown];

const fn one(
    name: &'static str,
    takes: &'static [Type],
    gives: Option<Type>,
    doc: &'static str,
    run: fn(&mut dyn Iterator<Item = Value>) -> Value,
) -> Function {
    Function { name, takes, gives, doc, run }
}

/// Returns the next argument. It always exists, because the number of arguments is checked when the file is read.
fn next(arguments: &mut dyn Iterator<Item = Value>) -> Value {
    arguments.next().unwrap_or_else(|| Value::unknown("an argument is missing"))
}

/// All functions.
pub const FUNCTIONS: &[Function] = &[
    one("abs", NUMBER, Some(Number), "absolute value", |a| next(a).map(&|v| number(v, f64::abs))),
    one("argmax", NUMBER, Some(Number), "where a series is greatest", |a| extreme(next(a), 1.0, true)),
    one("argmin", NUMBER, Some(Number), "where a series is least", |a| extreme(next(a), -1.0, true)),
    one("max", NUMBER, Some(Number), "its greatest value", |a| extreme(next(a), 1.0, false)),
    one("min", NUMBER, Some(Number), "its least value", |a| extreme(next(a), -1.0, false)),
    one("all", TRUTH, Some(Truth), "whether every element is true", |a| all(next(a), true)),
    one("any", TRUTH, Some(Truth), "whether some element is true", |a| all(next(a), false)),
    one("highest_where", TRUTH, Some(Number), "the greatest abscissa at which a series is true", |a| {
        where_true(next(a), true)
    }),
    one("lowest_where", TRUTH, Some(Number), "the least abscissa at which a series is true", |a| {
        where_true(next(a), false)
    }),
    one("count", TRUTH, Some(Number), "how many elements are true", |a| count(next(a))),
    one("rising", NUMBER, Some(Truth), "whether values grow with the abscissa, none falls", |a| ordered(next(a), 1.0)),
    one("falling", NUMBER, Some(Truth), "whether values fall with the abscissa, none grows", |a| {
        ordered(next(a), -1.0)
    }),
    one("rises_then_falls", NUMBER, Some(Truth), "whether values grow up to one place inside and fall after it", |a| {
        rises_then_falls(next(a))
    }),
    one("mean", NUMBER, Some(Number), "the mean of a list", |a| next(a).map(&mean)),
    one("length", ANY, Some(Number), "the number of entries of a list", |a| next(a).map(&length)),
    one("first", ANY, None, "the first entry of a list", |a| next(a).map(&|v| entry(v, true))),
    one("last", ANY, None, "the last entry of a list", |a| next(a).map(&|v| entry(v, false))),
    one(
        "recoveries",
        NUMBER,
        Some(Number),
        "of a load-displacement curve: how often its slope falls below half of what it reaches later",
        |a| recoveries(next(a)),
    ),
    Function {
        name: "at",
        takes: &[Type::Unknown, Type::Number],
        gives: None,
        doc: "the value of a series at an abscissa",
        run: |a| at(next(a), next(a)),
    },
    one("words", ANY, Some(Word), "the entries of a list as one text", |a| {
        next(a).map(&|list| Value::Word(list.describe().replace(',', "")))
    }),
    Function {
        name: "has",
        takes: &[Type::Unknown, Type::Unknown],
        gives: Some(Truth),
        doc: "whether a list holds a value",
        run: |a| has(next(a), next(a)),
    },
    Function {
        name: "within",
        takes: &[Type::Unknown, Type::Number, Type::Number],
        gives: None,
        doc: "a series from one abscissa to another",
        run: |a| within(next(a), next(a), next(a)),
    },
];

/// Returns the value of an expression; `names` returns a series by its name.
pub fn evaluate(expression: &Expression, names: SeriesByName<'_>) -> Value {
    match expression {
        Expression::Number(number) => Value::Number(*number),
        Expression::Word(word) => Value::Word(word.clone()),
        Expression::Name(name) => names(name).unwrap_or_else(|| Value::unknown(format!("there is no {name}"))),
        Expression::Call(name, arguments) => {
            let Some(function) = FUNCTIONS.iter().find(|function| function.name == name) else {
                return Value::unknown(format!("there is no function {name}"));
            };
            (function.run)(&mut arguments.iter().map(|argument| evaluate(argument, names)))
        }
        Expression::Binary(operator, a, b) => {
            evaluate(a, names).zip(evaluate(b, names), &|a, b| binary(*operator, a, b))
        }
        Expression::Not(a) => evaluate(a, names).map(&|value| match value {
            Value::Truth(truth) => Value::Truth(!truth),
            other => Value::unknown(format!("\"not\" of {}", other.describe())),
        }),
        Expression::Negative(a) => evaluate(a, names).map(&|value| number(value, |x| -x)),
    }
}

fn number(value: Value, f: impl Fn(f64) -> f64) -> Value {
    match value {
        Value::Number(x) => Value::Number(f(x)),
        missing @ Value::Missing { .. } => missing,
        other => Value::unknown(format!("{} is no number", other.describe())),
    }
}

fn binary(operator: Operator, a: Value, b: Value) -> Value {
    use Operator::*;
    // One false operand of `and`, or one true operand of `or`, decides alone.
    match (operator, &a, &b) {
        (And, Value::Truth(false), _) | (And, _, Value::Truth(false)) => return Value::Truth(false),
        (Or, Value::Truth(true), _) | (Or, _, Value::Truth(true)) => return Value::Truth(true),
        _ => {}
    }
    match (a, b) {
        (Value::Missing { proven: false, why }, _) | (_, Value::Missing { proven: false, why }) => Value::unknown(why),
        (Value::Missing { why, .. }, _) | (_, Value::Missing { why, .. }) => match operator {
            Add | Subtract | Multiply | Divide => Value::none(why),
            _ => Value::Truth(operator == Unequal),
        },
        (Value::Truth(a), Value::Truth(b)) => match operator {
            And => Value::Truth(a && b),
            Or => Value::Truth(a || b),
            Equal => Value::Truth(a == b),
            Unequal => Value::Truth(a != b),
            _ => Value::unknown("truths are neither added nor ordered"),
        },
        (Value::Number(a), Value::Number(b)) => arithmetic(operator, a, b),
        (a, b) => match operator {
            Equal => Value::Truth(a == b),
            Unequal => Value::Truth(a != b),
            _ => Value::unknown(format!("{} and {} are no numbers", a.describe(), b.describe())),
        },
    }
}

fn arithmetic(operator: Operator, a: f64, b: f64) -> Value {
    use Operator::*;
    let truth = match operator {
        Add | Subtract | Multiply | Divide => {
            let result = match operator {
                Add => a + b,
                Subtract => a - b,
                Multiply => a * b,
                _ => a / b,
            };
            return if result.is_nan() { Value::none("no number") } else { Value::Number(result) };
        }
        Equal => a == b,
        Unequal => a != b,
        Less => a < b,
        AtMost => a <= b,
        Greater => a > b,
        AtLeast => a >= b,
        And | Or => return Value::unknown("numbers are no truths"),
    };
    Value::Truth(truth)
}

/// Returns the points of a series. The error gives the reason if this is not possible.
fn points(value: Value) -> Result<Vec<(f64, Value)>, Value> {
    match value {
        Value::Series(points) if points.is_empty() => Err(Value::unknown("the series is empty")),
        Value::Series(points) => Ok(points),
        Value::List(values) => Ok(values.into_iter().enumerate().map(|(i, value)| (i as f64, value)).collect()),
        missing @ Value::Missing { .. } => Err(missing),
        other => Ok(vec![(0.0, other)]),
    }
}

/// Returns the numbers of a series. A number that is proved not to exist is omitted; any other missing number is an error.
fn numbers(value: Value) -> Result<Vec<(f64, f64)>, Value> {
    let mut out = Vec::new();
    for (x, value) in points(value)? {
        match value {
            Value::Number(y) => out.push((x, y)),
            Value::Missing { proven: true, .. } => {}
            Value::Missing { why, .. } => return Err(Value::unknown(why)),
            other => return Err(Value::unknown(format!("{} is no number", other.describe()))),
        }
    }
    Ok(out)
}

fn extreme(value: Value, sense: f64, place: bool) -> Value {
    let numbers = match numbers(value) {
        Ok(numbers) => numbers,
        Err(missing) => return missing,
    };
    let unbounded = numbers.iter().filter(|(_, y)| sense * y == f64::INFINITY).count();
    if unbounded > 0 && place {
        return Value::none(format!("no greatest: unbounded at {unbounded} of {}", numbers.len()));
    }
    let better = |best: (f64, f64), point: (f64, f64)| if sense * point.1 > sense * best.1 { point } else { best };
    match numbers.into_iter().reduce(better) {
        Some((x, y)) => Value::Number(if place { x } else { y }),
        None => Value::none("no value"),
    }
}

/// Three-valued logic: one element can decide; otherwise a missing element leaves the result open.
fn all(value: Value, every: bool) -> Value {
    let points = match points(value) {
        Ok(points) => points,
        Err(missing) => return missing,
    };
    let mut open = None;
    for (_, value) in points {
        match value {
            Value::Truth(truth) if truth != every => return Value::Truth(truth),
            Value::Truth(_) => {}
            other => open = Some(other),
        }
    }
    open.map_or(Value::Truth(every), |value| Value::unknown(value.describe()))
}

fn where_true(value: Value, greatest: bool) -> Value {
    let points = match points(value) {
        Ok(points) => points,
        Err(missing) => return missing,
    };
    let mut found: Option<f64> = None;
    for (x, value) in points {
        match value {
            Value::Truth(false) => {}
            Value::Truth(true) => {
                found = Some(found.map_or(x, |old: f64| if greatest { old.max(x) } else { old.min(x) }));
            }
            other => return Value::unknown(other.describe()),
        }
    }
    found.map_or_else(|| Value::none("nowhere"), Value::Number)
}

fn count(value: Value) -> Value {
    match points(value) {
        Ok(points) => Value::Number(points.iter().filter(|(_, value)| *value == Value::Truth(true)).count() as f64),
        Err(missing) => missing,
    }
}

fn ordered(value: Value, sense: f64) -> Value {
    match numbers(value) {
        Ok(numbers) => Value::Truth(numbers.windows(2).all(|pair| sense * (pair[1].1 - pair[0].1) >= 0.0)),
        Err(missing) => missing,
    }
}

fn rises_then_falls(value: Value) -> Value {
    let numbers = match numbers(value) {
        Ok(numbers) => numbers,
        Err(missing) => return missing,
    };
    let top = (0..numbers.len()).max_by(|a, b| numbers[*a].1.total_cmp(&numbers[*b].1)).unwrap_or(0);
    if numbers.is_empty() {
        return Value::none("no value");
    }
    let grows = numbers[..=top].windows(2).all(|pair| pair[1].1 >= pair[0].1);
    let falls = numbers[top..].windows(2).all(|pair| pair[1].1 <= pair[0].1);
    Value::Truth(grows && falls && top > 0 && top + 1 < numbers.len())
}

fn mean(value: Value) -> Value {
    match numbers(value) {
        Ok(numbers) if numbers.is_empty() => Value::none("no value"),
        Ok(numbers) => Value::Number(numbers.iter().map(|(_, y)| y).sum::<f64>() / numbers.len() as f64),
        Err(missing) => missing,
    }
}

fn length(value: Value) -> Value {
    match value {
        Value::List(values) => Value::Number(values.len() as f64),
        missing @ Value::Missing { .. } => missing,
        _ => Value::Number(1.0),
    }
}

fn entry(value: Value, first: bool) -> Value {
    match value {
        Value::List(values) => {
            let found = if first { values.into_iter().next() } else { values.into_iter().next_back() };
            found.unwrap_or_else(|| Value::none("an empty list"))
        }
        other => other,
    }
}

fn at(series: Value, place: Value) -> Value {
    let Some(place) = place.number() else { return Value::unknown("\"at\" needs a number") };
    match points(series) {
        Ok(points) => {
            let near = |x: f64| (x - place).abs() <= 1e-6 * place.abs().max(1e-6);
            let found = points.into_iter().find(|(x, _)| near(*x)).map(|(_, value)| value);
            found.unwrap_or_else(|| Value::unknown(format!("nothing stands at {place}")))
        }
        Err(missing) => missing,
    }
}

fn has(value: Value, item: Value) -> Value {
    // A condition on a value that is proved not to exist is false.
    if matches!(value, Value::Missing { proven: true, .. }) {
        return Value::Truth(false);
    }
    value.map(&|list| match list {
        Value::Missing { proven: true, .. } => Value::Truth(false),
        missing @ Value::Missing { .. } => missing,
        Value::List(values) => Value::Truth(values.contains(&item)),
        other => Value::Truth(other == item),
    })
}

fn within(series: Value, from: Value, to: Value) -> Value {
    let (Some(from), Some(to)) = (from.number(), to.number()) else {
        return Value::unknown("\"within\" needs two numbers");
    };
    let slack = 1e-9 * (to - from).abs().max(1e-9);
    match points(series) {
        Ok(points) => {
            Value::Series(points.into_iter().filter(|(x, _)| *x >= from - slack && *x <= to + slack).collect())
        }
        Err(missing) => missing,
    }
}

/// Returns the number of times that the slope of a curve before its peak falls below half of the greatest slope after it. Each
/// fall counts once.
fn recoveries(curve: Value) -> Value {
    let numbers = match numbers(curve) {
        Ok(numbers) => numbers,
        Err(missing) => return missing,
    };
    let top = (0..numbers.len()).max_by(|a, b| numbers[*a].1.total_cmp(&numbers[*b].1)).unwrap_or(0);
    if numbers.is_empty() {
        return Value::none("no value");
    }
    let range = numbers[..=top].iter().map(|(x, _)| x.abs()).fold(0.0, f64::max);
    let steps = numbers[..=top].windows(2).filter(|pair| (pair[1].0 - pair[0].0).abs() > 1e-6 * range);
    let slopes: Vec<f64> = steps.map(|pair| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).collect();
    let mut later = slopes.clone();
    for i in (0..later.len().saturating_sub(1)).rev() {
        later[i] = later[i].max(later[i + 1]);
    }
    let soft: Vec<bool> = slopes.iter().zip(&later).map(|(own, later)| *own < 0.5 * later).collect();
    let begins = (0..soft.len()).filter(|&i| soft[i] && (i == 0 || !soft[i - 1])).count();
    Value::Number(begins as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Value {
        let series = |name: &str| {
            let list = |values: &[f64]| {
                let point = |(i, y): (usize, &f64)| (i as f64, Value::Number(*y));
                Some(Value::Series(values.iter().enumerate().map(point).collect()))
            };
            match name {
                "hill" => list(&[1.0, 3.0, 7.0, 4.0]),
                "open" => list(&[1.0, f64::INFINITY, 2.0]),
                "soft" => list(&[0.0, 1.0, 2.0, 2.1, 2.2, 3.2, 4.2, 3.0]),
                "stalled" => Some(Value::Series(vec![(0.0, Value::Number(1.0)), (1.0, Value::unknown("stalled"))])),
                "none" => Some(Value::Series(vec![(0.0, Value::Number(1.0)), (1.0, Value::none("no equilibrium"))])),
                _ => None,
            }
        };
        evaluate(&Expression::parse(text).expect("an expression"), &series)
    }

    #[test]
    fn functions_of_series() {
        for text in [
            "argmax(hill) == 2 and max(hill) == 7 and min(hill) == 1",
            "rises_then_falls(hill) and not rising(hill) and rising(within(hill, 0, 2))",
            "all(hill > 0) and any(hill == 3) and count(hill > 2) == 3",
            "highest_where(hill > 2) == 3 and lowest_where(hill > 2) == 1",
            "at(hill * 2 - hill, 1) == 3 and max(hill / hill) == 1",
            "recoveries(soft) == 1 and recoveries(hill) == 0",
            "abs(-2) == 2 and 1 + 2 * 3 == 7",
            "argmax(none) == 0",
        ] {
            assert_eq!(value(text), Value::Truth(true), "{text}");
        }
    }

    /// A value that is proved not to exist compares false; an unknown value leaves the comparison open.
    #[test]
    fn missing_values_are_no_numbers() {
        assert_eq!(value("argmax(open) < 5"), Value::Truth(false));
        assert_eq!(value("max(open) > 1e9"), Value::Truth(true));
        assert!(matches!(value("argmax(stalled) < 5"), Value::Missing { proven: false, .. }));
        assert_eq!(value("all(stalled > 2)"), Value::Truth(false));
        assert!(matches!(value("all(stalled > 0)"), Value::Missing { .. }));
        assert_eq!(value("argmax(open) < 5 or 1 < 2"), Value::Truth(true));
    }
}
