//! The scene of a case with its materials and joint laws: plug-ins are read from their checked tables.

use super::diagnostics::DiagnosticList;
use super::resolved::Resolved;
use crate::config::dotted_key::join;
use serde_json::Value as Json;
use std::sync::Arc;
use voussoir_core::law::{BulkMaterial, InterfaceLaw};
use voussoir_core::model::{Assembly, Catalogue, Scene};
use voussoir_core::space::SpaceAssembly;

/// Returns the plug-in that a checked table configures, or a diagnostic at `key`.
pub fn read_plugin<T: serde::de::DeserializeOwned>(
    diagnostics: &mut DiagnosticList<'_>,
    key: &str,
    table: &Json,
) -> Option<T> {
    match T::deserialize(table) {
        Ok(plugin) => Some(plugin),
        Err(error) => {
            diagnostics.wrong(key, format!("cannot be read: {error}"), "correct this table");
            None
        }
    }
}

fn read_plugins<T: serde::de::DeserializeOwned>(
    diagnostics: &mut DiagnosticList<'_>,
    name: &str,
    tables: &Json,
) -> Option<Vec<(String, T)>> {
    let tables = tables.as_object()?.iter();
    let read =
        tables.filter_map(|(entry, table)| Some((entry.clone(), read_plugin(diagnostics, &join(name, entry), table)?)));
    Some(read.collect())
}

/// Returns materials and joint laws by name.
pub fn catalogue(diagnostics: &mut DiagnosticList<'_>, resolved: &Resolved) -> Option<Catalogue> {
    let materials: Option<Vec<(String, Box<dyn BulkMaterial>)>> =
        resolved.get("materials").and_then(|tables| read_plugins(diagnostics, "materials", tables));
    let laws: Option<Vec<(String, Box<dyn InterfaceLaw>)>> =
        resolved.get("joints").and_then(|tables| read_plugins(diagnostics, "joints", tables));
    Some(Catalogue {
        materials: materials?.into_iter().map(|(name, material)| (name, Arc::from(material))).collect(),
        laws: laws?.into_iter().map(|(name, law)| (name, Arc::from(law))).collect(),
    })
}

/// Blocks of a scene: in the plane, or in space.
pub enum Built {
    /// Blocks and joints in the plane.
    Plane(Box<Assembly>),
    /// Blocks and contacts in space.
    Space(SpaceAssembly),
}

/// Returns the blocks of the scene.
pub fn built(diagnostics: &mut DiagnosticList<'_>, resolved: &Resolved, catalogue: &Catalogue) -> Option<Built> {
    let scene: Box<dyn Scene> = read_plugin(diagnostics, "scene", resolved.get("scene")?)?;
    let built = match scene.build_space(catalogue) {
        Some(space) => space.map(Built::Space),
        None => scene.build(catalogue).map(|assembly| Built::Plane(Box::new(assembly))),
    };
    built.map_err(|wrong| diagnostics.extend(wrong)).ok()
}
