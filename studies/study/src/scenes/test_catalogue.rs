//! Materials and laws for tests of scenes and loads.

use std::sync::Arc;
use voussoir_core::law::{BulkMaterial, InterfaceLaw};
use voussoir_core::model::Catalogue;

/// A catalogue with `stone` (rigid) and `elastic` (elastic), and the laws `dry` and `wet`.
pub(crate) fn catalogue() -> Catalogue {
    let material =
        |value| -> Arc<dyn BulkMaterial> { Arc::from(serde_json::from_value::<Box<dyn BulkMaterial>>(value).unwrap()) };
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
