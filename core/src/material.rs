//! Bulk materials: what blocks are made of.

use std::fmt::Debug;

/// How a material deforms.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Deformability {
    /// Not at all.
    Rigid,
    /// Linearly, isotropically.
    LinearElastic {
        /// E \[Pa\].
        young_modulus: f64,
        /// ν.
        poisson_ratio: f64,
    },
}

/// The material of a block.
#[typetag::serde(tag = "law")]
pub trait BulkMaterial: Debug + Send + Sync {
    /// ρ \[kg/m³\].
    fn density(&self) -> f64;

    /// How it deforms.
    fn deformability(&self) -> Deformability;
}
