//! What every update of a point shares: what it is told besides strain and state, and how it fails.

use std::error::Error;
use std::fmt;

/// What an update of stresses is told besides strain and state; laws read what concerns them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UpdateContext<'a> {
    /// Characteristic length \[m\]: the width over which an element localises; for laws that soften.
    pub length: f64,
    /// Unit vectors of the block's axes in those of the strains; `None` where they are the same.
    pub axes: Option<&'a [[f64; 3]; 3]>,
    /// Duration of the step \[s\]; 0 where nothing depends on time.
    pub time_step: f64,
    /// What else is known at the point, by name.
    pub variables: &'a [(&'a str, f64)],
}

impl UpdateContext<'static> {
    /// A characteristic length \[m\] and nothing else.
    pub const fn of_length(length: f64) -> Self {
        UpdateContext { length, axes: None, time_step: 0.0, variables: &[] }
    }
}

impl UpdateContext<'_> {
    /// A variable by name.
    pub fn variable(&self, name: &str) -> Option<f64> {
        self.variables.iter().find(|(own, _)| *own == name).map(|(_, value)| *value)
    }
}

/// Why an update has no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum UpdateFailure {
    /// The strain or the state holds a number that is not finite.
    NotFinite,
    /// The iteration did not meet its tolerance.
    NoConvergence,
    /// The point's characteristic length is too large for the fracture energy: the softening branch
    /// would snap back inside the point.
    LengthTooLarge,
    /// A slice is not as long as the number of points and the law's state size demand.
    WrongSize,
    /// A law's own reason.
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
    /// Why.
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
