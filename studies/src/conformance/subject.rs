//! A law as one of its samples makes it.

use super::point::Point;
use voussoir_core::plugin::{Card, Sample};

/// What is checked: a law at a point, as one of its samples makes it.
pub(super) struct Subject<'a> {
    pub card: &'a Card,
    pub sample: &'a Sample,
    pub point: Point,
    /// The same after its table was written and read again.
    pub again: Point,
    /// What stiffnesses are measured by \[Pa/m\] or \[Pa\].
    pub stiffness: f64,
}
