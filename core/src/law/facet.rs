//! Facets: half planes of admissible tractions with their flow.

use serde::Serialize;

/// What happens to a joint that yields on a facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FacetMode {
    /// It opens.
    Opening,
    /// It slides.
    Sliding,
    /// It crushes.
    Crushing,
}

/// One half plane a·t ≤ b of admissible tractions t = (t_n, t_t) \[Pa\] and the direction of flow on
/// it: ġ = −Σ γ d, γ ≥ 0. Associated flow is d = a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// What happens when it yields.
    pub mode: FacetMode,
    /// a, dimensionless.
    pub normal: [f64; 2],
    /// b ≥ 0 \[Pa\].
    pub bound: f64,
    /// d, dimensionless.
    pub flow: [f64; 2],
}

impl Facet {
    /// A facet with associated flow.
    pub fn associated(mode: FacetMode, normal: [f64; 2], bound: f64) -> Self {
        Facet { mode, normal, bound, flow: normal }
    }

    /// t_n ≥ −`tensile_strength` \[Pa\].
    pub fn opening(tensile_strength: f64) -> Self {
        Facet::associated(FacetMode::Opening, [-1.0, 0.0], tensile_strength)
    }

    /// t_n ≤ `compressive_strength` \[Pa\].
    pub fn crushing(compressive_strength: f64) -> Self {
        Facet::associated(FacetMode::Crushing, [1.0, 0.0], compressive_strength)
    }

    /// |t_t| ≤ `cohesion` + `friction` t_n as two facets; slip opens the joint by `dilatancy`
    /// (the tangent of the dilatancy angle) per unit of slip.
    pub fn friction(friction: f64, cohesion: f64, dilatancy: f64) -> [Self; 2] {
        [1.0, -1.0].map(|sense| Facet {
            mode: FacetMode::Sliding,
            normal: [-friction, sense],
            bound: cohesion,
            flow: [-dilatancy, sense],
        })
    }
}

/// How limit analysis and mechanisms read the flow of laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlowRule {
    /// As the normal of each facet, whatever the law says: the bound theorems hold.
    Associated,
    /// As each facet's own direction.
    NonAssociated,
}

/// Whether every facet's flow is its normal, so that the bound theorems hold as they stand.
pub fn is_associated(facets: &[Facet]) -> bool {
    facets.iter().all(|facet| facet.flow == facet.normal)
}
