//! `body`: acceleration of every block, times its mass.

use super::load_kind::{LoadKind, Placed};
use super::site::LoadSite;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Acceleration of every block, times its mass.
#[derive(Debug, Keys)]
pub struct BodyLoad {
    /// acceleration, x to the right and y upwards
    #[key(names = ["x", "y"], unit = "m/s2")]
    pub acceleration: [f64; 2],
}

#[typetag::serde(name = "body")]
impl LoadKind for BodyLoad {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("acceleration", &self.acceleration)])?;
        Ok(Placed { accelerations: vec![Vec2::from(self.acceleration)], ..Placed::default() })
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "body",
        summary: "acceleration of every block, times its mass",
        samples: &[
            Sample::keys("acceleration = [1.5, -2.0]"),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `body`\n\nAn acceleration acts on every block; the force is the acceleration times the mass. Use it \
               for pushover and tilting.\n",
        ..Card::of::<BodyLoad>()
    }
}
