//! Interface laws: the strength of a joint and its flow when it yields.
//!
//! A law consists of parameters and pure functions; the solver stores the state. A law does not depend on any solver:
//! it offers one or more forms, and a solver uses the first form that its card asks for.

use super::cone::FrictionCone;
use super::facet::Facet;
use super::facet_response::FacetResponse;
use super::response::InterfaceResponse;
use crate::plugin::{KeyValue, PluginKind, Shape};
use std::fmt::Debug;
use std::sync::Arc;

/// The law of a joint. Implementors also register with `#[typetag::serde]` and submit a [`Card`](crate::plugin::Card).
#[typetag::serde(tag = "law")]
pub trait InterfaceLaw: Debug + Send + Sync {
    /// Returns the facets a·t ≤ b that bound the tractions of the joint, with their flow. `None` if the law has no such
    /// form.
    fn facets(&self) -> Option<Vec<Facet>> {
        None
    }

    /// Returns the cone of admissible tractions of a contact in space. `None` if the friction of the law is not
    /// isotropic, or has no such form. A law with facets and a cone has the same bounds in both: the facets are the cone
    /// in a plane through its axis.
    fn cone(&self) -> Option<FrictionCone> {
        None
    }

    /// Returns the response of the joint, which computes tractions from gaps and a state. `None` if the law has no such
    /// form. By default a law with facets has a response if both its stiffnesses are finite. If a law has both forms,
    /// they must agree: tractions of the response lie within the facets and its flow is the flow of the facets.
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(FacetResponse::new(self.facets()?, self.stiffness()?)?))
    }

    /// Returns the joint stiffness \[k_n, k_t\] \[Pa/m\] if the joint itself is compliant. Limit loads do not depend on
    /// it.
    fn stiffness(&self) -> Option<[f64; 2]>;
}

impl KeyValue for Box<dyn InterfaceLaw> {
    const SHAPE: Shape = Shape::Plugin(PluginKind::InterfaceLaw);
}
