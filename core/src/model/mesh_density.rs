//! The density of the meshes of deformable bodies.

/// The density of a body's mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshDensity {
    /// Number of elements along edges 0 and 2, and along edges 1 and 3: for a voussoir along the ring and across it.
    pub elements: [usize; 2],
    /// Order of the elements, 1 to 3.
    pub order: usize,
    /// g ≥ 1: ratio of greatest to least element size along edges 0 and 2, and along edges 1 and 3; elements are finer
    /// towards the ends of an edge. Polygons that are not quadrilaterals use the greater value for all edges.
    pub grading: [f64; 2],
}

impl MeshDensity {
    /// Greatest order of an element.
    pub const MAX_ORDER: usize = 3;

    /// Checks the values. An error gives the reason.
    pub fn check(&self) -> Result<(), String> {
        if self.elements.contains(&0) {
            return Err("a mesh needs at least one element each way".into());
        }
        if !(1..=Self::MAX_ORDER).contains(&self.order) {
            return Err(format!("elements have order 1 to {}, not {}", Self::MAX_ORDER, self.order));
        }
        if let Some(grading) = self.grading.iter().find(|g| !(g.is_finite() && **g >= 1.0)) {
            return Err(format!("the grading of a mesh is at least 1, not {grading}"));
        }
        Ok(())
    }
}
