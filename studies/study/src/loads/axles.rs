//! `axles`: wheels or axles on the extrados of an arch.

use super::extrados::{on_extrados, reach, x_at};
use super::load_kind::{LoadKind, Placed};
use super::site::LoadSite;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Wheels or axles on the extrados of an arch.
#[derive(Debug, Keys)]
pub struct Axles {
    /// span fraction of the origin of the positions
    #[key(unit = "-")]
    pub at: f64,
    /// positions of the axles, as horizontal distances from the origin
    #[key(unit = "m", len = ">= 1")]
    pub positions: Vec<f64>,
    /// forces, downwards, one for each position
    #[key(unit = "N", len = ">= 1")]
    pub forces: Vec<f64>,
}

#[typetag::serde(name = "axles")]
impl LoadKind for Axles {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("positions", &self.positions), ("forces", &self.forces)])?;
        if self.positions.len() != self.forces.len() {
            let message = format!("{} forces for {} positions", self.forces.len(), self.positions.len());
            return site.fail("forces", message);
        }
        if self.positions.is_empty() {
            return site.fail("positions", "there is no axle");
        }
        let start = x_at(site, self.at, "at")?;
        let (left, right) = reach(site, "at")?;
        let on = |position: &f64| (left..=right).contains(&(start + position));
        // If all axles are off the arch, the mistake is the position.
        let crossing = self.positions.iter().any(on);
        let (mut placed, mut diagnostics, mut notes) = (Vec::new(), Vec::new(), Vec::new());
        for (i, (position, force)) in self.positions.iter().zip(&self.forces).enumerate() {
            if crossing && !on(position) {
                let x = start + position;
                notes.push(format!(
                    "axle {i}, at x = {x:.3} m, is off the extrados ({left:.3} to {right:.3} m): it counts nothing"
                ));
                continue;
            }
            match on_extrados(site, start + position, Vec2::new(0.0, -force), &format!("positions.{i}")) {
                Ok(mut forces) => placed.append(&mut forces),
                Err(mut wrong) => diagnostics.append(&mut wrong),
            }
        }
        if diagnostics.is_empty() { Ok(Placed { notes, ..placed.into() }) } else { Err(diagnostics) }
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "axles",
        summary: "wheels or axles on the extrados of an arch",
        samples: &[
            Sample::keys("at = 0.4\npositions = [0.0, 1.8]\nforces = [40e3, 60e3]"),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `axles`\n\nDownward forces act on the extrados of an arch at distances from a span fraction, like \
               the axles of a vehicle. If some of the axles are not on the extrados, they are ignored, and a note reports \
               it.\n",
        ..Card::of::<Axles>()
    }
}
