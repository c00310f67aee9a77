//! Interface laws: what a joint can carry and how it moves when it yields.
//!
//! A law is parameters plus pure functions; state belongs to the solver. A law knows no solver: it gives the forms
//! it has, and a solver takes the first that its card asks for.

use super::facet::Facet;
use super::facet_response::FacetResponse;
use super::response::InterfaceResponse;
use std::fmt::Debug;
use std::sync::Arc;

/// A law of a joint. Implementors also register with `#[typetag::serde]` and submit a
/// [`Card`](crate::plugin::Card).
#[typetag::serde(tag = "law")]
pub trait InterfaceLaw: Debug + Send + Sync {
    /// Facets a·t ≤ b of what the joint can carry, and how it flows on them. `None` where the law has no such
    /// form.
    fn facets(&self) -> Option<Vec<Facet>> {
        None
    }

    /// Tractions from gaps, with state. `None` where the law has no such form; one of facets has it where
    /// both its stiffnesses are finite. Where a law has both forms they say the same: tractions lie within the
    /// facets and flow is theirs.
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(FacetResponse::new(self.facets()?, self.stiffness()?)?))
    }

    /// Joint stiffness \[k_n, k_t\] \[Pa/m\] where the joint itself is compliant. Limit loads do not
    /// depend on it.
    fn stiffness(&self) -> Option<[f64; 2]>;
}
