//! The law of a contact point: what it can carry and how it moves.

use crate::law::{Facet, InterfaceLaw, InterfaceResponse};
use std::sync::Arc;

/// The law of a contact point. Points of one law share it.
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
    /// The first form that a law has, in the order in which path solvers ask for them.
    pub fn of(law: &dyn InterfaceLaw) -> Option<Self> {
        law.facets().map(|facets| PointLaw::Facets(facets.into())).or_else(|| law.response().map(PointLaw::Response))
    }

    /// Its facets, where it has that form.
    pub fn facets(&self) -> Option<&[Facet]> {
        match self {
            PointLaw::Facets(facets) => Some(facets),
            _ => None,
        }
    }

    /// The tractions from gaps, where it has that form.
    pub fn response(&self) -> Option<&Arc<dyn InterfaceResponse>> {
        match self {
            PointLaw::Response(response) => Some(response),
            _ => None,
        }
    }

    /// Whether the bodies are one there.
    pub fn is_bonded(&self) -> bool {
        matches!(self, PointLaw::Bonded)
    }
}
