//! Branches of laws: the set of equations that an update has solved, with a name that the law gives.

use serde::{Serialize, Serializer};

/// The physical effect of a branch, for code that does not know the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Effect {
    /// Nothing irreversible happens.
    Elastic,
    /// Nothing irreversible happens. The stiffness is less than at first, because the material was damaged in an earlier step.
    Unloading,
    /// A joint slides.
    Sliding,
    /// Strength is lost.
    Softening,
    /// A material yields.
    Yielding,
    /// A material yields in tension.
    Tearing,
}

/// The branch of an update: the set of a law's equations that was solved. The law chooses the name; result files show
/// it. Only the name `elastic` is common to all laws. Two branches are equal if their names and effects are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct UpdateBranch {
    /// Name in result files.
    pub name: &'static str,
    /// Physical effect.
    pub effect: Effect,
}

impl UpdateBranch {
    /// Nothing irreversible happens in this step.
    pub const ELASTIC: Self = Self::new("elastic", Effect::Elastic);

    /// The joint is open, and nothing irreversible happens in this step.
    pub const OPEN: Self = Self::new("open", Effect::Elastic);

    /// A damaged material unloads or loads again; nothing irreversible happens in this step.
    pub const UNLOADING: Self = Self::new("unloading", Effect::Unloading);

    /// Creates a branch of a law.
    pub const fn new(name: &'static str, effect: Effect) -> Self {
        UpdateBranch { name, effect }
    }

    /// Returns true if nothing irreversible happened.
    pub fn is_elastic(self) -> bool {
        matches!(self.effect, Effect::Elastic | Effect::Unloading)
    }
}

impl Serialize for UpdateBranch {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.name)
    }
}
