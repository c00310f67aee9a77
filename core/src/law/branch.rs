//! Names for what an update did, given by laws.

use serde::{Serialize, Serializer};

/// What happens in a branch of a law, for those who do not know the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Effect {
    /// Nothing irreversible.
    Elastic,
    /// A joint slides.
    Sliding,
    /// Strength is lost.
    Softening,
    /// A material yields.
    Yielding,
    /// A material yields in tension.
    Tearing,
}

/// What an update did: which of a law's equations were solved, by the law's own name for them, which stands
/// in result files. `elastic` alone is the same in every law. Two branches are equal where names and
/// effects are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct UpdateBranch {
    /// Its name in result files.
    pub name: &'static str,
    /// What happens in it.
    pub effect: Effect,
}

impl UpdateBranch {
    /// Nothing irreversible in this step.
    pub const ELASTIC: Self = Self::new("elastic", Effect::Elastic);

    /// A joint is open, and nothing irreversible happens in this step.
    pub const OPEN: Self = Self::new("open", Effect::Elastic);

    /// A branch of a law.
    pub const fn new(name: &'static str, effect: Effect) -> Self {
        UpdateBranch { name, effect }
    }

    /// Whether nothing irreversible happened.
    pub fn is_elastic(self) -> bool {
        self.effect == Effect::Elastic
    }
}

impl Serialize for UpdateBranch {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.name)
    }
}
