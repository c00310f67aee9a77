//! Proofs of the end of a path by its solver: rates at a state, or the proof that no rate raises the load.
//!
//! The rate problem at a state, over the rates of contact forces ṙ, of gaps ġ and of motions q̇:
//!
//! ```text
//! equilibrium   E ṙ + K q̇ + λ̇ p = 0        of each free body; K = 0 with small displacements
//! kinematics    ġ = C ṙ + G q̇ + λ̇ g_p
//! law           (ṙ, ġ) in a mode of each contact point
//! ```
//!
//! The certificate derives E, K, p, C, G and g_p from the assembly, and checks a witness without any search.

use super::state::PathState;
use serde::{Deserialize, Serialize};

/// A statement about the rates at a state of a path.
#[derive(Debug, Clone)]
pub struct Witness {
    /// The state, one that the observer has received.
    pub state: PathState,
    /// The statement.
    pub claim: RateClaim,
}

/// The statement of a witness.
#[derive(Debug, Clone)]
pub enum RateClaim {
    /// These rates solve the rate problem: along a ray or, if laws have a history, just beyond a limit point.
    Rate(PathRate),
    /// No rate has λ̇ > 0 (λ̇ < 0 in a load step that unloads).
    NoneRises(ModeTree),
    /// No rate continues the path from the last state.
    NoneContinues(NoneContinues),
}

/// The proof that no rate continues a path from its last state, in the sense of the load step. Its trees may have leaves
/// [`ModeTree::Before`] if λ falls; on a path that arrives with λ falling also if λ rises, since that is the way back.
#[derive(Debug, Clone, PartialEq)]
pub struct NoneContinues {
    /// No rate has λ̇ > 0.
    pub rises: ModeTree,
    /// No rate has λ̇ = 0 and a load that does work.
    pub stands: ModeTree,
    /// No rate has λ̇ < 0, except rates in modes that the path had before.
    pub falls: ModeTree,
}

/// Rates of all quantities at a state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PathRate {
    /// Rate λ̇.
    pub factor: f64,
    /// (ṙ_n, ṙ_t) of every contact point, in axes that turn with it \[N\].
    pub force: Vec<[f64; 2]>,
    /// (ġ_n, ġ_t) of every contact point \[m\].
    pub gap: Vec<[f64; 2]>,
    /// Velocity of every body about its pole.
    pub motion: Vec<[f64; 3]>,
}

/// The mode of a contact point in a rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointMode {
    /// ġ = 0, and ṙ leaves no active facet outwards.
    Stick,
    /// The force stays on this facet, and the gap flows along it.
    Facet(usize),
    /// ṙ = 0, and the gap flows along all active facets.
    Vertex,
    /// ṙ = 0, and the gap is free: an open point without strength.
    Open,
}

/// A complete tree of decisions. Each leaf refutes a sense of λ̇ for the modes decided on the way to it; a point that is not
/// decided may be in any of its modes. If flow is associated and displacements are small, one leaf without decisions is enough.
#[derive(Debug, Clone, PartialEq)]
pub enum ModeTree {
    /// No rate has the modes decided so far.
    Leaf(FarkasVector),
    /// A contact point with a subtree for each of its modes.
    Split {
        /// Index of the contact point.
        contact: usize,
        /// Its modes, each with the subtree that refutes it.
        branches: Vec<(PointMode, ModeTree)>,
    },
    /// All points could have these modes just before the state: their rates existed there and do not continue the path.
    Before,
}

/// Multipliers y of equilibrium and β of kinematics. They are such that Kᵀ y + Gᵀ β = 0. Every rate then satisfies
///
/// ```text
/// α·ṙ + β·ġ = λ̇ (p·y + g_p·β),   α = −(Eᵀ y + Cᵀ β)
/// ```
///
/// If the left side is ≥ 0 in all modes that are left and the factor of λ̇ is negative, then λ̇ > 0 is impossible. A
/// mechanism q̇ with p·q̇ = 1 gives y = −q̇, β = 0, and α is the rate of its gaps.
///
/// If λ̇ = 0 is refuted, Kᵀ y + Gᵀ β = −κ p with κ > 0. Then α·ṙ + β·ġ = −κ W with α = −(Eᵀ y + Cᵀ β + κ g_p), where
/// W = p·q̇ + g_p·ṙ is the work of the load. If the left side is ≥ 0 in all modes that are left, the load does no work.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FarkasVector {
    /// y of every body; the entries of held bodies are not read.
    pub equilibrium: Vec<[f64; 3]>,
    /// β of every contact point.
    pub gap: Vec<[f64; 2]>,
    /// κ; read only if λ̇ = 0 is refuted.
    pub work: f64,
}

impl ModeTree {
    /// Number of leaves; counting ends above `most`.
    pub fn leaves(&self, most: usize) -> usize {
        let mut open = vec![self];
        let mut leaves = 0;
        while let Some(tree) = open.pop() {
            match tree {
                ModeTree::Leaf(_) | ModeTree::Before => leaves += 1,
                ModeTree::Split { branches, .. } => open.extend(branches.iter().map(|(_, tree)| tree)),
            }
            if leaves > most {
                break;
            }
        }
        leaves
    }
}
