//! The trait of a law of dispersion.

use std::fmt::Debug;
use voussoir_core::plugin::{KeyValue, PluginKind, Registered, Shape};

/// A part of a load on the level line between two x \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Left end.
    pub from: f64,
    /// Right end; equal to the left end for a point load.
    pub to: f64,
    /// Share of the whole load.
    pub share: f64,
}

/// A layer of fill between a load and the extrados.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Through {
    /// Thickness \[m\].
    pub thickness: f64,
    /// Angle of spread from the vertical, if the layer defines one \[rad\].
    pub angle: Option<f64>,
}

/// The spread of a live load between its position and the extrados, chosen by `dispersion = { law = … }`.
#[typetag::serde(tag = "law")]
pub trait Dispersion: Debug + Send + Sync {
    /// Returns the load at the level of the extrados, spread through the fill under the centre of the load. The shares add up
    /// to the share of the patch.
    fn spread(&self, patch: Patch, fill: &[Through]) -> Vec<Patch>;

    /// Returns true if the law defines the depth of the spread, so that it needs no fill.
    fn has_depth(&self) -> bool {
        true
    }
}

impl KeyValue for Box<dyn Dispersion> {
    const SHAPE: Shape = Shape::Plugin(PluginKind::Dispersion);
}

voussoir_core::inventory::submit! { Registered::of::<dyn Dispersion>(PluginKind::Dispersion) }
