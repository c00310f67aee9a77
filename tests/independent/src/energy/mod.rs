//! An independent method for rigid blocks on elastic joints: equilibria as stationary points of the potential energy.
//!
//! Unknowns are the motions (u, θ) of the free blocks, with rotations of any size; contact forces are derived from
//! them. Positions, tributary areas and joint stiffnesses come from the path problem of the assembly. Contact modes,
//! laws, equations and solvers of the program are not used.
//!
//! ```text
//! E(q) = Σ_c ½ k_n ⟨−g_n⟩² + ½ k_t (g_t − s)² − Σ_b m g·u_G − λ ℓ·q
//! g    = [n t]ᵀ R(θ_c)ᵀ (x⁺ − x⁻) + g_0,   θ_c = θ⁻ + β (θ⁺ − θ⁻),   x = P + u + R(θ)(X − P)
//! ```
//!
//! k_n, k_t are the stiffnesses of a point's tributary area \[N/m\], ⟨ ⟩ is the positive part, s the slip, ℓ the live
//! load. E is once continuously differentiable; its Hessian jumps when a point opens or closes.
//!
//! - `unilateral` with `tangential = "stuck"`: s = 0, at open points too, because that law bounds r_n only. The
//!   comparison with the program's paths is then exact, and states have no history.
//! - `coulomb`: near the tip of a crack r_n → 0, so friction is reached there in every scene with shear, however large
//!   μ is. With s = 0 the comparison is then approximate by the forces of those few points; slip is not followed.
//!
//! With the load point held (ℓ·q given) λ is the multiplier of that constraint, and minima are the states that are
//! stable under displacement control. The pole P of a loaded block is its load point, so that ℓ·q is exactly the
//! displacement of that point along the load, for any rotation.

mod descent;
mod potential;
mod scene;
mod trace;

pub use descent::{Control, Landing, land, stationary};
pub use potential::{Derivatives, evaluate};
pub use scene::{EnergyScene, Held, Place, SpringPoint};
pub use trace::{Peak, Snap, State, Trace, TraceLimits, dead_load, load_path, settle, weigh};
