//! `rigid`: blocks that do not deform.
//!
//! **Purpose.** Limit analysis, and blocks far stiffer than the rest of the scene. **Equations.** ε = 0.
//! **State.** None. **Validity.** Stresses inside a rigid block are not defined.

use crate::shared::MaterialKeys;
use voussoir_core::law::{BulkMaterial, Elasticity};
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind, Sample};

/// A material that does not deform.
#[derive(Debug, Clone, Keys)]
pub struct Rigid {
    /// ρ \[kg/m³\].
    #[key(like = MaterialKeys)]
    pub density: f64,
}

#[typetag::serde(name = "rigid")]
impl BulkMaterial for Rigid {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        None
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "rigid",
        summary: "blocks that do not deform",
        provides: &[Capability::RIGID_LIMIT, Capability::LINEAR],
        samples: &[
            Sample::new("density = 2200.0", 1e-3, &[]),
        ],
        sources: &["Heyman 1966, Int. J. Solids Struct. 2"],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `rigid`\n\nBlocks of this material do not deform: ε = 0.\n",
        ..Card::of::<Rigid>()
    }
}
