//! Keys that several load kinds share, and the shape of an entry of `loads`.

pub(super) use crate::scenes::POINT;
use std::sync::LazyLock;
use voussoir_core::plugin::{Need, Parameter, PluginKind, Quantity, Range, Shape, Variant, cards_of};

/// A span fraction.
pub(super) const FRACTION: Range = Range::ANY;
/// A force \[x, y\].
pub(super) const VECTOR: Shape = Shape::Tuple(&[("x", FORCE), ("y", FORCE)]);
const FORCE: Shape = Shape::Number(Quantity::Force, Range::ANY);
/// An index or a number of a block.
pub(super) const NUMBER: Shape = Shape::Integer { min: 0, max: i64::MAX };
/// A block.
pub(super) const BLOCK: Parameter = Parameter {
    name: "block",
    doc: "name of the block, on arches the number of the voussoir from the left",
    shape: Shape::Either(&[Shape::Text, NUMBER]),
    need: Need::Required,
};
/// How a load spreads on its way to the extrados.
pub(super) const DISPERSION: Parameter = Parameter {
    name: "dispersion",
    doc: "how the load spreads on its way to the extrados: { law = \"uniform\", angle = 30.0, depth = 0.5 }",
    shape: Shape::Plugin(PluginKind::Dispersion),
    need: Need::Optional("it does not spread"),
};

/// A list of at least one entry that must be given.
pub(super) const fn many(name: &'static str, of: &'static Shape, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape: Shape::List { of, min: 1, max: usize::MAX }, need: Need::Required }
}

/// What an entry of `loads` may hold: the keys of one of the registered load kinds.
pub fn load_shape() -> &'static Shape {
    static SHAPE: LazyLock<Shape> = LazyLock::new(|| {
        let kinds = cards_of(PluginKind::LoadKind).into_iter();
        let variants: Vec<Variant> =
            kinds.map(|card| Variant { tag: card.tag, doc: card.summary, parameters: card.parameters }).collect();
        // Made once, from a registry that lives as long as the program.
        Shape::Tagged { key: PluginKind::LoadKind.tag_key(), variants: Vec::leak(variants) }
    });
    &SHAPE
}
