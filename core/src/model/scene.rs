//! Scenes: geometry that becomes an [`Assembly`].

use super::assembly::{Assembly, Catalogue};
use crate::plugin::Diagnostic;
use std::fmt::Debug;

/// A kind of geometry, chosen by `[scene] scene = …`.
#[typetag::serde(tag = "scene")]
pub trait Scene: Debug + Send + Sync {
    /// Bodies and joints. Paths of diagnostics start at the study's root (`scene.…`).
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>>;
}
