//! Blocks in a chain, rigid or elastic: a rate problem as a band of joints and the redundants of its cycles.
//!
//! A joint's points feel those of the same joint and, through the two voussoirs beside it, those of the joints before
//! and after it. With the resultants of all joints given by statics from the redundants X and the arc s of the load,
//! the rates of a joint e are
//!
//! ```text
//! ġ_e = C_e,e−1 ṙ_e−1 + C_ee ṙ_e + C_e,e+1 ṙ_e+1 + H_e ξ̇_e + g_p      its points in their modes
//! H_eᵀ ṙ_e = R_e = E_e (Σ_k s_ek Ẋ_k + L_e)
//! Σ_e s_ek E_eᵀ ξ̇_e = 0                                               for each cycle k
//! ```
//!
//! The first two are block tridiagonal; their inverse is kept as that of every joint with all joints before it
//! condensed out ([`factors`]). A point that changes its mode changes two rows, and with them two columns of what is
//! handed on from joint to joint: updates die away along the chain, as the stresses of forces without resultant do
//! (Saint-Venant). What X, s and all joints do is kept beside ([`chain`]) and changed by the same few columns. So are the
//! rates themselves ([`rates`]): what a change of a mode leaves of them is two numbers, and a correction of rates that are
//! exact to rounding is more exact than their sum from responses that cancel.
//!
//! A joint with fewer than two stuck points (a hinge, a joint that slides) may leave no room for a resultant: there
//! H_eᵀ ṙ_e − κ ξ̇_e = R_e − κ ξ̇ with its twist ξ̇ as a further redundant.
//!
//! Where this does not decide (a mechanism, several rates that are possible), the whole system is asked.

mod chain;
mod decide;
mod factors;
mod joint;
mod rates;
mod redundants;
mod sections;

pub use chain::JointChain;
pub use decide::{Question, by_joint_chain};
