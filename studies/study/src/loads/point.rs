//! `point`: a force at a point.

use super::extrados::{dispersed, on_extrados, on_patch, x_at};
use super::keys::LoadKeys;
use super::load_kind::{LoadKind, Placed};
use super::site::{BlockName, LoadSite};
use super::space_site::{SpacePlaced, SpaceSite};
use super::vectors::{Force, Place};
use crate::scenes::dispersion::{Dispersion, Patch};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};
use voussoir_core::space::SpaceForce;

/// A force at a point.
#[derive(Debug, Keys)]
pub struct PointLoad {
    /// place on the extrados of an arch, along the span from the left
    #[key(unit = "-", optional = "block and point are given")]
    pub span_fraction: Option<f64>,
    /// The block, instead of `span_fraction`.
    #[key(like = LoadKeys, optional = "span_fraction is given")]
    pub block: Option<BlockName>,
    /// point in or on the block
    #[key(optional = "span_fraction is given")]
    pub point: Option<Place>,
    /// force: x to the right and y upwards; in space x, y and z upwards
    pub force: Force,
    /// Law of dispersion on the way to the extrados.
    #[key(like = LoadKeys)]
    pub dispersion: Option<Box<dyn Dispersion>>,
}

#[typetag::serde(name = "point")]
impl LoadKind for PointLoad {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        let force = site.vector("force", &self.force)?;
        match (self.span_fraction, &self.block, self.point) {
            (Some(fraction), None, None) => {
                let x = x_at(site, fraction, "span_fraction")?;
                let Some(dispersion) = &self.dispersion else {
                    return Ok(on_extrados(site, x, force, "span_fraction")?.into());
                };
                let mut forces = Vec::new();
                let patch = Patch { from: x, to: x, share: 1.0 };
                for Patch { from, to, share } in dispersed(site, dispersion.as_ref(), patch, "span_fraction")? {
                    forces.extend(if from == to {
                        on_extrados(site, from, force * share, "span_fraction")?
                    } else {
                        on_patch(site, [from, to], force * (share / (to - from)), ["span_fraction"; 2])?
                    });
                }
                Ok(forces.into())
            }
            (None, Some(block), Some(point)) => {
                let point = site.vector("point", &point)?;
                if self.dispersion.is_some() {
                    return site.fail("dispersion", "spreads a load above an arch: give span_fraction");
                }
                Ok(vec![site.on_block(block, point, force)?].into())
            }
            (Some(_), _, _) => {
                let key = if self.block.is_some() { "block" } else { "point" };
                site.fail(key, "given besides span_fraction; give span_fraction, or block and point")
            }
            (None, Some(_), None) => site.fail("point", "is missing: where on the block the force acts"),
            (None, None, Some(_)) => site.fail("block", "is missing: the block on which the force acts"),
            (None, None, None) => site.fail("", "needs span_fraction, or block and point"),
        }
    }

    fn place_space(&self, site: &SpaceSite) -> Option<Result<SpacePlaced, Vec<Diagnostic>>> {
        Some(self.placed_in_space(site))
    }
}

impl PointLoad {
    fn placed_in_space(&self, site: &SpaceSite) -> Result<SpacePlaced, Vec<Diagnostic>> {
        let force = site.vector("force", &self.force)?;
        let given = [("span_fraction", self.span_fraction.is_some()), ("dispersion", self.dispersion.is_some())];
        if let Some((key, _)) = given.iter().find(|(_, given)| *given) {
            return site.fail(key, "belongs to plane scenes; in space give block and point");
        }
        let (Some(block), Some(point)) = (&self.block, self.point) else {
            return site.fail("", "needs block and point");
        };
        let (body, point) = (site.block("block", block)?, site.vector("point", &point)?);
        Ok(SpacePlaced { forces: vec![SpaceForce { body, point, force }], ..SpacePlaced::default() })
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "point",
        summary: "a force at a point",
        samples: &[
            Sample::keys("span_fraction = 0.3\nforce = [1e3, -2e4]"),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `point`\n\nA force acts at a point: on the extrados of an arch at `span_fraction`, or in or on a \
               `block` at `point`. At the boundary of two voussoirs it acts on the one nearer to midspan; at midspan each \
               carries half of it.\n",
        ..Card::of::<PointLoad>()
    }
}
