//! Facets: half planes of admissible tractions, each with its direction of flow.

use serde::Serialize;

/// The way in which a joint yields on a facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FacetMode {
    /// The joint opens.
    Opening,
    /// The joint slides.
    Sliding,
    /// The joint crushes.
    Crushing,
}

/// A half plane a·t ≤ b of admissible tractions t = (t_n, t_t) \[Pa\] with its direction of flow d: ġ = −Σ γ d, γ ≥ 0.
/// Flow is associated if d = a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// The way in which the joint yields.
    pub mode: FacetMode,
    /// a, dimensionless.
    pub normal: [f64; 2],
    /// b ≥ 0 \[Pa\].
    pub bound: f64,
    /// d, dimensionless.
    pub flow: [f64; 2],
}

impl Facet {
    /// Creates a facet with associated flow.
    pub fn associated(mode: FacetMode, normal: [f64; 2], bound: f64) -> Self {
        Facet { mode, normal, bound, flow: normal }
    }

    /// The facet t_n ≥ −`tensile_strength` \[Pa\].
    pub fn opening(tensile_strength: f64) -> Self {
        Facet::associated(FacetMode::Opening, [-1.0, 0.0], tensile_strength)
    }

    /// The facet t_n ≤ `compressive_strength` \[Pa\].
    pub fn crushing(compressive_strength: f64) -> Self {
        Facet::associated(FacetMode::Crushing, [1.0, 0.0], compressive_strength)
    }

    /// The two facets of |t_t| ≤ `cohesion` + `friction` t_n. Slip opens the joint by `dilatancy` per unit of slip, the
    /// tangent of the dilatancy angle. `cohesion` is in \[Pa\].
    pub fn friction(friction: f64, cohesion: f64, dilatancy: f64) -> [Self; 2] {
        [1.0, -1.0].map(|sense| Facet {
            mode: FacetMode::Sliding,
            normal: [-friction, sense],
            bound: cohesion,
            flow: [-dilatancy, sense],
        })
    }
}

/// The flow rule that limit analysis and mechanisms use for joint laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlowRule {
    /// Flow along the normal of each facet, whatever the law defines: the bound theorems hold.
    Associated,
    /// Flow along the facet's own direction.
    NonAssociated,
}

/// Returns true if the flow of every facet is its normal, so that the bound theorems hold.
pub fn is_associated(facets: &[Facet]) -> bool {
    facets.iter().all(|facet| facet.flow == facet.normal)
}
