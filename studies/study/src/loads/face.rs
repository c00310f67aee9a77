//! A face of a block in space, its choice by a key, and the forces of a unit pressure on it.

use voussoir_core::model::CONTACT_TOLERANCE;
use voussoir_core::plugin::Keys;
use voussoir_core::space::{Polyhedron, Vec3};

/// A face of a block.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
#[keys(untagged)]
pub enum FaceKey {
    /// By index, from 0.
    Index(usize),
    /// By the outward normal that is nearest to a vector.
    #[key(names = ["x", "y", "z"], unit = "-")]
    Toward([f64; 3]),
}

/// Angles whose cosines differ by less are equal: the rounding of coordinates.
const SAME_ANGLE: f64 = 1e-9;

impl FaceKey {
    /// Returns the index of the face on a shape. The error is the end of a sentence about the block.
    pub(super) fn index(&self, shape: &Polyhedron) -> Result<usize, String> {
        match self {
            FaceKey::Index(index) if *index < shape.faces.len() => Ok(*index),
            FaceKey::Index(index) => Err(format!("has faces 0 to {}, not {index}", shape.faces.len() - 1)),
            FaceKey::Toward(vector) => nearest(shape, Vec3::from(*vector)),
        }
    }
}

/// Returns the face whose outward normal is nearest to a vector.
fn nearest(shape: &Polyhedron, vector: Vec3) -> Result<usize, String> {
    let unit = vector.try_normalize(0.0).filter(|unit| unit.iter().all(|x| x.is_finite()));
    let unit = unit.ok_or("needs a vector that is finite and not zero")?;
    let cosine = |face: &Vec<usize>| shape.area_vector(face).try_normalize(0.0).map_or(-1.0, |n| n.dot(&unit));
    let cosines: Vec<f64> = shape.faces.iter().map(cosine).collect();
    let best = (0..cosines.len()).max_by(|a, b| cosines[*a].total_cmp(&cosines[*b])).ok_or("has no faces")?;
    match (0..cosines.len()).find(|&other| other != best && cosines[best] - cosines[other] < SAME_ANGLE) {
        Some(other) => {
            Err(format!("has two faces that are equally near to this vector, {other} and {best}: give an index"))
        }
        None => Ok(best),
    }
}

/// A face of a shape.
pub(super) struct Face<'a> {
    shape: &'a Polyhedron,
    index: usize,
}

impl<'a> Face<'a> {
    pub fn new(shape: &'a Polyhedron, index: usize) -> Self {
        Face { shape, index }
    }

    /// Returns points \[m\] and forces \[N\] of a unit pressure: one force at the centroid of a plane face, or one on each
    /// triangle of a warped face. Without a direction the forces push inwards, and their resultant is exact about any
    /// pole.
    pub fn forces(&self, direction: Option<Vec3>) -> Vec<(Vec3, Vec3)> {
        let area = self.shape.area_vector(&self.shape.faces[self.index]);
        let Some(normal) = area.try_normalize(0.0) else { return Vec::new() };
        let force = |part: Vec3| direction.map_or(-part, |unit| unit * part.dot(&normal));
        let parts = self.triangles();
        if self.is_plane() {
            let moment: Vec3 = parts.iter().map(|(centroid, part)| centroid * part.dot(&normal)).sum();
            let pole = self.shape.face_mean(&self.shape.faces[self.index]);
            return vec![(pole + moment / area.norm(), force(area))];
        }
        let pole = self.shape.face_mean(&self.shape.faces[self.index]);
        parts.into_iter().map(|(centroid, part)| (pole + centroid, force(part))).collect()
    }

    fn is_plane(&self) -> bool {
        let (low, high) = self.shape.bounding_box();
        self.shape.warp(&self.shape.faces[self.index]) <= CONTACT_TOLERANCE * (high - low).norm()
    }

    /// Returns centroid, from the mean of the corners \[m\], and area vector \[m²\] of the triangles between the mean and the
    /// sides.
    fn triangles(&self) -> Vec<(Vec3, Vec3)> {
        let face = &self.shape.faces[self.index];
        let mean = self.shape.face_mean(face);
        let arm = |k: usize| self.shape.vertices[face[k % face.len()]] - mean;
        let triangle = |k: usize| ((arm(k) + arm(k + 1)) / 3.0, arm(k).cross(&arm(k + 1)) / 2.0);
        (0..face.len()).map(triangle).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{LoadKind, SpacePlaced, SpaceSite};
    use crate::scenes::test_catalogue::catalogue;
    use serde_json::{Value, json};
    use voussoir_core::space::{Polyhedron, SpaceAssembly, SpaceBody, Vec3, add_space_force};

    /// A box of 1 × 2 × 4 m far from the origin, with its top raised at one corner by `warp` \[m\].
    fn block(warp: f64) -> Polyhedron {
        let size = [1.0, 2.0, 4.0];
        let low = Vec3::new(3.0, -5.0, 7.0);
        let mut shape = Polyhedron::cuboid(&low, &(low + Vec3::from(size)));
        shape.vertices[7].z += warp;
        shape
    }

    fn placed(shape: &Polyhedron, keys: Value) -> Result<SpacePlaced, String> {
        let mut load = json!({ "kind": "pressure", "block": "a", "value": 10.0 });
        for (key, value) in keys.as_object().unwrap() {
            load[key] = value.clone();
        }
        let body = SpaceBody { name: "a".into(), shape: shape.clone(), material: 0, fixed: false };
        let assembly = SpaceAssembly { catalogue: catalogue(), bodies: vec![body], ..SpaceAssembly::default() };
        let load: Box<dyn LoadKind> = serde_json::from_value(load).unwrap();
        load.place_space(&SpaceSite::new(&assembly, "at")).unwrap().map_err(|wrong| wrong[0].path.clone())
    }

    /// Uniform pressure on all faces has no resultant, with plane and with warped faces, far from the origin.
    #[test]
    fn uniform_pressure_on_all_faces_is_in_equilibrium() {
        for warp in [0.0, 0.7] {
            let (shape, mut wrench) = (block(warp), [0.0; 6]);
            for face in 0..6 {
                let forces = placed(&shape, json!({ "face": face })).unwrap().forces;
                // Only the top is warped: the sides at the raised corner stay plane.
                assert_eq!(forces.len(), if warp > 0.0 && face == 1 { 4 } else { 1 });
                forces.iter().for_each(|force| add_space_force(&mut wrench, &force.point, &force.force, 1.0));
            }
            assert!(wrench.iter().all(|component| component.abs() < 1e-11), "{warp} {wrench:?}");
        }
    }

    /// The pressure of an L-shaped face acts at the centroid of the L, which no mean of corners gives.
    #[test]
    fn the_force_on_a_concave_face_acts_at_its_centroid() {
        let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let point = |z: f64| move |[x, y]: &[f64; 2]| Vec3::new(*x, *y, z);
        let vertices = outline.iter().map(point(0.0)).chain(outline.iter().map(point(1.0))).collect();
        let mut faces: Vec<Vec<usize>> = vec![(0..6).rev().collect(), (6..12).collect()];
        faces.extend((0..6).map(|k| vec![k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6]));
        let shape = Polyhedron { vertices, faces };
        assert_eq!(shape.check(), Ok(()));
        let forces = placed(&shape, json!({ "face": [0.0, 0.0, 1.0] })).unwrap().forces;
        let [force] = forces[..] else { panic!("{forces:?}") };
        // Two rectangles: 2 × 1 about (1, 0.5) and 1 × 2 about (0.5, 2).
        assert!((force.point - Vec3::new(0.75, 1.25, 1.0)).norm() < 1e-14);
        assert!((force.force - Vec3::new(0.0, 0.0, -40.0)).norm() < 1e-12);
    }

    /// A vector chooses the nearest face, and `direction` replaces the normal with the same size of the force.
    #[test]
    fn vectors_choose_faces_and_directions() {
        let shape = block(0.0);
        let force = |keys: Value| placed(&shape, keys).unwrap().forces[0].force;
        assert_eq!(force(json!({ "face": [0.9, 0.1, -0.2] })), Vec3::new(-80.0, 0.0, 0.0));
        assert_eq!(force(json!({ "face": 5 })), Vec3::new(-80.0, 0.0, 0.0));
        let inclined = force(json!({ "face": 5, "direction": [3.0, 0.0, -4.0] }));
        assert!((inclined - Vec3::new(48.0, 0.0, -64.0)).norm() < 1e-12);
    }

    /// Each mistake is reported at its key.
    #[test]
    fn mistakes_are_reported_at_their_keys() {
        let wrong = |keys: Value| placed(&block(0.0), keys).unwrap_err();
        assert_eq!(wrong(json!({ "face": 6 })), "at.face");
        assert_eq!(wrong(json!({ "face": [1.0, 1.0, 0.0] })), "at.face");
        assert_eq!(wrong(json!({ "face": [0.0, 0.0, 0.0] })), "at.face");
        assert_eq!(wrong(json!({})), "at.face");
        assert_eq!(wrong(json!({ "edge": 1 })), "at.edge");
        assert_eq!(wrong(json!({ "face": 1, "direction": [0.0, 0.0, 0.0] })), "at.direction");
    }
}
