//! `lane`: an even load along the road of a bridge, as of a lane or a track.

use super::extrados::on_faces;
use super::load_kind::{LoadKind, Placed};
use super::site::LoadSite;
use serde::{Deserialize, Serialize};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::{Card, Diagnostic, Parameter, PluginKind, Quantity, Range};

/// An even load along the road.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lane {
    /// x of its left end \[m\].
    pub from: f64,
    /// x of its right end \[m\].
    pub to: f64,
    /// On the plan area, over the full width, downwards \[Pa\].
    pub pressure: f64,
}

#[typetag::serde(name = "lane")]
impl LoadKind for Lane {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("from", &[self.from]), ("to", &[self.to]), ("pressure", &[self.pressure])])?;
        if self.from >= self.to {
            return site.fail("to", format!("{} must be more than from, {}", self.to, self.from));
        }
        let density = Vec2::new(0.0, -self.pressure * site.assembly.width);
        let forces = on_faces(site, [self.from, self.to], density, "from")?;
        let mut placed = Placed::from(forces);
        if placed.forces.is_empty() {
            placed
                .notes
                .push(format!("the lane from x = {} to {} m is off the bridge: it counts zero", self.from, self.to));
        }
        Ok(placed)
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "lane",
        summary: "an even load along the road of a bridge, as of a lane or a track",
        parameters: &[
            Parameter::number("from", Quantity::Length, Range::ANY, "x of the left end"),
            Parameter::number("to", Quantity::Length, Range::ANY, "x of the right end"),
            Parameter::number("pressure", Quantity::Stress, Range::ANY, "on the plan area over the full width, downwards"),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `lane`\n\nAn even vertical pressure on the plan area between two x, over the full width. Each block carries what stands \
               above its upper face; at its ends the load does not spread. What lies beyond the bridge goes to the ground.\n",
        ..Card::BLANK
    }
}
