//! Data that all stress updates share: the inputs besides strain and state, and the failures.

use std::error::Error;
use std::fmt;

/// Inputs of a stress update besides strain and state. A law reads the fields that it needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UpdateContext<'a> {
    /// Characteristic length \[m\]: the width over which strain localises in an element; for laws that soften.
    pub length: f64,
    /// Unit vectors of the block's axes in the axes of the strains; `None` if both systems of axes are equal.
    pub axes: Option<&'a [[f64; 3]; 3]>,
    /// Duration of the step \[s\]; 0 if nothing depends on time.
    pub time_step: f64,
    /// Further variables at the point, by name.
    pub variables: &'a [(&'a str, f64)],
}

impl UpdateContext<'static> {
    /// Creates a context with a characteristic length \[m\] and no other data.
    pub const fn of_length(length: f64) -> Self {
        UpdateContext { length, axes: None, time_step: 0.0, variables: &[] }
    }
}

impl UpdateContext<'_> {
    /// Returns the value of a variable by name.
    pub fn variable(&self, name: &str) -> Option<f64> {
        self.variables.iter().find(|(own, _)| *own == name).map(|(_, value)| *value)
    }
}

/// The reason why an update has no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum UpdateFailure {
    /// The strain or the state holds a number that is not finite.
    NotFinite,
    /// The iteration did not reach its tolerance.
    NoConvergence,
    /// The point's characteristic length is too large for the fracture energy: the softening branch
    /// would snap back inside the point.
    LengthTooLarge,
    /// The length of a slice does not match the number of points and the state size of the law.
    WrongSize,
    /// A reason that the law defines.
    Law(&'static str),
}

impl fmt::Display for UpdateFailure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            UpdateFailure::NotFinite => "the strain or the state is not finite",
            UpdateFailure::NoConvergence => "the stress update did not meet its tolerance",
            UpdateFailure::LengthTooLarge => "the characteristic length is too large for the fracture energy",
            UpdateFailure::WrongSize => "the arrays do not fit the number of points",
            UpdateFailure::Law(reason) => reason,
        })
    }
}

impl Error for UpdateFailure {}

/// The first point of a batch whose update failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BatchFailure {
    /// Index of the point in the batch.
    pub point: usize,
    /// Reason of the failure.
    pub failure: UpdateFailure,
}

impl fmt::Display for BatchFailure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "point {}: {}", self.point, self.failure)
    }
}

impl Error for BatchFailure {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(&self.failure)
    }
}
