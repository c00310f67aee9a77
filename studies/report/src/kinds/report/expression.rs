//! Expressions of claims, as text and as a tree: `abs(argmax(ten) - 0.59) < 0.15 and at(kind, 0.59) == "crushing"`.

/// An expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// A word in quotes.
    Word(String),
    /// A series, or `value` and `x`.
    Name(String),
    /// A function of values.
    Call(String, Vec<Expression>),
    /// Two values joined by an operator.
    Binary(Operator, Box<Expression>, Box<Expression>),
    /// Negation of a truth value.
    Not(Box<Expression>),
    /// Negative of a number.
    Negative(Box<Expression>),
}

/// A binary operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// Logical and.
    And,
    /// Logical or.
    Or,
    /// Sum of two values.
    Add,
    /// Difference of two values.
    Subtract,
    /// Product of two values.
    Multiply,
    /// Quotient of two values.
    Divide,
    /// Equality.
    Equal,
    /// Inequality.
    Unequal,
    /// Less than.
    Less,
    /// Less or equal.
    AtMost,
    /// Greater than.
    Greater,
    /// Greater or equal.
    AtLeast,
}

impl Operator {
    /// Returns the sign of the operator in expressions.
    pub fn sign(self) -> &'static str {
        LEVELS.iter().copied().flatten().find(|(_, operator)| *operator == self).map_or("", |(sign, _)| *sign)
    }
}

use Operator::*;

/// Operators by precedence, lowest first; longer signs before shorter ones.
const LEVELS: [&[(&str, Operator)]; 5] = [
    &[("or", Or)],
    &[("and", And)],
    &[("==", Equal), ("!=", Unequal), ("<=", AtMost), (">=", AtLeast), ("<", Less), (">", Greater)],
    &[("+", Add), ("-", Subtract)],
    &[("*", Multiply), ("/", Divide)],
];

/// Greatest nesting of an expression.
const DEPTH: usize = 60;
/// Greatest number of numbers, words, names and functions. A long sum is a deep tree, and every walk over it recurses.
const MAX_TERMS: usize = 250;

struct Parser<'a> {
    rest: &'a str,
    depth: usize,
    terms: usize,
}

impl Expression {
    /// Reads an expression. The error gives the position and the expected text.
    pub fn parse(text: &str) -> Result<Expression, String> {
        let mut parser = Parser { rest: text, depth: 0, terms: 0 };
        let expression = parser.level(0)?;
        match parser.rest.trim() {
            "" => Ok(expression),
            rest => Err(format!("\"{rest}\" is left over")),
        }
    }

    /// Calls `see` with every name, and with every function and its number of arguments.
    pub fn names<'a>(&'a self, see: &mut dyn FnMut(&'a str, Option<usize>)) {
        match self {
            Expression::Number(_) | Expression::Word(_) => {}
            Expression::Name(name) => see(name, None),
            Expression::Call(name, arguments) => {
                see(name, Some(arguments.len()));
                arguments.iter().for_each(|argument| argument.names(see));
            }
            Expression::Binary(_, a, b) => {
                a.names(see);
                b.names(see);
            }
            Expression::Not(a) | Expression::Negative(a) => a.names(see),
        }
    }
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

impl Parser<'_> {
    /// Consumes a word or sign if it comes next.
    fn take(&mut self, sign: &str) -> bool {
        let Some(rest) = self.rest.trim_start().strip_prefix(sign) else { return false };
        if sign.chars().all(is_name) && rest.starts_with(is_name) {
            return false;
        }
        self.rest = rest;
        true
    }

    fn level(&mut self, level: usize) -> Result<Expression, String> {
        let Some(operators) = LEVELS.get(level) else { return self.unary() };
        let mut left = self.level(level + 1)?;
        while let Some((_, operator)) = operators.iter().find(|(sign, _)| self.take(sign)) {
            let right = self.level(level + 1)?;
            left = Expression::Binary(*operator, Box::new(left), Box::new(right));
        }
        Ok(left)
    }

    fn unary(&mut self) -> Result<Expression, String> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err("it is nested too deeply".into());
        }
        let found = if self.take("not") {
            Expression::Not(Box::new(self.unary()?))
        } else if self.take("-") {
            Expression::Negative(Box::new(self.unary()?))
        } else {
            self.primary()?
        };
        self.depth -= 1;
        Ok(found)
    }

    fn primary(&mut self) -> Result<Expression, String> {
        self.rest = self.rest.trim_start();
        self.terms += 1;
        if self.terms > MAX_TERMS {
            return Err(format!("it has more than {MAX_TERMS} terms"));
        }
        if self.take("(") {
            let inner = self.level(0)?;
            return if self.take(")") { Ok(inner) } else { Err(self.expected("\")\"")) };
        }
        for quote in ['"', '\''] {
            if let Some((word, rest)) = self.rest.strip_prefix(quote).and_then(|rest| rest.split_once(quote)) {
                self.rest = rest;
                return Ok(Expression::Word(word.into()));
            }
        }
        if self.rest.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            return self.number();
        }
        let end = self.rest.find(|c| !is_name(c)).unwrap_or(self.rest.len());
        if end == 0 {
            return Err(self.expected("a number, a name or \"(\""));
        }
        let (name, rest) = self.rest.split_at(end);
        self.rest = rest;
        if !self.take("(") {
            return Ok(Expression::Name(name.into()));
        }
        let mut arguments = Vec::new();
        if !self.take(")") {
            loop {
                arguments.push(self.level(0)?);
                if self.take(")") {
                    break;
                }
                if !self.take(",") {
                    return Err(self.expected("\",\" or \")\""));
                }
            }
        }
        Ok(Expression::Call(name.into(), arguments))
    }

    fn number(&mut self) -> Result<Expression, String> {
        let mut end = 0;
        let mut last = ' ';
        for (place, c) in self.rest.char_indices() {
            let sign = (c == '-' || c == '+') && matches!(last, 'e' | 'E');
            if !(c.is_ascii_digit() || c == '.' || c == 'e' || c == 'E' || sign) {
                break;
            }
            (end, last) = (place + c.len_utf8(), c);
        }
        let (digits, rest) = self.rest.split_at(end);
        self.rest = rest;
        digits.parse().map(Expression::Number).map_err(|_| format!("\"{digits}\" is no number"))
    }

    fn expected(&self, what: &str) -> String {
        match self.rest.trim() {
            "" => format!("{what} is missing at its end"),
            rest => format!("{what} is missing before \"{}\"", rest.chars().take(30).collect::<String>()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_bind_before_sums_and_sums_before_comparisons() {
        let one = Expression::parse("1 + 2 * 3 < 8 and not done").expect("an expression");
        let two = Expression::parse("((1 + (2 * 3)) < 8) and (not done)").expect("an expression");
        assert_eq!(one, two);
    }

    #[test]
    fn mistakes_say_where() {
        let wrong = |text: &str| Expression::parse(text).expect_err("a mistake");
        assert_eq!(wrong("1 +"), "a number, a name or \"(\" is missing at its end");
        assert_eq!(wrong("max(a b)"), "\",\" or \")\" is missing before \"b)\"");
        assert_eq!(wrong("1 2"), "\"2\" is left over");
        assert!(wrong(&"(".repeat(100_000)).contains("nested"));
        assert!(wrong(&"not ".repeat(100_000)).contains("nested"));
        assert!(wrong(&format!("1{}", "+1".repeat(100_000))).contains("more than 250 terms"));
        assert!(wrong(&format!("max({})", "1,".repeat(100_000))).contains("more than 250 terms"));
        assert!(Expression::parse(&format!("1{}", "+1".repeat(249))).is_ok());
    }
}
