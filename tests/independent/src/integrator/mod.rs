//! An independent method for paths of rigid blocks with friction and finite displacements.
//!
//! It reads blocks, joints and loads from a case. It shares no mechanics, law or solver with the program. Joints have a
//! normal and a shear stiffness (`coulomb`); gravity comes first, then point loads grow.
//!
//! **Unknowns.** The displacement u of each centre of mass, the rotation θ of each block, and λ.
//!
//! **Contact points.** Simpson's rule on equal parts of each joint gives positions and areas A. A point is x⁻ on one
//! block and x⁺ on the other. Its axes rotate by θ⁻ + β (θ⁺ − θ⁻), and its gaps are
//!
//! ```text
//! g_n = n·(x⁺ − x⁻)     g_t = t·(x⁺ − x⁻)     Σ (∂g/∂q)ᵀ r + w + λ p = 0
//! ```
//!
//! β is 0 or 1 if the nearer end of the joint is a corner of one block. It changes from ½ to 0 or 1 with slip if both
//! blocks have a corner there. First derivatives are exact (dual numbers); the second derivatives in the tangent are
//! difference quotients.
//!
//! **Law.** An elastic spring with friction, integrated over a step in closed form ([`law`]):
//!
//! ```text
//! r* = −k A (g − s)     r_n = ⟨r_n*⟩     |r_t| = min(|r_t*|, μ r_n)     s changes if the minimum is μ r_n
//! ```
//!
//! For a point that closes in a step, s_t is the gap at the instant of closing.
//!
//! **Path.** Each step has a given length in the space of motions and load, and is solved by Newton's method with a
//! line search ([`path`]). A step is halved if it differs from two half steps, if it changes direction, or if a contact
//! point changes its mode in a step longer than 1e-5. Maxima of λ are computed again with shorter steps.
//!
//! **Corners.** If no short step continues the path, all modes of the points at the limit of their mode are tried; a
//! direction counts if a step confirms it. A direction that was possible before the corner is unloading and is left
//! out. If several remain, the direction of greatest dissipation is used. If none remains, the path is lost.

pub mod balance;
pub mod dual;
pub mod families;
pub mod law;
pub mod path;
pub mod scene;

pub use path::{End, Found, Path};
pub use scene::Scene;

use voussoir::study::Case;

/// Share of the longest step for the dead load, whose displacements are small.
const DEAD_LOAD_STEP: f64 = 0.05;

/// The path of a case: dead load, then the live load. `None` if the dead load is not carried.
pub fn integrate(case: &Case, longest: f64) -> Option<Found> {
    let scene = Scene::of_case(case);
    let dead = Path { scene: &scene, dead: true, longest: longest * DEAD_LOAD_STEP }.dead_load()?;
    Some(Path { scene: &scene, dead: false, longest }.follow(Some(&dead)))
}
