//! A second route for rigid blocks on elastic joints: equilibria as stationary points of the potential energy.
//!
//! Unknowns are the motions (u, θ) of the free blocks, with rotations of any size; contact forces are derived from
//! them. Positions, tributary areas and joint stiffnesses are read from the assembly's path problem; contact modes,
//! laws, equations and solvers of the program are not used.
//!
//! ```text
//! E(q) = Σ_c ½ k_n ⟨−g_n⟩² + ½ k_t (g_t − s)² − Σ_b m g·u_G − λ ℓ·q
//! g    = [n t]ᵀ R(θ_c)ᵀ (x⁺ − x⁻) + g_0,   θ_c = θ⁻ + β (θ⁺ − θ⁻),   x = P + u + R(θ)(X − P)
//! ```
//!
//! k_n, k_t are the stiffnesses of a point's tributary area \[N/m\], ⟨ ⟩ the positive part, s the slip, ℓ the live
//! load. E is once continuously differentiable, with a Hessian that jumps where a point opens or closes.
//!
//! - `unilateral` with `tangential = "stuck"`: s = 0, at open points too, because that law bounds r_n only. There the
//!   comparison with the program's paths is exact, and states have no history.
//! - `coulomb`: near the tip of a crack r_n → 0, so friction is reached there in every scene with shear, however large
//!   μ is. With s = 0 the comparison is then approximate, by what those few points carry; slip is not followed.
//!
//! With the load point held (ℓ·q given) λ is the multiplier of that constraint, and minima are the states that are
//! stable under control of the displacement. The pole P of a loaded block is its load point, so that ℓ·q is the
//! displacement of that point along the load exactly, whatever the rotation.

mod descent;
mod potential;
mod scene;
mod trace;

pub use descent::{Control, Landing, land, stationary};
pub use potential::{Derivatives, evaluate};
pub use scene::{EnergyScene, Held, Place, SpringPoint};
pub use trace::{Peak, Snap, State, Trace, TraceLimits, dead_load, load_path, settle};
