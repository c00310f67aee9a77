//! Voussoir's core: the traits plug-ins implement, their cards and registry, geometry, the model of
//! an assembly of blocks, and the certificates that prove an answer. It knows no plug-in.
//!
//! # Conventions
//! SI units; plane problems, x to the right, y upwards, `width` out of plane; rotations
//! anticlockwise \[rad\]. Contact frame (n, t): n points from the *minus* to the *plus* body,
//! t = n turned by +90°. The gap vector is g = u_plus − u_minus in (n, t), g_n ≥ 0 open. The
//! contact force r pushes with +r on plus and −r on minus, r_n ≥ 0 in compression. Along a joint
//! of height h the coordinate s runs along t from −h/2 (end 0) to +h/2 (end 1).
#![forbid(unsafe_code)]

pub mod certificate;
pub mod elastic;
mod form;
pub mod law;
pub mod limit;
pub mod linear;
pub mod model;
pub mod path;
pub mod plugin;

pub use inventory;
pub use typetag;
