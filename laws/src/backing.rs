//! `backing`: solid backing beside a ring.
#![doc = include_str!("backing.md")]

use serde::{Deserialize, Serialize};
use voussoir_core::law::{FillResistance, FillState};
use voussoir_core::plugin::{Card, Parameter, PluginKind, Quantity, Range};

/// Resists up to a pressure, whatever stands on it.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Backing {
    /// \[Pa\].
    pub strength: f64,
    /// Pressure by displacement \[Pa/m\].
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
        summary: "solid backing: resists up to a pressure, whatever stands on it",
        parameters: &[
            Parameter::number(
                "strength",
                Quantity::Stress,
                Range::NON_NEGATIVE,
                "horizontal pressure up to which it resists; 0 switches it off",
            ),
            Parameter::number(
                "stiffness",
                Quantity::Stiffness,
                Range::POSITIVE,
                "pressure by displacement into the backing before it yields; limit loads do not depend on it",
            )
            .optional("it is rigid until it yields"),
        ],
        sources: &["Gilbert 2007, ARCH'07 (backing beside the ring)"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("backing.md"),
        ..Card::BLANK
    }
}
