//! `strip`: vertical pressure on the extrados of an arch, over the full width.

use super::extrados::{dispersed, on_patch, x_at};
use super::keys::LoadKeys;
use super::load_kind::{LoadKind, Placed};
use super::site::LoadSite;
use crate::scenes::dispersion::{Dispersion, Patch};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Vertical pressure on the extrados of an arch, over the full width.
#[derive(Debug, Keys)]
pub struct Strip {
    /// span fraction of the left end
    #[key(unit = "-")]
    pub from: f64,
    /// span fraction of the right end
    #[key(unit = "-")]
    pub to: f64,
    /// on the plan area, downwards
    #[key(unit = "Pa")]
    pub pressure: f64,
    /// Law of dispersion on the way to the extrados.
    #[key(like = LoadKeys)]
    pub dispersion: Option<Box<dyn Dispersion>>,
}

#[typetag::serde(name = "strip")]
impl LoadKind for Strip {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("pressure", &[self.pressure])])?;
        let ends = [x_at(site, self.from, "from")?, x_at(site, self.to, "to")?];
        if self.from >= self.to {
            return site.fail("to", format!("{} must be more than from, {}", self.to, self.from));
        }
        let density = Vec2::new(0.0, -self.pressure * site.assembly.width);
        let Some(dispersion) = &self.dispersion else {
            return Ok(on_patch(site, ends, density, ["from", "to"])?.into());
        };
        let mut forces = Vec::new();
        let patch = Patch { from: ends[0], to: ends[1], share: 1.0 };
        for Patch { from, to, share } in dispersed(site, dispersion.as_ref(), patch, "from")? {
            let density = density * (share * (ends[1] - ends[0]) / (to - from));
            forces.extend(on_patch(site, [from, to], density, ["from", "to"])?);
        }
        Ok(forces.into())
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "strip",
        summary: "vertical pressure on the extrados of an arch, over the full width",
        samples: &[
            Sample::keys("from = 0.2\nto = 0.45\npressure = 8e3"),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `strip`\n\nA uniform vertical pressure acts on the plan area between two span fractions, over the \
               full width. Each voussoir carries the part above its straight extrados.\n",
        ..Card::of::<Strip>()
    }
}
