//! What a law of dispersion is.

use std::fmt::Debug;

/// A part of a load on the level line between two x \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Left end.
    pub from: f64,
    /// Right end; the left one where the load is at a point.
    pub to: f64,
    /// Share of the whole load.
    pub share: f64,
}

/// How a live load spreads between where it stands and the extrados, chosen by `dispersion = { law = … }`.
#[typetag::serde(tag = "law")]
pub trait Dispersion: Debug + Send + Sync {
    /// What reaches the level of the extrados; the shares add up to that of the patch.
    fn spread(&self, patch: Patch) -> Vec<Patch>;
}
