//! `body`: acceleration of every block, times its mass.

use super::load_kind::{LoadKind, Placed};
use super::site::LoadSite;
use serde::{Deserialize, Serialize};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::{Card, Diagnostic, Need, Parameter, PluginKind, Quantity, Range, Shape};

/// Acceleration of every block, times its mass.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyLoad {
    /// \[m/s²\].
    pub acceleration: [f64; 2],
}

#[typetag::serde(name = "body")]
impl LoadKind for BodyLoad {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("acceleration", &self.acceleration)])?;
        Ok(Placed { accelerations: vec![Vec2::from(self.acceleration)], ..Placed::default() })
    }
}

const ACCELERATION: Shape = Shape::Number(Quantity::Acceleration, Range::ANY);

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "body",
        summary: "acceleration of every block, times its mass",
        parameters: &[Parameter {
            name: "acceleration",
            doc: "acceleration, x to the right and y upwards",
            shape: Shape::Tuple(&[("x", ACCELERATION), ("y", ACCELERATION)]),
            need: Need::Required,
        }],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `body`\n\nAn acceleration of every block, times its mass: for pushover and tilting.\n",
        ..Card::BLANK
    }
}
