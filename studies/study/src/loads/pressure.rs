//! `pressure`: pressure on an edge of a block.

use super::keys::LoadKeys;
use super::load_kind::{LoadKind, Placed};
use super::site::{BlockName, LoadSite};
use voussoir_core::model::geometry::turned;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Pressure on an edge of a block.
#[derive(Debug, Keys)]
pub struct Pressure {
    /// The block.
    #[key(like = LoadKeys)]
    pub block: BlockName,
    /// index of its first vertex, anticlockwise; on voussoirs 0 intrados, 1 right, 2 extrados, 3 left
    pub edge: usize,
    /// pressure, which pushes inwards
    #[key(unit = "Pa")]
    pub value: f64,
}

#[typetag::serde(name = "pressure")]
impl LoadKind for Pressure {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("value", &[self.value])])?;
        let body = site.block(&self.block)?;
        let (vertices, edge) = (&site.assembly.bodies[body].vertices, self.edge);
        if edge >= vertices.len() {
            let message = format!("block \"{}\" has edges 0 to {}, not {edge}", self.block.text(), vertices.len() - 1);
            return site.fail("edge", message);
        }
        let (a, b) = (vertices[edge], vertices[(edge + 1) % vertices.len()]);
        // The interior of an anticlockwise polygon is to the left of each edge.
        let force = turned(b - a) * (self.value * site.assembly.width);
        Ok(site.spread(body, [a, b], force).into())
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "pressure",
        summary: "pressure on an edge of a block",
        samples: &[
            Sample::keys(r#"block = "4"
edge = 2
value = 2e4"#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `pressure`\n\nA uniform pressure acts on one edge of a block, over the full width. A positive \
               pressure pushes inwards.\n",
        ..Card::of::<Pressure>()
    }
}
