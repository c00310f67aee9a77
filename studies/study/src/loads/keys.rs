//! Keys that several load kinds share, and the shape of an entry of `loads`.

use super::site::BlockName;
use crate::scenes::dispersion::Dispersion;
use std::sync::LazyLock;
use voussoir_core::plugin::{Keys, PluginKind, Shape, Variant, cards_of};

/// Keys that several load kinds share.
#[derive(Debug, Keys)]
pub(super) struct LoadKeys {
    /// name of the block, on arches the number of the voussoir from the left
    block: BlockName,
    /// how the load spreads on its way to the extrados: { law = "uniform", angle = 30.0, depth = 0.5 }
    #[key(optional = "it does not spread")]
    dispersion: Option<Box<dyn Dispersion>>,
}

/// Returns the shape of an entry of `loads`: the keys of one of the registered load kinds.
pub fn load_shape() -> &'static Shape {
    static SHAPE: LazyLock<Shape> = LazyLock::new(|| {
        let kinds = cards_of(PluginKind::LoadKind).into_iter();
        let variants: Vec<Variant> =
            kinds.map(|card| Variant { tag: card.tag, doc: card.summary, parameters: card.parameters }).collect();
        // Made once, from a registry with the lifetime of the program.
        Shape::Tagged { key: PluginKind::LoadKind.tag_key(), variants: Vec::leak(variants) }
    });
    &SHAPE
}
