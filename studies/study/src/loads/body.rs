//! `body`: acceleration of every block, or of named blocks, times its mass.

use super::load_kind::{LoadKind, Placed};
use super::site::{BlockName, LoadSite};
use super::space_site::{SpacePlaced, SpaceSite};
use super::vectors::Acceleration;
use voussoir_core::model::PointForce;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Acceleration of every block, or of named blocks, times its mass.
#[derive(Debug, Keys)]
pub struct BodyLoad {
    /// acceleration: x to the right and y upwards; in space x, y and z upwards
    pub acceleration: Acceleration,
    /// names of the blocks on which it acts
    #[key(len = ">= 1", optional = "all blocks")]
    pub blocks: Option<Vec<BlockName>>,
}

#[typetag::serde(name = "body")]
impl LoadKind for BodyLoad {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        let acceleration = site.vector("acceleration", &self.acceleration)?;
        let Some(blocks) = &self.blocks else {
            return Ok(Placed { accelerations: vec![acceleration], ..Placed::default() });
        };
        let force = |block: &BlockName| -> Result<PointForce, Vec<Diagnostic>> {
            let body = site.block_under("blocks", block)?;
            let inertia = site.assembly.inertia(body);
            Ok(PointForce { body, point: inertia.centroid, force: acceleration * inertia.mass })
        };
        Ok(blocks.iter().map(force).collect::<Result<Vec<_>, _>>()?.into())
    }

    fn place_space(&self, site: &SpaceSite) -> Option<Result<SpacePlaced, Vec<Diagnostic>>> {
        Some(self.placed_in_space(site))
    }
}

impl BodyLoad {
    fn placed_in_space(&self, site: &SpaceSite) -> Result<SpacePlaced, Vec<Diagnostic>> {
        let acceleration = site.vector("acceleration", &self.acceleration)?;
        let Some(blocks) = &self.blocks else {
            return Ok(SpacePlaced { accelerations: vec![acceleration], ..SpacePlaced::default() });
        };
        let force = |block: &BlockName| site.block("blocks", block).map(|body| site.inertia_force(body, acceleration));
        Ok(SpacePlaced { forces: blocks.iter().map(force).collect::<Result<_, _>>()?, ..SpacePlaced::default() })
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "body",
        summary: "acceleration of every block, or of named blocks, times its mass",
        samples: &[
            Sample::keys("acceleration = [1.5, -2.0]"),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `body`\n\nAn acceleration acts on every block, or on the named `blocks`; the force is the \
               acceleration times the mass and acts at the centroid. Use it for pushover and tilting. In space the \
               acceleration has three components, `[x, y, z]` with z upwards.\n",
        ..Card::of::<BodyLoad>()
    }
}
