//! `uniform`: a load spreads evenly under an angle through a depth.

use super::law::{Dispersion, Patch};
use serde::{Deserialize, Serialize};
use voussoir_core::plugin::{Card, Parameter, PluginKind, Quantity, Range};

/// A load spreads evenly to both sides.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Uniform {
    /// From the vertical \[deg\].
    pub angle: f64,
    /// Through which it spreads \[m\].
    pub depth: f64,
}

#[typetag::serde(name = "uniform")]
impl Dispersion for Uniform {
    fn spread(&self, patch: Patch) -> Vec<Patch> {
        let reach = self.depth * self.angle.to_radians().tan();
        vec![Patch { from: patch.from - reach, to: patch.to + reach, ..patch }]
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Dispersion,
        tag: "uniform",
        summary: "a load spreads evenly to both sides, under an angle through a depth",
        parameters: &[
            Parameter::number("angle", Quantity::Degrees, Range::new(0.0, false, 90.0, true), "from the vertical"),
            Parameter::number("depth", Quantity::Length, Range::NON_NEGATIVE, "through which the load spreads"),
        ],
        sources: &["Highways Agency 2001, BD 21/01, The Assessment of Highway Bridges and Structures"],
        file: file!(),
        page: "# `uniform`\n\nA load that stands between two x reaches the extrados evenly between these x widened by depth × tan(angle) \
               on both sides; the force stays. The depth is one number, so the level above the extrados is taken as even.\n",
        ..Card::BLANK
    }
}
