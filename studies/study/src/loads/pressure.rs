//! `pressure`: pressure on an edge of a plane block, or on a face of a block in space.

use super::face::{Face, FaceKey};
use super::keys::LoadKeys;
use super::load_kind::{LoadKind, Placed};
use super::site::{BlockName, LoadSite};
use super::space_site::{SpacePlaced, SpaceSite};
use voussoir_core::model::geometry::turned;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};
use voussoir_core::space::{SpaceForce, Vec3};

/// Pressure on an edge or a face of a block.
#[derive(Debug, Keys)]
pub struct Pressure {
    /// The block.
    #[key(like = LoadKeys)]
    pub block: BlockName,
    /// index of its first vertex, anticlockwise; on voussoirs 0 intrados, 1 right, 2 extrados, 3 left
    #[key(optional = "the scene is in space")]
    pub edge: Option<usize>,
    /// face of a block in space: its index, or a vector, which chooses the face whose outward normal is nearest to it
    #[key(optional = "the scene is plane")]
    pub face: Option<FaceKey>,
    /// pressure, which pushes inwards
    #[key(unit = "Pa")]
    pub value: f64,
    /// direction of the force in space; the pressure acts on the area of the face
    #[key(names = ["x", "y", "z"], unit = "-", optional = "against the outward normal of the face")]
    pub direction: Option<[f64; 3]>,
}

#[typetag::serde(name = "pressure")]
impl LoadKind for Pressure {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("value", &[self.value])])?;
        let in_space = [("face", self.face.is_some()), ("direction", self.direction.is_some())];
        if let Some((key, _)) = in_space.iter().find(|(_, given)| *given) {
            return site.fail(key, "belongs to scenes in space; a plane block has edges");
        }
        let Some(edge) = self.edge else {
            return site.fail("edge", "is missing: the edge on which the pressure acts");
        };
        let body = site.block(&self.block)?;
        let vertices = &site.assembly.bodies[body].vertices;
        if edge >= vertices.len() {
            let message = format!("block \"{}\" has edges 0 to {}, not {edge}", self.block.text(), vertices.len() - 1);
            return site.fail("edge", message);
        }
        let (a, b) = (vertices[edge], vertices[(edge + 1) % vertices.len()]);
        // The interior of an anticlockwise polygon is to the left of each edge.
        let force = turned(b - a) * (self.value * site.assembly.width);
        Ok(site.spread(body, [a, b], force).into())
    }

    fn place_space(&self, site: &SpaceSite) -> Option<Result<SpacePlaced, Vec<Diagnostic>>> {
        Some(self.placed_in_space(site))
    }
}

impl Pressure {
    fn placed_in_space(&self, site: &SpaceSite) -> Result<SpacePlaced, Vec<Diagnostic>> {
        if !self.value.is_finite() {
            return site.fail("value", "must be finite");
        }
        if self.edge.is_some() {
            return site.fail("edge", "belongs to plane scenes; in space give face");
        }
        let Some(key) = &self.face else {
            return site.fail("face", "is missing: the face on which the pressure acts");
        };
        let direction = self.direction.map(|direction| unit(site, direction)).transpose()?;
        let body = site.block("block", &self.block)?;
        let shape = &site.assembly.bodies[body].shape;
        let face = key.index(shape).map_err(|why| format!("block \"{}\" {why}", self.block.text()));
        let face = match face {
            Ok(index) => Face::new(shape, index),
            Err(why) => return site.fail("face", why),
        };
        let force = |(point, force): (Vec3, Vec3)| SpaceForce { body, point, force: self.value * force };
        Ok(SpacePlaced { forces: face.forces(direction).into_iter().map(force).collect(), ..SpacePlaced::default() })
    }
}

/// Returns the unit vector of the key `direction`.
fn unit(site: &SpaceSite, direction: [f64; 3]) -> Result<Vec3, Vec<Diagnostic>> {
    match Vec3::from(direction).try_normalize(0.0).filter(|unit| unit.iter().all(|x| x.is_finite())) {
        Some(unit) => Ok(unit),
        None => site.fail("direction", "must be finite and not zero"),
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "pressure",
        summary: "pressure on an edge of a block, or on a face of a block in space",
        samples: &[
            Sample::keys(r#"block = "4"
edge = 2
value = 2e4"#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("pressure.md"),
        ..Card::of::<Pressure>()
    }
}
