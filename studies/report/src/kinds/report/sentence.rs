//! Conditions of tests as sentences: "The place of the greatest value of ten differs from 0.59 by less than 0.15."

use super::expression::{Expression, Operator, Operator::*};

/// Returns a condition as a sentence. `value` is the number behind the test: the sentence names it if it has no operator,
/// and is about "the value" otherwise. `series` returns the words for a series.
pub fn sentence(condition: &Expression, value: Option<&Expression>, series: &dyn Fn(&str) -> String) -> String {
    let value = value.filter(|value| is_short(value));
    let words = Words { value, series }.clause(condition, None);
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).chain(['.']).collect())
}

/// Returns true if an expression is a name, or functions of names, numbers and words.
fn is_short(expression: &Expression) -> bool {
    match expression {
        Expression::Name(_) => true,
        Expression::Call(_, arguments) => arguments.iter().all(|argument| match argument {
            Expression::Number(_) | Expression::Word(_) => true,
            other => is_short(other),
        }),
        _ => false,
    }
}

struct Words<'a> {
    /// The expression called `value`, if the sentence names it.
    value: Option<&'a Expression>,
    series: &'a dyn Fn(&str) -> String,
}

impl Words<'_> {
    /// Returns an expression that is true or false in words. `outer` is the operator that joins it to another one.
    fn clause(&self, expression: &Expression, outer: Option<Operator>) -> String {
        match expression {
            Expression::Binary(operator @ (And | Or), a, b) => {
                let [a, b] = [a, b].map(|own| self.clause(own, Some(*operator)));
                match outer {
                    Some(outer) if outer != *operator => format!("({a} {} {b})", operator.sign()),
                    _ => format!("{a}, {} {b}", operator.sign()),
                }
            }
            Expression::Binary(operator, a, b) => self.comparison(*operator, a, b),
            Expression::Not(inner) => match &**inner {
                Expression::Call(name, arguments) if name == "any" => format!("nowhere {}", self.first(arguments)),
                Expression::Call(name, arguments) if name == "all" => {
                    format!("not everywhere {}", self.first(arguments))
                }
                other => format!("it is not true that {}", self.inner(other)),
            },
            Expression::Call(name, arguments) => match (name.as_str(), arguments.as_slice()) {
                ("all", _) => format!("everywhere {}", self.first(arguments)),
                ("any", _) => format!("somewhere {}", self.first(arguments)),
                ("rising", [of]) => format!("{} rises with the abscissa and never falls", self.noun(of)),
                ("falling", [of]) => format!("{} falls with the abscissa and never rises", self.noun(of)),
                ("rises_then_falls", [of]) => {
                    format!("{} rises up to one place inside and falls after it", self.noun(of))
                }
                ("has", [list, entry]) => format!("the list {} contains {}", self.noun(list), self.noun(entry)),
                _ => format!("{} is true", self.noun(expression)),
            },
            Expression::Name(name) if name == "value" => match self.value {
                Some(value) => self.plain().clause(value, outer),
                None => "the value is true".into(),
            },
            other => format!("{} is true", self.noun(other)),
        }
    }

    /// Returns the only argument of a function of conditions in words.
    fn first(&self, arguments: &[Expression]) -> String {
        arguments.first().map_or(String::new(), |own| self.inner(own))
    }

    /// Returns a condition inside another one, so that its end is clear.
    fn inner(&self, condition: &Expression) -> String {
        self.clause(condition, Some(Multiply))
    }

    /// These words without a number behind the test, for the expression of this number itself.
    fn plain(&self) -> Words<'_> {
        Words { value: None, series: self.series }
    }

    fn comparison(&self, operator: Operator, a: &Expression, b: &Expression) -> String {
        let words = match operator {
            Equal => "is",
            Unequal => "is not",
            Less => "is less than",
            AtMost => "is at most",
            Greater => "is greater than",
            AtLeast => "is at least",
            _ => return format!("{} is true", self.arithmetic(operator, a, b)),
        };
        if let (Less | AtMost, Expression::Call(name, arguments)) = (operator, a)
            && let ("abs", [Expression::Binary(Subtract, own, other)]) = (name.as_str(), arguments.as_slice())
        {
            let bound = if operator == Less { "less than" } else { "at most" };
            return match (&**own, &**other) {
                (Expression::Binary(Divide, of, by), Expression::Number(1.0)) => {
                    let [of, by, least] = [of, by, b].map(|own| self.noun(own));
                    format!("the relative difference of {of} from {by} is {bound} {least}")
                }
                _ => format!("{} differs from {} by {bound} {}", self.noun(own), self.noun(other), self.noun(b)),
            };
        }
        format!("{} {words} {}", self.noun(a), self.noun(b))
    }

    /// Returns a number, word, list or series in words.
    fn noun(&self, expression: &Expression) -> String {
        match expression {
            Expression::Number(number) if *number != 0.0 && !(1e-3..1e6).contains(number) => format!("{number:e}"),
            Expression::Number(number) => number.to_string(),
            Expression::Word(word) => format!("\"{word}\""),
            Expression::Name(name) if name == "value" => match self.value {
                Some(value) => self.plain().noun(value),
                None => "the value".into(),
            },
            Expression::Name(name) => (self.series)(name),
            Expression::Negative(own) => match &**own {
                Expression::Number(number) => format!("−{number}"),
                other => format!("the negative of {}", self.noun(other)),
            },
            Expression::Binary(operator @ (Add | Subtract | Multiply | Divide), a, b) => {
                self.arithmetic(*operator, a, b)
            }
            Expression::Call(name, arguments) => self.call(name, arguments),
            condition => format!("the truth of ({})", self.inner(condition)),
        }
    }

    fn arithmetic(&self, operator: Operator, a: &Expression, b: &Expression) -> String {
        let between = match operator {
            Add => "plus",
            Subtract => "minus",
            Multiply => "times",
            _ => "divided by",
        };
        let operand = |own: &Expression| match own {
            Expression::Binary(..) => format!("({})", self.noun(own)),
            _ => self.noun(own),
        };
        format!("{} {between} {}", operand(a), operand(b))
    }

    fn call(&self, name: &str, arguments: &[Expression]) -> String {
        let noun = |own: &Expression| self.noun(own);
        match (name, arguments) {
            ("abs", [of]) => format!("the absolute value of {}", noun(of)),
            ("argmax", [of]) => format!("the place of the greatest value of {}", noun(of)),
            ("argmin", [of]) => format!("the place of the least value of {}", noun(of)),
            ("max", [of]) => format!("the greatest value of {}", noun(of)),
            ("min", [of]) => format!("the least value of {}", noun(of)),
            ("highest_where", [of]) => format!("the greatest place at which {}", self.inner(of)),
            ("lowest_where", [of]) => format!("the least place at which {}", self.inner(of)),
            ("count", [of]) => format!("the number of elements for which {}", self.inner(of)),
            ("mean", [of]) => format!("the mean of {}", noun(of)),
            ("length", [of]) => format!("the number of entries of {}", noun(of)),
            ("first", [of]) => format!("the first entry of {}", noun(of)),
            ("last", [of]) => format!("the last entry of {}", noun(of)),
            ("words", [of]) => format!("the text of the list {}", noun(of)),
            ("recoveries", [of]) => {
                format!("the number of times that the slope of {} falls below half of a later slope", noun(of))
            }
            ("at", [of, place]) => format!("{} at {}", noun(of), noun(place)),
            ("within", [of, from, to]) => format!("{} from {} to {}", noun(of), noun(from), noun(to)),
            ("all" | "any" | "rising" | "falling" | "rises_then_falls" | "has", _) => {
                let condition = Expression::Call(name.into(), arguments.to_vec());
                format!("the truth of ({})", self.inner(&condition))
            }
            // A function without words here keeps its form.
            _ => format!("{name}({})", arguments.iter().map(noun).collect::<Vec<_>>().join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::evaluate::FUNCTIONS;
    use super::*;

    fn words(condition: &str, value: &str) -> String {
        let [condition, value] = [condition, value].map(|text| Expression::parse(text).expect("an expression"));
        sentence(&condition, Some(&value), &|name| name.into())
    }

    #[test]
    fn conditions_are_sentences() {
        for (condition, value, expected) in [
            ("value < 1", "2 * a", "The value is less than 1."),
            ("value <= 1", "2 * a", "The value is at most 1."),
            (
                "value >= 1",
                "recoveries(a)",
                "The number of times that the slope of a falls below half of a later slope is at least 1.",
            ),
            (
                "abs(value - 0.59) < 0.15",
                "argmax(a)",
                "The place of the greatest value of a differs from 0.59 by less than 0.15.",
            ),
            ("abs(value) < 1", "100 * (max(a) / max(b) - 1)", "The absolute value of the value is less than 1."),
            (
                "abs(value / 29.99 - 1) < 1e-3",
                "at(a, 0) / 1e6",
                "The relative difference of the value from 29.99 is less than 0.001.",
            ),
            ("abs(a - b) <= 1", "a", "A differs from b by at most 1."),
            ("value == 5", "at(a, 3.89)", "A at 3.89 is 5."),
            ("value != -5", "min(a)", "The least value of a is not −5."),
            (
                "value == \"intrados extrados\"",
                "words(at(a, 0))",
                "The text of the list a at 0 is \"intrados extrados\".",
            ),
            ("has(value, 15)", "at(a, 45)", "The list a at 45 contains 15."),
            ("length(at(a, 0)) == 2", "words(at(a, 0))", "The number of entries of a at 0 is 2."),
            (
                "rises_then_falls(a) and value > 0",
                "argmax(a)",
                "A rises up to one place inside and falls after it, and the place of the greatest value of a is greater than 0.",
            ),
            (
                "value < 0 and rising(within(mean(a), 1.4, 6))",
                "at(mean(a), 1) - at(mean(a), 5)",
                "The value is less than 0, and the mean of a from 1.4 to 6 rises with the abscissa and never falls.",
            ),
            ("falling(a)", "a", "A falls with the abscissa and never rises."),
            (
                "all(within(a, 1.1, 6) == 4 and k != \"crushing\") and not any(a == 4)",
                "a",
                "Everywhere (a from 1.1 to 6 is 4 and k is not \"crushing\"), and nowhere a is 4.",
            ),
            (
                "not all(a > 1) or not (a > b)",
                "a",
                "Not everywhere a is greater than 1, or it is not true that a is greater than b.",
            ),
            (
                "a > 1 and (b > 1 or c > 1)",
                "a",
                "A is greater than 1, and (b is greater than 1 or c is greater than 1).",
            ),
            ("value < 2 * (a + b)", "highest_where(a > 1e12)", "The value is less than 2 times (a plus b)."),
            ("value < 1e-6", "highest_where(a > 1e12)", "The value is less than 1e-6."),
            ("value < 1", "highest_where(a)", "The greatest place at which a is true is less than 1."),
            (
                "count(a > 1) == length(b)",
                "a",
                "The number of elements for which a is greater than 1 is the number of entries of b.",
            ),
            ("value", "all(a > 1)", "The value is true."),
            ("value", "rising(a)", "A rises with the abscissa and never falls."),
            (
                "rising(a) == rising(b)",
                "a",
                "The truth of (a rises with the abscissa and never falls) is the truth of (b rises with the abscissa and never falls).",
            ),
            (
                "first(value) < -last(value)",
                "at(a, 1)",
                "The first entry of a at 1 is less than the negative of the last entry of a at 1.",
            ),
        ] {
            assert_eq!(words(condition, value), expected, "{condition} with {value}");
        }
    }

    /// Words for every function: none keeps the form of an expression.
    #[test]
    fn every_function_has_words() {
        for function in FUNCTIONS {
            let arguments = ["a", "1", "2"][..function.takes.len()].join(", ");
            let call = format!("{}({arguments})", function.name);
            for condition in [call.clone(), format!("{call} == 1")] {
                let words = words(&condition, "b");
                assert!(!words.contains(&format!("{}(", function.name)), "{words}");
            }
        }
    }

    /// A series that is called `value` does not refer to itself, and deep expressions end.
    #[test]
    fn names_and_depth_have_an_end() {
        assert_eq!(words("value > 1", "max(value)"), "The greatest value of the value is greater than 1.");
        let long = format!("value < 1{}", " and value < 1".repeat(120));
        assert!(words(&long, "max(a)").starts_with("The greatest value of a is less than 1, and"));
    }
}
