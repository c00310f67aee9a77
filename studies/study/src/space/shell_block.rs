//! Blocks of shells: columns of four corners, between two faces along the shell.

use voussoir_core::space::{Polyhedron, Vec3};

/// A block between the inner and the outer face of a shell. Each column has the corners \[inner low, outer low, inner high,
/// outer high\] \[m\]. Directions out, from column to column, and up are right-handed. Corners may coincide.
pub(super) struct ShellBlock {
    /// At least two columns.
    pub columns: Vec<[Vec3; 4]>,
}

impl ShellBlock {
    fn quad(&self, corners: [(usize, usize); 4]) -> Vec<Vec3> {
        corners.map(|(column, corner)| self.columns[column][corner]).to_vec()
    }

    /// Returns the lower facet after column s, anticlockwise from outside.
    pub fn low(&self, s: usize) -> Vec<Vec3> {
        self.quad([(s, 0), (s + 1, 0), (s + 1, 1), (s, 1)])
    }

    /// Returns the upper facet after column s, anticlockwise from outside.
    pub fn high(&self, s: usize) -> Vec<Vec3> {
        self.quad([(s, 2), (s, 3), (s + 1, 3), (s + 1, 2)])
    }

    /// Returns the outer facet after column s, anticlockwise from outside.
    pub fn outside(&self, s: usize) -> Vec<Vec3> {
        self.quad([(s, 1), (s + 1, 1), (s + 1, 3), (s, 3)])
    }

    /// Returns the inner facet after column s, anticlockwise from outside.
    pub fn inside(&self, s: usize) -> Vec<Vec3> {
        self.quad([(s, 0), (s, 2), (s + 1, 2), (s + 1, 0)])
    }

    /// Returns the side at the first column, anticlockwise from outside.
    pub fn first(&self) -> Vec<Vec3> {
        self.quad([(0, 0), (0, 1), (0, 3), (0, 2)])
    }

    /// Returns the side at the last column, anticlockwise from outside.
    pub fn last(&self) -> Vec<Vec3> {
        let last = self.columns.len() - 1;
        self.quad([(last, 0), (last, 2), (last, 3), (last, 1)])
    }

    /// Returns its surface. Faces without three different corners are left out.
    pub fn shape(&self) -> Polyhedron {
        let mut faces = vec![self.first(), self.last()];
        for s in 0..self.columns.len() - 1 {
            faces.push(self.low(s));
            faces.push(self.high(s));
            faces.push(self.outside(s));
            faces.push(self.inside(s));
        }
        surface(&faces)
    }
}

/// Returns the polyhedron of faces; equal corners are one corner.
pub(super) fn surface(faces: &[Vec<Vec3>]) -> Polyhedron {
    let mut shape = Polyhedron::default();
    for face in faces {
        let mut corners: Vec<usize> = Vec::with_capacity(face.len());
        let mut different: Vec<&Vec3> = Vec::with_capacity(face.len());
        for point in face {
            if !different.contains(&point) {
                different.push(point);
            }
        }
        if different.len() < 3 {
            continue;
        }
        for point in different {
            let known = shape.vertices.iter().position(|vertex| vertex == point);
            corners.push(known.unwrap_or(shape.vertices.len()));
            if known.is_none() {
                shape.vertices.push(*point);
            }
        }
        shape.faces.push(corners);
    }
    shape
}
