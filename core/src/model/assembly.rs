//! Bodies and joints with their materials and laws, before any solver sees them.

use super::bridge::{Bridge, Chord, FillReaction};
use super::geometry::{Vec2, area_and_centroid, bounding_box};
use super::joints::{Bond, Joint};
use crate::elastic::{MeshDensity, largest_element};
use crate::law::{BulkMaterial, InterfaceLaw, Plane};
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
    /// Present for bridges: road and fill.
    pub bridge: Option<Bridge>,
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

    /// Centroids of all bodies \[m\].
    pub fn centroids(&self) -> Vec<Vec2> {
        (0..self.bodies.len()).map(|body| self.inertia(body).centroid).collect()
    }

    /// The law of a joint, unless it is bonded.
    pub fn law(&self, joint: &Joint) -> Option<&dyn InterfaceLaw> {
        match joint.bond {
            Bond::Bonded => None,
            Bond::Law(index) => Some(&*self.catalogue.laws[index].1),
        }
    }

    /// The material of a body.
    pub fn material(&self, body: usize) -> &dyn BulkMaterial {
        &*self.catalogue.materials[self.bodies[body].material].1
    }

    /// Whether a body's material is rigid.
    pub fn is_rigid(&self, body: usize) -> bool {
        self.material(body).elasticity().is_none()
    }

    /// Whether a body is free and its material deforms.
    pub fn is_deformable(&self, body: usize) -> bool {
        !self.bodies[body].fixed && !self.is_rigid(body)
    }

    /// Whether a body's material yields.
    pub fn yields(&self, body: usize) -> bool {
        self.material(body).inelastic().is_some()
    }

    /// Whether the elements of a body are small enough for its material to soften without snapping
    /// back inside an element; the error names sizes and what to change.
    pub fn fine_enough(&self, body: usize) -> Result<(), String> {
        let (name, material) = &self.catalogue.materials[self.bodies[body].material];
        let Some(update) = material.inelastic() else { return Ok(()) };
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
        (0..self.bodies.len()).any(|body| self.is_deformable(body))
            || self.joints.iter().any(|j| self.law(j).is_some_and(|law| law.stiffness().is_some()))
    }

    /// The straight upper faces on which loads and fill stand: of arches their extrados, of bridges also the tops of
    /// piers; empty where there is none. From left to right.
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

    /// What the fill presses with, element by element.
    pub fn fill_reactions(&self) -> &[FillReaction] {
        self.bridge.as_ref().map_or(&[], |bridge| &bridge.reactions)
    }

    /// Width and height of the box around everything \[m\].
    fn extent(&self) -> Vec2 {
        let points = self.bodies.iter().flat_map(|b| &b.vertices).chain(self.joints.iter().flat_map(|j| &j.ends));
        let (low, high) = bounding_box(points);
        high - low
    }

    /// Diagonal of the box around everything \[m\].
    pub fn size(&self) -> f64 {
        self.extent().norm()
    }

    /// The longest clear span at the intrados springings \[m\]; of what is no arch [`size`](Self::size).
    pub fn span(&self) -> f64 {
        self.clear_span().unwrap_or_else(|| self.size())
    }

    /// The displacement of a load up to which a path without a limit point is followed \[m\]: the longest clear span, or the
    /// height of a scene that is no arch.
    pub fn search_range(&self) -> f64 {
        self.clear_span().unwrap_or_else(|| self.extent().y)
    }

    fn clear_span(&self) -> Option<f64> {
        let bridge = self.bridge.as_ref().map(|bridge| bridge.longest_span);
        self.arch.as_ref().map(|arch| arch.span).or(bridge)
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
