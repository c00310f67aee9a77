//! `[scene.mesh]`: how deformable blocks are meshed, the same key in every scene.

use super::lookup::out_of_range;
use serde::{Deserialize, Serialize};
use voussoir_core::elastic::MeshDensity;
use voussoir_core::plugin::{Diagnostic, Need, Parameter, Quantity, Range, Shape};

/// Mesh of each deformable block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Mesh {
    /// Elements along the ring, across it; of other blocks along edges 0 and 2, along 1 and 3.
    pub elements: [usize; 2],
    /// Order of the elements, 1 to 3.
    pub order: usize,
    /// Greatest over least element size along an edge; more than 1 is finer towards the edge's ends.
    pub grading: Grading,
}

/// One grading for all edges, or one along the ring and one across it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Grading {
    /// The same both ways.
    Both(f64),
    /// Along, across; as `elements`.
    Each([f64; 2]),
}

impl Grading {
    fn pair(self) -> [f64; 2] {
        match self {
            Grading::Both(grading) => [grading; 2],
            Grading::Each(grading) => grading,
        }
    }
}

impl Default for Mesh {
    fn default() -> Self {
        let MeshDensity { elements, order, grading } = MeshDensity::default();
        Mesh {
            elements,
            order,
            grading: if grading[0] == grading[1] { Grading::Both(grading[0]) } else { Grading::Each(grading) },
        }
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
const COUNT: Shape = Shape::Integer { min: 1, max: MAX_ELEMENTS as i64 };
const GRADING_NUMBER: Shape = Shape::Number(Quantity::Ratio, GRADING);

/// The density of a scene's mesh, where it gives none the default.
pub(super) fn density(mesh: Option<Mesh>) -> MeshDensity {
    mesh.unwrap_or_default().into()
}

/// Entries of the matrix that condenses a block: displacements of all nodes for a force at each node of its edges.
fn condensed_numbers(mesh: &Mesh) -> f64 {
    let [along, across] = mesh.elements.map(|count| (count * mesh.order + 1) as f64);
    let edges = 2.0 * (along + across);
    (2.0 * along * across) * (2.0 * edges)
}

/// Mistakes in a scene's mesh, with paths from the scene's table.
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
        Grading::Both(grading) => diagnostics.extend(out_of_range("mesh.grading", grading, GRADING)),
        Grading::Each(each) => {
            for (i, grading) in each.into_iter().enumerate() {
                diagnostics.extend(out_of_range(&format!("mesh.grading.{i}"), grading, GRADING));
            }
        }
    }
    diagnostics
}

const KEYS: &[Parameter] = &[
    Parameter {
        name: "elements",
        doc: "elements along the ring, across it; of other blocks along edges 0 and 2, along 1 and 3",
        shape: Shape::Tuple(&[("along", COUNT), ("across", COUNT)]),
        need: Need::Default("[4, 6]"),
    },
    Parameter {
        name: "order",
        doc: "order of the elements",
        shape: Shape::Integer { min: 1, max: MAX_ORDER as i64 },
        need: Need::Default("2"),
    },
    Parameter {
        name: "grading",
        doc: "greatest over least element size along an edge, one number or [along the ring, across it]: more than 1 is finer towards the joint's ends",
        shape: Shape::Either(&[GRADING_NUMBER, Shape::Tuple(&[("along", GRADING_NUMBER), ("across", GRADING_NUMBER)])]),
        need: Need::Default("1.0"),
    },
];

/// The key `mesh` of a scene.
pub(super) const MESH: Parameter = Parameter {
    name: "mesh",
    doc: "mesh of deformable blocks",
    shape: Shape::Table(KEYS),
    need: Need::Optional("the defaults of its keys"),
};
