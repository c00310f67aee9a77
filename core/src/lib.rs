//! Core of Voussoir: the traits that plug-ins implement, their cards and registry, geometry, the model of an assembly
//! of blocks, and the certificates that prove an answer. The core depends on no plug-in.
//!
//! # Conventions
//! SI units; plane problems with x to the right, y upwards and `width` out of plane; rotations are positive
//! anticlockwise \[rad\]. The contact frame is (n, t): n points from the *minus* to the *plus* body, t is n rotated by
//! +90°. The gap vector g = u_plus − u_minus has components in (n, t); positive g_n is open. The contact force r acts
//! as +r on plus and as −r on minus; positive r_n is compressive. Along a joint of height h the coordinate s is
//! parallel to t and goes from −h/2 (end 0) to +h/2 (end 1).
#![forbid(unsafe_code)]

// The derive `Keys` names this crate from outside.
extern crate self as voussoir_core;

pub mod certificate;
pub mod elastic;
mod form;
pub mod law;
pub mod limit;
pub mod linear;
pub mod model;
pub mod number_text;
pub mod path;
pub mod plugin;
pub mod random;
mod registered;
pub mod space;

pub use inventory;
pub use nalgebra;
pub use serde;
pub use typetag;
