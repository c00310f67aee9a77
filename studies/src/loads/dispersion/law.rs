//! What a law of dispersion is.

use std::fmt::Debug;
use voussoir_core::plugin::{KeyValue, PluginKind, Shape};

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

/// A layer through which a load goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Through {
    /// \[m\].
    pub thickness: f64,
    /// Angle of spread that the layer has of its own, from the vertical \[rad\].
    pub angle: Option<f64>,
}

/// How a live load spreads between where it stands and the extrados, chosen by `dispersion = { law = … }`.
#[typetag::serde(tag = "law")]
pub trait Dispersion: Debug + Send + Sync {
    /// What reaches the level of the extrados through the fill under the load's centre; the shares add up to that of
    /// the patch.
    fn spread(&self, patch: Patch, fill: &[Through]) -> Vec<Patch>;

    /// Whether it says itself through what depth loads spread, so that it needs no fill.
    fn has_depth(&self) -> bool {
        true
    }
}

impl KeyValue for Box<dyn Dispersion> {
    const SHAPE: Shape = Shape::Plugin(PluginKind::Dispersion);
}
