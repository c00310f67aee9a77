//! Scenes: geometry that becomes an assembly of blocks, one file each; file = tag.

use serde::{Deserialize, Serialize};
use voussoir_core::law::Plane;
use voussoir_core::model::Catalogue;
use voussoir_core::plugin::{Diagnostic, Need, Parameter, Quantity, Range, Shape, nearest};

pub mod arch;
pub mod blocks;
mod curve;
pub mod mesh;
pub mod profile;
pub mod wall;

/// `plane`: stress state of deformable bodies.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlaneState {
    /// ε_z = 0.
    #[default]
    Strain,
    /// σ_z = 0.
    Stress,
}

impl From<PlaneState> for Plane {
    fn from(state: PlaneState) -> Plane {
        match state {
            PlaneState::Strain => Plane::Strain,
            PlaneState::Stress => Plane::Stress,
        }
    }
}

const WIDTH: Parameter = Parameter::number("width", Quantity::Length, Range::POSITIVE, "out of plane");

const PLANE: Parameter = Parameter {
    name: "plane",
    doc: "stress state of deformable blocks: no strain, or no stress, out of plane",
    shape: Shape::Choice(&["strain", "stress"]),
    need: Need::Default("\"strain\""),
};

const MATERIAL: Parameter = Parameter {
    name: "material",
    doc: "material of the blocks",
    shape: Shape::Reference("materials"),
    need: Need::Required,
};

const JOINT: Parameter = Parameter {
    name: "joint",
    doc: "interface law of the joints",
    shape: Shape::Reference("joints"),
    need: Need::Required,
};

/// A point \[x, y\] in m.
pub(crate) const POINT: Shape = Shape::List { of: &LENGTH, min: 2, max: 2 };
const LENGTH: Shape = Shape::Number(Quantity::Length, Range::ANY);

/// Index of a material, or a mistake at `path`.
fn material(catalogue: &Catalogue, name: &str, path: &str) -> Result<usize, Diagnostic> {
    catalogue
        .material(name)
        .ok_or_else(|| unknown(path, "material", name, catalogue.materials.iter().map(|(name, _)| name.as_str())))
}

/// Index of an interface law, or a mistake at `path`.
fn law(catalogue: &Catalogue, name: &str, path: &str) -> Result<usize, Diagnostic> {
    catalogue
        .law(name)
        .ok_or_else(|| unknown(path, "joint law", name, catalogue.laws.iter().map(|(name, _)| name.as_str())))
}

/// "There is no such thing", with the nearest right name.
pub(crate) fn unknown<'a>(path: &str, kind: &str, name: &str, names: impl Iterator<Item = &'a str>) -> Diagnostic {
    let diagnostic = Diagnostic::new(path, format!("there is no {kind} called \"{name}\""));
    match nearest(name, names) {
        Some(near) => diagnostic.help(format!("did you mean \"{near}\"?")),
        None => diagnostic,
    }
}

/// A diagnostic at a number that breaks a range; `None` where it does not.
fn out_of_range(path: &str, value: f64, range: Range) -> Option<Diagnostic> {
    (!range.contains(value)).then(|| Diagnostic::new(path, format!("{value} must be {}", range.describe())))
}

/// The value, or its mistake added to the list.
fn take<T>(result: Result<T, Diagnostic>, diagnostics: &mut Vec<Diagnostic>) -> Option<T> {
    result.map_err(|diagnostic| diagnostics.push(diagnostic)).ok()
}

/// Issues with paths from the scene's table, as a card's check gives them.
fn pairs_of(diagnostics: Vec<Diagnostic>) -> Vec<(String, String)> {
    let words = |diagnostic: Diagnostic| match diagnostic.help {
        Some(help) => (diagnostic.path, format!("{}; {help}", diagnostic.message)),
        None => (diagnostic.path, diagnostic.message),
    };
    diagnostics.into_iter().map(words).collect()
}

/// Issues with paths from the scene's table, now from the study's root.
fn from_root(diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics
        .into_iter()
        .map(|diagnostic| Diagnostic { path: format!("scene.{}", diagnostic.path), ..diagnostic })
        .collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use std::sync::Arc;
    use voussoir_core::law::{BulkMaterial, InterfaceLaw};
    use voussoir_core::model::Catalogue;

    /// A catalogue with `stone` (rigid) and `elastic` (elastic), and the laws `dry` and `wet`.
    pub(crate) fn catalogue() -> Catalogue {
        let material = |value| -> Arc<dyn BulkMaterial> {
            Arc::from(serde_json::from_value::<Box<dyn BulkMaterial>>(value).unwrap())
        };
        let law = |friction: f64| -> Arc<dyn InterfaceLaw> {
            let value = serde_json::json!({ "law": "coulomb", "friction": friction });
            Arc::from(serde_json::from_value::<Box<dyn InterfaceLaw>>(value).unwrap())
        };
        let elastic =
            serde_json::json!({ "law": "elastic", "young_modulus": 5e9, "poisson_ratio": 0.3, "density": 2200.0 });
        Catalogue {
            materials: vec![
                ("stone".into(), material(serde_json::json!({ "law": "rigid", "density": 2200.0 }))),
                ("elastic".into(), material(elastic)),
            ],
            laws: vec![("dry".into(), law(0.6)), ("wet".into(), law(0.3))],
        }
    }
}
