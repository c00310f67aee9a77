//! Types of expressions, as far as they are known before there are results.

/// The type of a value, or of each element of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    /// A number.
    Number,
    /// A word.
    Word,
    /// True or false.
    Truth,
    /// Known only after the run.
    Unknown,
}

impl Type {
    /// Returns the type in words.
    pub fn describe(self) -> &'static str {
        match self {
            Type::Number => "a number",
            Type::Word => "a word",
            Type::Truth => "true or false",
            Type::Unknown => "any value",
        }
    }

    /// Returns false if a value of this type is never of the other type.
    pub fn may_be(self, other: Type) -> bool {
        self == other || self == Type::Unknown || other == Type::Unknown
    }
}
