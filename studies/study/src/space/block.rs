//! Blocks given by vertices and faces, with the search for their contacts.

use super::parts::found_contacts;
use crate::scenes::keys::SceneKeys;
use crate::scenes::lookup::{law, material, take};
use voussoir_core::model::Catalogue;
use voussoir_core::plugin::{Diagnostic, Keys};
use voussoir_core::space::{ContactTolerances, Polyhedron, SpaceAssembly, SpaceBody, Vec3};

/// One block.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Block3d {
    /// unique
    pub name: String,
    /// its corners
    #[key(names = ["x", "y", "z"], unit = "m", len = ">= 4")]
    pub vertices: Vec<[f64; 3]>,
    /// corners of each face, counted from 0, in order around the face; all faces are seen from outside or all from inside
    #[key(len = ">= 3")]
    pub faces: Vec<Vec<usize>>,
    /// held by the ground
    #[key(default = false)]
    pub fixed: bool,
    /// Material instead of the scene's material.
    #[key(like = SceneKeys, optional = "the scene's")]
    pub material: Option<String>,
    /// Law of its contacts instead of the scene's law.
    #[key(like = SceneKeys, optional = "the scene's")]
    pub joint: Option<String>,
}

/// Keys of the search for contacts.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Search {
    /// greatest distance between the planes of two faces in contact; a contact has at least the area of a square with ten
    /// times this side
    #[key(unit = "m", range = "> 0", optional = "1e-5 of the diagonal of the scene")]
    pub tolerance: Option<f64>,
}

impl Block3d {
    /// Returns its shape with faces seen from outside. The error is a sentence.
    pub fn shape(&self) -> Result<Polyhedron, String> {
        let vertices = self.vertices.iter().map(|&vertex| Vec3::from(vertex)).collect();
        let shape = Polyhedron { vertices, faces: self.faces.clone() };
        let inward = shape.is_indexed() && shape.volume_and_centroid().0 < 0.0;
        let shape = if inward { shape.reversed() } else { shape };
        shape.check().map(|()| shape)
    }
}

/// Returns the shapes of blocks, and the mistakes that need no catalogue, with paths from the scene's table.
pub(super) fn shapes(blocks: &[Block3d]) -> (Vec<Option<Polyhedron>>, Vec<Diagnostic>) {
    let mut diagnostics = Vec::new();
    let mut names = std::collections::HashMap::new();
    for (i, block) in blocks.iter().enumerate() {
        let key = format!("blocks.{i}.name");
        if block.name.trim().is_empty() {
            diagnostics.push(Diagnostic::new(&key, "is empty"));
        }
        if let Some(first) = names.insert(&block.name, i) {
            let message = format!("\"{}\" is already the name of block {first} of the list", block.name);
            diagnostics.push(Diagnostic::new(&key, message));
        }
    }
    let shape = |(i, block): (usize, &Block3d)| {
        let wrong =
            |message| Diagnostic::new(format!("blocks.{i}.faces"), format!("block \"{}\": {message}", block.name));
        take(block.shape().map_err(wrong), &mut diagnostics)
    };
    let shapes = blocks.iter().enumerate().map(shape).collect();
    (shapes, diagnostics)
}

/// Reports a list of blocks without a fixed or without a free block, at a key.
pub(super) fn supports(fixed: impl Iterator<Item = bool>, key: &str, help: &str) -> Option<Diagnostic> {
    let fixed: Vec<bool> = fixed.collect();
    if fixed.is_empty() {
        Some(Diagnostic::new("blocks", "there is no block"))
    } else if !fixed.contains(&true) {
        Some(Diagnostic::new(key, "nothing is fixed").help(help))
    } else if !fixed.contains(&false) {
        Some(Diagnostic::new(key, "every block is fixed: nothing can move"))
    } else {
        None
    }
}

/// Materials and laws of blocks by name.
pub(super) struct Names<'a> {
    /// Material of blocks that name no material.
    pub material: Option<&'a str>,
    /// Law of contacts whose blocks name no law.
    pub joint: Option<&'a str>,
}

impl Names<'_> {
    /// Returns an assembly of blocks without contacts. Mistakes have paths from the scene's table.
    pub fn assembly(
        &self,
        blocks: &[Block3d],
        catalogue: &Catalogue,
        shapes: Vec<Option<Polyhedron>>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<SpaceAssembly> {
        let common = self.material.and_then(|name| take(material(catalogue, name, "material"), diagnostics));
        let mut bodies = Vec::with_capacity(blocks.len());
        for (i, (block, shape)) in blocks.iter().zip(shapes).enumerate() {
            let own = match &block.material {
                Some(name) => take(material(catalogue, name, &format!("blocks.{i}.material")), diagnostics),
                None => common,
            };
            if let Some(name) = &block.joint {
                diagnostics.extend(law(catalogue, name, &format!("blocks.{i}.joint")).err());
            }
            if let (Some(shape), Some(material)) = (shape, own) {
                bodies.push(SpaceBody { name: block.name.clone(), shape, material, fixed: block.fixed });
            }
        }
        if self.material.is_none() && blocks.iter().any(|block| block.material.is_none()) {
            diagnostics.push(Diagnostic::new("material", "is missing: the material of blocks that name no material"));
        }
        if let Some(name) = self.joint {
            diagnostics.extend(law(catalogue, name, "joint").err());
        }
        let assembly = SpaceAssembly { catalogue: catalogue.clone(), bodies, ..SpaceAssembly::default() };
        diagnostics.is_empty().then_some(assembly)
    }

    /// Sets the laws of all contacts, from their blocks or from the scene.
    pub fn set_laws(&self, blocks: &[Block3d], assembly: &mut SpaceAssembly) -> Result<(), Vec<Diagnostic>> {
        let mut diagnostics: Vec<Diagnostic> = Vec::new();
        for contact in &mut assembly.contacts {
            let index = self
                .law_name(blocks, contact.minus, contact.plus)
                .and_then(|(name, key)| law(&assembly.catalogue, name, &key));
            match index {
                Ok(index) => contact.law = index,
                Err(diagnostic) if diagnostics.contains(&diagnostic) => {}
                Err(diagnostic) => diagnostics.push(diagnostic),
            }
        }
        if diagnostics.is_empty() { Ok(()) } else { Err(diagnostics) }
    }

    /// Returns the name of the law between two blocks, and the key that defines it.
    fn law_name<'b>(&'b self, blocks: &'b [Block3d], a: usize, b: usize) -> Result<(&'b str, String), Diagnostic> {
        match [a, b].map(|i| blocks[i].joint.as_deref().map(|name| (name, format!("blocks.{i}.joint")))) {
            [Some(one), Some(other)] if one.0 != other.0 => {
                let message = format!(
                    "blocks \"{}\" and \"{}\" touch and name different joint laws, \"{}\" and \"{}\"",
                    blocks[a].name, blocks[b].name, one.0, other.0
                );
                Err(Diagnostic::new(other.1, message).help("leave out one of the two"))
            }
            [Some(one), _] | [None, Some(one)] => Ok(one),
            [None, None] => match self.joint {
                Some(name) => Ok((name, "joint".into())),
                None => {
                    Err(Diagnostic::new("joint", "is missing: the interface law of contacts whose blocks name no law"))
                }
            },
        }
    }
}

/// Adds the contacts of all blocks to an assembly; without any contact it is refused.
pub(super) fn add_contacts(assembly: &mut SpaceAssembly, tolerance: Option<f64>) -> Result<(), Diagnostic> {
    let (low, high) = assembly.bounding_box();
    let size = (high - low).norm();
    let tolerances = match tolerance {
        Some(distance) => ContactTolerances::of_distance(distance, size),
        None => ContactTolerances::of_size(size),
    };
    assembly.contacts = found_contacts(assembly, &tolerances);
    if assembly.contacts.is_empty() {
        let message = format!("no two blocks touch within {:.3e} m", tolerances.distance);
        return Err(Diagnostic::new("blocks", message).help("a larger tolerance closes gaps between faces"));
    }
    Ok(())
}
