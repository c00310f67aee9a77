//! A plug-in that a table configures, and all that it does with the standard input of the checks.

use super::site::{Site, catalogue};
use serde_json::Value as Json;
use voussoir_core::law::{BulkMaterial, InterfaceLaw};
use voussoir_core::model::Scene;
use voussoir_core::plugin::PluginKind;
use voussoir_study::loads::LoadKind;

/// A plug-in that a table configures.
pub(super) enum PlugIn {
    Joint(Box<dyn InterfaceLaw>),
    Material(Box<dyn BulkMaterial>),
    Scene(Box<dyn Scene>),
    Load(Box<dyn LoadKind>),
}

impl PlugIn {
    /// Returns true if plug-ins of this kind are read from a table and have samples.
    pub(super) fn is_of(kind: PluginKind) -> bool {
        let kinds = [PluginKind::InterfaceLaw, PluginKind::BulkMaterial, PluginKind::Scene, PluginKind::LoadKind];
        kinds.contains(&kind)
    }

    /// Returns the plug-in that a table configures.
    pub(super) fn read(kind: PluginKind, table: &Json) -> Result<Self, String> {
        let table = table.clone();
        match kind {
            PluginKind::InterfaceLaw => serde_json::from_value(table).map(PlugIn::Joint),
            PluginKind::BulkMaterial => serde_json::from_value(table).map(PlugIn::Material),
            PluginKind::Scene => serde_json::from_value(table).map(PlugIn::Scene),
            _ => serde_json::from_value(table).map(PlugIn::Load),
        }
        .map_err(|error| error.to_string())
    }

    /// Returns the table of the plug-in.
    pub(super) fn write(&self) -> Result<Json, String> {
        match self {
            PlugIn::Joint(law) => serde_json::to_value(law),
            PlugIn::Material(law) => serde_json::to_value(law),
            PlugIn::Scene(scene) => serde_json::to_value(scene),
            PlugIn::Load(load) => serde_json::to_value(load),
        }
        .map_err(|error| error.to_string())
    }

    /// Returns all properties that need no path: of a scene its blocks and joints, of a load its forces on the standard
    /// bridge.
    pub(super) fn says(&self) -> String {
        match self {
            PlugIn::Joint(law) => format!("{law:?} {:?} {:?}", law.facets(), law.stiffness()),
            PlugIn::Material(law) => format!("{law:?} {:?} {:?}", law.density(), law.elasticity()),
            PlugIn::Scene(scene) => match scene.build_space(&catalogue()) {
                Some(space) => format!("{space:?}"),
                None => format!("{:?}", scene.build(&catalogue())),
            },
            PlugIn::Load(load) => format!("{:?}", load.place(&Site::standard().place())),
        }
    }
}
