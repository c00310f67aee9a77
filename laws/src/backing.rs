//! `backing`: solid backing behind a ring.
#![doc = include_str!("backing.md")]

use voussoir_core::law::{FillResistance, FillState};
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// Backing that resists up to a pressure, for any load on it.
#[derive(Debug, Clone, Keys)]
pub struct Backing {
    /// horizontal pressure up to which it resists; 0 switches it off
    #[key(unit = "Pa", range = ">= 0")]
    pub strength: f64,
    /// pressure by displacement into the backing before it yields; limit loads do not depend on it
    #[key(unit = "Pa/m", range = "> 0", optional = "it is rigid until it yields")]
    pub stiffness: Option<f64>,
}

#[typetag::serde(name = "backing")]
impl FillResistance for Backing {
    fn pressures(&self, _: &FillState) -> [f64; 2] {
        [0.0, self.strength]
    }

    fn stiffness(&self) -> Option<f64> {
        self.stiffness
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::FillResistance,
        tag: "backing",
        summary: "solid backing: resists up to a given pressure that does not depend on the fill above it",
        sources: &["Gilbert 2007, ARCH'07 (backing beside the ring)"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("backing.md"),
        ..Card::of::<Backing>()
    }
}
