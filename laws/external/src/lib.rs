//! Compiled behaviours of other projects as laws: `law = "external"` for joints and for materials.
//!
//! A behaviour is a C function of a shared library with MFront's generic interface, version 1 (TFEL 4 and later; Helfer
//! et al. 2020, J. Open Source Softw. 5(48)). The library describes its requirements; all of them are checked before it
//! is called. To run a library of another project is to run its program: only libraries that [`allow`] has named are
//! opened.
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
