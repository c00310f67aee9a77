//! The model: bodies, joints, loads and stages, before any solver sees them.

use crate::elastic::{MeshDensity, largest_element};
use crate::geometry::{Vec2, area_and_centroid, bounding_box, cross, turned};
use crate::interface::InterfaceLaw;
use crate::material::{BulkMaterial, Deformability};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The materials and interface laws of a study, by name.
#[derive(Debug, Clone, Default)]
pub struct Catalogue {
    /// `[materials.NAME]`.
    pub materials: Vec<(String, Arc<dyn BulkMaterial>)>,
    /// `[joints.NAME]`.
    pub laws: Vec<(String, Arc<dyn InterfaceLaw>)>,
}

impl Catalogue {
    /// Index of the material called `name`.
    pub fn material(&self, name: &str) -> Option<usize> {
        self.materials.iter().position(|(n, _)| n == name)
    }

    /// Index of the interface law called `name`.
    pub fn law(&self, name: &str) -> Option<usize> {
        self.laws.iter().position(|(n, _)| n == name)
    }
}

/// A block, or a support.
#[derive(Debug, Clone)]
pub struct Body {
    /// Unique in its assembly.
    pub name: String,
    /// Anticlockwise; empty for a support without a shape of its own.
    pub vertices: Vec<Vec2>,
    /// Index into the catalogue's materials.
    pub material: usize,
    /// Held by the ground.
    pub fixed: bool,
}

/// How two bodies meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bond {
    /// As one piece.
    Bonded,
    /// By the interface law with this index in the catalogue.
    Law(usize),
}

/// Initial opening of a joint: a number, or a table along it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Gap {
    /// The same everywhere \[m\].
    Uniform(f64),
    /// Pairs \[s, gap\] \[m\], s ascending from the joint's end 0; linear between them, constant
    /// before the first and behind the last.
    Table(Vec<[f64; 2]>),
}

impl Default for Gap {
    fn default() -> Self {
        Gap::Uniform(0.0)
    }
}

impl Gap {
    /// The opening at the distance s \[m\] from the joint's end 0 \[m\].
    pub fn at(&self, s: f64) -> f64 {
        let table = match self {
            Gap::Uniform(gap) => return *gap,
            Gap::Table(table) => table,
        };
        let behind = table.partition_point(|row| row[0] <= s);
        match (behind.checked_sub(1).map(|i| table[i]), table.get(behind)) {
            (Some([a, from]), Some(&[b, to])) => from + (to - from) * (s - a) / (b - a),
            (Some([_, gap]), None) => gap,
            (None, first) => first.map_or(0.0, |row| row[1]),
        }
    }
}

/// A straight contact between two bodies.
#[derive(Debug, Clone)]
pub struct Joint {
    /// Index of the body on the minus side.
    pub minus: usize,
    /// Index of the body on the plus side.
    pub plus: usize,
    /// Ends at s = −h/2 and s = +h/2; t points from the first to the second, n = t turned by −90°
    /// points into plus.
    pub ends: [Vec2; 2],
    /// How the bodies meet.
    pub bond: Bond,
    /// Initial opening, along s from end 0.
    pub gap: Gap,
}

impl Joint {
    /// h \[m\].
    pub fn height(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    /// s = 0.
    pub fn middle(&self) -> Vec2 {
        (self.ends[0] + self.ends[1]) / 2.0
    }

    /// Unit vectors (n, t).
    pub fn frame(&self) -> (Vec2, Vec2) {
        let t = (self.ends[1] - self.ends[0]).normalize();
        (-turned(t), t)
    }
}

/// What an arch knows of itself beyond bodies and joints: voussoirs are bodies `first..first + n`
/// from left to right, joint k lies between voussoirs k−1 and k, its end 0 on the intrados.
#[derive(Debug, Clone)]
pub struct ArchLayout {
    /// Index of the first voussoir.
    pub first: usize,
    /// Number of voussoirs.
    pub voussoirs: usize,
    /// Clear span at the intrados springings \[m\].
    pub span: f64,
    /// Rise of the intrados \[m\].
    pub rise: f64,
}

/// Stress state of deformable bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    /// ε_z = 0.
    Strain,
    /// σ_z = 0.
    Stress,
}

/// Bodies and joints with their laws.
#[derive(Debug, Clone)]
pub struct Assembly {
    /// Laws and materials that bodies and joints refer to.
    pub catalogue: Catalogue,
    /// Blocks and supports.
    pub bodies: Vec<Body>,
    /// Contacts.
    pub joints: Vec<Joint>,
    /// Out of plane \[m\].
    pub width: f64,
    /// Stress state of deformable bodies.
    pub plane: Plane,
    /// How deformable bodies are meshed.
    pub mesh: MeshDensity,
    /// Present for arches.
    pub arch: Option<ArchLayout>,
}

/// Mass and centroid of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// \[kg\]; 0 for a support without a shape.
    pub mass: f64,
    /// \[m\]; the origin for a support without a shape.
    pub centroid: Vec2,
}

impl Assembly {
    /// Index of the body called `name`.
    pub fn body(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// Mass and centroid of a body.
    pub fn inertia(&self, body: usize) -> Inertia {
        let body = &self.bodies[body];
        if body.vertices.is_empty() {
            return Inertia { mass: 0.0, centroid: Vec2::zeros() };
        }
        let (area, centroid) = area_and_centroid(&body.vertices);
        Inertia { mass: self.catalogue.materials[body.material].1.density() * area * self.width, centroid }
    }

    /// The law of a joint, unless it is bonded.
    pub fn law(&self, joint: &Joint) -> Option<&dyn InterfaceLaw> {
        match joint.bond {
            Bond::Bonded => None,
            Bond::Law(index) => Some(&*self.catalogue.laws[index].1),
        }
    }

    /// Whether a body's material is rigid.
    pub fn is_rigid(&self, body: usize) -> bool {
        self.catalogue.materials[self.bodies[body].material].1.deformability() == Deformability::Rigid
    }

    /// Whether a body's material yields.
    pub fn yields(&self, body: usize) -> bool {
        let material = &self.catalogue.materials[self.bodies[body].material].1;
        matches!(material.deformability(), Deformability::Inelastic { .. })
    }

    /// Whether the elements of a body are small enough for its material to soften without snapping
    /// back inside an element; the error names sizes and what to change.
    pub fn fine_enough(&self, body: usize) -> Result<(), String> {
        let (name, material) = &self.catalogue.materials[self.bodies[body].material];
        let Some(update) = material.stress_update().filter(|_| self.yields(body)) else { return Ok(()) };
        let (most, own) = (update.largest_length(), largest_element(&self.bodies[body].vertices, &self.mesh)?);
        if own <= most {
            return Ok(());
        }
        Err(format!(
            "elements of \"{}\" have the size √area = {own:.4e} m; material \"{name}\" softens too steeply for more than \
             {most:.4e} m: use more elements, or raise its fracture energy",
            self.bodies[body].name
        ))
    }

    /// Whether some free block deforms or some joint is compliant.
    pub fn deforms(&self) -> bool {
        let soft = |body: usize| !self.bodies[body].fixed && !self.is_rigid(body);
        (0..self.bodies.len()).any(soft)
            || self.joints.iter().any(|j| self.law(j).is_some_and(|law| law.stiffness().is_some()))
    }

    /// Diagonal of the box around everything \[m\].
    pub fn size(&self) -> f64 {
        let points = self.bodies.iter().flat_map(|b| &b.vertices).chain(self.joints.iter().flat_map(|j| &j.ends));
        let (low, high) = bounding_box(points);
        (high - low).norm()
    }

    /// Which bodies move as one because bonded joints hold them together: for each body the index
    /// of its free group, or `None` where the group is held by the ground. Also the number of groups.
    pub fn rigid_groups(&self) -> (Vec<Option<usize>>, usize) {
        let mut parent: Vec<usize> = (0..self.bodies.len()).collect();
        for joint in self.joints.iter().filter(|joint| joint.bond == Bond::Bonded) {
            let (a, b) = (root(&mut parent, joint.minus), root(&mut parent, joint.plus));
            parent[a] = b;
        }
        let mut held = vec![false; self.bodies.len()];
        for (index, body) in self.bodies.iter().enumerate() {
            let r = root(&mut parent, index);
            held[r] |= body.fixed;
        }
        let (mut number, mut count) = (vec![None; self.bodies.len()], 0);
        let groups = (0..self.bodies.len())
            .map(|index| {
                let r = root(&mut parent, index);
                (!held[r]).then(|| {
                    *number[r].get_or_insert_with(|| {
                        count += 1;
                        count - 1
                    })
                })
            })
            .collect();
        (groups, count)
    }
}

/// The root of i in a forest of groups (union–find), paths halved on the way.
pub fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}

/// A force on a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointForce {
    /// Index of the body.
    pub body: usize,
    /// Where it acts \[m\].
    pub point: Vec2,
    /// \[N\].
    pub force: Vec2,
}

/// Force resultants on bodies, each \[F_x, F_y, moment about the origin\] \[N, N m\].
pub type Wrenches = Vec<[f64; 3]>;

/// A movement imposed on a support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settlement {
    /// Index of the held body.
    pub body: usize,
    /// \[m\].
    pub displacement: Vec2,
    /// About `about` \[rad\].
    pub rotation: f64,
    /// Pole of the rotation \[m\].
    pub about: Vec2,
}

/// One stage of loading.
#[derive(Debug, Clone)]
pub struct Stage {
    /// Its name.
    pub name: String,
    /// Gravity from this stage on \[m/s²\]; `None` leaves it as it was. Not multiplied by the factor.
    pub gravity: Option<Vec2>,
    /// Forces, multiplied by the stage's factor.
    pub forces: Vec<PointForce>,
    /// Accelerations (× mass) on every free body, multiplied by the stage's factor \[m/s²\].
    pub accelerations: Vec<Vec2>,
    /// Movements of supports, multiplied by the stage's factor.
    pub settlements: Vec<Settlement>,
    /// How far it goes.
    pub target: Target,
    /// Least factor searched; 0 where it is not given.
    pub factor_min: f64,
    /// Greatest factor searched.
    pub factor_max: f64,
}

/// How far a stage goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// To this factor.
    Factor(f64),
    /// Until it collapses.
    Collapse,
}

/// What a stage applies: `fixed + factor × varying`.
#[derive(Debug, Clone)]
pub struct StageLoads {
    /// Wrench per body, about the origin.
    pub fixed: Wrenches,
    /// Wrench per body, about the origin, for factor 1.
    pub varying: Wrenches,
}

/// Adds a force at a point to a wrench about the origin.
pub fn add_force(wrench: &mut [f64; 3], point: Vec2, force: Vec2, factor: f64) {
    wrench[0] += factor * force.x;
    wrench[1] += factor * force.y;
    wrench[2] += factor * cross(point, force);
}

/// The loads of each stage, those of earlier stages at the factors they reached included.
/// The gravity in force at each stage acts on all bodies.
pub fn stage_loads(assembly: &Assembly, stages: &[Stage]) -> Vec<StageLoads> {
    let count = assembly.bodies.len();
    let inertia: Vec<_> = (0..count).map(|body| assembly.inertia(body)).collect();
    let accelerate = |wrenches: &mut Wrenches, acceleration: Vec2| {
        for (wrench, inertia) in wrenches.iter_mut().zip(&inertia) {
            add_force(wrench, inertia.centroid, acceleration * inertia.mass, 1.0);
        }
    };
    let mut gravity = Vec2::zeros();
    let mut earlier: Wrenches = vec![[0.0; 3]; count];
    stages
        .iter()
        .map(|stage| {
            gravity = stage.gravity.unwrap_or(gravity);
            let mut fixed = earlier.clone();
            accelerate(&mut fixed, gravity);
            let mut varying: Wrenches = vec![[0.0; 3]; count];
            for force in &stage.forces {
                add_force(&mut varying[force.body], force.point, force.force, 1.0);
            }
            for &acceleration in &stage.accelerations {
                accelerate(&mut varying, acceleration);
            }
            if let Target::Factor(factor) = stage.target {
                for (sum, add) in earlier.iter_mut().zip(&varying) {
                    (0..3).for_each(|i| sum[i] += factor * add[i]);
                }
            }
            StageLoads { fixed, varying }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table is linear between its rows and constant outside.
    #[test]
    fn gaps_along_a_joint() {
        let gap = Gap::Table(vec![[0.0, 0.1], [1.0, 0.3], [2.0, 0.0]]);
        for (s, expected) in [(-1.0, 0.1), (0.0, 0.1), (0.5, 0.2), (1.0, 0.3), (1.5, 0.15), (2.0, 0.0), (3.0, 0.0)] {
            assert!((gap.at(s) - expected).abs() < 1e-15, "{s}");
        }
        assert_eq!(Gap::Uniform(0.2).at(7.0), 0.2);
    }
}
