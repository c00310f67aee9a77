//! Bodies and joints with their materials and laws: the input of all solvers.

use super::bridge::{Bridge, Chord, FillReaction};
use super::geometry::{Vec2, area_and_centroid, bounding_box};
use super::joints::{Bond, Joint};
use super::mesh_density::MeshDensity;
use crate::law::{BulkMaterial, InterfaceLaw, Plane};
use std::sync::Arc;

/// The materials and interface laws of a study, by name.
#[derive(Debug, Clone, Default)]
pub struct Catalogue {
    /// Materials `[materials.NAME]`.
    pub materials: Vec<(String, Arc<dyn BulkMaterial>)>,
    /// Interface laws `[joints.NAME]`.
    pub laws: Vec<(String, Arc<dyn InterfaceLaw>)>,
}

impl Catalogue {
    /// Returns the index of the material called `name`.
    pub fn material(&self, name: &str) -> Option<usize> {
        self.materials.iter().position(|(n, _)| n == name)
    }

    /// Returns the index of the interface law called `name`.
    pub fn law(&self, name: &str) -> Option<usize> {
        self.laws.iter().position(|(n, _)| n == name)
    }
}

/// A block, or a support.
#[derive(Debug, Clone)]
pub struct Body {
    /// Name, unique in its assembly.
    pub name: String,
    /// Vertices in anticlockwise order \[m\]; empty for a support without a shape.
    pub vertices: Vec<Vec2>,
    /// Index into the catalogue's materials.
    pub material: usize,
    /// True if the ground holds the body.
    pub fixed: bool,
}

/// Layout of an arch. Voussoirs are the bodies `first..first + n` from left to right; joint k ≤ n lies between
/// voussoirs k−1 and k and has its end 0 on the intrados. Bases of abutments are joints after these.
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

impl ArchLayout {
    /// Returns true if a joint lies across the ring; the other joints are the bases of abutments.
    pub fn crosses_ring(&self, joint: usize) -> bool {
        joint <= self.voussoirs
    }
}

/// Bodies and joints, with the materials and laws that they refer to.
#[derive(Debug, Clone)]
pub struct Assembly {
    /// Materials and laws.
    pub catalogue: Catalogue,
    /// Blocks and supports.
    pub bodies: Vec<Body>,
    /// Joints between bodies.
    pub joints: Vec<Joint>,
    /// Thickness out of plane \[m\].
    pub width: f64,
    /// Stress state of deformable bodies.
    pub plane: Plane,
    /// Density of the meshes of deformable bodies.
    pub mesh: MeshDensity,
    /// Layout of the arch; `None` for other scenes.
    pub arch: Option<ArchLayout>,
    /// Road and fill of the bridge; `None` for other scenes.
    pub bridge: Option<Bridge>,
}

/// Mass and centroid of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// Mass \[kg\]; 0 for a support without a shape.
    pub mass: f64,
    /// Centroid \[m\]; the origin for a support without a shape.
    pub centroid: Vec2,
}

impl Assembly {
    /// Creates an assembly without bodies, for scenes in space.
    pub fn without_blocks(catalogue: Catalogue) -> Self {
        Assembly {
            catalogue,
            bodies: Vec::new(),
            joints: Vec::new(),
            width: 1.0,
            plane: Plane::Strain,
            mesh: MeshDensity { elements: [1, 1], order: 1, grading: [1.0, 1.0] },
            arch: None,
            bridge: None,
        }
    }

    /// Returns the index of the body called `name`.
    pub fn body(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// Returns mass and centroid of a body.
    pub fn inertia(&self, body: usize) -> Inertia {
        let body = &self.bodies[body];
        if body.vertices.is_empty() {
            return Inertia { mass: 0.0, centroid: Vec2::zeros() };
        }
        let (area, centroid) = area_and_centroid(&body.vertices);
        Inertia { mass: self.catalogue.materials[body.material].1.density() * area * self.width, centroid }
    }

    /// Returns the centroids of all bodies \[m\].
    pub fn centroids(&self) -> Vec<Vec2> {
        (0..self.bodies.len()).map(|body| self.inertia(body).centroid).collect()
    }

    /// Returns the law of a joint. `None` if the joint is bonded.
    pub fn law(&self, joint: &Joint) -> Option<&dyn InterfaceLaw> {
        match joint.bond {
            Bond::Bonded => None,
            Bond::Law(index) => Some(&*self.catalogue.laws[index].1),
        }
    }

    /// Returns the material of a body.
    pub fn material(&self, body: usize) -> &dyn BulkMaterial {
        &*self.catalogue.materials[self.bodies[body].material].1
    }

    /// Returns true if the material of a body is rigid.
    pub fn is_rigid(&self, body: usize) -> bool {
        self.material(body).elasticity().is_none()
    }

    /// Returns true if a body is free and its material deforms.
    pub fn is_deformable(&self, body: usize) -> bool {
        !self.bodies[body].fixed && !self.is_rigid(body)
    }

    /// Returns true if the material of a body can yield.
    pub fn yields(&self, body: usize) -> bool {
        self.material(body).inelastic().is_some()
    }

    /// Returns true if a free block deforms or a joint is compliant.
    pub fn deforms(&self) -> bool {
        (0..self.bodies.len()).any(|body| self.is_deformable(body))
            || self.joints.iter().any(|j| self.law(j).is_some_and(|law| law.stiffness().is_some()))
    }

    /// Returns the straight upper faces that carry loads and fill, from left to right: the extrados of arches, for
    /// bridges also the tops of piers and abutments. Empty for other scenes.
    pub fn extrados(&self) -> Vec<Chord> {
        if let Some(bridge) = &self.bridge {
            return bridge.extrados.clone();
        }
        let Some(arch) = &self.arch else { return Vec::new() };
        let chord = |k: usize| Chord {
            body: arch.first + k,
            ends: [self.joints[k].ends[1], self.joints[k + 1].ends[1]],
            from_middle: (2 * k + 1).abs_diff(arch.voussoirs),
        };
        (0..arch.voussoirs).map(chord).collect()
    }

    /// Returns the horizontal reactions of the fill, element by element.
    pub fn fill_reactions(&self) -> &[FillReaction] {
        self.bridge.as_ref().map_or(&[], |bridge| &bridge.reactions)
    }

    /// Returns width and height of the bounding box \[m\].
    fn extent(&self) -> Vec2 {
        let points = self.bodies.iter().flat_map(|b| &b.vertices).chain(self.joints.iter().flat_map(|j| &j.ends));
        let (low, high) = bounding_box(points);
        high - low
    }

    /// Returns the diagonal of the bounding box \[m\].
    pub fn size(&self) -> f64 {
        self.extent().norm()
    }

    /// Returns the longest clear span at the intrados springings \[m\], or [`size`](Self::size) if the scene is not an
    /// arch.
    pub fn span(&self) -> f64 {
        self.clear_span().unwrap_or_else(|| self.size())
    }

    /// Returns the displacement of a load up to which a path without a limit point is followed \[m\]: the longest clear
    /// span, or the height of a scene that is not an arch.
    pub fn search_range(&self) -> f64 {
        self.clear_span().unwrap_or_else(|| self.extent().y)
    }

    fn clear_span(&self) -> Option<f64> {
        let bridge = self.bridge.as_ref().map(|bridge| bridge.longest_span);
        self.arch.as_ref().map(|arch| arch.span).or(bridge)
    }

    /// Returns for each body the index of its free group, and the number of groups. Bonded joints connect the bodies of
    /// a group. The index is `None` if the ground holds the group.
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

/// Returns the root of i in a forest of groups (union–find) and halves the paths on the way.
pub fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}
