//! The force method: a path through many events where statics leaves little open.
//!
//! Blocks that are rigid on joints with a compliance of their own, and few cycles of them (an arch between
//! its abutments is one): given the three redundants X of each cycle and the load, statics gives the
//! resultant R of every section, and a section's points see nothing else. A rate problem is then three
//! equations a cycle instead of three a block, an event changes the flexibility of one section, and a
//! section none of whose points has changed its mode is a function of (X, s), s the arc of the load:
//!
//! ```text
//! R_e = E (Σ_k s_ek X_k + L_e s)       ξ_e = ξ_e⁰ − K⁻¹ ΔR_e
//! ```
//!
//! It is examined only where something may happen in it: when its rate ξ̇ has left the neighbourhood in which
//! no point can leave its mode, or when the earliest event that is possible there is near. What dissipates
//! on the way, −∫ r·dg_p with both linear in z = (X, s), is had from ∫ z dzᵀ, one matrix for all sections.
//!
//! Where this does not decide (a mechanism, many points that choose at once, no end), it gives the present
//! state back, and the rate problem is put to the whole system.
//!
//! Source: the force method for arches, Müller-Breslau (1887), Die graphische Statik der Baukonstruktionen II.

mod equations;
mod examine;
mod joint;
mod progress;
mod run;
mod section;
mod state;

pub use equations::solved;
pub use run::by_force_method;
pub use section::{Section, Sections};
