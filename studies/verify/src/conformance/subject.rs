//! A law with the keys of one of its samples.

use super::point::Point;
use voussoir_core::plugin::{Card, Sample};

/// The subject of a check: a law at a point, with the keys of one of its samples.
pub(super) struct Subject<'a> {
    pub card: &'a Card,
    pub sample: &'a Sample,
    pub point: Point,
    /// The same law after its table was written and read back.
    pub again: Point,
    /// Scale of stiffnesses \[Pa/m\] or \[Pa\].
    pub stiffness: f64,
}
