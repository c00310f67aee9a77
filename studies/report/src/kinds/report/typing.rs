//! Wrong types in an expression: `"a" + 1`, `not 3`, or a condition that is a number.

use super::evaluate::FUNCTIONS;
use super::expression::{Expression, Operator};
use super::types::Type;

/// Returns the type of an expression. `names` returns the types of series; every mistake is added to `mistakes`.
pub fn type_of(expression: &Expression, names: &dyn Fn(&str) -> Type, mistakes: &mut Vec<String>) -> Type {
    let mut of = |part: &Expression| type_of(part, names, mistakes);
    match expression {
        Expression::Number(_) => Type::Number,
        Expression::Word(_) => Type::Word,
        Expression::Name(name) => names(name),
        Expression::Call(name, arguments) => {
            let found: Vec<Type> = arguments.iter().map(of).collect();
            let Some(function) = FUNCTIONS.iter().find(|function| function.name == name) else { return Type::Unknown };
            for (found, wanted) in found.iter().zip(function.takes) {
                need(&format!("{name}(…)"), *found, *wanted, mistakes);
            }
            function.gives.unwrap_or_else(|| found.first().copied().unwrap_or(Type::Unknown))
        }
        Expression::Binary(operator, a, b) => {
            let found = [of(a), of(b)];
            binary(*operator, found, mistakes)
        }
        Expression::Not(a) => {
            let found = of(a);
            need("not", found, Type::Truth, mistakes);
            Type::Truth
        }
        Expression::Negative(a) => {
            let found = of(a);
            need("-", found, Type::Number, mistakes);
            Type::Number
        }
    }
}

fn binary(operator: Operator, [a, b]: [Type; 2], mistakes: &mut Vec<String>) -> Type {
    use Operator::*;
    let (wanted, result) = match operator {
        And | Or => (Type::Truth, Type::Truth),
        Add | Subtract | Multiply | Divide => (Type::Number, Type::Number),
        Less | AtMost | Greater | AtLeast => (Type::Number, Type::Truth),
        Equal | Unequal => {
            if !a.may_be(b) {
                mistakes.push(format!("\"{}\" compares {} with {}", operator.sign(), a.describe(), b.describe()));
            }
            return Type::Truth;
        }
    };
    [a, b].into_iter().for_each(|found| need(operator.sign(), found, wanted, mistakes));
    result
}

fn need(by: &str, found: Type, wanted: Type, mistakes: &mut Vec<String>) {
    if !found.may_be(wanted) {
        mistakes.push(format!("\"{by}\" needs {}, but this is {}", wanted.describe(), found.describe()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(text: &str) -> (Type, Vec<String>) {
        let names = |name: &str| match name {
            "load" => Type::Number,
            "kind" => Type::Word,
            _ => Type::Unknown,
        };
        let mut mistakes = Vec::new();
        let found = type_of(&Expression::parse(text).expect("an expression"), &names, &mut mistakes);
        (found, mistakes)
    }

    #[test]
    fn wrong_types_are_found_without_results() {
        for (text, found) in [
            ("abs(argmax(load) - 0.59) < 0.15 and at(kind, 0.59) == \"crushing\"", Type::Truth),
            ("at(kind, 1)", Type::Word),
            ("first(other) + 1", Type::Number),
            ("within(load, 0, 1)", Type::Number),
        ] {
            assert_eq!(typed(text), (found, Vec::new()), "{text}");
        }
        for (text, mistake) in [
            ("load and true_one", "\"and\" needs true or false, but this is a number"),
            ("kind + 1", "\"+\" needs a number, but this is a word"),
            ("not 3", "\"not\" needs true or false, but this is a number"),
            ("all(load)", "\"all(…)\" needs true or false, but this is a number"),
            ("kind == 3", "\"==\" compares a word with a number"),
            ("max(kind) < 2", "\"max(…)\" needs a number, but this is a word"),
        ] {
            assert_eq!(typed(text).1, [mistake], "{text}");
        }
    }
}
