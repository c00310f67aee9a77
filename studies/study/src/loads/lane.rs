//! `lane`: a uniform load along the road of a bridge, such as a traffic lane or a railway track.

use super::extrados::on_faces;
use super::load_kind::{LoadKind, Placed};
use super::site::LoadSite;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// An even load along the road.
#[derive(Debug, Clone, Keys)]
pub struct Lane {
    /// x of the left end
    #[key(unit = "m")]
    pub from: f64,
    /// x of the right end
    #[key(unit = "m")]
    pub to: f64,
    /// on the plan area over the full width, downwards
    #[key(unit = "Pa")]
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
        samples: &[
            Sample::keys("from = 0.5\nto = 3.5\npressure = 5e3"),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `lane`\n\nA uniform vertical pressure acts on the plan area between two x, over the full width. Each \
               block carries the part above its upper face; the load does not spread at its ends. The part beyond the bridge \
               goes to the ground.\n",
        ..Card::of::<Lane>()
    }
}
