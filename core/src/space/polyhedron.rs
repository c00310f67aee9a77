//! Closed surfaces of plane or warped faces.

use super::Vec3;

/// A closed polyhedron. Each face lists its corners anticlockwise as seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polyhedron {
    /// Corners \[m\].
    pub vertices: Vec<Vec3>,
    /// Indices of the corners of each face.
    pub faces: Vec<Vec<usize>>,
}

impl Polyhedron {
    /// Returns the mean of the corners of a face \[m\].
    pub fn face_mean(&self, face: &[usize]) -> Vec3 {
        face.iter().map(|&corner| self.vertices[corner]).sum::<Vec3>() / face.len() as f64
    }

    /// Returns the volume \[m³\] and the centroid \[m\]. Each face is a fan of triangles about the mean of its corners,
    /// so that the values of a warped face do not depend on the order of its corners. Volumes are summed about the
    /// first corner, which keeps the rounding error small far from the origin.
    pub fn volume_and_centroid(&self) -> (f64, Vec3) {
        let Some(&pole) = self.vertices.first() else { return (0.0, Vec3::zeros()) };
        let (mut volume, mut moment) = (0.0, Vec3::zeros());
        for face in &self.faces {
            let mean = self.face_mean(face) - pole;
            for (k, &corner) in face.iter().enumerate() {
                let a = self.vertices[corner] - pole;
                let b = self.vertices[face[(k + 1) % face.len()]] - pole;
                let part = mean.dot(&a.cross(&b)) / 6.0;
                volume += part;
                moment += part * (mean + a + b) / 4.0;
            }
        }
        if volume == 0.0 { (0.0, pole) } else { (volume, pole + moment / volume) }
    }
}
