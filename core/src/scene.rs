//! Scenes: geometry that becomes an [`Assembly`].

use crate::assembly::{Assembly, Catalogue};
use crate::issue::Issue;
use std::fmt::Debug;

/// A kind of geometry, chosen by `[scene] scene = …`.
#[typetag::serde(tag = "scene")]
pub trait Scene: Debug + Send + Sync {
    /// Bodies and joints. Paths of issues start at the study's root (`scene.…`).
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Issue>>;
}
