//! `uniform`: a load spreads evenly at an angle through a depth.

use crate::scenes::dispersion::law::{Dispersion, Patch, Through};
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// A load spreads evenly to both sides.
#[derive(Debug, Keys)]
pub struct Uniform {
    /// from the vertical
    #[key(unit = "deg", range = ">= 0, < 90")]
    pub angle: f64,
    /// through which the load spreads
    #[key(unit = "m", range = ">= 0", optional = "the depth of the fill under the load's centre")]
    pub depth: Option<f64>,
}

#[typetag::serde(name = "uniform")]
impl Dispersion for Uniform {
    fn spread(&self, patch: Patch, fill: &[Through]) -> Vec<Patch> {
        let own = self.angle.to_radians();
        let reach = match self.depth {
            Some(depth) => depth * own.tan(),
            None => fill.iter().map(|layer| layer.thickness * layer.angle.unwrap_or(own).tan()).sum(),
        };
        vec![Patch { from: patch.from - reach, to: patch.to + reach, ..patch }]
    }

    fn has_depth(&self) -> bool {
        self.depth.is_some()
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Dispersion,
        tag: "uniform",
        summary: "a load spreads evenly to both sides, under an angle through a depth",
        sources: &["Highways Agency 2001, BD 21/01, The Assessment of Highway Bridges and Structures"],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `uniform`\n\nA load between two x acts uniformly on the extrados between these x, widened by depth × \
               tan(angle) on both sides; the force stays the same. In the fill of a bridge the depth is the depth of the \
               straight extrados chord under the centre of the load, the same for the whole patch; each layer can have a \
               separate angle. In other scenes you give the depth.\n",
        ..Card::of::<Uniform>()
    }
}
