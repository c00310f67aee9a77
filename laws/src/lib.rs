//! Interface laws and bulk materials, one file each; file = tag.
#![forbid(unsafe_code)]

mod meridian;
mod parameters;

pub mod backing;
pub mod cohesive;
pub mod coulomb;
pub mod coulomb_associated;
pub mod drucker_prager_cap;
pub mod drucker_prager_softening;
pub mod elastic;
pub mod fill_pressure;
pub mod mohr_coulomb;
pub mod orthotropic_elastic;
pub mod rigid;
pub mod unilateral;
