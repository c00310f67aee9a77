//! Bulk materials of blocks.
//!
//! A material consists of parameters and pure functions; the solver stores the state.
//! [`PlanarUpdate`](super::PlanarUpdate) derives plane strain and plane stress from the law in space.

use super::elasticity::{Elasticity, LinearUpdate};
use super::stress::StressUpdate;
use crate::plugin::{KeyValue, PluginKind, Shape};
use std::fmt::Debug;
use std::sync::Arc;

/// The material of a block. Implementors also register with `#[typetag::serde]` and submit a
/// [`Card`](crate::plugin::Card).
#[typetag::serde(tag = "law")]
pub trait BulkMaterial: Debug + Send + Sync {
    /// Returns the density ρ \[kg/m³\].
    fn density(&self) -> f64;

    /// Returns the elasticity before the material yields. `None` if the material is rigid.
    fn elasticity(&self) -> Option<Elasticity>;

    /// Returns the inelastic law. `None` if the material is linear elastic or rigid.
    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        None
    }

    /// Returns the stress update, elastic or inelastic. `None` if the material is rigid.
    fn stress_update(&self) -> Option<Arc<dyn StressUpdate>> {
        self.inelastic().or_else(|| Some(Arc::new(LinearUpdate(self.elasticity()?))))
    }
}

impl KeyValue for Box<dyn BulkMaterial> {
    const SHAPE: Shape = Shape::Plugin(PluginKind::BulkMaterial);
}
