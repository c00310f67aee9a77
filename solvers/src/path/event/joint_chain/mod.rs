//! Blocks in a chain, rigid or elastic: a rate problem as a band of joints and the redundants of its cycles.
//!
//! The gaps of a joint depend on the forces of the same joint and, through the two voussoirs beside it, on the forces
//! of the joints before and after it. With the resultants of all joints given by statics from the redundants X and the
//! arc s of the load, the rates of a joint e are
//!
//! ```text
//! ġ_e = C_e,e−1 ṙ_e−1 + C_ee ṙ_e + C_e,e+1 ṙ_e+1 + H_e ξ̇_e + g_p      its points in their modes
//! H_eᵀ ṙ_e = R_e = E_e (Σ_k s_ek Ẋ_k + L_e)
//! Σ_e s_ek E_eᵀ ξ̇_e = 0                                               for each cycle k
//! ```
//!
//! The first two are block tridiagonal; their inverse is stored for every joint with all joints before it condensed out
//! ([`factors`]). A point that changes its mode changes two rows, and with them two columns of the quantities passed
//! from joint to joint. Updates decrease along the chain, as stresses of forces without resultant do (Saint-Venant).
//! The responses of all joints to X and s are stored ([`chain`]) and changed by the same few columns, and so are the
//! rates ([`rates`]). After a change of a mode the residual of the rates has two entries. A correction of rates that
//! are exact to rounding is more exact than their sum from responses that cancel.
//!
//! A joint with fewer than two stuck points (a hinge, a joint that slides) may not be able to carry every resultant:
//! then H_eᵀ ṙ_e − κ ξ̇_e = R_e − κ ξ̇ with its twist ξ̇ as a further redundant.
//!
//! If this does not decide the problem (a mechanism, several possible rates), the whole system is solved.

mod chain;
mod decide;
mod factors;
mod joint;
mod rates;
mod redundants;
mod sections;

pub use chain::JointChain;
pub use decide::{Question, by_joint_chain};
