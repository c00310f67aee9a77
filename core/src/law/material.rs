//! Bulk materials: what blocks are made of.
//!
//! A material is parameters plus pure functions; state belongs to whoever solves. Plane strain and
//! plane stress are made from the law in space by [`PlanarUpdate`](super::PlanarUpdate).

use super::elasticity::{Elasticity, LinearUpdate};
use super::stress::StressUpdate;
use std::fmt::Debug;
use std::sync::Arc;

/// The material of a block. Implementors also register with `#[typetag::serde]` and submit a
/// [`Card`](crate::plugin::Card).
#[typetag::serde(tag = "law")]
pub trait BulkMaterial: Debug + Send + Sync {
    /// ρ \[kg/m³\].
    fn density(&self) -> f64;

    /// How it deforms before it yields; `None` where it is rigid.
    fn elasticity(&self) -> Option<Elasticity>;

    /// How it yields; `None` where it does not, and its elasticity says everything.
    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        None
    }

    /// Stress from strain at a point, whether it yields or not; `None` where it is rigid.
    fn stress_update(&self) -> Option<Arc<dyn StressUpdate>> {
        self.inelastic().or_else(|| Some(Arc::new(LinearUpdate(self.elasticity()?))))
    }
}
