//! The blocks on which a load is placed, with the key of the load in the study, for messages.

use super::vectors::Components;
use super::vehicle_axles::VehicleAxles;
use crate::scenes::dispersion::Dispersion;
use crate::scenes::unknown;
use std::collections::BTreeMap;
use voussoir_core::model::geometry::{Vec2, contains};
use voussoir_core::model::{Assembly, CONTACT_TOLERANCE, PointForce};
use voussoir_core::plugin::{Diagnostic, Keys};

/// Number of parts of a uniform load on a deformable block.
const PARTS: usize = 16;

/// A block by name; a whole number is the name of a voussoir.
#[derive(Debug, Clone, PartialEq, Eq, Keys)]
#[keys(untagged)]
pub enum BlockName {
    /// By name.
    Name(String),
    /// By number.
    Number(u64),
}

impl BlockName {
    /// Returns the name as text.
    pub fn text(&self) -> String {
        match self {
            BlockName::Number(number) => number.to_string(),
            BlockName::Name(name) => name.clone(),
        }
    }
}

/// The blocks on which a load is placed.
#[derive(Debug)]
pub struct LoadSite<'a> {
    /// Blocks and joints.
    pub assembly: &'a Assembly,
    /// Key of the load in the study.
    path: &'a str,
    /// Tables of the study that loads refer to.
    pub tables: &'a LoadTables,
    /// Free group of each body; `None` if bonds connect it to the ground.
    held: Vec<Option<usize>>,
}

/// Tables of a study for loads, besides the list of a stage.
#[derive(Debug, Default)]
pub struct LoadTables {
    /// `[vehicles.NAME]`.
    pub vehicles: BTreeMap<String, VehicleAxles>,
    /// Law by which loads on the road spread in the fill.
    pub dispersion: Option<Box<dyn Dispersion>>,
}

impl<'a> LoadSite<'a> {
    /// Prepares the blocks of an assembly; `path` is the key of the load in the study.
    pub fn new(assembly: &'a Assembly, tables: &'a LoadTables, path: &'a str) -> Self {
        LoadSite { assembly, path, tables, held: assembly.rigid_groups().0 }
    }

    /// Returns true if a force can move a block.
    pub fn moves(&self, body: usize) -> bool {
        !self.assembly.bodies[body].fixed && (self.held[body].is_some() || !self.assembly.is_rigid(body))
    }

    /// Returns a key of the load with its path from the root of the study.
    pub fn key(&self, key: &str) -> String {
        if key.is_empty() { self.path.to_string() } else { format!("{}.{key}", self.path) }
    }

    /// Reports a mistake in a key of the load.
    pub fn fail<T>(&self, key: &str, message: impl Into<String>) -> Result<T, Vec<Diagnostic>> {
        Err(vec![Diagnostic::new(self.key(key), message)])
    }

    /// Returns the vector under a key, which must have two finite components.
    pub fn vector(&self, key: &str, vector: &impl Components) -> Result<Vec2, Vec<Diagnostic>> {
        self.finite(&[(key, vector.components())])?;
        let wrong = "has three components, but the scene is plane: write [x, y] with y upwards";
        vector.plane().map_or_else(|| self.fail(key, wrong), Ok)
    }

    /// Refuses numbers that are not finite, by key.
    pub fn finite(&self, values: &[(&str, &[f64])]) -> Result<(), Vec<Diagnostic>> {
        let wrong: Vec<_> = values
            .iter()
            .filter(|(_, numbers)| numbers.iter().any(|x| !x.is_finite()))
            .map(|(key, _)| Diagnostic::new(self.key(key), "must be finite"))
            .collect();
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// Returns the index of a block that a load can move.
    pub fn movable(&self, body: usize, key: &str) -> Result<usize, Vec<Diagnostic>> {
        let name = &self.assembly.bodies[body].name;
        if self.assembly.bodies[body].fixed {
            return self.fail(key, format!("block \"{name}\" is fixed: a load on it does nothing"));
        }
        if self.held[body].is_none() && self.assembly.is_rigid(body) {
            let message = format!("block \"{name}\" is rigid and bonded to the ground: a load on it does nothing");
            return self.fail(key, message);
        }
        Ok(body)
    }

    /// Returns the index of a block that a load can move, by its name under the key `block`.
    pub fn block(&self, block: &BlockName) -> Result<usize, Vec<Diagnostic>> {
        self.block_under("block", block)
    }

    /// Returns the index of a block that a load can move, by its name under a key.
    pub fn block_under(&self, key: &str, block: &BlockName) -> Result<usize, Vec<Diagnostic>> {
        let name = block.text();
        let body = self.assembly.body(&name).ok_or_else(|| {
            let names = self.assembly.bodies.iter().filter(|body| !body.fixed).map(|body| body.name.as_str());
            vec![unknown(&self.key(key), "block", &name, names)]
        })?;
        self.movable(body, key)
    }

    /// Places a force at a point in or on a block.
    pub fn on_block(&self, block: &BlockName, point: Vec2, force: Vec2) -> Result<PointForce, Vec<Diagnostic>> {
        let body = self.block(block)?;
        let tolerance = CONTACT_TOLERANCE * self.assembly.size();
        if !contains(&self.assembly.bodies[body].vertices, point, tolerance) {
            let message = format!("({}, {}) lies outside block \"{}\"", point.x, point.y, block.text());
            return self.fail("point", message);
        }
        Ok(PointForce { body, point, force })
    }

    /// Spreads a force uniformly between two points: as its resultant on a rigid block, as the points of a Gauss rule on equal
    /// parts on a deformable block.
    pub fn spread(&self, body: usize, [from, to]: [Vec2; 2], force: Vec2) -> Vec<PointForce> {
        if self.assembly.is_rigid(body) || self.assembly.bodies[body].fixed {
            return vec![PointForce { body, point: (from + to) / 2.0, force }];
        }
        let offset = 0.5 / 3f64.sqrt();
        let at = |part: usize, side: f64| (part as f64 + 0.5 + side * offset) / PARTS as f64;
        let places = (0..PARTS).flat_map(|part| [at(part, -1.0), at(part, 1.0)]);
        let share = force / (2 * PARTS) as f64;
        places.map(|t| PointForce { body, point: from + (to - from) * t, force: share }).collect()
    }
}
