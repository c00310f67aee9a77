//! The law of a contact point: its strength and its flow.

use crate::law::{Facet, InterfaceLaw, InterfaceResponse};
use std::sync::Arc;

/// The law of a contact point. Points with the same law share it.
#[derive(Debug, Clone)]
pub enum PointLaw {
    /// g = 0.
    Bonded,
    /// Facets a·t ≤ b with flow along d.
    Facets(Arc<[Facet]>),
    /// Tractions from gaps, with state.
    Response(Arc<dyn InterfaceResponse>),
}

impl PointLaw {
    /// Returns the first form that a law offers, in the order of preference of path solvers.
    pub fn of(law: &dyn InterfaceLaw) -> Option<Self> {
        law.facets().map(|facets| PointLaw::Facets(facets.into())).or_else(|| law.response().map(PointLaw::Response))
    }

    /// Returns the facets. `None` if the law has another form.
    pub fn facets(&self) -> Option<&[Facet]> {
        match self {
            PointLaw::Facets(facets) => Some(facets),
            _ => None,
        }
    }

    /// Returns the response. `None` if the law has another form.
    pub fn response(&self) -> Option<&Arc<dyn InterfaceResponse>> {
        match self {
            PointLaw::Response(response) => Some(response),
            _ => None,
        }
    }

    /// Returns true if the bodies are bonded at the point.
    pub fn is_bonded(&self) -> bool {
        matches!(self, PointLaw::Bonded)
    }
}
