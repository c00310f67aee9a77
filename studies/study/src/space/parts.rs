//! Bodies and contacts of a generated scene.

use crate::scenes::lookup::{from_root, law, material, take};
use voussoir_core::model::Catalogue;
use voussoir_core::plugin::Diagnostic;
use voussoir_core::space::{
    Contact, ContactBody, ContactTolerances, Polyhedron, SpaceAssembly, SpaceBody, SpaceFill, Vec3, find_contacts,
    tangents,
};

/// Bodies of one material with contacts of one law.
pub(super) struct Parts {
    assembly: SpaceAssembly,
    material: usize,
    law: usize,
}

impl Parts {
    /// Looks up a material and a law. Mistakes of the names are added to mistakes of the geometry.
    pub fn new(
        catalogue: &Catalogue,
        names: [&str; 2],
        mut diagnostics: Vec<Diagnostic>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let material = take(material(catalogue, names[0], "material"), &mut diagnostics);
        let law = take(law(catalogue, names[1], "joint"), &mut diagnostics);
        match (material, law) {
            (Some(material), Some(law)) if diagnostics.is_empty() => {
                let assembly = SpaceAssembly { catalogue: catalogue.clone(), ..SpaceAssembly::default() };
                Ok(Parts { assembly, material, law })
            }
            _ => Err(from_root(diagnostics)),
        }
    }

    /// Adds a body and returns its index.
    pub fn body(&mut self, name: impl Into<String>, shape: Polyhedron, fixed: bool) -> usize {
        self.assembly.bodies.push(SpaceBody { name: name.into(), shape, material: self.material, fixed });
        self.assembly.bodies.len() - 1
    }

    /// Adds a contact with the corners of a convex plane polygon, anticlockwise about the normal from minus to plus \[m\].
    /// Two supports have no contact.
    pub fn contact(&mut self, minus: usize, plus: usize, corners: &[Vec3]) {
        if self.assembly.bodies[minus].fixed && self.assembly.bodies[plus].fixed {
            return;
        }
        let mut points: Vec<Vec3> = Vec::with_capacity(corners.len());
        for corner in corners {
            if !points.contains(corner) {
                points.push(*corner);
            }
        }
        let twice_area: Vec3 = points.windows(2).map(|pair| (pair[0] - points[0]).cross(&(pair[1] - points[0]))).sum();
        let normal = twice_area.normalize();
        self.assembly.contacts.push(Contact {
            minus,
            plus,
            points,
            normal,
            tangents: tangents(&normal),
            law: self.law,
        });
    }

    /// Adds the mass of fill on a body \[kg\], at its centroid \[m\].
    pub fn fill(&mut self, body: usize, mass: f64, point: Vec3) {
        self.assembly.fill.push(SpaceFill { body, point, mass });
    }

    /// Adds the contacts of all bodies.
    pub fn find_contacts(&mut self) {
        let (low, high) = self.assembly.bounding_box();
        self.assembly.contacts = found_contacts(&self.assembly, &ContactTolerances::of_size((high - low).norm()));
        self.assembly.contacts.iter_mut().for_each(|contact| contact.law = self.law);
    }

    /// Returns the assembly.
    pub fn finish(self) -> SpaceAssembly {
        self.assembly
    }
}

/// Returns the contacts of the bodies of an assembly, with law 0.
pub(super) fn found_contacts(assembly: &SpaceAssembly, tolerances: &ContactTolerances) -> Vec<Contact> {
    find_contacts(&ContactBody::all(assembly), tolerances).contacts
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::scenes::test_catalogue::catalogue;
    use serde_json::Value;
    use voussoir_core::model::Scene;

    /// Builds a scene of a tag with a material and a law from a table of further keys.
    pub(in crate::space) fn built(tag: &str, keys: &Value) -> Result<SpaceAssembly, Vec<Diagnostic>> {
        let mut scene = serde_json::json!({ "scene": tag, "material": "stone", "joint": "dry" });
        for (key, value) in keys.as_object().unwrap() {
            scene[key] = value.clone();
        }
        let scene = serde_json::from_value::<Box<dyn Scene>>(scene).unwrap();
        assert!(scene.build(&catalogue()).unwrap().bodies.is_empty());
        scene.build_space(&catalogue()).unwrap()
    }

    /// Returns the paths of the mistakes of a scene.
    pub(in crate::space) fn wrong(tag: &str, keys: &Value) -> Vec<String> {
        built(tag, keys).unwrap_err().into_iter().map(|diagnostic| diagnostic.path).collect()
    }

    /// Returns numbers of free blocks, contacts and points.
    pub(in crate::space) fn counts(scene: &SpaceAssembly) -> [usize; 3] {
        let free = scene.bodies.iter().filter(|body| !body.fixed).count();
        [free, scene.contacts.len(), scene.contacts.iter().map(|contact| contact.points.len()).sum()]
    }

    /// Asserts that all blocks are closed, and that the contact finder finds the contacts of the scene with their normals and areas.
    pub(in crate::space) fn assert_conforming(scene: &SpaceAssembly) {
        for body in &scene.bodies {
            assert_eq!(body.shape.check(), Ok(()), "{}", body.name);
        }
        let (low, high) = scene.bounding_box();
        let mut found = found_contacts(scene, &ContactTolerances::of_size((high - low).norm()));
        let mut own = scene.contacts.clone();
        for contact in &mut own {
            if contact.minus > contact.plus {
                (contact.minus, contact.plus) = (contact.plus, contact.minus);
                contact.normal = -contact.normal;
            }
        }
        let mean = |contact: &Contact| contact.points.iter().sum::<Vec3>() / contact.points.len() as f64;
        let order = |a: &Contact, b: &Contact| {
            let rounded = |contact: &Contact| mean(contact).map(|x| (x * 1e6).round() as i64);
            let key = |contact: &Contact| (contact.minus, contact.plus, rounded(contact).as_slice().to_vec());
            key(a).cmp(&key(b))
        };
        own.sort_by(order);
        found.sort_by(order);
        let pairs = |contacts: &[Contact]| contacts.iter().map(|c| (c.minus, c.plus)).collect::<Vec<_>>();
        assert_eq!(pairs(&own), pairs(&found));
        for (one, other) in own.iter().zip(&found) {
            let same = (mean(one) - mean(other)).norm() < 1e-9 && (one.normal - other.normal).norm() < 1e-9;
            assert!(same && one.points.len() == other.points.len(), "{one:?}\n{other:?}");
        }
    }
}
