//! Sensitivity of the limit load to the data of its problem: one-sided derivatives from the optimal face.
//!
//! λ*(θ) = max { λ : E r + w + λ p = 0, A r ≤ b } with E, w, p, A, b functions of a parameter θ. If the set X* of
//! fields that carry λ* and the set Y* of mechanisms at λ* are bounded, the right derivative is (Gol'shtein 1972,
//! Freund 1985)
//!
//! λ*′(θ+) = max over r ∈ X* of min over (q, γ) ∈ Y* of  q·(E′ r + w′ + λ* p′) − γ·(A′ r − b′),
//!
//! and by duality of the inner program, with T the tight rows of any one field r̂ of X*,
//!
//! λ*′(θ+) = max { δλ : r ∈ X*, E δr + p δλ + E′ r + w′ + λ* p′ = 0, A_T δr + A′_T r − b′_T ≤ 0 },
//!
//! one linear program, since r and δr enter linearly. The left derivative is minus the right derivative with −E′, −w′,
//! …. If field and mechanism are unique, both equal the derivative of the Lagrangian; otherwise they may differ. Stress
//! blocks are represented by their tangents at r̂: forces of yielding blocks are the same in all of X*.

mod data;
mod face;
mod program;
mod row;

pub use self::data::{DataRate, same_data};
pub use self::face::OptimalFace;
