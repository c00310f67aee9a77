//! The blocks in space on which a load is placed, with the key of the load in the study, for messages.

use super::site::BlockName;
use super::vectors::Components;
use crate::scenes::unknown;
use voussoir_core::plugin::Diagnostic;
use voussoir_core::space::{SpaceAssembly, SpaceForce, Vec3};

/// The action of a load on the blocks of a scene in space.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SpacePlaced {
    /// Forces on blocks.
    pub forces: Vec<SpaceForce>,
    /// Accelerations of all blocks \[m/s²\].
    pub accelerations: Vec<Vec3>,
}

/// The blocks in space on which a load is placed.
#[derive(Debug)]
pub struct SpaceSite<'a> {
    /// Blocks and contacts.
    pub assembly: &'a SpaceAssembly,
    /// Key of the load in the study.
    path: &'a str,
}

impl<'a> SpaceSite<'a> {
    /// Prepares the blocks of an assembly; `path` is the key of the load in the study.
    pub fn new(assembly: &'a SpaceAssembly, path: &'a str) -> Self {
        SpaceSite { assembly, path }
    }

    /// Reports a mistake in a key of the load.
    pub fn fail<T>(&self, key: &str, message: impl Into<String>) -> Result<T, Vec<Diagnostic>> {
        let key = if key.is_empty() { self.path.to_string() } else { format!("{}.{key}", self.path) };
        Err(vec![Diagnostic::new(key, message)])
    }

    /// Returns the vector under a key, which must have three finite components.
    pub fn vector(&self, key: &str, vector: &impl Components) -> Result<Vec3, Vec<Diagnostic>> {
        match vector.space() {
            Some(vector) if vector.iter().all(|x| x.is_finite()) => Ok(vector),
            Some(_) => self.fail(key, "must be finite"),
            None => self.fail(key, "has two components, but the scene is in space: write [x, y, z] with z upwards"),
        }
    }

    /// Returns the index of a free block, by its name under a key.
    pub fn block(&self, key: &str, block: &BlockName) -> Result<usize, Vec<Diagnostic>> {
        let name = block.text();
        let Some(body) = self.assembly.body(&name) else {
            let free = self.assembly.bodies.iter().filter(|body| !body.fixed);
            return Err(vec![unknown(
                &format!("{}.{key}", self.path),
                "block",
                &name,
                free.map(|body| body.name.as_str()),
            )]);
        };
        if self.assembly.bodies[body].fixed {
            return self.fail(key, format!("block \"{name}\" is fixed: a load on it does nothing"));
        }
        Ok(body)
    }

    /// Returns the force of an acceleration on one block, at its centroid.
    pub fn inertia_force(&self, body: usize, acceleration: Vec3) -> SpaceForce {
        let (mass, point) = self.assembly.mass_and_centroid(body);
        SpaceForce { body, point, force: acceleration * mass }
    }
}
