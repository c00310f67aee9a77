//! Closed surfaces of plane or warped faces.

use super::vector::Vec3;
use std::collections::HashMap;

/// A closed polyhedron. Each face lists its corners anticlockwise as seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polyhedron {
    /// Corners \[m\].
    pub vertices: Vec<Vec3>,
    /// Indices of the corners of each face.
    pub faces: Vec<Vec<usize>>,
}

impl Polyhedron {
    /// Creates a box with its sides along the axes, between two corners \[m\].
    pub fn cuboid(low: &Vec3, high: &Vec3) -> Self {
        let corner = |k: usize| Vec3::from_fn(|axis, _| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Polyhedron { vertices: (0..8).map(corner).collect(), faces: faces.map(Vec::from).into() }
    }

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

    /// Returns the area of a face times its unit normal \[m²\], outward. It does not depend on the warp of the face.
    pub fn area_vector(&self, face: &[usize]) -> Vec3 {
        let Some(&first) = face.first() else { return Vec3::zeros() };
        let pole = self.vertices[first];
        let corner = |k: usize| self.vertices[face[k % face.len()]] - pole;
        (0..face.len()).map(|k| corner(k).cross(&corner(k + 1))).sum::<Vec3>() / 2.0
    }

    /// Returns the greatest distance of a corner of a face from the plane through the mean of its corners \[m\].
    pub fn warp(&self, face: &[usize]) -> f64 {
        let (normal, mean) = (self.area_vector(face), self.face_mean(face));
        let length = normal.norm();
        if length == 0.0 {
            return 0.0;
        }
        face.iter().map(|&corner| (self.vertices[corner] - mean).dot(&normal).abs() / length).fold(0.0, f64::max)
    }

    /// Returns the lowest and the highest corner of the bounding box \[m\].
    pub fn bounding_box(&self) -> (Vec3, Vec3) {
        let infinite = Vec3::repeat(f64::INFINITY);
        self.vertices.iter().fold((infinite, -infinite), |(low, high), corner| (low.inf(corner), high.sup(corner)))
    }

    /// Returns true if all faces name corners that exist.
    pub fn is_indexed(&self) -> bool {
        self.faces.iter().flatten().all(|&corner| corner < self.vertices.len())
    }

    /// Returns the polyhedron with all faces reversed.
    pub fn reversed(mut self) -> Self {
        self.faces.iter_mut().for_each(|face| face.reverse());
        self
    }

    /// Checks that the surface is closed and consistently oriented, and that it encloses a positive volume.
    ///
    /// # Errors
    /// A sentence with the face, edge or corner that is wrong. Faces and corners are counted from 0.
    pub fn check(&self) -> Result<(), String> {
        self.check_corners()?;
        self.check_faces()?;
        self.check_edges()?;
        let (volume, _) = self.volume_and_centroid();
        let (low, high) = self.bounding_box();
        if volume.abs() <= LEAST_VOLUME * (high - low).norm().powi(3) {
            return Err("it has no volume".into());
        }
        if volume < 0.0 {
            return Err(format!("its faces point inwards (volume {volume:.3e} m³): reverse the corners of each face"));
        }
        Ok(())
    }

    fn check_corners(&self) -> Result<(), String> {
        if let Some(corner) = self.vertices.iter().position(|vertex| !vertex.iter().all(|x| x.is_finite())) {
            return Err(format!("corner {corner} is not finite"));
        }
        let mut used = vec![false; self.vertices.len()];
        self.faces.iter().flatten().for_each(|&corner| used.get_mut(corner).into_iter().for_each(|used| *used = true));
        match used.iter().position(|used| !used) {
            Some(corner) => Err(format!("corner {corner} belongs to no face")),
            None => Ok(()),
        }
    }

    fn check_faces(&self) -> Result<(), String> {
        let (faces, corners) = (self.faces.len(), self.vertices.len());
        if faces < 4 {
            return Err(format!("{faces} faces enclose no volume: at least four"));
        }
        for (i, face) in self.faces.iter().enumerate() {
            if face.len() < 3 {
                return Err(format!("face {i} has {} corners: at least three", face.len()));
            }
            if let Some(corner) = face.iter().find(|&&corner| corner >= corners) {
                return Err(format!("face {i} names corner {corner}; corners are numbered from 0 to {}", corners - 1));
            }
            if let Some(k) = (1..face.len()).find(|&k| face[..k].contains(&face[k])) {
                return Err(format!("face {i} names corner {} twice", face[k]));
            }
        }
        Ok(())
    }

    /// Checks that every edge belongs to two faces, which run along it in opposite directions.
    fn check_edges(&self) -> Result<(), String> {
        let mut faces: HashMap<(usize, usize), usize> = HashMap::new();
        for (i, face) in self.faces.iter().enumerate() {
            for (k, &from) in face.iter().enumerate() {
                let to = face[(k + 1) % face.len()];
                if let Some(first) = faces.insert((from, to), i) {
                    return Err(format!(
                        "faces {first} and {i} run along edge {from}–{to} in the same direction: reverse one of them"
                    ));
                }
            }
        }
        let mut open: Vec<_> = faces.iter().filter(|((from, to), _)| !faces.contains_key(&(*to, *from))).collect();
        open.sort_unstable();
        match open.first() {
            Some(((from, to), face)) => {
                Err(format!("the surface is open at edge {from}–{to} of face {face} ({} open edges)", open.len()))
            }
            None => Ok(()),
        }
    }
}

/// Least volume as a share of the cube of the size, above the rounding of the sum of the faces.
const LEAST_VOLUME: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with one corner at the origin.
    fn cuboid(size: [f64; 3]) -> Polyhedron {
        Polyhedron::cuboid(&Vec3::zeros(), &size.into())
    }

    fn moved(mut shape: Polyhedron, by: Vec3) -> Polyhedron {
        shape.vertices.iter_mut().for_each(|vertex| *vertex += by);
        shape
    }

    #[test]
    fn volume_and_centroid_match_the_closed_form_far_from_the_origin() {
        let far = Vec3::new(1e6, -2e6, 3e6);
        let (volume, centroid) = moved(cuboid([1.0, 2.0, 4.0]), far).volume_and_centroid();
        assert!((volume - 8.0).abs() < 1e-8 && (centroid - far - Vec3::new(0.5, 1.0, 2.0)).norm() < 1e-8);
        // A pyramid on the base of the box: a third of its volume, the centroid at a quarter of its height.
        let mut pyramid = cuboid([1.0, 2.0, 4.0]);
        pyramid.vertices.truncate(4);
        pyramid.vertices.push(Vec3::new(0.5, 1.0, 3.0));
        pyramid.faces = vec![vec![0, 2, 3, 1], vec![0, 1, 4], vec![1, 3, 4], vec![3, 2, 4], vec![2, 0, 4]];
        assert_eq!(pyramid.check(), Ok(()));
        let (volume, centroid) = pyramid.volume_and_centroid();
        assert!((volume - 2.0).abs() < 1e-14 && (centroid - Vec3::new(0.5, 1.0, 0.75)).norm() < 1e-14);
    }

    /// Raising one corner of a box warps its top: the fan about the mean of the four corners gives h a b (1 + e/4h), whichever
    /// corner is listed first.
    #[test]
    fn a_warped_face_has_one_volume() {
        let mut shape = cuboid([1.0, 2.0, 3.0]);
        shape.vertices[7].z += 0.4;
        for _ in 0..4 {
            shape.faces[1].rotate_left(1);
            assert!((shape.volume_and_centroid().0 - 2.0 * (3.0 + 0.1)).abs() < 1e-12);
        }
        let warp = shape.warp(&shape.faces[1]);
        assert!(warp > 0.09 && warp < 0.1, "{warp}");
        assert_eq!(shape.warp(&shape.faces[0]), 0.0);
    }

    #[test]
    fn mistakes_are_named() {
        let wrong = |change: &dyn Fn(&mut Polyhedron)| {
            let mut shape = cuboid([1.0, 1.0, 1.0]);
            change(&mut shape);
            shape.check().unwrap_err()
        };
        assert_eq!(cuboid([1.0, 1.0, 1.0]).check(), Ok(()));
        assert!(wrong(&|shape| shape.faces[1].reverse()).contains("run along edge"));
        assert!(wrong(&|shape| _ = shape.faces.pop()).contains("open at edge 1–5 of face 2 (4 open edges)"));
        assert!(wrong(&|shape| shape.faces.truncate(3)).contains("3 faces enclose no volume"));
        assert!(wrong(&|shape| shape.faces[0].push(9)).contains("names corner 9; corners are numbered from 0 to 7"));
        assert!(wrong(&|shape| shape.vertices[2].x = f64::NAN).contains("corner 2 is not finite"));
        assert!(wrong(&|shape| shape.faces.iter_mut().for_each(|face| face.reverse())).contains("point inwards"));
        assert!(wrong(&|shape| shape.vertices.iter_mut().for_each(|vertex| vertex.z = 0.0)).contains("no volume"));
        assert!(wrong(&|shape| shape.vertices.push(Vec3::zeros())).contains("corner 8 belongs to no face"));
        assert!(wrong(&|shape| shape.faces[3] = vec![2, 6, 7, 6]).contains("names corner 6 twice"));
    }
}
