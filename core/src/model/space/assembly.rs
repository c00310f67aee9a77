//! Blocks in space with their contacts, materials and laws.

use super::polyhedron::Polyhedron;
use super::vector::Vec3;
use crate::model::assembly::Catalogue;

/// A block, or a support.
#[derive(Debug, Clone)]
pub struct SpaceBody {
    /// Name, unique in its assembly.
    pub name: String,
    /// Its shape.
    pub shape: Polyhedron,
    /// Index into the catalogue's materials.
    pub material: usize,
    /// True if the ground holds the body.
    pub fixed: bool,
}

/// A plane contact face between two bodies.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Index of the body on the minus side.
    pub minus: usize,
    /// Index of the body on the plus side.
    pub plus: usize,
    /// Vertices of the convex hull, anticlockwise about the normal \[m\].
    pub points: Vec<Vec3>,
    /// Unit normal from minus to plus.
    pub normal: Vec3,
    /// Unit tangents s and t; (n, s, t) is right-handed.
    pub tangents: [Vec3; 2],
    /// Index into the catalogue's laws.
    pub law: usize,
}

/// Mass of fill that a body carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceFill {
    /// Index of the body.
    pub body: usize,
    /// Centroid of the fill \[m\].
    pub point: Vec3,
    /// Mass \[kg\].
    pub mass: f64,
}

/// Bodies and contacts in space, with the materials and laws that they refer to.
#[derive(Debug, Clone, Default)]
pub struct SpaceAssembly {
    /// Materials and laws.
    pub catalogue: Catalogue,
    /// Blocks and supports.
    pub bodies: Vec<SpaceBody>,
    /// Contacts. A contact between two supports has no effect and is left out.
    pub contacts: Vec<Contact>,
    /// Fill on bodies. Gravity acts on it; accelerations do not.
    pub fill: Vec<SpaceFill>,
}

impl SpaceAssembly {
    /// Returns the index of the body called `name`.
    pub fn body(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// Returns the centroid of a body \[m\].
    pub fn centroid(&self, body: usize) -> Vec3 {
        self.bodies[body].shape.volume_and_centroid().1
    }

    /// Returns mass \[kg\] and centroid \[m\] of a body.
    pub fn mass_and_centroid(&self, body: usize) -> (f64, Vec3) {
        let body = &self.bodies[body];
        let (volume, centroid) = body.shape.volume_and_centroid();
        (volume * self.catalogue.materials[body.material].1.density(), centroid)
    }

    /// Returns the lowest and the highest corner of the bounding box of all bodies \[m\].
    pub fn bounding_box(&self) -> (Vec3, Vec3) {
        let infinite = Vec3::repeat(f64::INFINITY);
        let corners = self.bodies.iter().flat_map(|body| &body.shape.vertices);
        corners.fold((infinite, -infinite), |(low, high), corner| (low.inf(corner), high.sup(corner)))
    }
}
