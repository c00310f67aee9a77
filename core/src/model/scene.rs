//! Scenes: descriptions of geometry that are converted into an [`Assembly`].

use super::assembly::{Assembly, Catalogue};
use super::space::SpaceAssembly;
use crate::plugin::{Diagnostic, KeyValue, PluginKind, Shape};
use std::fmt::Debug;

/// A kind of scene, chosen by `[scene] scene = …`.
#[typetag::serde(tag = "scene")]
pub trait Scene: Debug + Send + Sync {
    /// Builds bodies and joints. Paths of diagnostics start at the root of the study (`scene.…`).
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>>;

    /// Builds bodies and contacts of a scene in space. `None` for a plane scene. A scene in space returns an assembly
    /// without bodies from [`build`](Self::build).
    fn build_space(&self, _: &Catalogue) -> Option<Result<SpaceAssembly, Vec<Diagnostic>>> {
        None
    }
}

impl KeyValue for Box<dyn Scene> {
    const SHAPE: Shape = Shape::Plugin(PluginKind::Scene);
}
