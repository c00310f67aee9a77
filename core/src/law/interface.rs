//! Interface laws: what a joint can carry and how it moves when it yields.
//!
//! A law is parameters plus a pure function; state belongs to the solver. A law knows no solver.

use super::material::{BatchFailure, UpdateFailure};
use serde::Serialize;
use std::fmt::Debug;
use std::sync::Arc;

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

/// How a law states itself. The third form of the design, complementarity, comes with the first law
/// that is neither of these.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Formulation {
    /// Facets in tractions: usable by every solver.
    Facets(Vec<Facet>),
    /// Tractions from gaps: for solvers that follow a path.
    Response(Arc<dyn InterfaceResponse>),
}

/// What a joint does at the end of an update.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum UpdateBranch {
    /// Nothing irreversible in this step.
    Elastic,
    /// The bond softens.
    Softening,
    /// It slides.
    Sliding,
    /// The bond softens while it slides.
    SofteningSliding,
}

impl UpdateBranch {
    /// Its name in result files.
    pub fn name(self) -> &'static str {
        match self {
            UpdateBranch::Elastic => "elastic",
            UpdateBranch::Softening => "softening",
            UpdateBranch::Sliding => "sliding",
            UpdateBranch::SofteningSliding => "softening_sliding",
        }
    }
}

/// What an update gives for one point of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TractionPoint {
    /// (t_n, t_t) on the plus side \[Pa\], t_n ≥ 0 in compression.
    pub traction: [f64; 2],
    /// ∂t/∂g of the update itself \[Pa/m\], row by row.
    pub tangent: [[f64; 2]; 2],
    /// What happened.
    pub branch: UpdateBranch,
    /// Energy stored at the end of the step \[J/m²\].
    pub stored: f64,
    /// Energy dissipated in the step \[J/m²\].
    pub dissipated: f64,
}

impl TractionPoint {
    /// No traction and no stiffness: something to be overwritten.
    pub const ZERO: TractionPoint = TractionPoint {
        traction: [0.0; 2],
        tangent: [[0.0; 2]; 2],
        branch: UpdateBranch::Elastic,
        stored: 0.0,
        dissipated: 0.0,
    };
}

/// Traction from gap: a pure function of the gap g = (g_n, g_t) \[m\] (g_n > 0 open) and the state at
/// the start of the step. −t·ġ is the power the joint takes up per area. Nothing is allocated; call
/// [`respond`](InterfaceResponse::respond) once per group of points.
pub trait InterfaceResponse: Debug + Send + Sync {
    /// Numbers in the state of a point.
    fn state_size(&self) -> usize;

    /// Writes the state of the untouched joint into a slice of [`state_size`](Self::state_size).
    fn initial_state(&self, state: &mut [f64]);

    /// What each number of the state is, with its unit, such as `"damage [-]"`.
    fn state_names(&self) -> &'static [&'static str];

    /// Tensile strength f_t \[Pa\] and the energy G_I that full opening dissipates \[J/m²\], where the law
    /// softens in tension: what the spacing of contact points is compared with.
    fn tensile_softening(&self) -> Option<[f64; 2]> {
        None
    }

    /// The update of one point. `old` and `new` are as long as the state.
    fn respond_point(&self, gap: [f64; 2], old: &[f64], new: &mut [f64]) -> Result<TractionPoint, UpdateFailure>;

    /// Updates a group of points; one gap and result each, states one after the other.
    fn respond(
        &self,
        gaps: &[[f64; 2]],
        old: &[f64],
        new: &mut [f64],
        points: &mut [TractionPoint],
    ) -> Result<(), BatchFailure> {
        let (size, count) = (self.state_size(), gaps.len());
        if points.len() != count || old.len() != count * size || new.len() != count * size {
            return Err(BatchFailure { point: 0, failure: UpdateFailure::WrongSize });
        }
        for (index, (gap, point)) in gaps.iter().zip(points).enumerate() {
            let place = index * size..(index + 1) * size;
            *point = self
                .respond_point(*gap, &old[place.clone()], &mut new[place])
                .map_err(|failure| BatchFailure { point: index, failure })?;
        }
        Ok(())
    }
}

/// A law of a joint. Implementors also register with `#[typetag::serde]` and submit a
/// [`Card`](crate::plugin::Card).
#[typetag::serde(tag = "law")]
pub trait InterfaceLaw: Debug + Send + Sync {
    /// What the joint can carry and how it flows.
    fn formulation(&self) -> Formulation;

    /// Joint stiffness \[k_n, k_t\] \[Pa/m\] where the joint itself is compliant. Limit loads do not
    /// depend on it.
    fn stiffness(&self) -> Option<[f64; 2]>;
}

impl Formulation {
    /// The facets, where the law has that form.
    pub fn facets(self) -> Option<Vec<Facet>> {
        match self {
            Formulation::Facets(facets) => Some(facets),
            Formulation::Response(_) => None,
        }
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
