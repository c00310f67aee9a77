//! `[scene.mesh]`: the mesh of deformable blocks, with the same keys in every scene.

use super::lookup::outside;
use voussoir_core::elastic::MeshDensity;
use voussoir_core::plugin::{Diagnostic, Keys, Range};

/// Mesh of each deformable block.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct Mesh {
    /// elements along the ring, across it; of other blocks along edges 0 and 2, along 1 and 3
    #[key(names = ["along", "across"], range = ">= 1, <= MAX_ELEMENTS", default = [4, 6])]
    pub elements: [usize; 2],
    /// order of the elements
    #[key(range = ">= 1, <= MAX_ORDER", default = 2)]
    pub order: usize,
    /// greatest over least element size along an edge, one number or \[along the ring, across it\]: more than
    /// 1 is finer towards the joint's ends
    #[key(default = 1.0)]
    pub grading: Grading,
}

/// One grading for all edges, or one along the ring and one across it.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
#[keys(untagged)]
pub enum Grading {
    /// One grading for all edges.
    #[key(unit = "-", range = GRADING)]
    Both(f64),
    /// Gradings along and across, in the order of `elements`.
    #[key(names = ["along", "across"], unit = "-", range = GRADING)]
    Each([f64; 2]),
}

impl Grading {
    /// Returns the gradings along and across.
    pub fn pair(self) -> [f64; 2] {
        match self {
            Grading::Both(grading) => [grading; 2],
            Grading::Each(grading) => grading,
        }
    }
}

impl Default for Mesh {
    fn default() -> Self {
        Self::defaults()
    }
}

impl From<Mesh> for MeshDensity {
    fn from(Mesh { elements, order, grading }: Mesh) -> MeshDensity {
        MeshDensity { elements, order, grading: grading.pair() }
    }
}

const MAX_ELEMENTS: usize = 1000;
const MAX_ORDER: usize = MeshDensity::MAX_ORDER;
/// Greatest number of entries of the dense matrix that condenses a block.
const MAX_CONDENSED_NUMBERS: f64 = 2.5e7;
const GRADING: Range = Range::new(1.0, false, 10_000.0, false);

/// Returns the density of a scene's mesh, or the default.
pub(super) fn density(mesh: Option<Mesh>) -> MeshDensity {
    mesh.unwrap_or_default().into()
}

/// Returns the number of entries of the matrix that condenses a block: displacements of all nodes for a force at each node of
/// its edges.
fn condensed_numbers(mesh: &Mesh) -> f64 {
    let [along, across] = mesh.elements.map(|count| (count * mesh.order + 1) as f64);
    let edges = 2.0 * (along + across);
    (2.0 * along * across) * (2.0 * edges)
}

/// Returns the mistakes in a scene's mesh, with paths from the scene's table.
pub(super) fn mesh_diagnostics(mesh: Option<&Mesh>) -> Vec<Diagnostic> {
    let Some(mesh) = mesh else {
        return Vec::new();
    };
    let mut diagnostics = Vec::new();
    for (i, &count) in mesh.elements.iter().enumerate().filter(|&(_, n)| !(1..=MAX_ELEMENTS).contains(n)) {
        diagnostics
            .push(Diagnostic::new(format!("mesh.elements.{i}"), format!("{count} must be from 1 to {MAX_ELEMENTS}")));
    }
    if !(1..=MAX_ORDER).contains(&mesh.order) {
        diagnostics.push(Diagnostic::new("mesh.order", format!("{} must be from 1 to {MAX_ORDER}", mesh.order)));
    }
    let numbers = condensed_numbers(mesh);
    if diagnostics.is_empty() && numbers > MAX_CONDENSED_NUMBERS {
        let message = format!(
            "a block of {} × {} elements of order {} needs {:.1} GB to be condensed; at most {:.1} GB are used",
            mesh.elements[0],
            mesh.elements[1],
            mesh.order,
            8e-9 * numbers,
            8e-9 * MAX_CONDENSED_NUMBERS
        );
        diagnostics.push(Diagnostic::new("mesh.elements", message));
    }
    match mesh.grading {
        Grading::Both(grading) => diagnostics.extend(outside(GRADING, "mesh.grading", grading)),
        Grading::Each(each) => {
            for (i, grading) in each.into_iter().enumerate() {
                diagnostics.extend(outside(GRADING, &format!("mesh.grading.{i}"), grading));
            }
        }
    }
    diagnostics
}
