//! Compiled behaviours of other people as laws: `law = "external"` of joints and of materials.
//!
//! A behaviour is a C function of a shared library that keeps to MFront's generic interface, version 1 (TFEL 4 and later;
//! Helfer et al. 2020, J. Open Source Softw. 5(48)). The library says of itself what it needs; all of that is checked before it
//! is called. Running somebody's library is running somebody's program: none is opened that [`allow`] has not named.
#![doc = include_str!("external.md")]

mod behaviour;
mod buffers;
mod data;
mod isolated;
mod joint;
mod library;
#[cfg(any(not(unix), test))]
mod loopback;
mod material;
mod runner;

pub use isolated::{isolate_with, serve};
pub use joint::ExternalJoint;
pub use library::allow;
pub use material::ExternalMaterial;
